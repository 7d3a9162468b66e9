// web/src/views/shortcuts.tsx: the keys, as a table that the dialog and the System view share.
import { JSX } from "preact";
import { use_app } from "../app";
import { Dialog } from "../ui/controls";

const kShortcuts: [string[], string][] = [
  [["Space"], "Stop. Works everywhere but in a text field; Release has its own button"],
  [["P"], "Play or pause"],
  [["."], "One tick on"],
  [["V"], "Look round: drag to move the view, press to select. Every load returns to this tool"],
  [["G"], "Goal tool: press for the position, drag for the heading. Real hardware drives only after Go"],
  [["Shift+click"], "Goal tool: add a goal after the others"],
  [["C"], "Cylinder tool"],
  [["B"], "Box tool"],
  [["M"], "Measure"],
  [["N"], "Select the next obstacle or the goal"],
  [["Arrows"], "Move the selection by 0.1 m (with Shift 0.01 m)"],
  [["[", "]"], "Turn the selection by 5°"],
  [["Enter"], "Place the goal or obstacle at the crosshair (scene in focus)"],
  [["Delete"], "Remove the selection"],
  [["Ctrl+Z"], "Undo"],
  [["Ctrl+Shift+Z"], "Do again"],
  [["F"], "Fit the world into the view"],
  [["+", "−"], "Zoom"],
  [["L"], "Layers: the meaning of each colour, and its switch (Enter)"],
  [["3"], "Switch between the view from above and 3D"],
  [["Esc"], "Cancel the drawing; deselect"],
  [["?"], "This list"],
];

export function ShortcutTable(): JSX.Element {
  return (
    <table class="keys">
      <tbody>
        {kShortcuts.map(([keys, words]) => (
          <tr key={words}>
            <th scope="row">{keys.map((k) => <kbd key={k}>{k}</kbd>)}</th><td>{words}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

export function Shortcuts(): JSX.Element {
  const app = use_app();
  return (
    <Dialog title="Keys" name="shortcuts" on_close={() => app.ui.set({ shortcuts: false })}>
      <ShortcutTable />
    </Dialog>
  );
}
