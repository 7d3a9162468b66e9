// web/src/views/which_world.tsx: the choice among the worlds of an imported file.
import { JSX } from "preact";
import { use_app } from "../app";
import { ScenarioDocument } from "../contract";
import { open_world } from "../edit/import";
import { Dialog, Pick } from "../ui/controls";

export function WhichWorld(props: { worlds: ScenarioDocument[]; on_close: () => void }): JSX.Element {
  const app = use_app();
  const { worlds, on_close } = props;
  const open = (world: ScenarioDocument) => {
    on_close();
    void open_world(app, world);
  };
  return (
    <Dialog title="Which world?" name="which-dialog" on_close={on_close}>
      <p>There are {worlds.length} worlds.</p>
      <Pick label="World" name="which-world" value="" choices={[{ name: "", label: "Choose one" },
        ...worlds.map((w, i) => ({ name: String(i), label: w.title ?? w.name }))]}
        on_pick={(i) => i !== "" && open(worlds[Number(i)])} />
    </Dialog>
  );
}
