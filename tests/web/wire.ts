// tests/web/wire.ts: builds frames by the generated wire code, for tests that need one.
import * as flatbuffers from "flatbuffers";
import * as wire from "../../web/src/wire/telemetry_generated";

export interface FrameSpec {
  tick: number;
  stamp?: number;
  pose?: [number, number, number];
  ranges?: number[];
  range_max?: number;
  mount?: [number, number, number];
  scan_stamp?: number;
  goal?: [number, number, number | null];
  mission?: wire.Mission;
  hold?: wire.Hold;
  requests?: ((b: flatbuffers.Builder) => [wire.Request, number])[];
  truth?: [number, number, number, number, boolean];
  words?: [string, string];
  layers?: LayerSpec[];
  measures?: [string, string, number][];
  sonar?: [number, number][]; // heading of the mount, range
  moved?: [number, number, number, number][]; // id, x, y, heading
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

function add_layer(b: flatbuffers.Builder, l: LayerSpec): number {
  const text = (value: string | undefined) => (value === undefined ? 0 : b.createString(value));
  const [name, label, unit, lines] = [l.name, l.label, l.unit, l.text].map(text);
  const values = wire.Layer.createValuesVector(b, l.values);
  const cells = l.cells ? wire.Layer.createCellsVector(b, l.cells) : 0;
  wire.Layer.startLayer(b);
  wire.Layer.addName(b, name);
  if (label) wire.Layer.addLabel(b, label);
  if (unit) wire.Layer.addUnit(b, unit);
  if (lines) wire.Layer.addText(b, lines);
  if (cells) wire.Layer.addCells(b, cells);
  wire.Layer.addValues(b, values);
  wire.Layer.addKind(b, l.kind);
  wire.Layer.addFrame(b, l.frame ?? wire.LayerFrame.World);
  wire.Layer.addTone(b, l.tone ?? wire.Tone.Accent);
  wire.Layer.addStyle(b, l.style ?? wire.LayerStyle.Solid);
  wire.Layer.addAxes(b, l.axes ?? 2);
  wire.Layer.addLevel(b, l.level ?? 0);
  return wire.Layer.endLayer(b);
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

export const set_parameter = (name: string, value: number) =>
  (b: flatbuffers.Builder): [wire.Request, number] => {
    const text = b.createString(name);
    wire.SetParameter.startSetParameter(b);
    wire.SetParameter.addName(b, text);
    wire.SetParameter.addValue(b, value);
    return [wire.Request.SetParameter, wire.SetParameter.endSetParameter(b)];
  };

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
  const layers = wire.Frame.createLayersVector(b, (spec.layers ?? []).map((l) => add_layer(b, l)));
  let measures = 0;
  if (spec.measures) {
    const names = b.createString(spec.measures.map((m) => m[0]).join("\n"));
    const units = b.createString(spec.measures.map((m) => m[1]).join("\n"));
    const values = wire.Measures.createValuesVector(b, spec.measures.map((m) => m[2]));
    measures = wire.Measures.createMeasures(b, names, units, values);
  }
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
  const [what, why] = (spec.words ?? []).map((text) => b.createString(text));
  wire.Frame.startFrame(b);
  wire.Frame.addTick(b, BigInt(spec.tick));
  wire.Frame.addStamp(b, spec.stamp ?? spec.tick * 0.026);
  const [x, y, heading] = spec.pose ?? [0, 0, 0];
  wire.Frame.addOdometry(b, wire.Odometry.createOdometry(b, x, y, heading, 0.25, -0.5));
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
  }
  wire.Frame.addDecision(b, wire.Decision.createDecision(b, 0, spec.hold ?? wire.Hold.None,
    spec.mission ?? wire.Mission.Idle, wire.Behaviour.Rest));
  wire.Frame.addLayers(b, layers);
  wire.Frame.addMoved(b, places);
  wire.Frame.addSonar(b, readings);
  if (measures) wire.Frame.addMeasures(b, measures);
  if (what) wire.Frame.addWhat(b, what);
  if (why) wire.Frame.addWhy(b, why);
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
