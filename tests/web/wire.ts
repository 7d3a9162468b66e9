// tests/web/wire.ts: builds frames for tests by the generated wire code.
import * as flatbuffers from "flatbuffers";
import * as wire from "../../web/src/wire/telemetry_generated";

export interface FrameSpec {
  tick: number;
  stamp?: number;
  pose?: [number, number, number];
  twist?: [number, number];   // by odometry
  command?: [number, number];
  clearance?: number;
  ranges?: number[];
  range_max?: number;
  mount?: [number, number, number];
  scan_stamp?: number;
  goal?: [number, number, number | null];
  mission?: wire.Mission;
  clearance?: number;
  hold?: string;
  behaviour?: string;
  limit?: string;
  requests?: ((b: flatbuffers.Builder) => [wire.Request, number])[];
  truth?: [number, number, number, number, boolean];
  words?: Words | null; // null: no news, although there are layers
  legend?: number;
  ends?: "overturned" | "fallen"; // with `truth`
  tilt?: [number, number, number]; // z, roll, pitch
  inclination?: [number, number];   // roll, pitch
  readings?: [number, number[], number?][]; // channel, values, stamp
  layers?: LayerSpec[];
  measures?: [string, string, number][];
  sonar?: [number, number][]; // heading of the mount, range
  moved?: [number, number, number, number][]; // id, x, y, heading
  joints?: number[];
  arm?: ArmSpec;
}

export interface ArmSpec {
  state?: wire.ArmState;
  clearance?: number[];
  own?: number;
  hand_goal?: { x: number; y: number; z: number; qw: number; qx: number; qy: number; qz: number; arm_angle?: number };
  joint_goal?: number[];
  plan?: number;
  ghost?: number[];
}

function add_arm(b: flatbuffers.Builder, arm: ArmSpec): number {
  const clearance = wire.Arm.createClearanceVector(b, arm.clearance ?? []);
  const joint_goal = arm.joint_goal ? wire.Arm.createJointGoalVector(b, arm.joint_goal) : 0;
  const ghost = arm.ghost ? wire.Arm.createGhostVector(b, arm.ghost) : 0;
  let goal = 0;
  if (arm.hand_goal) {
    const g = arm.hand_goal;
    wire.SetHandGoal.startSetHandGoal(b);
    wire.SetHandGoal.addPosition(b, wire.Vec3.createVec3(b, g.x, g.y, g.z));
    wire.SetHandGoal.addAttitude(b, wire.Quaternion.createQuaternion(b, g.qw, g.qx, g.qy, g.qz));
    if (g.arm_angle !== undefined) wire.SetHandGoal.addArmAngle(b, g.arm_angle);
    goal = wire.SetHandGoal.endSetHandGoal(b);
  }
  wire.Arm.startArm(b);
  wire.Arm.addClearance(b, clearance);
  wire.Arm.addOwnClearance(b, arm.own ?? 0);
  wire.Arm.addState(b, arm.state ?? wire.ArmState.Rest);
  if (goal) wire.Arm.addHandGoal(b, goal);
  if (joint_goal) wire.Arm.addJointGoal(b, joint_goal);
  wire.Arm.addPlan(b, arm.plan ?? 0);
  if (ghost) wire.Arm.addGhost(b, ghost);
  return wire.Arm.endArm(b);
}

function add_joints(b: flatbuffers.Builder, positions: number[]): number {
  const at = wire.Joints.createPositionsVector(b, positions);
  const rates = wire.Joints.createRatesVector(b, positions.map(() => 0));
  return wire.Joints.createJoints(b, at, rates, null);
}

export interface LayerSpec {
  name: string;
  kind: wire.LayerKind;
  values: number[];
  label?: string;
  unit?: string;
  frame?: wire.LayerFrame;
  tone?: wire.Tone;
  style?: wire.LayerStyle;
  axes?: number;
  level?: number;
  cells?: number[];
  text?: string;
}

type Words = [string, string];

