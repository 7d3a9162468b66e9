// web/src/draw/scene.ts: the whole scene from above, from the lowest drawing to the uppermost.
import type { HandGoalJson } from "../contract";
import { Obstacle, is_ground, present } from "../obstacle";
import { Point, Pose, distance } from "../geometry";
import { Goal } from "../link/frame";
import { Columns } from "../state/columns";
import { sweep_age } from "../state/age";
import { kOwn, visible_layers } from "../state/layers";
import { SceneState, robot_pose, senses_ground } from "../state/scene";
import { kRing } from "../state/stick";
import { sweep_points } from "../state/sweeps";
import { draw_layer, stacked } from "./layers";
import { Context, circle, dots, draw_path, fill, polyline, stroke, write } from "./marks";
import { Palette } from "./palette";
import { draw_handles, draw_paths, draw_route, draw_sketch, draw_start } from "./edit";
import { draw_goal, draw_goals_ahead, draw_robot, draw_safety, draw_truth } from "./robot";
import { draw_bumpers, draw_fan, draw_ranging } from "./sensing";
import { Insets, View } from "./view";
import { draw_grid, draw_obstacles, draw_scale, trace_obstacle } from "./world";

/** A goal without an index is the one to which the robot drives. */
export type Selection = { kind: "goal"; index?: number } | { kind: "obstacle"; id: number } | { kind: "hand" } | null;

/** An edit in progress: drawn, but not sent. */
export interface Draft {
  goal?: Goal;
  hand?: HandGoalJson; // of an arm
  obstacle?: Obstacle;
  start?: Pose;
  pose?: Pose; // of the robot on its map
  sketch?: Point[]; // corners so far
  measure?: { from: Point; to: Point };
  cursor?: Point; // the keyboard's crosshair
  moved?: { id: number; pose: Pose }; // an obstacle in the hand
}

/** Another run drawn over the first, in its own colour and dashes. */
export interface Ghost {
  columns: Columns; rows: number; pose: Pose | null; radius: number; hull: SceneState["hull"];
  look: RunLook;
}
/** How a compared run is drawn. The letter and the dashes repeat what the colour says. */
export interface RunLook { letter: string; colour: "accent" | "elastic" | "third" | "fourth"; dash: number[] }

export interface Overlay {
  selection: Selection;
  hovered: number | null;
  draft: Draft;
  force_scale: number;
  hidden: ReadonlySet<string>; // names of the layers that are switched off
  ghosts: Ghost[];
  future: boolean;             // draws the path still to come, faintly
  insets: Insets;
  handles?: boolean;           // of the selected obstacle
  pointer?: Point | null;      // the place of W under the mouse or the crosshair
  preview?: Goal | null;       // a goal that is not sent yet
  hand?: HandGoalJson | null;  // a goal of the arm's hand that is not sent yet
  /** Another colour of the path: the Runs view draws the first of two runs in the accent. */
  path?: "accent";
}

/** Draws something of `scene`, by the layers that are not `hidden`. */
type Draw = (g: Context, view: View, palette: Palette, scene: SceneState, hidden: ReadonlySet<string>) => void;
interface DriverDrawings { draw_sectors: Draw; draw_ways_ahead: Draw; draw_wall_words: Draw }
let driver: DriverDrawings | null = null;

/** Adds what a driver sees to every scene from now on. The part of the page for driving brings it along. */
export function draw_for_driver(drawings: DriverDrawings): void {
  driver = drawings;
}

interface GroundDrawings {
  draw_ground(g: Context, view: View, palette: Palette, ground: Obstacle[], selected: number | null, hovered: number | null): void;
  draw_tilt(g: Context, view: View, palette: Palette, scene: SceneState): void;
}
let grounds: GroundDrawings | null = null;

/** Draws ramps, steps and trenches from now on. */
export function draw_on_ground(drawings: GroundDrawings): void {
  grounds = drawings;
}
/** Whether something of `scene` needs drawings that draw/ground.ts has yet to bring. */
export function lacks_ground(scene: SceneState): boolean {
  return !grounds && (scene.obstacles.some(is_ground) || !!scene.frame?.tilt || senses_ground(scene));
}

interface MapDrawings {
  draw_map(g: Context, view: View, palette: Palette): void;
  draw_sure(g: Context, view: View, palette: Palette, scene: SceneState): void;
}
let maps: MapDrawings | null = null;

/** Draws the map that the robot knows, and how sure it is of its pose, from now on. */
export function draw_on_map(drawings: MapDrawings): void {
  maps = drawings;
}

interface ArmDrawings { draw_plan: DrawArm; draw_arm: DrawArm }
type DrawArm = (g: Context, view: View, palette: Palette, scene: SceneState, overlay: Overlay) => void;
let arms: ArmDrawings | null = null;

