// web/src/link/frame.ts: one FlatBuffers frame (telemetry.fbs) as a plain object.
import * as flatbuffers from "flatbuffers";
import type { HandGoalJson } from "../contract";
import { Point, Pose } from "../geometry";
import { LayerView } from "../layer";
import { Obstacle, ObstacleKind, PathJson } from "../obstacle";
import type { DrivenStick } from "../state/stick";
import * as wire from "../wire/telemetry_generated";
import { Legends, Measure, legend_of, shown } from "./legend";

/** Wire value of a beam that met nothing within range. */
export const kFree = 65535;
/** Greatest wire value that is a distance [mm]; above it and below kFree are device codes. */
export const kMaxRange = 65519;

export interface Sweep {
  mount: Pose;              // of the scanner in R
  stamp: number;            // [s]
  angle_min: number;        // [rad]
  angle_increment: number;  // [rad]
  range_max: number;        // [m]
  ranges: Uint16Array;      // [mm] or a code, B beams
}

export interface Goal { x: number; y: number; heading: number | null }
export interface RangeReading { mount: Pose; range: number; status: number }

/** A reading of a further sensor, by its index in the robot's list of channels. */
export interface ChannelReading { channel: number; stamp: number; values: number[] }
/** The robot's action and its reason: a sentence each. */
export interface Words { what: string; why: string }

/** A request as the page reads it from a frame; a joystick's is the frame's stick. */
export type FrameRequest =
  | { type: "set_goal"; goals: Goal[]; next: number; loop: boolean }
  | { type: "add_goal"; goal: Goal }
  | { type: "clear_goal" }
  | { type: "add_obstacle" | "change_obstacle"; obstacle: Obstacle }
  | { type: "move_obstacle"; id: number; pose: Pose }
  | { type: "remove_obstacle"; id: number }
  | { type: "stop"; engaged: boolean }
  | { type: "set_parameter"; name: string; value: number };

/** Why real hardware stops its own wheels. */
const kHalts = ["none", "disarmed", "base_lost", "scanner_lost", "bad_line", "scanner_fault",
  "stop_button", "base_fault", "over_current", "battery_low", "motors_off", "late_tick",
  "floor_lost", "floor_fault"] as const;
export type Halt = (typeof kHalts)[number];
const kArmStates = ["rest", "turns", "plans", "goes", "waits", "arrived", "given_up"] as const;
const kMissions = ["idle", "driving", "arrived", "stuck", "held"] as const;
const kKinds: ObstacleKind[] = ["cylinder", "box", "polygon", "wall", "ramp", "trench"];

/** What the simulator knows: the true pose, and the nearest surface from the robot's centre and from its hull [m]. */
export interface Truth {
  pose: Pose; collided: boolean; distance: number; clearance: number;
  overturned: boolean; // it lies on its side or its back
  fallen: boolean;     // it came down an edge too high for it
}

/** How the robot stands: its height above z = 0, left side up and nose down positive [m, rad]. */
export interface Tilt { z: number; roll: number; pitch: number }

/** The arm's decision in a tick. */
export interface ArmFrame {
  state: (typeof kArmStates)[number];
  clearance: number[];      // [m] of base, mast, upper arm, forearm and hand to all that the robot knows
  own: number;              // [m] of the arm to the robot itself
  hand_goal: HandGoalJson | null;
  joint_goal: number[];     // [rad]; empty: none
  plan: number;             // 0: none
  ghost: Float32Array | null; // of a new plan: x, y, heading and the joints of each of its poses
}

/** One tick of a run; positions in W, metres, radians, seconds. */
export const kFixes = ["searching", "nowhere", "not_unique", "unsure", "located"] as const;
/** Of a robot that knows a map: Frame.pose is then its pose by matched scans. */
export interface MapPose {
  fix: (typeof kFixes)[number];
  places: number; // that fit
  wheels: Pose;   // by the odometry alone
  xx: number;     // [m2] variances of the pose
  xy: number;
  yy: number;
  turn: number;   // [rad2]
  fit: number;    // share of the newest scans' points on the map's walls
}

