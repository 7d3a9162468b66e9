// web/src/views/rail.tsx: links to the views: a column at the left, on a phone tabs at the bottom.
import { JSX } from "preact";
import { ViewName, use_app, use_ui } from "../app";
import { icons } from "../ui/icons";

const kViews: { name: ViewName; label: string; icon: JSX.Element }[] = [
  { name: "drive", label: "Drive", icon: icons.drive },
  { name: "runs", label: "Runs", icon: icons.runs },
  { name: "system", label: "System", icon: icons.system },
];

export function Rail(): JSX.Element {
  const app = use_app();
  const { view, sheet } = use_ui("view", "sheet");
  return (
    <nav class="rail" aria-label="Views">
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
