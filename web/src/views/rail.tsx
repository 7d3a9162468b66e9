// web/src/views/rail.tsx: links to the views: a column at the left, on a phone tabs at the
// bottom, at a small height a menu.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { ViewName } from "../link/route";
import { icons } from "../ui/icons";

const kViews: { name: ViewName; label: string; icon: JSX.Element }[] = [
  { name: "drive", label: "Drive", icon: icons.drive },
  { name: "teleop", label: "Teleop", icon: icons.teleop },
  { name: "runs", label: "Runs", icon: icons.runs },
  { name: "experiments", label: "Experiments", icon: icons.experiments },
  { name: "system", label: "System", icon: icons.system },
];

export function Rail(): JSX.Element {
  const app = use_app();
  const { view, sheet, views } = use_ui("view", "sheet", "views");
  return (
    <nav class={`rail ${views ? "open" : ""}`} aria-label="Views">
      {kViews.map((v) => (
        <a key={v.name} href={`#/${v.name}`} class={v.name === view ? "on" : ""}
          aria-current={v.name === view ? "page" : undefined} data-testid={`nav-${v.name}`}>
          {v.icon}<span>{v.label}</span>
        </a>
      ))}
      {view === "drive" &&
        <button class={`narrow ${sheet ? "on" : ""}`} aria-expanded={sheet} data-testid="tune"
          onClick={() => app.ui.set({ sheet: !sheet })}>{icons.tune}<span>Tune</span></button>}
    </nav>
  );
}
