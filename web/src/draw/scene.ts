// web/src/draw/scene.ts: the whole picture from above, in the order in which things lie.
import { Obstacle } from "../obstacle";
import { Point, Pose } from "../geometry";
import { Goal } from "../link/frame";
import { Columns } from "../state/columns";
import { sweep_age } from "../state/age";
import { SceneState, robot_pose } from "../state/scene";
import { Palette } from "./palette";
import { draw_bumpers, draw_ranging } from "./ranging";
import { draw_goal, draw_goals_ahead, draw_robot, draw_safety, draw_truth } from "./robot";
import { draw_fan, draw_nearest, draw_returns } from "./sensing";
import { draw_forces, draw_path, draw_strip } from "./strip";
import { Insets, View } from "./view";
import { draw_candidates, draw_cells, draw_histogram, draw_plan, draw_tracks } from "./weighing";
import { draw_grid, draw_obstacles, draw_scale, trace_obstacle } from "./world";

export type Selection = { kind: "goal" } | { kind: "obstacle"; id: number } | null;

/** What a gesture is about to do; drawn, not yet asked for. */
export interface Draft {
  goal?: Goal;
  obstacle?: Obstacle;
  measure?: { from: Point; to: Point };
  cursor?: Point; // the keyboard's crosshair
  /** Obstacle whose drawn pose is the hand's rather than the server's. */
  moved?: { id: number; pose: Pose };
}

/** A second run drawn over the first. */
export interface Ghost { columns: Columns; rows: number; pose: Pose | null; radius: number }

export interface Overlay {
  selection: Selection;
  hovered: number | null;
  draft: Draft;
  force_scale: number;
  ghost: Ghost | null;
  /** Draws the path still to come, faintly. */
  future: boolean;
  insets: Insets;
  /** A goal that the robot has not been sent to. */
  preview?: Goal | null;
  /** A path in the strip's colour, as the Runs view draws the first of two. */
  path_colour?: string;
}

export function draw_scene(g: CanvasRenderingContext2D, view: View, palette: Palette,
  scene: SceneState, overlay: Overlay): void {
  g.fillStyle = palette.bg;
  g.fillRect(0, 0, view.width, view.height);
  draw_grid(g, view, palette);
  const pose = robot_pose(scene);
  const f = scene.frame;
  const old = new Set(scene.sweeps.filter((s) => sweep_age(scene, s) !== null));
  for (const sweep of scene.sweeps) if (!old.has(sweep)) draw_fan(g, view, palette, sweep);
  const selected = overlay.selection?.kind === "obstacle" ? overlay.selection.id : null;
  draw_obstacles(g, view, palette, held_obstacles(scene.obstacles, overlay.draft), selected,
    overlay.hovered);
  for (const sweep of scene.sweeps) draw_returns(g, view, palette, sweep, old.has(sweep));
  draw_ranging(g, view, palette, scene.readings);
  if (scene.grid && f?.goal) draw_cells(g, view, palette, scene.grid);
  const path = overlay.path_colour ?? palette.path;
  if (overlay.future) {
    draw_path(g, view, scene.columns, 0, scene.columns.length, path, 2, 0.3);
  }
  if (overlay.ghost) draw_ghost(g, view, palette, overlay.ghost);
  draw_path(g, view, scene.columns, 0, Math.min(scene.rows, scene.columns.length), path, 3);
  if (pose && scene.world) draw_safety(g, view, palette, pose, scene.safety_distance);
  const preview = overlay.preview && !overlay.draft.goal ? overlay.preview : null;
  if (preview) draw_goal(g, view, palette, preview, overlay.selection?.kind === "goal", true);
  const goal = overlay.draft.goal ?? scene.goal;
  if (goal) {
    draw_goals_ahead(g, view, palette, goal, scene.goals_ahead);
    draw_goal(g, view, palette, goal, overlay.selection?.kind === "goal" && !preview,
      !!overlay.draft.goal);
  }
  if (f) draw_tracks(g, view, palette, f);
  if (f && old.size === 0) draw_nearest(g, view, palette, f);
  if (f) draw_plan(g, view, palette, f);
  if (f) draw_histogram(g, view, palette, f);
  if (pose) draw_robot(g, view, palette, pose, scene.radius, scene.half_track, palette.robot, 1, scene.hull);
  if (f) draw_bumpers(g, view, palette, f, scene.radius);
  if (f) draw_candidates(g, view, palette, f);
  if (f?.truth && pose && Math.hypot(f.truth.pose.x - pose.x, f.truth.pose.y - pose.y) > 0.03) {
    draw_truth(g, view, palette, f.truth.pose, scene.radius);
  }
  // A strip of one step ends inside the hull, so it lies on top of it.
  if (f) draw_strip(g, view, palette, f);
  if (f) draw_forces(g, view, palette, f, overlay.force_scale);
  draw_draft(g, view, palette, overlay.draft);
  draw_scale(g, view, palette, overlay.insets);
}

