// web/src/state/scene.ts: what there is to draw, as one plain object, and how a frame and the
// session's document are folded into it. Live session and stored run fill the same object.
import { moved_along, ObstaclePath, paths_of } from "./paths";
import { SessionState } from "../contract";
import { FilterName, apply_filter, samples_of } from "../filter";
import { Bounds, Point, Pose, compose, empty_bounds, include } from "../geometry";
import { Frame, FrameRequest, Goal, GridLayer, Sweep, kMaxRange } from "../link/frame";
import { Obstacle, include_obstacle, obstacle_from_json } from "../obstacle";
import { Columns } from "./columns";
import { EventLog } from "./events";
import { PlacedReadings, place_readings } from "./ranging";

/** A sweep where it was taken. Points are worked out when first drawn, not per message. */
export interface PlacedSweep {
  sweep: Sweep;
  origin: Pose; // of the scanner in W
  filter: string;
  half_width: number;
  points: SweepPoints | null;
}

/** Points in W; x, y alternate. `end` holds every beam's end for the field of view, NaN: none. */
export interface SweepPoints { raw: Float32Array; filtered: Float32Array; end: Float32Array }

export interface SceneState {
  frame: Frame | null;
  sweeps: PlacedSweep[];    // the newest of each scanner
  readings: PlacedReadings; // of sonar and infrared
  grid: GridLayer | null; // the controller's newest
  columns: Columns;
  rows: number;           // of columns that have happened at the shown instant
  obstacles: Obstacle[];
  paths: ObstaclePath[];  // of those that move by themselves
  start: Pose | null;
  goal: Goal | null;
  goals_ahead: Point[]; // after that one, in order
  radius: number;         // [m] hull
  hull: { half_length: number; half_width: number } | null; // [m] of a rectangle; null: a disc
  half_track: number;     // [m]
  filter: FilterName | string;
  half_width: number;
  safety_distance: number; // [m] about the centre
  scan_timeout: number; // [s] the age of a scan by which the robot stops
  events: EventLog;
  run: number | null;
  heard_at: number | null; // [ms] performance.now() when the newest live frame came
  /** A world has walls to fit; a log has only what the scanner saw. */
  world: boolean;
}

export function new_scene(most_rows = Infinity): SceneState {
  return {
    frame: null, sweeps: [], readings: new Map(), grid: null, columns: new Columns(most_rows), rows: 0, obstacles: [], paths: [], start: null,
    goal: null, goals_ahead: [], radius: 0.35, hull: null, half_track: 0.25, filter: "none", half_width: 1, safety_distance: 1,
    scan_timeout: 0,
    events: new EventLog(), run: null, heard_at: null, world: true,
  };
}

/** Forgets the travelled path, the history and the events: a new run begins. */
export function begin_run(scene: SceneState): void {
  scene.frame = null;
  scene.heard_at = null;
  scene.sweeps = [];
  scene.readings.clear();
  scene.grid = null;
  scene.columns.clear();
  scene.rows = 0;
  scene.events.clear();
}

export function fold_session(scene: SceneState, s: SessionState): void {
  const run = s.run?.id ?? null;
  if (run !== scene.run) begin_run(scene);
  scene.run = run;
  scene.obstacles = (s.obstacles ?? []).map(obstacle_from_json);
  scene.paths = paths_of(s.scenario?.obstacles ?? []);
  scene.start = s.scenario?.start ?? null;
  scene.goal = s.goal ? { x: s.goal.x, y: s.goal.y, heading: s.goal.heading ?? null } : null;
  scene.goals_ahead = s.goals_ahead ?? [];
  scene.radius = s.robot?.radius ?? scene.radius;
  const { half_length = 0, half_width = 0 } = s.robot ?? {};
  scene.hull = half_length > 0 ? { half_length, half_width } : null;
  scene.half_track = s.robot?.half_track ?? scene.half_track;
  scene.filter = s.filter;
  scene.world = s.source === "simulation";
  take_parameters(scene, s.parameters ?? {});
}

export function take_parameters(scene: SceneState, p: Record<string, number>): void {
  scene.half_width = Math.round(p.filter_half_width ?? scene.half_width);
  scene.safety_distance = p.safety_distance ?? scene.safety_distance;
  scene.scan_timeout = p.scan_timeout ?? scene.scan_timeout;
}

/** A live frame: the newest instant, and a row of history. */
export function fold_frame(scene: SceneState, f: Frame): void {
  if (scene.frame && f.tick < scene.frame.tick) begin_run(scene);
  scene.columns.push(f);
  scene.rows = scene.columns.length;
  scene.events.push(f);
  show_frame(scene, f);
}