export interface Frame {
  tick: number;
  stamp: number;
  pose: Pose;               // odometry, or on the map that the robot knows
  twist: { v: number; omega: number };   // executed, by odometry
  command: { v: number; omega: number };
  sweeps: Sweep[];          // only those new in this tick
  sonar: RangeReading[];
  infrared: RangeReading[];
  bumpers: { mount: Pose; pressed: boolean }[];
  requests: FrameRequest[]; // applied before this tick
  stick: DrivenStick | null; // newly pushed in this tick
  truth: Truth | null;      // simulator only
  tilt: Tilt | null;        // simulator only, where the ground is not level
  gyro: number | null;      // [rad/s]
  inclination: { roll: number; pitch: number } | null; // measured, with the signs of `tilt`
  encoders: { left: number; right: number } | null; // counts
  goal: Goal | null;
  goals_ahead: Point[]; // after that one, in order
  hold: string;             // "stale_scan", ...: why the command is zero; "none"
  limit: string;            // what keeps the command below the wanted one; "": nothing
  waits: boolean;           // the controller lets the robot stand
  halt: Halt;
  mission: (typeof kMissions)[number];
  behaviour: string;        // "rest", "avoid", "manual", ...
  clearance: number;        // [m] hull to the nearest filtered return; its range less the radius without one
  words: Words | null;      // null: as in the frames before
  layers: LayerView[];      // a grid of an earlier frame holds
  measures: Measure[];
  readings: ChannelReading[]; // of further sensors; only those new in this tick
  moved: { id: number; pose: Pose }[]; // obstacles that move by themselves and are there
  joints: number[] | null;      // [rad] measured; robots with an arm only, as the next two
  joint_rates: number[];        // [rad/s] measured
  arm: ArmFrame | null;
  map_pose: MapPose | null;
}

interface XY { x(): number; y(): number }
interface XYH extends XY { heading(): number }
const zero: Point = { x: 0, y: 0 };
const point = (p: XY | null): Point => (p ? { x: p.x(), y: p.y() } : zero);
const pose = (p: XYH | null): Pose =>
  p ? { x: p.x(), y: p.y(), heading: p.heading() } : { x: 0, y: 0, heading: 0 };
const twist = (t: wire.Twist2 | null) => ({ v: t?.v() ?? 0, omega: t?.omega() ?? 0 });

/** Decodes `bytes`; throws when they are too short to be a frame. The ranges are copied. */
export function decode_frame(bytes: Uint8Array, legends: Legends): Frame {
  const f = root_of(bytes);
  legends.learn(f);
  const clock = f.clock();
  const stamp = clock?.stamp() ?? 0;
  const odometry = f.odometry();
  const truth = f.truth();
  const inclination = f.inclinometer();
  const tilt = f.tilt();
  const encoders = f.encoders();
  const goal = f.goal();
  const decision = f.decision();
  const joints = f.joints();
  const what = f.news()?.what();
  const { layers, measures } = shown(f, legends.find(legend_of(f)));
  return {
    tick: Number(clock?.tick() ?? 0),
    stamp,
    pose: pose(odometry?.pose() ?? null),
    twist: twist(odometry?.twist() ?? null),
    command: twist(f.command()),
    sweeps: list(f.scansLength(), (i) => sweep(f.scans(i)!)),
    sonar: list(f.sonarLength(), (i) => reading(f.sonar(i)!)),
    infrared: list(f.infraredLength(), (i) => reading(f.infrared(i)!)),
    bumpers: list(f.bumpersLength(), (i) => {
      const bumper = f.bumpers(i)!;
      return { mount: pose(bumper.mount()), pressed: bumper.pressed() };
    }),
    requests: list(f.requestsLength(), (i) => request(f.requests(i)!)).filter((r) => r !== null),
    stick: stick_of(f),
    truth: truth && {
      pose: pose(truth.pose()), collided: f.collided(), distance: truth.obstacleDistance(), clearance: truth.clearance(),
      overturned: f.overturned(), fallen: f.fallen(),
    },
    gyro: f.gyro()?.rate() ?? null,
    tilt: tilt && { z: tilt.z(), roll: tilt.roll(), pitch: tilt.pitch() },
    inclination: inclination && { roll: inclination.roll(), pitch: inclination.pitch() },
    encoders: encoders && { left: encoders.left(), right: encoders.right() },
    goals_ahead: list(f.goalsAheadLength(), (i) => point(f.goalsAhead(i))),
    goal: goal && { ...point(goal), heading: f.goalHeading() },
    hold: f.hold() ?? "none",
    limit: f.limit() ?? "",
    waits: decision?.waits() ?? false,
    halt: kHalts[f.halt()] ?? "none",
    mission: kMissions[decision?.mission() ?? 0] ?? "idle",
    behaviour: f.behaviour() ?? "avoid",
    clearance: decision?.clearance() ?? 0,
    words: what ? { what, why: f.news()?.why() ?? "" } : null,
    layers,
    measures,
    readings: list(f.channelsLength(), (i) => channel_reading(f.channels(i)!, stamp)),
    moved: list(f.movedLength(), (i) => ({ id: f.moved(i)!.id(), pose: pose(f.moved(i)) })),
    joints: joints && list(joints.positionsLength(), (i) => joints.positions(i)!),
    joint_rates: joints ? list(joints.ratesLength(), (i) => joints.rates(i)!) : [],
    arm: arm_of(f.arm()),
    map_pose: map_pose_of(f.mapPose()),
  };
}

