// web/src/contract.ts: the JSON documents of docs/interfaces.md as types.
import { Pose } from "./geometry";
import { ObstacleJson } from "./obstacle";

export interface GoalJson { x: number; y: number; heading?: number | null }

export interface ScenarioDocument {
  name: string;
  title?: string;
  start?: Pose;
  goal?: GoalJson | null;
  obstacles?: ObstacleJson[];
  [key: string]: unknown;
}

/** A pose of an arm's hand in W [m], as a unit quaternion. `then`: where the base drives after that. */
export interface HandGoalJson {
  x: number; y: number; z: number;
  qw: number; qx: number; qy: number; qz: number;
  arm_angle?: number; // [rad] of the elbow about the line from shoulder to wrist; absent: any
  base_stays?: boolean;
  path?: { x: number; y: number; z: number }[]; // on from there, in straight lines
  then?: GoalJson;
}

/** A robot's arm [m, rad]: seven joints in each list, the shoulder's first. */
export interface ArmInfo {
  shoulder: [number, number, number]; // in R
  heading: number;                    // of the shoulder's frame
  upper_arm: number;
  elbow_offset: number;
  forearm: number;
  hand: number;
  link_radius: number;
  mast_radius: number;
  base_height: number;
  limits: number[]; // to either side
  rates: number[];
  rest: number[];   // folded
}

/** A sensor of the robot beside scanner, sonar, infrared and bumpers. */
export interface ChannelInfo { name: string; kind: string; unit: string; values: number }

export interface RobotInfo {
  name: string;
  radius: number;
  half_length?: number; // of a rectangular hull; 0: a disc
  half_width?: number;
  half_track: number;
  period: number;
  max_v: number;
  max_omega: number;
  editable: boolean;
  paceable: boolean;
  drives: boolean;
  channels?: ChannelInfo[];
  arm?: ArmInfo;
}

export type Source = "simulation" | "replay" | "hardware";

/** One device of real hardware, in words. */
export interface DeviceInfo {
  name: string;
  port: string;
  well: boolean;
  sentence: string;
  remarks: string[];
  facts: Record<string, string>;
}

/** Real hardware as the server sees it; null in simulation. */
export interface HardwareInfo {
  armed: boolean;
  halt: string;
  trouble: string; // why the wheels stand still; empty when they may turn
  disarmed: { why: string; at: string } | null; // the last disarming; null while armed
  devices: DeviceInfo[];
  warnings: string[];
  real_time: boolean;
  memory_locked: boolean;
  missed_periods: number;
  /** How late the loop woke up: the number of ticks in each bucket, which ends at `below` [s]. */
  lateness: { ticks: number; worst: number; buckets: { below: number | null; ticks: number }[] };
}

/** The state of the live run's record; `kept_from` [s]: run clock of its oldest tick. */
export interface RecordInfo { status: string; sentence: string; kept_from: number; deleted: string | null }

/** Who did what still holds, by name or address; null: nobody that the server knows. */
export interface By {
  goal: string | null;
  stop: string | null;
  pause: string | null;
  arming: string | null;
}

/** Somebody with a WebSocket. */
export interface Party { client: number; name: string }

/** Who has the controls (`silent`: others may take over), who asks for them, and sticks that were not obeyed. */
export interface Driving {
  driver: (Party & { silent: boolean }) | null;
  asking: Party[];
  dropped: { late: number; out_of_order: number; barred: number; unreadable: number };
}

/** The /state document. */
export interface SessionState {
  run: { id: number; status: string; outcome: string } | null;
  source: Source;
  scenario: ScenarioDocument;
  controller: string;
  filter: string;
  physics: string;
  seed: number;
  robot: RobotInfo;
  pace: { paused: boolean; speed: number };
  stop: boolean;
  goal: GoalJson | null;
  goals_ahead: GoalJson[];
  goals_behind: GoalJson[]; // reached
  hand_goal?: HandGoalJson | null; // of robots with an arm, as the next two
  carry_goal?: GoalJson | null;
  joint_goal?: number[] | null;
  map: string | null;       // the file of the map that the robot knows
  loop: boolean;            // after the last goal, go on to the first
  edited: boolean;          // the world differs from the scenario as loaded or saved
  obstacles: ObstacleJson[];
  parameters: Record<string, number>;
  lost_ticks: number;
  missed_periods: number;
  problem: string | null;
  hardware: HardwareInfo | null;
  watchers: number; // pages in sight, and one more if scripts watch
  watched_by_script: boolean;
  viewers: number;  // connected pages and other clients
  by: By;
  driving: Driving;
  emulated: boolean; // the hardware's devices are emulated
  record: RecordInfo;
}

