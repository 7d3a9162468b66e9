// web/src/state/signals.ts: the signals of every robot: column, label, unit and meaning, and how each is read from a
// frame. Columns have their names of the CSV.
import { distance } from "../geometry";
import { Frame } from "../link/frame";
import type { Token } from "./layers";

export interface Signal {
  name: string;            // of its column
  label: string;
  unit: string;
  meaning: string;
  group: string;           // in the list to choose from
  plot: string;            // signals with the same plot share their axes
  least: [number, number]; // range of the values that is always shown
  digits: number;          // after the point
  colour: Token;
  dash: number[];
  usual: boolean;          // shown until a person chooses
}

/** What a frame's signals need of the frames before it. */
export interface Before {
  stamp: number; // [s] of the tick before; NaN: none yet
  scan: number;  // [s] of the newest scan; NaN: none yet
  sees: boolean; // a scan or an echo has come
}

interface FrameSignal extends Signal { of: (f: Frame, before: Before) => number }

export const kDash = [5, 3];
const flag = (on: boolean) => (on ? 1 : 0);

type Words = Pick<Signal, "name" | "label" | "unit" | "meaning" | "group" | "plot"> & Partial<Signal>;
function signal(words: Words, of: FrameSignal["of"]): FrameSignal {
  return { least: [0, 0.2], digits: 2, colour: "accent", dash: [], usual: false, ...words, of };
}

export const kSensors = "Sensors";
const [kMotion, kSafety, kControl, kTruth] = ["Motion", "Clearance", "Control", "Simulation"];

/** Of the seven joints, and of the links: robots with an arm have them. */
const kInTurn: Pick<Signal, "colour" | "dash">[] = [
  ...(["accent", "filtered", "path", "ok"] as const).map((colour) => ({ colour, dash: [] })),
  ...(["accent", "filtered", "path"] as const).map((colour) => ({ colour, dash: kDash })),
];
const kArm = kInTurn.flatMap((look, k) => [
  signal({ ...look, name: `joint[${k}]`, label: `Joint ${k + 1}`, unit: "rad", group: "Arm", plot: "Joints", least: [-1, 1], usual: true,
    meaning: "Position that the arm measures; the shoulder's joints come first" }, (f) => f.joints?.[k] ?? NaN),
  signal({ ...look, name: `joint_moves[${k}]`, label: `Joint ${k + 1}`, unit: "rad/s", group: "Arm: rates", plot: "Joint rates", least: [-0.5, 0.5],
    meaning: "Turn rate that the arm measures" }, (f) => f.joint_rates[k] ?? NaN),
]);
const kLinks = ["base", "mast", "upper_arm", "forearm", "hand"].map((link, k) =>
  signal({ ...kInTurn[k], name: `clearance.${link}`, label: `Clear of ${link.replace("_", " ")}`, unit: "m", group: "Arm", plot: "Clearance of the links",
    meaning: "To the nearest thing that the robot knows" }, (f) => f.arm?.clearance[k] ?? NaN));