/** Draws arms from now on. */
export function draw_arms(drawings: ArmDrawings): void {
  arms = drawings;
}
/** Whether `scene` has an arm that arm/draw.ts has yet to draw. */
export const lacks_arm = (scene: SceneState): boolean => !arms && scene.arm !== null;

export const kDrift = 0.03; // [m] of odometry from which the true pose is drawn as well

export function draw_scene(g: Context, view: View, palette: Palette,
  scene: SceneState, overlay: Overlay): void {
  g.fillStyle = palette.bg;
  g.fillRect(0, 0, view.width, view.height);
  if (!overlay.hidden.has(kOwn.mesh.name)) draw_grid(g, view, palette);
  if (!overlay.hidden.has(kOwn.map.name)) maps?.draw_map(g, view, palette);
  const solids: Obstacle[] = [], ground: Obstacle[] = [];
  const there = present(scene.obstacles);
  for (const o of held_obstacles(there, overlay.draft)) (is_ground(o) ? ground : solids).push(o);
  const pose = robot_pose(scene);
  const f = scene.frame;
  const on = (key: { name: string }) => !overlay.hidden.has(key.name);
  const shown = visible_layers(scene, overlay.hidden);
  const { below, above } = stacked(shown.filter((l) => !driver || l.name !== kRing));
  const canvas = f && { g, view, palette, robot: f.pose, radius: scene.radius, times: overlay.force_scale };

  const filtered = on(kOwn.filtered) ? scene.filtered.shown : null;
  const filtered_old = filtered !== null && sweep_age(scene, filtered) !== null;
  const selected = overlay.selection?.kind === "obstacle" ? overlay.selection.id : null;
  if (on(kOwn.ground)) grounds?.draw_ground(g, view, palette, ground, selected, overlay.hovered);
  if (filtered && !filtered_old) draw_fan(g, view, palette, filtered);
  draw_obstacles(g, view, palette, solids, selected, overlay.hovered);
  if (on(kOwn.ways)) draw_paths(g, view, palette, scene.obstacles, selected);
  if (on(kOwn.scan)) for (const sweep of scene.sweeps) dots(g, view, sweep_points(sweep).hits, palette.scan, 2.2);
  if (filtered) dots(g, view, sweep_points(filtered).hits, filtered_old ? palette.scan : palette.filtered, 1.4);
  if (on(kOwn.ranging)) draw_ranging(g, view, palette, scene.readings);
  const grids = below.filter((l) => l.kind === "grid");
  if (canvas) for (const layer of grids) draw_layer(canvas, layer);
  driver?.draw_sectors(g, view, palette, scene, overlay.hidden);
  draw_ways(g, view, palette, scene, overlay);
  driver?.draw_ways_ahead(g, view, palette, scene, overlay.hidden);
  arms?.draw_plan(g, view, palette, scene, overlay);
  if (pose && scene.drives && on(kOwn.safety)) draw_safety(g, view, palette, pose, scene.safety_distance);
  draw_goals(g, view, palette, scene, overlay);
  if (canvas) for (const layer of below) if (!grids.includes(layer)) draw_layer(canvas, layer);
  if (on(kOwn.sure)) maps?.draw_sure(g, view, palette, scene);
  if (pose) draw_robot(g, view, palette, pose, scene.radius, scene.half_track, palette.robot, 1, scene.hull);
  grounds?.draw_tilt(g, view, palette, scene);
  if (f) draw_bumpers(g, view, palette, f, scene.radius);
  if (f?.truth && on(kOwn.truth) && distance(f.truth.pose, f.pose) > kDrift) {
    draw_truth(g, view, palette, f.truth.pose, scene.radius, scene.hull);
  }
  arms?.draw_arm(g, view, palette, scene, overlay);
  if (canvas) for (const layer of above) draw_layer(canvas, layer);
  driver?.draw_wall_words(g, view, palette, scene, overlay.hidden);
  const held = there.find((o) => o.id === selected);
  if (held && overlay.handles && !overlay.draft.moved) draw_handles(g, view, palette, overlay.draft.obstacle ?? held);
  draw_draft(g, view, palette, overlay.draft);
  if (overlay.draft.pose) {
    draw_robot(g, view, palette, overlay.draft.pose, scene.radius, scene.half_track, palette.accent, 0.8, scene.hull);
  }
  draw_scale(g, view, palette, overlay.insets, overlay.pointer ?? null);
}

