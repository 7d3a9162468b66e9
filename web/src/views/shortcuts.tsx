// web/src/views/shortcuts.tsx: the keys, as a table that the dialog and the System view share.
import { JSX } from "preact";
import { use_app } from "../app";
import { Dialog } from "../ui/controls";

const kShortcuts: [string[], string][] = [
  [["Space"], "Stop. Works everywhere but in a text field; Release is a button of its own"],
  [["P"], "Play or pause"],
  [["."], "One tick on"],
  [["V"], "Look round, as after every load: drag to move the view, press to see what is there"],
  [["G"], "Goal tool: press where, drag for the heading. Real hardware sets off with Go only"],
  [["Shift+click"], "Goal tool: a further goal, for when those before it are reached"],
  [["C"], "Cylinder tool"],
  [["B"], "Box tool"],
  [["M"], "Measure"],
  [["N"], "Select the next obstacle or the goal"],
  [["Arrows"], "Move what is selected by 0.1 m (with Shift 0.01 m)"],
  [["[", "]"], "Turn what is selected by 5°"],
  [["Enter"], "Place what the tool makes at the crosshair (scene in focus)"],
  [["Delete"], "Remove what is selected"],
  [["Ctrl+Z"], "Undo"],
  [["Ctrl+Shift+Z"], "Do again"],
  [["F"], "Fit the world into the view"],
  [["+", "−"], "Zoom"],
  [["L"], "Layers: what the colours mean, each with its switch (Enter)"],
  [["3"], "Seen from above or in 3D"],
  [["Esc"], "Leave what is being drawn; deselect"],
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
