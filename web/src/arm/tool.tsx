// web/src/arm/tool.tsx: the tool by which the hand's goal is set in the scene.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";

export function HandTool(): JSX.Element {
  const app = use_app();
  const { tool, three } = use_ui("tool", "three");
  const on = tool === "hand";
  const label = three ? "Hand: drag the axes to move its goal, the rings to turn it"
    : "Hand: press for the goal's position, drag for the direction";
  return (
    <button class={on ? "on" : ""} aria-pressed={on} aria-label={label} title={`${label} (H)`} data-testid="tool-hand"
      onClick={() => app.pick_tool(on && three ? "pan" : "hand")}>
      <svg viewBox="0 0 20 20" fill="none" stroke="currentColor" stroke-width="1.7" stroke-linecap="round"
        stroke-linejoin="round" aria-hidden="true" focusable="false">
        <path d="M4 17v-6l4-6 6 4M14 9l3.5-.5M14 9l1 3.4" /><circle cx="8" cy="5" r="1.6" /><path d="M2 17h5" />
      </svg>
    </button>
  );
}
