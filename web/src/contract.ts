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
  devices: DeviceInfo[];
  warnings: string[];
  real_time: boolean;
  memory_locked: boolean;
  missed_periods: number;
  /** How late the loop woke up: the number of ticks in each bucket, which ends at `below` [s]. */
  lateness: { ticks: number; worst: number; buckets: { below: number | null; ticks: number }[] };
}

/** The state of the live run's record. */
export interface RecordInfo { status: string; sentence: string; deleted: string | null }

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
  obstacles: ObstacleJson[];
  parameters: Record<string, number>;
  lost_ticks: number;
  missed_periods: number;
  problem: string | null;
  hardware: HardwareInfo | null;
  watchers: number; // pages in sight, and one more if scripts watch
  watched_by_script: boolean;
  record: RecordInfo;
}

export type RequestJson =
  | { type: "set_goal"; x: number; y: number; heading?: number }
  | { type: "add_goal"; x: number; y: number; heading?: number }
  | { type: "clear_goal" }
  | { type: "add_obstacle"; obstacle: ObstacleJson }
  | { type: "move_obstacle"; id: number; x: number; y: number; heading: number }
  | { type: "remove_obstacle"; id: number }
  | { type: "stop"; engaged: boolean };

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
export interface Controller extends Choice { parameters: string[] }
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
  reason?: string | null;
  scenario: string;
  controller: string;
  filter: string;
  physics: string;
  seed: number;
  parameters: Record<string, number>;
  ticks: number;
  time: number;
  metrics: Metrics | null;
  document?: RunDocument;
}

/** The description of a run. */
export interface RunDocument {
  scenario: ScenarioDocument;
  robot?: RobotInfo;
  others?: ObstacleJson[]; // the other robots, as obstacles at their starts
  [key: string]: unknown;
}

export interface Page<T> { items: T[]; next: string | number | null; total?: number }