/** What a frame says of its layers and measures. */
function add_news(b: flatbuffers.Builder, words: Words, layers: LayerSpec[], measures: [string, string, number][]): number {
  const text = (value: string | undefined) => (value === undefined ? 0 : b.createString(value));
  const infos = layers.map((l) => {
    const [name, label, unit] = [l.name, l.label, l.unit].map(text);
    return wire.LayerInfo.createLayerInfo(b, name, label, unit, l.kind, l.frame ?? wire.LayerFrame.World,
      l.tone ?? wire.Tone.Accent, l.style ?? wire.LayerStyle.Solid, l.axes ?? 2, l.level ?? 0);
  });
  const [what, why] = words.map(text);
  const list = wire.News.createLayersVector(b, infos);
  const names = measures.length > 0 ? b.createString(measures.map((m) => m[0]).join("\n")) : 0;
  const units = measures.length > 0 ? b.createString(measures.map((m) => m[1]).join("\n")) : 0;
  return wire.News.createNews(b, what, why, list, names, units);
}

/** In 16 bits where every number is then exact. */
function add_shown(b: flatbuffers.Builder, layers: LayerSpec[], measures: [string, string, number][]): { narrow: number; wide: number } {
  const in_steps = (n: number) => (Number.isNaN(n) ? -32768 : n * 1024);
  const list = (each: (n: number) => number) => [
    ...layers.flatMap((l) => [l.values.length, ...l.values.map(each)]),
    ...measures.map((m) => each(m[2])),
  ];
  const steps = list(in_steps);
  const fits = steps.every((n) => Number.isInteger(n) && n >= -32768 && n <= 32767);
  return fits
    ? { narrow: wire.Frame.createShownVector(b, steps), wide: 0 }
    : { narrow: 0, wide: wire.Frame.createShownWideVector(b, list((n) => n)) };
}

function add_more(b: flatbuffers.Builder, layers: LayerSpec[]): number {
  const more = layers.flatMap((l, i) => {
    if (!l.cells && l.text === undefined) return [];
    const cells = l.cells ? wire.LayerMore.createCellsVector(b, l.cells) : 0;
    return [wire.LayerMore.createLayerMore(b, i, cells, l.text === undefined ? 0 : b.createString(l.text))];
  });
  return wire.Frame.createMoreVector(b, more);
}

interface ScanSpec { ranges: number[]; range_max?: number; mount?: [number, number, number]; stamp?: number }

function add_scan(b: flatbuffers.Builder, scan: ScanSpec): number {
  const ranges = wire.LaserScan.createRangesVector(b, scan.ranges);
  wire.LaserScan.startLaserScan(b);
  wire.LaserScan.addStamp(b, scan.stamp ?? 0);
  wire.LaserScan.addMount(b, wire.Pose2.createPose2(b, ...(scan.mount ?? [0, 0, 0])));
  wire.LaserScan.addAngleMin(b, -Math.PI / 2);
  wire.LaserScan.addAngleIncrement(b, Math.PI / (scan.ranges.length - 1));
  wire.LaserScan.addRangeMax(b, scan.range_max ?? 8.191);
  wire.LaserScan.addRanges(b, ranges);
  return wire.LaserScan.endLaserScan(b);
}

/** A filtered scan as it comes on its own. */
export function scan_bytes(spec: ScanSpec): Uint8Array {
  const b = new flatbuffers.Builder(256);
  b.finish(add_scan(b, spec));
  return b.asUint8Array().slice();
}

export const add_cylinder = (id: number, x: number, y: number, radius: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] => {
    wire.Obstacle.startObstacle(b);
    wire.Obstacle.addId(b, id);
    wire.Obstacle.addPose(b, wire.Pose2.createPose2(b, x, y, 0));
    wire.Obstacle.addKind(b, wire.ShapeKind.Cylinder);
    wire.Obstacle.addSize(b, wire.Vec2.createVec2(b, radius, 0));
    const obstacle = wire.Obstacle.endObstacle(b);
    wire.AddObstacle.startAddObstacle(b);
    wire.AddObstacle.addObstacle(b, obstacle);
    return [wire.Request.AddObstacle, wire.AddObstacle.endAddObstacle(b)];
  };