function map_pose_of(m: wire.MapPose | null): MapPose | null {
  return m && {
    fix: kFixes[m.fix()] ?? "searching", places: m.places(), wheels: pose(m.wheels()),
    xx: m.xx(), xy: m.xy(), yy: m.yy(), turn: m.turn(), fit: m.fit(),
  };
}

function arm_of(a: wire.Arm | null): ArmFrame | null {
  return a && {
    state: kArmStates[a.state()] ?? "rest",
    clearance: list(a.clearanceLength(), (i) => a.clearance(i)!),
    own: a.ownClearance(),
    hand_goal: hand_goal(a.handGoal()),
    joint_goal: list(a.jointGoalLength(), (i) => a.jointGoal(i)!),
    plan: a.plan(),
    ghost: a.ghostArray()?.slice() ?? null,
  };
}

function place(p: wire.Vec3): { x: number; y: number; z: number } {
  return { x: p.x(), y: p.y(), z: p.z() };
}

function hand_goal(g: wire.SetHandGoal | null): HandGoalJson | null {
  const at = g?.position(), q = g?.attitude(), then = g?.then();
  return at && q ? {
    x: at.x(), y: at.y(), z: at.z(), qw: q.w(), qx: q.x(), qy: q.y(), qz: q.z(),
    arm_angle: g!.armAngle() ?? undefined, base_stays: g!.baseStays(), then: then ? wanted(then) : undefined,
    ...(g!.pathLength() > 0 && { path: list(g!.pathLength(), (i) => place(g!.path(i)!)) }),
  } : null;
}

/** Decodes frames of one run; a later frame may bring the legend of an earlier one. */
export function decode_frames(frames: Uint8Array[], legends = new Legends()): Frame[] {
  for (const bytes of frames) legends.learn(root_of(bytes));
  return frames.map((bytes) => decode_frame(bytes, legends));
}

/** The frame in `bytes`, unread. */
function root_of(bytes: Uint8Array): wire.Frame {
  if (bytes.length < 8) throw new Error(`a frame of ${bytes.length} bytes is too short`);
  return wire.Frame.getRootAsFrame(buffer_of(bytes));
}

/** Decodes a scan that comes on its own, as of /tautline/filtered; null for an empty message. */
export function decode_sweep(bytes: Uint8Array): Sweep | null {
  return bytes.length < 8 ? null : sweep(wire.LaserScan.getRootAsLaserScan(buffer_of(bytes)));
}

/** Typed arrays over the buffer need an aligned start, so bytes that are not aligned are copied. */
function buffer_of(bytes: Uint8Array): flatbuffers.ByteBuffer {
  return new flatbuffers.ByteBuffer(bytes.byteOffset % 4 === 0 ? bytes : bytes.slice());
}

function list<T>(length: number, item: (i: number) => T): T[] {
  const out: T[] = [];
  for (let i = 0; i < length; ++i) out.push(item(i));
  return out;
}

