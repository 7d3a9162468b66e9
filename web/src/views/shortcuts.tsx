// web/src/views/shortcuts.tsx: the help: how the scene is used by hand, the theme, and the keys as a table
// that the System view shares.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { Dialog } from "../ui/controls";
import { icons } from "../ui/icons";

const kShortcuts: [string[], string][] = [
  [["Space"], "Stop. Works everywhere but in a text field; Release has its own button"],
  [["P"], "Play or pause; while looking back, the record"],
  [[","], "One tick back: look back in the run, while the robot goes on"],
  [["."], "One tick on"],
  [["L", "End"], "Live again, while looking back"],
  [["V"], "Look round: drag to move the view, press to select. Every load returns to this tool"],
  [["G"], "Goal tool: press for the position, drag for the heading. Real hardware drives only after Go"],
  [["Shift+click"], "Goal tool: add a goal after the others"],
  [["I"], "Robots that know a map, pose tool: press where the robot is, drag for its heading"],
  [["S"], "Start tool: where the robot begins after the next reset"],
  [["W"], "Wall tool"],
  [["C"], "Cylinder tool"],
  [["B"], "Box tool"],
  [["O"], "Polygon tool"],
  [["K"], "Walking person: press the corners of the path"],
  [["R", "E", "T"], "Ramp, step and trench tools: drag the way over it; a ramp rises along the drag"],
  [["M"], "Measure"],
  [["H"], "Robots with an arm, hand tool: press for the place of the hand's goal, drag for its bearing; in 3D axes and rings"],
  [["PgUp", "PgDn"], "The chosen goal of the hand: 0.1 m up or down (with Shift 0.01 m); arrows move it on"],
  [["[", "]", "{", "}", "(", ")"], "The chosen goal of the hand: bearing, pitch and turn by 5°"],
  [["N"], "Select the next obstacle or the goal"],
  [["Arrows"], "Move the selection by 0.1 m (with Shift 0.01 m); with none, the crosshair, which tells what is there"],
  [["[", "]"], "Turn the selection by 5°"],
  [["Enter"], "Place the goal or obstacle at the crosshair (scene in focus); with Shift, one more goal"],
  [["Delete"], "Remove the selection"],
  [["Ctrl+D"], "Duplicate the selected obstacle"],
  [["Ctrl+Z"], "Undo"],
  [["Ctrl+Shift+Z"], "Do again"],
  [["F"], "Fit the world into the view"],
  [["+", "−"], "Zoom"],
  [["L"], "Layers: the meaning of each colour, and its switch (Enter)"],
  [["3"], "Switch between the view from above and 3D"],
  [["←", "→"], "Plots in focus: one tick back or on (with Shift ten); + and − zoom, 0 goes back"],
  [["X", "Shift+Arrows"], "Runs: select the run in focus, or those on the way"],
  [["W", "A", "S", "D", "Arrows"], "Teleop: drive by hand while held"],
  [["Esc"], "Cancel the drawing; deselect"],
  [["?"], "Help and this list"],
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
  const { theme } = use_ui("theme");
  const next = theme === "dark" ? "light" : "dark";
  const close = () => app.ui.set({ shortcuts: false });
  return (
    <Dialog title="Help" name="shortcuts" on_close={close}>
      <ol class="how">
        <li>Choose the goal tool and press in the scene: the robot drives there.</li>
        <li>Put a cylinder or a box in its way, or drag one that stands there.</li>
        <li>Choose another controller. Every drive is kept under Runs.</li>
      </ol>
      <p class="quiet">By hand: drag to look round with the first tool, two fingers or the wheel to zoom, press to select.</p>
      <p class="ways">
        <button class="ghost" data-testid="steps-again" onClick={() => {
          app.to_step(0);
          close();
          app.go("drive");
        }}>Show the first steps</button>
        <button class="ghost" data-testid="help-theme" onClick={() => app.set_theme(next)}>{icons.theme}Use the {next} theme</button>
      </p>
      <h3>Keys</h3>
      <ShortcutTable />
    </Dialog>
  );
}