/** A shape with heights, at the origin; `size`: length and width. */
export const add_shape = (id: number, kind: wire.ShapeKind, size: [number, number], low: number, height: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] => {
    wire.Obstacle.startObstacle(b);
    wire.Obstacle.addId(b, id);
    wire.Obstacle.addPose(b, wire.Pose2.createPose2(b, 0, 0, 0));
    wire.Obstacle.addKind(b, kind);
    wire.Obstacle.addSize(b, wire.Vec2.createVec2(b, ...size));
    wire.Obstacle.addHeight(b, height);
    wire.Obstacle.addLow(b, low);
    const obstacle = wire.Obstacle.endObstacle(b);
    wire.AddObstacle.startAddObstacle(b);
    wire.AddObstacle.addObstacle(b, obstacle);
    return [wire.Request.AddObstacle, wire.AddObstacle.endAddObstacle(b)];
  };

export const move = (id: number, x: number, y: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] => {
    wire.MoveObstacle.startMoveObstacle(b);
    wire.MoveObstacle.addId(b, id);
    wire.MoveObstacle.addPose(b, wire.Pose2.createPose2(b, x, y, 0));
    return [wire.Request.MoveObstacle, wire.MoveObstacle.endMoveObstacle(b)];
  };

export const remove = (id: number) => (b: flatbuffers.Builder): [wire.Request, number] => {
  wire.RemoveObstacle.startRemoveObstacle(b);
  wire.RemoveObstacle.addId(b, id);
  return [wire.Request.RemoveObstacle, wire.RemoveObstacle.endRemoveObstacle(b)];
};

/** mode: 0 guarded, 1 wall, 2 raw, 3 elastic */
export const push_stick = (forward: number, turn: number, mode: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] =>
    [wire.Request.Joystick, wire.Joystick.createJoystick(b, forward, turn, mode)];

export const set_parameter = (name: string, value: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] => {
    const text = b.createString(name);
    wire.SetParameter.startSetParameter(b);
    wire.SetParameter.addName(b, text);
    wire.SetParameter.addValue(b, value);
    return [wire.Request.SetParameter, wire.SetParameter.endSetParameter(b)];
  };

/** As the server numbers them: another for other layers or measures. */
function legend_of(spec: FrameSpec): number {
  const looks = (spec.layers ?? []).map((l) => ({ ...l, values: 0, cells: 0, text: 0 }));
  const text = JSON.stringify([looks, (spec.measures ?? []).map((m) => [m[0], m[1]])]);
  let hash = 0;
  for (const c of text) hash = (Math.imul(hash, 31) + c.charCodeAt(0)) >>> 0;
  return hash;
}