/** The obstacles, with the one in the hand where the hand is. */
function held_obstacles(obstacles: Obstacle[], draft: Draft): Obstacle[] {
  const moved = draft.moved;
  if (!moved) return obstacles;
  return obstacles.map((o) => (o.id === moved.id ? { ...o, pose: moved.pose } : o));
}

function draw_ghost(g: CanvasRenderingContext2D, view: View, palette: Palette, ghost: Ghost): void {
  draw_path(g, view, ghost.columns, 0, ghost.columns.length, palette.elastic, 2, 0.4);
  draw_path(g, view, ghost.columns, 0, ghost.rows, palette.elastic, 2.5, 0.9);
  if (!ghost.pose) return;
  draw_robot(g, view, palette, ghost.pose, ghost.radius, ghost.radius * 0.7, palette.elastic, 0.8);
}

function draw_draft(g: CanvasRenderingContext2D, view: View, palette: Palette, draft: Draft): void {
  if (draft.obstacle) {
    trace_obstacle(g, view, draft.obstacle);
    g.fillStyle = palette.obst;
    g.globalAlpha = 0.6;
    g.fill();
    g.globalAlpha = 1;
    g.strokeStyle = palette.accent;
    g.lineWidth = 2;
    g.setLineDash([5, 4]);
    g.stroke();
    g.setLineDash([]);
  }
  if (draft.measure) draw_measure(g, view, palette, draft.measure.from, draft.measure.to);
  if (!draft.cursor) return;
  const c = view.to_screen(draft.cursor);
  g.strokeStyle = palette.text;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(c.x - 11, c.y);
  g.lineTo(c.x + 11, c.y);
  g.moveTo(c.x, c.y - 11);
  g.lineTo(c.x, c.y + 11);
  g.stroke();
}

function draw_measure(g: CanvasRenderingContext2D, view: View, palette: Palette, from: Point,
  to: Point): void {
  const a = view.to_screen(from);
  const b = view.to_screen(to);
  g.strokeStyle = palette.text;
  g.fillStyle = palette.text;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(a.x, a.y);
  g.lineTo(b.x, b.y);
  g.stroke();
  for (const p of [a, b]) {
    g.beginPath();
    g.arc(p.x, p.y, 3.5, 0, 2 * Math.PI);
    g.fill();
  }
  const text = `${Math.hypot(to.x - from.x, to.y - from.y).toFixed(2)} m`;
  g.font = `600 13px ${palette.font}`;
  const w = g.measureText(text).width + 16;
  const x = (a.x + b.x) / 2;
  const y = (a.y + b.y) / 2 - 20;
  g.fillStyle = palette.panel;
  g.beginPath();
  g.roundRect(x - w / 2, y - 12, w, 24, 6);
  g.fill();
  g.fillStyle = palette.text;
  g.textAlign = "center";
  g.textBaseline = "middle";
  g.fillText(text, x, y + 1);
}
