// web/src/experiments/paths.tsx: the paths of all controllers in one scenario, over its world. A
// press on a path makes its run again and opens it.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { may } from "../people";
import { Guard, use_me } from "../ui/guard";
import { result_word, titled } from "../words";
import { PathsOf, Point } from "./contract";
import { tone_of } from "./results_table";
import { use_paths } from "./watch";

const kEdge = 0.6;  // [m] around the drawing
const kDashes = ["", "8 4", "2 4", "10 4 2 4"] /* [px] */;
const kTones = 4;   // colours of paths in experiments.css; the baseline's and the picked one's are those of the table

export function Paths(props: {
  id: string; scenario: string; done: number | null; baseline: string | null; picked: string | null;
  on_replay: (run: number) => Promise<void>;
}): JSX.Element | null {
  const { value } = use_paths(props.id, props.scenario, props.done);
  const [pointed, set_pointed] = useState<number | null>(null);
  const [busy, set_busy] = useState<number | null>(null);
  const me = use_me();
  if (!value || value.paths.length === 0) return null;
  const operator = may(me, "operator");
  const replay = async (run: number) => {
    if (!operator || busy !== null) return;
    set_busy(run);
    await props.on_replay(run);
    set_busy(null);
  };
  const tone = (i: number) => {
    const named = tone_of(value.paths[i].controller, props.baseline, props.picked);
    return named === "muted" ? `path-${i % kTones}` : named;
  };
  const path = (i: number) => `path tone-${tone(i)} ${pointed === null ? "" : pointed === i ? "pointed" : "other"}`;
  const [x, y, width, height] = box_of(value);
  return (
    <section class="experiment-paths" aria-label="Paths over the world" data-testid="experiment-paths">
      <h3>Paths in {titled(value.scenario)}</h3>
      <div>
        <svg viewBox={`${x} ${-y - height} ${width} ${height}`} role="img" aria-label={`The paths of ${value.paths.length} controllers from the start to the goal; the list beside names them.`}>
          {value.obstacles.map((o, i) => o.corners
            ? <polygon key={i} class="obstacle" points={points_text(o.corners)} />
            : <circle key={i} class="obstacle" cx={o.x} cy={-o.y!} r={o.radius} />)}
          <circle class="start" cx={value.start.x} cy={-value.start.y} r={value.radius} />
          <path class="goal" d={`M${value.goal.x - 0.15} ${-value.goal.y}h.3m-.15 -.15v.3`} />
          {value.paths.map((each, i) => (
            <g key={each.run} class={path(i)} onPointerEnter={() => set_pointed(i)} onPointerLeave={() => set_pointed(null)} onClick={() => void replay(each.run)}>
              <polyline class="reach" points={points_text(each.points)} />
              <polyline points={points_text(each.points)} stroke-dasharray={kDashes[Math.floor(i / kTones) % kDashes.length]} />
              <title>{each.controller}: {result_word(each.outcome).word}.{operator && " Press to replay."}</title>
            </g>
          ))}
        </svg>
        <Guard need="operator"><ul>
          {value.paths.map((each, i) => (
            <li key={each.run}>
              <button class={`text ${path(i)}`} disabled={busy !== null} data-testid={`path-${each.run}`} onPointerEnter={() => set_pointed(i)}
                onPointerLeave={() => set_pointed(null)} onFocus={() => set_pointed(i)} onBlur={() => set_pointed(null)} onClick={() => void replay(each.run)}>
                <svg viewBox="0 -0.2 1 0.4" aria-hidden="true"><polyline points="0,0 1,0" stroke-dasharray={kDashes[Math.floor(i / kTones) % kDashes.length]} /></svg>
                <b>{each.controller}</b> <span>{busy === each.run ? "Making it again" : result_word(each.outcome).word}</span>
              </button>
            </li>
          ))}
        </ul></Guard>
      </div>
    </section>
  );
}

/** y points down in a picture. */
const points_text = (points: Point[]) => points.map(([x, y]) => `${x},${-y}`).join(" ");

/** x, y, width and height of everything drawn, in metres of the world. */
function box_of(value: PathsOf): [number, number, number, number] {
  const around = (x: number, y: number, r: number): Point[] => [[x - r, y - r], [x + r, y + r]];
  const all: Point[] = [
    ...around(value.start.x, value.start.y, value.radius), [value.goal.x, value.goal.y], ...value.paths.flatMap((each) => each.points),
    ...value.obstacles.flatMap((o) => o.corners ?? around(o.x!, o.y!, o.radius!)),
  ];
  let [left, low, right, high] = [Infinity, Infinity, -Infinity, -Infinity];
  for (const [x, y] of all) {
    [left, low, right, high] = [Math.min(left, x), Math.min(low, y), Math.max(right, x), Math.max(high, y)];
  }
  return [left - kEdge, low - kEdge, right - left + 2 * kEdge, high - low + 2 * kEdge];
}
