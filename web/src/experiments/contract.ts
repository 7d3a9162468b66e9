// web/src/experiments/contract.ts: the JSON documents about experiments (docs/interfaces.md) as types.

export type ExperimentState = "running" | "paused" | "interrupted" | "cancelled" | "finished";

export interface ExperimentInfo {
  id: string;
  name: string;
  by: string;
  created: string;
  state: ExperimentState;
  problem: string;
  runs: number;
  done: number;
  failed: number;
  rate: number | null;      // [runs/s]
  time_left: number | null; // [s]
}

export interface ExperimentDetail extends ExperimentInfo {
  arms: string[];
  scenarios: string[];
  document: unknown;
  files: string[];
}

export interface Rate { count: number; runs: number; rate: number | null; interval?: [number, number] }

/** Without runs that have the figure, only `n`. */
export interface Figure {
  n: number;
  least?: number;
  lower_quartile?: number;
  median?: number;
  upper_quartile?: number;
  largest?: number;
  mean?: number;
  mean_interval?: [number, number];
}

/** The runs of one controller at one setting, in all scenarios or in one. */
export interface Arm {
  label: string;
  controller: string;
  runs: number;
  missing: number;
  rates: Record<string, Rate>;
  figures: Record<string, Figure>;
}

export interface Comparison {
  label: string;
  baseline: string;
  [test: string]: unknown;
}

export interface Results {
  arms: Arm[];
  scenarios?: (Arm & { scenario: string })[];
  comparisons: Comparison[];
  runs: number;
  missing: number;
  failed: number;
  complete: boolean;
}

export interface ExperimentRun {
  run: number;
  scenario: string;
  controller: string;
  seed: number;
  outcome: string;
  reason: string;
  figures: Record<string, number | null>;
  command: string;
}

export interface RunsPage { items: ExperimentRun[]; found: number; next: number | null }

export type Point = [number, number]; // [m] x, y

/** The world of a scenario at its start, and a path a controller. */
export interface PathsOf {
  scenario: string;
  obstacles: { x?: number; y?: number; radius?: number; corners?: Point[] }[];
  start: { x: number; y: number };
  radius: number; // [m] of the robot
  goal: { x: number; y: number };
  paths: { run: number; controller: string; outcome: string; points: Point[] }[];
}

export interface Estimate {
  name: string;
  runs: number;
  scenarios: number;
  controllers: number;
  settings: number;
  seeds: number;
  cpu_time: number; // [s]
  bytes: number;
  extrapolated: boolean; // not every controller was measured
}
