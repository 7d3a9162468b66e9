// web/src/views/which_world.tsx: the choice among the worlds of an imported file.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { open_world } from "../edit/import";
import { Dialog, Pick } from "../ui/controls";

export function WhichWorld(): JSX.Element | null {
  const app = use_app();
  const { several } = use_ui("several");
  if (!several) return null;
  return (
    <Dialog title="Which world?" name="which-dialog" on_close={() => app.ui.set({ several: null })}>
      <p>The file holds {several.length} worlds.</p>
      <Pick label="World" name="which-world" value="" choices={[{ name: "", label: "Choose one" },
        ...several.map((w, i) => ({ name: String(i), label: w.title ?? w.name }))]}
        on_pick={(i) => i !== "" && void open_world(app, several[Number(i)])} />
    </Dialog>
  );
}
