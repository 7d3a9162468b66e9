// web/src/views/drop.tsx: files that are dragged onto the page.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { ScenarioDocument } from "../contract";
import { import_files } from "../edit/import";
import { use_listener, use_store } from "../state/store";
import { WhichWorld } from "./which_world";

/** Opens a dropped world in the Drive view. Its code comes with the first drag over the page. */
export function Dropped(): JSX.Element {
  const app = use_app();
  const { view } = use_ui("view");
  const hardware = use_store(app.ui, (u) => u.session?.source === "hardware");
  const takes = view === "drive" && !hardware && app.people.may("operator");
  const [over, set_over] = useState(false);
  const [several, set_several] = useState<ScenarioDocument[] | null>(null);
  use_listener("dragover", (e) => {
    if (!takes) e.dataTransfer!.dropEffect = "none";
    set_over(true);
  });
  use_listener("dragleave", (e) => e.relatedTarget === null && set_over(false));
  use_listener("drop", ({ dataTransfer }) => {
    set_over(false);
    if (takes && dataTransfer && dataTransfer.files.length > 0) void import_files(app, dataTransfer.files).then(set_several);
  });
  return <>
    {over && takes && <p class="drop" data-testid="drop">Drop a world here: a scenario, a BARN file, a map, or recorded people.</p>}
    {several && <WhichWorld worlds={several} on_close={() => set_several(null)} />}
  </>;
}
