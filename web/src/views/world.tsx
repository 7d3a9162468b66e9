// web/src/views/world.tsx: the World tab: the world's name, its files, start and goals, what was changed.
import { JSX } from "preact";
import css from "../style/world.css?text";
import { use_app, use_ui } from "../app";
import { reordered } from "../edit/edits";
import { degrees } from "../geometry";
import { is_robot } from "../obstacle";
import { use_pulse } from "../state/store";
import { icons } from "../ui/icons";
import { adopt } from "../ui/sheet";
import { fixed } from "../words";
import { WorldFiles } from "./world_files";

export { Dropped } from "./drop";

adopt(css);

const kPulse = 300; // [ms]

export function World(): JSX.Element {
  const { session } = use_ui("session");
  use_pulse(kPulse);
  if (!session?.robot.editable) {
    return <p class="help">{session ? "This world cannot be changed: it is real, or a recording." : "The world appears here once the server has been reached."}</p>;
  }
  return (
    <>
      <WorldFiles />
      <p class="quiet" data-testid="world-words"><Contents /></p>
      <Route />
      <Changes />
    </>
  );
}

/** "6 walls, 3 boxes, 1 walker, 3 goals". */
function Contents(): JSX.Element {
  const app = use_app();
  const count = new Map<string, number>();
  for (const o of app.scene.obstacles) {
    const name = is_robot(o) ? "robot" : o.path ? "walker" : o.kind;
    count.set(name, (count.get(name) ?? 0) + 1);
  }
  count.set("goal", app.scene.route.goals.length);
  const words = [...count].filter(([, n]) => n > 0)
    .map(([name, n]) => `${n} ${n === 1 ? name : name === "box" || name === "trench" ? `${name}es` : `${name}s`}`);
  return <>{words.length > 0 ? words.join(", ") : "Nothing stands here yet. Pick a tool and draw."}</>;
}

function place(p: { x: number; y: number; heading: number | null }): string {
  const turn = p.heading === null ? "any heading" : `${fixed(degrees(p.heading), 0)}°`;
  return `${fixed(p.x, 2)}, ${fixed(p.y, 2)} m, ${turn}`;
}

function Route(): JSX.Element {
  const app = use_app();
  const { selection, snap } = use_ui("selection", "snap");
  const { route, start } = app.scene;
  const { goals, next, loop } = route;
  const chosen = selection?.kind === "goal" ? selection.index ?? next : null;
  const move = (index: number, by: number) => app.editor.want_route("Reorder goals", reordered(route, index, by));
  return (
    <section>
      <h2>Start and goals</h2>
      <ol class="places">
        {start && <li>
          <button class="place" data-testid="place-start" onClick={() => app.pick_tool("start")}>
            <b>S</b><span>Start<small class="num">{place(start)}</small></span>
          </button>
        </li>}
        {goals.map((goal, i) => (
          <li key={i} class={`${i === chosen ? "on" : ""} ${i < next && !loop ? "past" : ""}`}>
            <button class="place" data-testid={`place-${i + 1}`} aria-pressed={i === chosen}
              onClick={() => app.ui.set({ selection: goals.length > 1 ? { kind: "goal", index: i } : { kind: "goal" } })}>
              <b>{i + 1}</b><span>{i === next ? "Goal, driving to it" : "Goal"}<small class="num">{place(goal)}</small></span>
            </button>
            <button class="icon" aria-label={`Goal ${i + 1} earlier`} title="Earlier" disabled={i === 0} data-testid={`earlier-${i + 1}`}
              onClick={() => move(i, -1)}>{icons.up}</button>
            <button class="icon" aria-label={`Goal ${i + 1} later`} title="Later" disabled={i === goals.length - 1}
              onClick={() => move(i, 1)}>{icons.down}</button>
            <button class="icon" aria-label={`Remove goal ${i + 1}`} title="Remove"
              onClick={() => app.editor.change_goal(i, null)}>{icons.trash}</button>
          </li>
        ))}
      </ol>
      {goals.length === 0 && <p class="help">No goal yet. Pick the goal tool and press where the robot shall go.</p>}
      <label class="check"><input type="checkbox" checked={loop} disabled={goals.length < 2} data-testid="route-loop"
        onChange={(e) => app.editor.want_route(e.currentTarget.checked ? "Loop goals" : "End the loop", { ...route, loop: e.currentTarget.checked })} />
        <span>Loop: after the last goal back to the first</span></label>
      <label class="check"><input type="checkbox" checked={snap} data-testid="snap"
        onChange={(e) => app.ui.set({ snap: e.currentTarget.checked })} />
        <span>Snap drawings to corners and 0.1 m</span></label>
    </section>
  );
}

const kShown = 6; // changes

function Changes(): JSX.Element | null {
  const app = use_app();
  const { undo } = use_ui("undo");
  const done = app.editor.history.done.slice(0, kShown);
  if (undo === null) return null;
  return (
    <section>
      <h2>Your changes</h2>
      <ul class="changes" data-testid="changes">
        {done.map((edit, i) => (
          <li key={edit.at}><time class="num">{new Date(edit.at ?? 0).toLocaleTimeString([], { hour12: false })}</time>
            <span>{edit.label}</span>
            {i === 0 && <button class="text" onClick={() => void app.editor.undo()}>Undo</button>}</li>
        ))}
      </ul>
    </section>
  );
}