function sweep(s: wire.LaserScan): Sweep {
  return {
    mount: pose(s.mount()),
    stamp: s.stamp(),
    angle_min: s.angleMin(),
    angle_increment: s.angleIncrement(),
    range_max: s.rangeMax(),
    ranges: s.rangesArray()?.slice() ?? new Uint16Array(0),
  };
}

function reading(r: wire.RangeReading): RangeReading {
  return { mount: pose(r.mount()), range: r.range(), status: r.status() };
}

function channel_reading(r: wire.Reading, now: number): ChannelReading {
  return { channel: r.channel(), stamp: r.stamp() ?? now, values: [...(r.valuesArray() ?? [])] };
}

function obstacle(o: wire.Obstacle): Obstacle {
  const [low, height] = [o.low(), o.height()];
  const named = kKinds[o.kind()] ?? "cylinder";
  const kind = named === "ramp" && low === height ? "step" : named;
  const size = point(o.size());
  return {
    id: o.id(),
    kind,
    pose: pose(o.pose()),
    radius: kind === "cylinder" ? size.x : 0,
    length: size.x,
    width: size.y,
    points: list(o.pointsLength(), (i) => point(o.points(i))),
    height: kind === "trench" ? 0 : kind === "ramp" ? height : height || 1,
    low,
    bottom: o.bottom(),
    path: path(o.path()),
    away: false,
    extra: {},
  };
}

function path(p: wire.ObstaclePath | null): PathJson | null {
  if (!p) return null;
  const keys = list(p.keysLength() / 3, (i) => [p.keys(3 * i)!, p.keys(3 * i + 1)!, p.keys(3 * i + 2)!]);
  return { period: p.period(), phase: p.phase(), comes_and_goes: p.comesAndGoes(), keys: keys as PathJson["keys"] };
}

function wanted(g: wire.SetGoal): Goal {
  return { ...point(g.position()), heading: g.hasHeading() ? g.heading() : null };
}

const kStickModes = ["guarded", "wall", "raw", "elastic"];

/** The last joystick request of the tick. */
function stick_of(f: wire.Frame): DrivenStick | null {
  for (let i = f.requestsLength() - 1; i >= 0; --i) {
    const box = f.requests(i)!;
    if (box.requestType() !== wire.Request.Joystick) continue;
    const s = box.request(new wire.Joystick()) as wire.Joystick;
    return { forward: s.forward(), turn: s.turn(), mode: kStickModes[s.mode()] ?? "" };
  }
  return null;
}

function request(box: wire.RequestBox): FrameRequest | null {
  const read = <T>(into: T): T => box.request(into) as T;
  switch (box.requestType()) {
    case wire.Request.SetGoal:
      return { type: "set_goal", goals: [wanted(read(new wire.SetGoal()))], next: 0, loop: false };
    case wire.Request.AddGoal: {
      const goal = read(new wire.AddGoal()).goal();
      return goal && { type: "add_goal", goal: wanted(goal) };
    }
    case wire.Request.SetGoals: {
      const s = read(new wire.SetGoals());
      const goals = list(s.goalsLength(), (i) => wanted(s.goals(i)!));
      return goals.length > 0 ? { type: "set_goal", goals, next: s.next(), loop: s.loop() } : { type: "clear_goal" };
    }
    case wire.Request.ClearGoal:
      return { type: "clear_goal" };
    case wire.Request.AddObstacle: {
      const o = read(new wire.AddObstacle()).obstacle();
      return o && { type: "add_obstacle", obstacle: obstacle(o) };
    }
    case wire.Request.ChangeObstacle: {
      const o = read(new wire.ChangeObstacle()).obstacle();
      return o && { type: "change_obstacle", obstacle: obstacle(o) };
    }
    case wire.Request.MoveObstacle: {
      const m = read(new wire.MoveObstacle());
      return { type: "move_obstacle", id: m.id(), pose: pose(m.pose()) };
    }
    case wire.Request.RemoveObstacle:
      return { type: "remove_obstacle", id: read(new wire.RemoveObstacle()).id() };
    case wire.Request.Stop:
      return { type: "stop", engaged: read(new wire.Stop()).engaged() };
    case wire.Request.SetParameter: {
      const s = read(new wire.SetParameter());
      return { type: "set_parameter", name: s.name() ?? "", value: s.value() };
    }
    default:
      return null;
  }
}
