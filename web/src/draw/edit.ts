// web/src/draw/edit.ts: marks of the editor: handles, sketches, the paths of movers, start and route.
import { corners_of } from "../edit/edits";
import { handles_of } from "../edit/handles";
import { Point, Pose } from "../geometry";
import { Obstacle } from "../obstacle";
import { Route } from "../state/goals";
import { Context, arrow, circle, fill, polyline, stroke, write } from "./marks";
import { Palette } from "./palette";
import { draw_goal } from "./robot";
import { View } from "./view";

const kHandle = 6; // [px] half a side

/** Squares at corners and keys, a ring with a stem for the handle that turns. */
export function draw_handles(g: Context, view: View, palette: Palette, o: Obstacle): void {
  for (const { at, kind } of handles_of(o)) {
    if (kind === "turn") {
      polyline(g, view, [o.pose, at], palette.accent, 1.5);
      circle(g, view, at, kHandle);
    } else {
      g.beginPath();
      g.rect(view.sx(at.x) - kHandle, view.sy(at.y) - kHandle, 2 * kHandle, 2 * kHandle);
    }
    fill(g, palette.panel);
    stroke(g, kind === "key" ? palette.text : palette.accent, 2);
  }
}

/** The corners so far, joined. */
export function draw_sketch(g: Context, view: View, palette: Palette, points: Point[]): void {
  polyline(g, view, points, palette.accent, 2, [5, 4]);
  for (const p of points) {
    circle(g, view, p, 4);
    fill(g, palette.accent);
  }
}

/** The ways of obstacles that move by themselves; of a crowd that comes and goes only the selected one's. */
export function draw_paths(g: Context, view: View, palette: Palette, obstacles: Obstacle[], selected: number | null): void {
  for (const o of obstacles) {
    if (!o.path || (o.path.comes_and_goes && o.id !== selected)) continue;
    polyline(g, view, corners_of(o.path), o.id === selected ? palette.accent : palette.obstline, 1.5, [6, 5]);
  }
}

export function draw_start(g: Context, view: View, palette: Palette, start: Pose | null): void {
  if (!start) return;
  circle(g, view, start, 6);
  stroke(g, palette.muted, 1.6);
  const length = Math.max(0.3, 20 / view.scale);
  arrow(g, view, start, { x: length * Math.cos(start.heading), y: length * Math.sin(start.heading) }, 1, palette.muted, 2);
}

/** All goals with their numbers; the one to which the robot drives is drawn strongest. */
export function draw_route(g: Context, view: View, palette: Palette, route: Route, selected: number | null): void {
  const { goals, next, loop } = route;
  polyline(g, view, loop && goals.length > 2 ? [...goals, goals[0]] : goals, palette.ok, 1.4, [3, 5]);
  goals.forEach((goal, i) => {
    g.save();
    if (i < next && !loop) g.globalAlpha = 0.5;
    draw_goal(g, view, palette, goal, i === selected || (selected === null && i === next));
    g.restore();
    write(g, String(i + 1), view.sx(goal.x), view.sy(goal.y) - Math.max(9, 0.2 * view.scale) - 8, palette.ok,
      `600 12px ${palette.font}`);
  });
}
