// web/src/figures.ts: the figures of the page: each name once, with its unit and its meaning.
import { Metrics } from "./contract";
import { SceneState } from "./state/scene";

export interface Figure { label: string; unit: string; digits: number; meaning: string }

const figure = (label: string, unit: string, digits: number, meaning: string): Figure => ({ label, unit, digits, meaning });

/** Of the live robot. */
export const kLive = {
  true_clearance: figure("True clearance", "m", 2,
    "From the robot's hull to the nearest surface on any side, as the simulator knows it. Negative inside an obstacle."),
  clearance: figure("Clear ahead", "m", 2,
    "From the robot's hull to the nearest return of the filtered scan. The scanner looks ahead only: an obstacle beside " +
    "or behind its field is not seen. \">\" means that nothing was within its range."),
  speed: figure("Speed", "m/s", 2, "Along the robot's heading, by its wheels. Negative backwards."),
  turn_rate: figure("Turn rate", "rad/s", 2, "Of the heading, by the wheels. Positive to the left."),
  to_goal: figure("To goal", "m", 2, "Straight from the robot's centre, by odometry, to its present goal."),
  scans: figure("Scans", "", 0, "Of the log that were replayed so far."),
  state: figure("State", "", 0, "What the robot is doing in one word. The sentence in the scene says why."),
};

/** Of a finished run. `min_clearance` and `intrusion` are true in simulation, and of the filtered scan elsewhere. */
export const kMetrics: (Figure & { of: (m: Metrics) => number | null })[] = [
  { ...figure("Time", "s", 1, "Of the run's own clock, from its start to its first outcome."), of: (m) => m.time },
  { ...figure("Least clearance", "m", 2,
    "The least distance from the hull to a surface during the run: true in simulation, by the filtered scan elsewhere."),
    of: (m) => m.min_clearance },
  { ...figure("Intrusion", "m", 2,
    "How far a surface came into the safety circle about the robot's centre. 0: it never did."), of: (m) => m.intrusion },
  { ...figure("Path", "m", 2, "Length of the way that the robot drove."), of: (m) => m.path_length },
  { ...figure("Turning", "rad", 2, "The turns of the heading added up, to either side."), of: (m) => m.turning },
  { ...figure("Via points", "", 0, "Points that the strip was led through near obstacles."), of: (m) => m.via_points },
];

/** Of the System view, by the name of their row. */
const kSystem: Record<string, string> = {
  "State": "Of the page's connection: frames that came in a second, and the time of a message to the server and back.",
  "Address": "The server that this page came from.",
  "Api": "The version of the REST interface; it is part of each path.",
  "Name": "Of the program that serves this page.",
  "Version": "Of the program that serves this page.",
  "Signed in": "Whether this browser has signed in with the server's token.",
  "Drawing a frame":
    "Time that the page spends on drawing the scene, in ms: the mean of the last frames and the longest of them, and how " +
    "many were drawn in the last second. Below 16.7 ms a screen of 60 frames a second misses none.",
  "Robot": "The model that drives.",
  "Source": "Where the sensor readings come from: a simulation, a recorded log, or hardware.",
  "Scenario": "The world and the start.",
  "Run": "The number under which this drive is recorded, and the state of its record.",
  "Tick": "The period of the control loop, in ms.",
  "Hull radius": "Of the circle about the centre that holds the robot, in m.",
  "Limits": "The greatest speed in m/s and turn rate in rad/s that the base takes.",
  "Seed": "Of the random numbers: the same scenario with the same seed gives the same run.",
  "Watched": "Pages in sight of somebody, and scripts.",
  "Record": "Whether what the robot does is written down.",
  "Lost ticks": "Ticks of this run that a fault kept out of the record.",
  "Missed periods": "Ticks that began too late, so that one after it was left out.",
};

/** The meaning of a row of the System view; null for one without a figure. */
export function system_meaning(name: string): string | null {
  return kSystem[name] ?? null;
}

/** For people who cannot see the unit beside the value. */
export function figure_words(f: { unit: string; meaning: string }): string {
  return f.unit ? `${f.meaning} Unit: ${f.unit}.` : f.meaning;
}

/** The clearance that Drive shows: the true one in simulation, else that of the filtered scan; "–" while unknown. */
export function shown_clearance(scene: SceneState, simulated: boolean): Figure & { value: number | null; beyond: boolean } {
  const f = scene.frame;
  if (simulated) {
    const value = f?.truth?.clearance;
    return { ...kLive.true_clearance, value: Number.isFinite(value) ? value! : null, beyond: false };
  }
  const scan = scene.sweeps.at(0)?.sweep;
  const known = f !== null && (scan !== undefined || scene.readings.size > 0);
  // A scan without a return gives its range, less the radius.
  const beyond = known && scan !== undefined && f.clearance > scan.range_max - scene.radius - 1e-3;
  return { ...kLive.clearance, value: known ? f.clearance : null, beyond };
}