/** The travelled path, the true one, the path of a second run, and the path still to come of a stored run. */
function draw_ways(g: Context, view: View, palette: Palette, scene: SceneState, overlay: Overlay): void {
  const travelled = !overlay.hidden.has(kOwn.path.name);
  const colour = palette[overlay.path ?? "path"];
  if (overlay.future && travelled) draw_path(g, view, scene.columns, 0, scene.columns.length, colour, 2, 0.3);
  for (const ghost of overlay.ghosts) draw_ghost(g, view, palette, ghost);
  const rows = Math.min(scene.rows, scene.columns.length);
  if (!overlay.hidden.has(kOwn.truth.name)) draw_path(g, view, scene.columns, 0, rows, palette.muted, 2, 1, [6, 5], true);
  if (travelled) draw_path(g, view, scene.columns, 0, rows, colour, 3);
}

function draw_goals(g: Context, view: View, palette: Palette, scene: SceneState, overlay: Overlay): void {
  const preview = overlay.preview && !overlay.draft.goal ? overlay.preview : null;
  if (preview) draw_goal(g, view, palette, preview, overlay.selection?.kind === "goal", true);
  draw_start(g, view, palette, overlay.draft.start ?? scene.start);
  const goal = overlay.draft.goal ?? scene.goal;
  const routed = !overlay.hidden.has(kOwn.route.name);
  if (routed && scene.route.goals.length > 1) {
    const index = overlay.selection?.kind === "goal" ? overlay.selection.index ?? null : null;
    draw_route(g, view, palette, scene.route, index);
    if (overlay.draft.goal) draw_goal(g, view, palette, overlay.draft.goal, true, true);
    return;
  }
  if (!goal) return;
  draw_goals_ahead(g, view, palette, goal, scene.goals_ahead, routed);
  draw_goal(g, view, palette, goal, overlay.selection?.kind === "goal" && !preview, !!overlay.draft.goal);
}

/** The obstacles, with the one that is dragged at the pointer. */
function held_obstacles(obstacles: Obstacle[], draft: Draft): Obstacle[] {
  const moved = draft.moved;
  if (!moved) return obstacles;
  return obstacles.map((o) => (o.id === moved.id ? { ...o, pose: moved.pose } : o));
}

function draw_ghost(g: Context, view: View, palette: Palette, ghost: Ghost): void {
  const { columns, rows, pose, radius, hull, look } = ghost;
  const colour = palette[look.colour];
  draw_path(g, view, columns, 0, columns.length, colour, 2, 0.4, look.dash);
  draw_path(g, view, columns, 0, rows, colour, 2.5, 0.9, look.dash);
  if (!pose) return;
  draw_robot(g, view, palette, pose, radius, radius * 0.7, colour, 0.8, hull);
  const { x, y } = view.to_screen(pose);
  g.font = `600 13px ${palette.font}`;
  g.textAlign = "center";
  g.fillStyle = colour;
  g.fillText(look.letter, x, y - Math.max(radius * view.scale, 6) - 5);
}

function draw_draft(g: Context, view: View, palette: Palette, draft: Draft): void {
  if (draft.sketch) draw_sketch(g, view, palette, draft.sketch);
  if (draft.obstacle) {
    if (is_ground(draft.obstacle)) grounds?.draw_ground(g, view, palette, [draft.obstacle], null, null);
    trace_obstacle(g, view, draft.obstacle);
    g.globalAlpha = is_ground(draft.obstacle) ? 0 : 0.6;
    fill(g, palette.obst);
    g.globalAlpha = 1;
    stroke(g, palette.accent, 2, [5, 4]);
  }
  if (draft.measure) draw_measure(g, view, palette, draft.measure.from, draft.measure.to);
  if (!draft.cursor) return;
  const c = view.to_screen(draft.cursor);
  g.beginPath();
  g.moveTo(c.x - 11, c.y);
  g.lineTo(c.x + 11, c.y);
  g.moveTo(c.x, c.y - 11);
  g.lineTo(c.x, c.y + 11);
  stroke(g, palette.text, 1.5);
}

function draw_measure(g: Context, view: View, palette: Palette, from: Point, to: Point): void {
  polyline(g, view, [from, to], palette.text, 1.5);
  for (const p of [from, to]) {
    circle(g, view, p, 3.5);
    fill(g, palette.text);
  }
  const text = `${distance(from, to).toFixed(2)} m`;
  const font = `600 13px ${palette.font}`;
  g.font = font;
  const w = g.measureText(text).width + 16;
  const x = (view.sx(from.x) + view.sx(to.x)) / 2;
  const y = (view.sy(from.y) + view.sy(to.y)) / 2 - 20;
  g.beginPath();
  g.roundRect(x - w / 2, y - 12, w, 24, 6);
  fill(g, palette.panel);
  write(g, text, x, y + 1, palette.text, font);
}
