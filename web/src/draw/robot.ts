// web/src/draw/robot.ts: the robot, its safety circle, and its goals.
import { Point, Pose } from "../geometry";
import { Goal } from "../link/frame";
import { Context, arrow, circle, fill, polyline, stroke, write } from "./marks";
import { Palette } from "./palette";
import { SceneState } from "../state/scene";
import { View } from "./view";

type Hull = SceneState["hull"];

export function draw_safety(g: Context, view: View, palette: Palette, pose: Pose,
  radius: number): void {
  g.globalAlpha = 0.75;
  circle(g, view, pose, radius * view.scale);
  stroke(g, palette.safe, 1.4, [5, 6]);
  g.globalAlpha = 1;
}

/** Hull, two wheels and an arrowhead ahead. */
export function draw_robot(g: Context, view: View, palette: Palette, pose: Pose, radius: number,
  half_track: number, colour = palette.robot, alpha = 1, hull: Hull = null): void {
  const s = view.scale;
  const r = Math.max(radius * s, 6);
  const k = r / radius; // small robots are drawn no smaller than 12 px across
  g.save();
  g.globalAlpha = alpha;
  g.translate(view.sx(pose.x), view.sy(pose.y));
  g.rotate(-pose.heading);
  trace_hull(g, s, r, hull);
  fill(g, palette.panel);
  stroke(g, colour, Math.max(1.5, Math.min(2.4, r / 8)));
  g.fillStyle = colour;
  const wheel = Math.min(half_track, radius * 0.86);
  g.fillRect(-0.29 * r, (-wheel - 0.035) * k, 0.58 * r, 0.07 * k);
  g.fillRect(-0.29 * r, (wheel - 0.035) * k, 0.58 * r, 0.07 * k);
  g.beginPath();
  g.moveTo(0.77 * r, 0);
  g.lineTo(0.14 * r, -0.32 * r);
  g.lineTo(0.14 * r, 0.32 * r);
  g.fill();
  g.restore();
}

/** Begins an outline about the origin: `hull` at `scale` [px/m], or a disc of `radius` [px]. */
function trace_hull(g: Context, scale: number, radius: number, hull: Hull): void {
  g.beginPath();
  if (hull) {
    g.rect(-hull.half_length * scale, -hull.half_width * scale, 2 * hull.half_length * scale, 2 * hull.half_width * scale);
  } else {
    g.arc(0, 0, radius, 0, 2 * Math.PI);
  }
}

/** The true pose, beside the drifted odometry. */
export function draw_truth(g: Context, view: View, palette: Palette, pose: Pose, radius: number, hull: Hull): void {
  g.save();
  g.translate(view.sx(pose.x), view.sy(pose.y));
  g.rotate(-pose.heading);
  trace_hull(g, view.scale, radius * view.scale, hull);
  stroke(g, palette.muted, 1.2, [2, 3]);
  g.restore();
}

export function draw_goal(g: Context, view: View, palette: Palette, goal: Goal, selected: boolean,
  draft = false): void {
  circle(g, view, goal, Math.max(9, 0.2 * view.scale));
  stroke(g, palette.ok, selected ? 4 : 2.5, draft ? [4, 4] : []);
  g.globalAlpha = 0.16;
  fill(g, palette.ok);
  g.globalAlpha = 1;
  circle(g, view, goal, 2.5);
  fill(g, palette.ok);
  if (goal.heading !== null) {
    const length = Math.max(0.46, 26 / view.scale);
    arrow(g, view, goal, { x: length * Math.cos(goal.heading), y: length * Math.sin(goal.heading) },
      1, palette.ok, 2.6);
  }
}

/** The goals after `goal` with their numbers, and the line through them if the `route` is shown. */
export function draw_goals_ahead(g: Context, view: View, palette: Palette, goal: Point,
  ahead: Point[], route: boolean): void {
  if (ahead.length === 0) return;
  if (route) {
    polyline(g, view, [goal, ...ahead], palette.ok, 1.4, [3, 5]);
  }
  ahead.forEach((next, i) => {
    circle(g, view, next, 9);
    fill(g, palette.bg);
    stroke(g, palette.ok, 1.4);
    write(g, String(i + 2), view.sx(next.x), view.sy(next.y) + 0.5, palette.ok, `600 11px ${palette.font}`);
  });
}
