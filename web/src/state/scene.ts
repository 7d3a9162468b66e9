// web/src/state/scene.ts: the state that is drawn, as one plain object, and how frames and the
// session's document change it. Live session and stored run fill the same object.
import type { ArmInfo, ArmRequest, RobotInfo, SessionState } from "../contract";
import { Bounds, Point, Pose, distance, empty_bounds, include } from "../geometry";
import { LayerView } from "../layer";
import type { ArmFrame, Frame, FrameRequest, Goal, Words } from "../link/frame";
import { Obstacle, include_obstacle, is_ground, obstacle_from_json } from "../obstacle";
import { Columns } from "./columns";
import { EventLog } from "./events";
import { Route, goal_from_json } from "./goals";
import { LayerKey, learn_layers } from "./layers";
import { PlacedReadings, kReadingHolds, place_readings, reading_key } from "./ranging";
import { DrivenStick, stick_after } from "./stick";
import { FilteredScan, PlacedSweep, newest_sweeps } from "./sweeps";

export interface SceneState {
  frame: Frame | null;
  sweeps: PlacedSweep[];    // the newest of each scanner
  filtered: FilteredScan;   // the scan that the controller saw
  readings: PlacedReadings; // of sonar and infrared
  layers: Map<string, LayerView>;  // of the controller; the newest of each grid
  known: Map<string, LayerKey>;    // of every layer so far, also those without values now
  words: Words | null;             // the newest
  inclination: Frame["inclination"]; // the newest
  stick: DrivenStick | null;       // of somebody who drives by hand now
  columns: Columns;
  rows: number;           // of the columns, up to the shown instant
  obstacles: Obstacle[];
  start: Pose | null;
  goal: Goal | null;
  goals_ahead: Point[]; // after that one, in order
  route: Route;         // all goals of the live robot, as set
  arm: ArmInfo | null;         // of a robot with one
  arm_plan: ArmFrame | null;   // the frame's that brought the present plan
  arm_asked: ArmRequest | null; // of the live robot's arm; null: nothing
  radius: number;         // [m] hull
  hull: { half_length: number; half_width: number } | null; // [m] of a rectangle; null: a disc
  half_track: number;     // [m]
  top: { v: number; omega: number }; // [m/s, rad/s] of the robot
  safety_distance: number; // [m] about the centre
  parameters: Record<string, number>; // of the shown instant
  scan_timeout: number; // [s] age of a scan at which the robot stops
  events: EventLog;
  run: number | null;
  controller: string;
  heard_at: number | null; // [ms] performance.now() when the newest live frame came
  drives: boolean; // false for a recorded log, which nothing steers
  world: boolean; // false for a recorded log, which has no obstacles
  map: Bounds | null; // of the map that the live robot knows
}

export function new_scene(most_rows = Infinity): SceneState {
  return {
    frame: null, sweeps: [], filtered: new FilteredScan(), readings: new Map(), layers: new Map(), known: new Map(),
    words: null, inclination: null, stick: null, columns: new Columns(most_rows), rows: 0, obstacles: [], start: null,
    goal: null, goals_ahead: [], route: { goals: [], next: 0, loop: false }, arm: null, arm_plan: null, arm_asked: null, radius: 0.35, hull: null, half_track: 0.25, top: { v: Infinity, omega: Infinity }, safety_distance: 1, parameters: {},
    scan_timeout: 0, events: new EventLog(), run: null, controller: "", heard_at: null, drives: true, world: true, map: null,
  };
}

/** Forgets the travelled path, the history and the events: a new run begins. */
export function begin_run(scene: SceneState): void {
  forget_instant(scene);
  scene.heard_at = null;
  scene.filtered.clear();
  scene.columns.clear();
  scene.rows = 0;
  scene.events.clear();
}

/** Forgets the shown instant, with the values that hold from earlier frames. */
export function forget_instant(scene: SceneState): void {
  scene.frame = null;
  scene.sweeps = [];
  scene.readings.clear();
  scene.layers.clear();
  scene.words = null;
  scene.inclination = null;
  scene.stick = null;
  scene.arm_plan = null;
}