/** What an arm is asked for. */
export type ArmRequest =
  | ({ type: "set_hand_goal" } & HandGoalJson)
  | { type: "set_joints"; position: number[] }
  | ({ type: "carry" } & GoalJson);

export type RequestJson =
  | ArmRequest
  | { type: "set_goal"; x: number; y: number; heading?: number }
  | { type: "add_goal"; x: number; y: number; heading?: number }
  | { type: "set_goals"; goals: GoalJson[]; next?: number; loop?: boolean }
  | { type: "clear_goal" }
  | { type: "add_obstacle"; obstacle: ObstacleJson }
  | { type: "change_obstacle"; obstacle: ObstacleJson }
  | { type: "move_obstacle"; id: number; x: number; y: number; heading: number }
  | { type: "remove_obstacle"; id: number }
  | { type: "joystick"; forward: number; turn: number; mode: string }
  | { type: "stop"; engaged: boolean }
  | { type: "set_initial_pose"; x: number; y: number; heading: number }
  | { type: "set_initial_pose" };

/** The map that a robot knows: cells by rows from the corner, as pairs of a kind (0 unknown, 1 free, 2 wall) and the
 * number of such cells in a row. */
export interface MapDocument {
  name: string;
  cell: number; // [m]
  x: number;    // [m] the lower left corner
  y: number;
  columns: number;
  rows: number;
  cells: number[];
}

/** The answer to a request; `warning` says why a goal may not be reached. */
export interface Accepted { id?: number; warning?: string }

export interface Choice { name: string; label: string; help?: string }
export interface ParameterInfo {
  name: string;
  label: string;
  unit: string;
  min: number;
  max: number;
  step: number;
  initial: number;
  help?: string;
}
/** `outside`: the simulated world waits for its answers. */
export interface Controller extends Choice { outside: boolean; parameters: string[] }
export interface Catalog {
  controllers: Controller[];
  filters: Choice[];
  physics: Choice[];
  parameters: ParameterInfo[];
  common_parameters: string[]; // read whichever controller drives
}

/** A robot model. The description of an unusable one says why. */
export interface RobotItem { name: string; title: string; description: string; usable: boolean }

export interface ScenarioItem {
  name: string;
  title: string;
  description: string;
  builtin: boolean; // cannot be changed
  kind: "world" | "log";
}

export interface Metrics {
  outcome: string;
  time: number;
  path_length: number;
  min_clearance: number | null;
  intrusion: number | null;
  turning: number;
  via_points: number;
}

export interface RunItem {
  id: number;
  status: string;
  outcome: string;
  result: string; // the outcome, or the status of a run without one
  reason?: string | null;
  kind: "session" | "background";
  batch: number | null;
  label: string;
  note: string;
  tags: string[];
  scenario: string;
  controller: string;
  filter: string;
  physics: string;
  seed: number;
  parameters: Record<string, number>;
  ticks: number;
  time: number;     // [s] at which it reached its outcome; of the newest tick while it has none
  later: { outcome: string; reason: string; time: number } | null; // how a live run went on
  metrics: Metrics | null;
  group?: RunGroup;
  gaps?: Gap[];
  document?: RunDocument;
}

/** The runs of one batch that the list shows as one line. */
export interface RunGroup { runs: number; first: number; last: number; results: Record<string, number> }

/** A page of runs; the first one counts the runs by result. */
export interface RunPage extends Page<RunItem> { results?: Record<string, number> }

/** The answer to a change of many runs. */
export interface ManyRuns { runs: number[]; refused: { id: number; why: string }[] }

/** Ticks of a run that are not in its record. */
export interface Gap { first_tick: number; last_tick: number; cause: string; sentence: string }

/** The description of a run. */
export interface RunDocument {
  scenario: ScenarioDocument;
  robot?: RobotInfo;
  others?: ObstacleJson[]; // the other robots, as obstacles at their starts
  [key: string]: unknown;
}

export interface Page<T> { items: T[]; next: string | number | null; total?: number }
