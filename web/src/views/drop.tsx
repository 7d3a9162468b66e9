// web/src/views/drop.tsx: files that are dragged onto the page.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { use_listener, use_store } from "../state/store";

/** Opens a dropped world in the Drive view. A browser left to itself would open the file in place of the page. */
export function Drop(): JSX.Element | null {
  const app = use_app();
  const { view } = use_ui("view");
  const hardware = use_store(app.ui, (u) => u.session?.source === "hardware");
  const [over, set_over] = useState(false);
  const takes = view === "drive" && !hardware && app.people.may("operator");
  const holds_files = (e: DragEvent) => e.dataTransfer?.types.includes("Files") ?? false;
  use_listener("dragover", (e) => {
    if (!holds_files(e)) return;
    e.preventDefault();
    e.dataTransfer!.dropEffect = takes ? "copy" : "none";
    if (takes) set_over(true);
  });
  use_listener("dragleave", (e) => e.relatedTarget === null && set_over(false));
  use_listener("drop", (e) => {
    if (!holds_files(e)) return;
    e.preventDefault();
    set_over(false);
    const { files } = e.dataTransfer!;
    if (takes && files.length > 0) void import("../edit/import").then(({ import_files }) => import_files(app, files));
  });
  if (!over) return null;
  return <p class="drop" data-testid="drop">Drop a world here: a scenario, a BARN file, a map, or recorded people.</p>;
}