/** The signals of every robot. A signal without a value so far is not offered. */
export const kFrameSignals: FrameSignal[] = [
  signal({ name: "clearance", label: "Clear ahead", unit: "m", group: kSafety, plot: "Clearance", least: [0, 1],
    colour: "filtered", usual: true,
    meaning: "From the hull to the nearest return of the filtered scan; the scanner's range if there is none" },
  (f, { sees }) => (sees ? f.clearance : NaN)), // before the first reading the wire has 0
  signal({ name: "truth.clearance", label: "True clearance", unit: "m", group: kSafety, plot: "Clearance", least: [0, 1],
    colour: "ok", dash: kDash, usual: true, meaning: "From the hull to the nearest obstacle, as the simulator knows it; negative inside" },
  (f) => f.truth?.clearance ?? NaN),
  signal({ name: "truth.obstacle_distance", label: "True distance", unit: "m", group: kSafety, plot: "Clearance", least: [0, 1],
    colour: "muted", dash: kDash, meaning: "From the robot's centre to the nearest obstacle, as the simulator knows it" },
  (f) => f.truth?.distance ?? NaN),
  signal({ name: "goal.distance", label: "To the goal", unit: "m", group: kMotion, plot: "To the goal", colour: "ok",
    meaning: "From the robot's centre to the current goal" }, (f) => (f.goal ? distance(f.goal, f.pose) : NaN)),
  signal({ name: "v", label: "Commanded speed", unit: "m/s", group: kMotion, plot: "Speed", usual: true,
    meaning: "Forward speed that the gate sends to the base" }, (f) => f.command.v),
  signal({ name: "odometry.v", label: "Executed speed", unit: "m/s", group: kMotion, plot: "Speed", colour: "path", dash: kDash,
    usual: true, meaning: "Forward speed over the last period, by odometry" }, (f) => f.twist.v),
  signal({ name: "omega", label: "Commanded turn rate", unit: "rad/s", group: kMotion, plot: "Turn rate", least: [-0.2, 0.2],
    usual: true, meaning: "Turn rate that the gate sends to the base; left is positive" }, (f) => f.command.omega),
  signal({ name: "odometry.omega", label: "Executed turn rate", unit: "rad/s", group: kMotion, plot: "Turn rate",
    least: [-0.2, 0.2], colour: "path", dash: kDash, usual: true,
    meaning: "Turn rate over the last period, by odometry; left is positive" }, (f) => f.twist.omega),
  signal({ name: "x", label: "x", unit: "m", group: kMotion, plot: "Position",
    meaning: "Position by odometry along the world's x" }, (f) => f.pose.x),
  signal({ name: "y", label: "y", unit: "m", group: kMotion, plot: "Position", colour: "path", dash: kDash,
    meaning: "Position by odometry along the world's y" }, (f) => f.pose.y),
  signal({ name: "heading", label: "Heading", unit: "rad", group: kMotion, plot: "Heading",
    meaning: "Heading by odometry, from the world's x to the left" }, (f) => f.pose.heading),
  signal({ name: "period", label: "Period", unit: "s", group: kControl, plot: "Period", least: [0, 0.03], digits: 4,
    meaning: "Run clock from the tick before to this one; a late tick is a peak" }, (f, { stamp }) => f.stamp - stamp),
  signal({ name: "held", label: "Held", unit: "", group: kControl, plot: "States", least: [0, 1], digits: 0, colour: "bad",
    meaning: "1 while the gate holds the robot, for whatever reason" }, (f) => flag(f.hold !== "none")),
  signal({ name: "limited", label: "Limited", unit: "", group: kControl, plot: "States", least: [0, 1], digits: 0,
    dash: kDash, meaning: "1 while a limit keeps the command below the wanted one" }, (f) => flag(f.limit !== "")),
  signal({ name: "waits", label: "Waits", unit: "", group: kControl, plot: "States", least: [0, 1], digits: 0,
    colour: "muted", dash: [2, 3], meaning: "1 while the controller lets the robot stand on purpose" }, (f) => flag(f.waits)),
  signal({ name: "goals_ahead", label: "Goals ahead", unit: "", group: kControl, plot: "Goals ahead", least: [0, 1], digits: 0,
    colour: "ok", meaning: "Goals in the queue after the current one" }, (f) => f.goals_ahead.length),
  signal({ name: "scan.age", label: "Age of the scan", unit: "s", group: kSensors, plot: "Age of the scan", least: [0, 0.1],
    digits: 3, colour: "filtered", meaning: "Run clock since the end of the newest sweep" },
  (f, { scan }) => f.stamp - scan),
  signal({ name: "gyro.rate", label: "Gyro", unit: "rad/s", group: kSensors, plot: "Turn rate", least: [-0.2, 0.2],
    colour: "filtered", dash: [2, 3], meaning: "Turn rate that the gyro measures" }, (f) => f.gyro ?? NaN),
  signal({ name: "inclinometer.roll", label: "Roll", unit: "rad", group: kSensors, plot: "Inclination", least: [-0.05, 0.05],
    digits: 3, meaning: "Measured inclination to the side; left side up is positive" }, (f) => f.inclination?.roll ?? NaN),
  signal({ name: "inclinometer.pitch", label: "Pitch", unit: "rad", group: kSensors, plot: "Inclination", least: [-0.05, 0.05],
    digits: 3, colour: "path", dash: kDash, meaning: "Measured inclination ahead; nose down is positive" },
  (f) => f.inclination?.pitch ?? NaN),
  signal({ name: "encoders.left", label: "Left encoder", unit: "", group: kSensors, plot: "Encoders", digits: 0,
    meaning: "Counts of the left wheel, modulo 2^32" }, (f) => f.encoders?.left ?? NaN),
  signal({ name: "encoders.right", label: "Right encoder", unit: "", group: kSensors, plot: "Encoders", digits: 0,
    colour: "path", dash: kDash, meaning: "Counts of the right wheel, modulo 2^32" }, (f) => f.encoders?.right ?? NaN),
  signal({ name: "truth.x", label: "True x", unit: "m", group: kTruth, plot: "Position", colour: "ok",
    meaning: "True position along the world's x" }, (f) => f.truth?.pose.x ?? NaN),
  signal({ name: "truth.y", label: "True y", unit: "m", group: kTruth, plot: "Position", colour: "filtered", dash: kDash,
    meaning: "True position along the world's y" }, (f) => f.truth?.pose.y ?? NaN),
  signal({ name: "truth.heading", label: "True heading", unit: "rad", group: kTruth, plot: "Heading", colour: "ok", dash: kDash,
    meaning: "True heading, from the world's x to the left" }, (f) => f.truth?.pose.heading ?? NaN),
  signal({ name: "truth.z", label: "True height", unit: "m", group: kTruth, plot: "Height", digits: 3, colour: "ok",
    meaning: "Height above the level floor" }, (f) => f.tilt?.z ?? NaN),
  signal({ name: "truth.roll", label: "True roll", unit: "rad", group: kTruth, plot: "Inclination", digits: 3, colour: "ok",
    meaning: "True inclination to the side; left side up is positive" }, (f) => f.tilt?.roll ?? NaN),
  signal({ name: "truth.pitch", label: "True pitch", unit: "rad", group: kTruth, plot: "Inclination", digits: 3, colour: "filtered",
    dash: kDash, meaning: "True inclination ahead; nose down is positive" }, (f) => f.tilt?.pitch ?? NaN),
  signal({ name: "odometry.error", label: "Odometry error", unit: "m", group: kTruth, plot: "Odometry error", digits: 3,
    colour: "bad", meaning: "From the true position to the position by odometry" },
  (f) => (f.truth ? distance(f.truth.pose, f.pose) : NaN)),
  signal({ name: "truth.collided", label: "Contact", unit: "", group: kTruth, plot: "States", least: [0, 1], digits: 0,
    colour: "external", meaning: "1 while the hull touches an obstacle in the simulation" },
  (f) => (f.truth ? flag(f.truth.collided) : NaN)),
  ...kArm, ...kLinks,
  signal({ name: "clearance.own", label: "Clear of itself", unit: "m", group: "Arm", plot: "Clearance of the links", colour: "muted",
    meaning: "From the arm to the robot itself" }, (f) => f.arm?.own ?? NaN),
];