/** Makes `f` the shown instant without touching the history. */
export function show_frame(scene: SceneState, f: Frame): void {
  scene.frame = f;
  scene.goal = f.goal;
  scene.goals_ahead = f.goals_ahead;
  scene.grid = f.grid ?? scene.grid;
  if (scene.paths.length > 0) scene.obstacles = moved_along(scene.obstacles, scene.paths, f.stamp);
  place_sweeps(scene, f);
  place_readings(scene.readings, f);
}

const same = (a: Pose, b: Pose): boolean =>
  a.x === b.x && a.y === b.y && a.heading === b.heading;

export function place_sweeps(scene: SceneState, f: Frame): void {
  if (f.sweeps.length === 0) return;
  // Scanners deliver when they are ready, each in its own phase: the others' sweeps stay.
  const others = scene.sweeps.filter((old) => old.sweep.stamp <= f.stamp &&
    !f.sweeps.some((sweep) => same(sweep.mount, old.sweep.mount)));
  const fresh = f.sweeps.map((sweep) => ({
    sweep,
    origin: compose(f.pose, sweep.mount),
    filter: scene.filter,
    half_width: scene.half_width,
    points: null,
  }));
  scene.sweeps = [...others, ...fresh];
}

/** Obstacles after `request`, as a new list; the old one when it changes nothing. */
export function edited(obstacles: Obstacle[], request: FrameRequest): Obstacle[] {
  switch (request.type) {
    case "add_obstacle":
      return [...obstacles.filter((o) => o.id !== request.obstacle.id), request.obstacle];
    case "move_obstacle":
      return obstacles.map((o) => (o.id === request.id ? { ...o, pose: request.pose } : o));
    case "remove_obstacle":
      return obstacles.filter((o) => o.id !== request.id);
    default:
      return obstacles;
  }
}

/** Where the sweep's beams ended, raw and filtered. Kept with the sweep. */
export function sweep_points(placed: PlacedSweep): SweepPoints {
  if (placed.points) return placed.points;
  const { sweep, origin } = placed;
  const raw_samples = samples_of(sweep);
  const filtered = apply_filter(placed.filter, placed.half_width, raw_samples);
  const size = sweep.ranges.length;
  const raw: number[] = [];
  const kept: number[] = [];
  const end = new Float32Array(2 * size).fill(NaN);
  for (let i = 0; i < size; ++i) {
    const bearing = origin.heading + sweep.angle_min + i * sweep.angle_increment;
    const c = Math.cos(bearing);
    const s = Math.sin(bearing);
    if (sweep.ranges[i] <= kMaxRange) {
      const r = raw_samples.values[i];
      raw.push(origin.x + r * c, origin.y + r * s);
    }
    if (!filtered.valid[i]) continue;
    const r = Math.min(filtered.values[i], sweep.range_max);
    end[2 * i] = origin.x + r * c;
    end[2 * i + 1] = origin.y + r * s;
    if (r < sweep.range_max) kept.push(end[2 * i], end[2 * i + 1]);
  }
  placed.points = { raw: Float32Array.from(raw), filtered: Float32Array.from(kept), end };
  return placed.points;
}

/** Where the robot is drawn: the newest frame's pose, or the start before the first frame. */
export function robot_pose(scene: SceneState): Pose | null {
  return scene.frame?.pose ?? scene.start;
}

/** [m] To the goal; null without one. */
export function goal_distance(scene: SceneState): number | null {
  const pose = robot_pose(scene);
  if (!scene.goal || !pose) return null;
  return Math.hypot(scene.goal.x - pose.x, scene.goal.y - pose.y);
}

/** What a fitted view should show: the world and all that moves in it. */
export function scene_bounds(scene: SceneState): Bounds {
  const b = empty_bounds();
  const pose = robot_pose(scene);
  if (scene.start && scene.world) include(b, scene.start.x, scene.start.y, scene.radius + 0.25);
  if (scene.goal) include(b, scene.goal.x, scene.goal.y, 0.7);
  for (const goal of scene.goals_ahead) include(b, goal.x, goal.y, 0.7);
  for (const o of scene.obstacles) include_obstacle(b, o);
  if (pose) include(b, pose.x, pose.y, scene.world ? scene.radius + 0.25 : 5);
  if (b.min_x > b.max_x) include(b, 0, 0, 3);
  return b;
}