export function fold_session(scene: SceneState, s: SessionState): void {
  const run = s.run?.id ?? null;
  if (run !== scene.run) begin_run(scene);
  if (s.controller !== scene.controller) {
    scene.layers.clear();
    scene.known.clear();
  }
  scene.controller = s.controller;
  scene.run = run;
  scene.obstacles = moved_by_themselves((s.obstacles ?? []).map(obstacle_from_json), scene.frame);
  scene.start = s.scenario?.start ?? null;
  scene.goal = goal_from_json(s.goal ?? s.carry_goal);
  scene.goals_ahead = s.goals_ahead ?? [];
  scene.route = route_of(s);
  scene.arm_asked = asked_of(s);
  take_robot(scene, s.robot);
  scene.world = s.source === "simulation";
  take_parameters(scene, s.parameters ?? {});
}

function asked_of({ hand_goal, carry_goal, joint_goal }: SessionState): ArmRequest | null {
  return hand_goal ? { type: "set_hand_goal", ...hand_goal } : carry_goal ? { type: "carry", ...carry_goal }
    : joint_goal ? { type: "set_joints", position: joint_goal } : null;
}

/** All goals, reached and ahead. */
function route_of(s: SessionState): Route {
  const behind = s.goals_behind ?? [];
  const all = [...behind, ...(s.goal ? [s.goal] : []), ...(s.goals_ahead ?? [])];
  return { goals: all.map((g) => goal_from_json(g)!), next: s.goal ? behind.length : 0, loop: s.loop ?? false };
}

export function take_robot(scene: SceneState, robot: Partial<RobotInfo> = {}): void {
  scene.radius = robot.radius ?? scene.radius;
  scene.half_track = robot.half_track ?? scene.half_track;
  scene.drives = robot.drives ?? scene.drives;
  scene.top = { v: robot.max_v ?? scene.top.v, omega: robot.max_omega ?? scene.top.omega };
  const { half_length = 0, half_width = 0 } = robot;
  scene.columns.channels = robot.channels ?? [];
  scene.arm = robot.arm ?? null;
  scene.hull = half_length > 0 ? { half_length, half_width } : null;
}

export function take_parameters(scene: SceneState, p: Record<string, number>): void {
  scene.parameters = { ...scene.parameters, ...p };
  scene.safety_distance = p.safety_distance ?? scene.safety_distance;
  scene.scan_timeout = p.scan_timeout ?? scene.scan_timeout;
}

/** A live frame: the newest instant, and a row of history. */
export function fold_frame(scene: SceneState, f: Frame): void {
  if (scene.frame && f.tick < scene.frame.tick) begin_run(scene);
  scene.columns.push(f);
  scene.rows = scene.columns.length;
  scene.events.push(f);
  learn_layers(scene.known, f.layers);
  show_frame(scene, f);
  scene.filtered.see(f);
}

/** Whether the robot tells of the ground ahead, or of its own tilt where the ground may not be level. */
export function senses_ground({ frame, inclination, obstacles, world }: SceneState): boolean {
  return (inclination !== null && (!world || obstacles.some(is_ground))) || !!frame?.measures.some((m) => /^(ground|turnover)\./.test(m.name));
}

/** Makes `f` the shown instant; the history stays. Values that `f` does not bring hold. */
export function show_frame(scene: SceneState, f: Frame): void {
  scene.frame = f;
  scene.goal = f.goal;
  scene.goals_ahead = f.goals_ahead;
  scene.words = f.words ?? scene.words;
  scene.inclination = f.inclination ?? scene.inclination;
  scene.stick = stick_after(scene.stick, f);
  if (f.arm?.ghost) scene.arm_plan = f.arm;
  else if (scene.arm_plan?.plan !== f.arm?.plan) scene.arm_plan = null;
  scene.obstacles = moved_by_themselves(scene.obstacles, f);
  for (const [name, layer] of scene.layers) if (layer.kind !== "grid" || !f.goal) scene.layers.delete(name);
  for (const layer of f.layers) {
    scene.layers.delete(layer.name); // so that the map has the order of the frame
    scene.layers.set(layer.name, layer);
  }
  scene.sweeps = newest_sweeps(scene.sweeps, f);
  place_readings(scene.readings, f);
}