export function frame_bytes(spec: FrameSpec): Uint8Array {
  const b = new flatbuffers.Builder(512);
  const { ranges } = spec;
  const scans = ranges ? wire.Frame.createScansVector(b, [add_scan(b, { ...spec, stamp: spec.scan_stamp, ranges })]) : 0;
  const boxes = (spec.requests ?? []).map((make) => {
    const [type, at] = make(b);
    wire.RequestBox.startRequestBox(b);
    wire.RequestBox.addRequestType(b, type);
    wire.RequestBox.addRequest(b, at);
    return wire.RequestBox.endRequestBox(b);
  });
  const requests = wire.Frame.createRequestsVector(b, boxes);
  const { layers = [], measures = [] } = spec;
  const words: Words = spec.words ?? ["Driving", "On its way."];
  const silent = spec.words === null || (!spec.words && !spec.layers && !spec.measures);
  const news = silent ? 0 : add_news(b, words, layers, measures);
  const { narrow, wide } = add_shown(b, layers, measures);
  const more = add_more(b, layers);
  const hold = spec.hold ? b.createString(spec.hold) : 0;
  const behaviour = b.createString(spec.behaviour ?? "rest");
  const limit = spec.limit ? b.createString(spec.limit) : 0;
  const readings_of = (spec.readings ?? []).map(([channel, list, stamp]) => {
    const numbers = wire.Reading.createValuesVector(b, list);
    return wire.Reading.createReading(b, channel, numbers, stamp ?? null);
  });
  const channels = wire.Frame.createChannelsVector(b, readings_of);
  const moved = spec.moved ?? [];
  wire.Frame.startMovedVector(b, moved.length);
  for (const [id, x, y, heading] of [...moved].reverse()) wire.Moved.createMoved(b, x, y, heading, id);
  const places = b.endVector();
  const sonar = spec.sonar ?? [];
  wire.Frame.startSonarVector(b, sonar.length);
  for (const [heading, range] of [...sonar].reverse()) {
    wire.RangeReading.createRangeReading(b, 0, 0, heading, spec.tick * 0.026, range, 4, wire.BeamStatus.Ok);
  }
  const readings = b.endVector();
  const joints = spec.joints ? add_joints(b, spec.joints) : 0;
  const arm = spec.arm ? add_arm(b, spec.arm) : 0;
  wire.Frame.startFrame(b);
  if (joints) wire.Frame.addJoints(b, joints);
  if (arm) wire.Frame.addArm(b, arm);
  if (limit) wire.Frame.addLimit(b, limit);
  wire.Frame.addClock(b, wire.Clock.createClock(b, BigInt(spec.tick), spec.stamp ?? spec.tick * 0.026));
  const [x, y, heading] = spec.pose ?? [0, 0, 0];
  wire.Frame.addOdometry(b, wire.Odometry.createOdometry(b, x, y, heading, ...(spec.twist ?? [0.25, -0.5])));
  if (spec.command) wire.Frame.addCommand(b, wire.Twist2.createTwist2(b, ...spec.command));
  if (scans) wire.Frame.addScans(b, scans);
  wire.Frame.addRequests(b, requests);
  if (spec.goal) {
    const [gx, gy, heading] = spec.goal;
    wire.Frame.addGoal(b, wire.Vec2f.createVec2f(b, gx, gy));
    if (heading !== null) wire.Frame.addGoalHeading(b, heading);
  }
  if (spec.truth) {
    const [tx, ty, th, d, hit] = spec.truth;
    wire.Frame.addTruth(b, wire.GroundTruth.createGroundTruth(b, tx, ty, th, d, d - 0.5));
    wire.Frame.addCollided(b, hit);
    if (spec.ends === "overturned") wire.Frame.addOverturned(b, true);
    if (spec.ends === "fallen") wire.Frame.addFallen(b, true);
  }
  if (spec.tilt) wire.Frame.addTilt(b, wire.Tilt.createTilt(b, ...spec.tilt));
  if (spec.inclination) wire.Frame.addInclinometer(b, wire.Inclinometer.createInclinometer(b, ...spec.inclination));
  wire.Frame.addDecision(b, wire.Decision.createDecision(b, spec.clearance ?? 0, spec.legend ?? legend_of(spec), spec.mission ?? wire.Mission.Idle, 0, false));
  wire.Frame.addMoved(b, places);
  wire.Frame.addSonar(b, readings);
  if (news) wire.Frame.addNews(b, news);
  if (narrow) wire.Frame.addShown(b, narrow);
  if (wide) wire.Frame.addShownWide(b, wide);
  wire.Frame.addMore(b, more);
  wire.Frame.addBehaviour(b, behaviour);
  wire.Frame.addChannels(b, channels);
  if (hold) wire.Frame.addHold(b, hold);
  b.finish(wire.Frame.endFrame(b));
  return b.asUint8Array().slice();
}

/** An answer of GET /runs/{id}/frames. */
export function framed(frames: Uint8Array[]): Uint8Array {
  const out = new Uint8Array(frames.reduce((n, f) => n + 4 + f.length, 0));
  let at = 0;
  for (const f of frames) {
    new DataView(out.buffer).setUint32(at, f.length, true);
    out.set(f, at + 4);
    at += 4 + f.length;
  }
  return out;
}

/** Parts of frames in more than one suite. */
export const grid = (byte: number): LayerSpec => ({ name: "grid", kind: wire.LayerKind.Grid, values: [0, 0, 0.1, 1], cells: [byte] });
export const line: LayerSpec = { name: "strip", label: "Strip", kind: wire.LayerKind.Polyline, values: [0, 0, 1, 1] };
export const goal: [number, number, null] = [1, 0, null];