/** Names of the values of `f` that hold in later frames, by the rules of `show_frame`. */
export function held_of(f: Frame): string[] {
  const mount = (m: Pose) => `${m.x} ${m.y} ${m.heading}`;
  return [
    ...(f.words ? ["words"] : []),
    ...(f.stick ? ["stick"] : []),
    ...(f.inclination ? [kInclination] : []),
    ...(f.arm?.ghost ? ["plan"] : []),
    ...(f.goal ? [] : ["no goal"]),
    ...(f.moved.length > 0 ? ["moved"] : []),
    ...f.layers.filter((l) => l.kind === "grid").map((l) => `grid ${l.name}`),
    ...f.sweeps.map((s) => `scan ${mount(s.mount)}`),
    ...f.sonar.map((r) => reading_key("sonar", r.mount)),
    ...f.infrared.map((r) => reading_key("infrared", r.mount)),
  ];
}

const kInclination = "inclination";
const kStickHolds = 2; // [s] at most: the greatest manual.joystick_timeout

/** [s] For how long the value `name` of `held_of` holds. */
export function hold_time(name: string): number {
  if (name === "stick") return kStickHolds;
  return name === kInclination || /^(sonar|infrared) /.test(name) ? kReadingHolds : Infinity;
}

/** The obstacles with the poses that `f` brings, and without those that come and go and are not in it. */
function moved_by_themselves(obstacles: Obstacle[], f: Frame | null): Obstacle[] {
  if (!f || (f.moved.length === 0 && !obstacles.some((o) => o.path?.comes_and_goes))) return obstacles;
  const places = new Map(f.moved.map((m) => [m.id, m.pose]));
  return obstacles.map((o) => {
    const pose = places.get(o.id);
    return { ...o, pose: pose ?? o.pose, away: !pose && !!o.path?.comes_and_goes };
  });
}

/** The obstacles after `request` as a new list; the same list if it changes nothing. */
export function edited(obstacles: Obstacle[], request: FrameRequest): Obstacle[] {
  switch (request.type) {
    case "add_obstacle":
      return [...obstacles.filter((o) => o.id !== request.obstacle.id), request.obstacle];
    case "change_obstacle":
      return obstacles.map((o) => (o.id === request.obstacle.id ? request.obstacle : o));
    case "move_obstacle":
      return obstacles.map((o) => (o.id === request.id ? { ...o, pose: request.pose } : o));
    case "remove_obstacle":
      return obstacles.filter((o) => o.id !== request.id);
    default:
      return obstacles;
  }
}

/** The drawn pose of the robot: that of the newest frame, or the start before the first frame. */
export function robot_pose(scene: SceneState): Pose | null {
  return scene.frame?.pose ?? scene.start;
}

/** [m] To the goal; null without one. */
export function goal_distance(scene: SceneState): number | null {
  const pose = robot_pose(scene);
  if (!scene.goal || !pose) return null;
  return distance(scene.goal, pose);
}

const kOpenSight = 4; // [m] shown about a robot in an empty world

/** The bounds of a fitted view: obstacles, start, goals and robot. */
export function scene_bounds(scene: SceneState): Bounds {
  const b = empty_bounds();
  const pose = robot_pose(scene);
  if (scene.start && scene.world) include(b, scene.start.x, scene.start.y, scene.radius + 0.25);
  if (scene.goal) include(b, scene.goal.x, scene.goal.y, 0.7);
  const hand = scene.frame?.arm?.hand_goal;
  if (hand) include(b, hand.x, hand.y, 0.3);
  for (const goal of scene.goals_ahead) include(b, goal.x, goal.y, 0.7);
  for (const o of scene.obstacles) include_obstacle(b, o);
  if (scene.map) {
    include(b, scene.map.min_x, scene.map.min_y);
    include(b, scene.map.max_x, scene.map.max_y);
  }
  const empty = !scene.world || scene.obstacles.length === 0;
  if (pose) include(b, pose.x, pose.y, empty ? kOpenSight : scene.radius + 0.25);
  if (b.min_x > b.max_x) include(b, 0, 0, 3);
  return b;
}
