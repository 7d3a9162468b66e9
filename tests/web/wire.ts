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
  goal?: [number, number, number | null];
  mission?: wire.Mission;
  hold?: wire.Hold;
  strip?: [number, number][];
  internal?: [number, number];
  external_left?: [number, number];
  requests?: ((b: flatbuffers.Builder) => [wire.Request, number])[];
  truth?: [number, number, number, number, boolean];
  what?: string;
  grid?: { corner: [number, number]; cell: number; columns: number; cells: number[] };
  plan?: [number, number][];
  candidates?: [number, number, number, number, boolean, boolean][];
  histogram?: { density: number[]; threshold: number };
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
  let scans = 0;
  if (spec.ranges) {
    const ranges = wire.LaserScan.createRangesVector(b, spec.ranges);
    wire.LaserScan.startLaserScan(b);
    wire.LaserScan.addMount(b, wire.Pose2.createPose2(b, ...(spec.mount ?? [0, 0, 0])));
    wire.LaserScan.addAngleMin(b, -Math.PI / 2);
    wire.LaserScan.addAngleIncrement(b, Math.PI / (spec.ranges.length - 1));
    wire.LaserScan.addRangeMax(b, spec.range_max ?? 8.191);
    wire.LaserScan.addRanges(b, ranges);
    scans = wire.Frame.createScansVector(b, [wire.LaserScan.endLaserScan(b)]);
  }
  const boxes = (spec.requests ?? []).map((make) => {
    const [type, at] = make(b);
    wire.RequestBox.startRequestBox(b);
    wire.RequestBox.addRequestType(b, type);
    wire.RequestBox.addRequest(b, at);
    return wire.RequestBox.endRequestBox(b);
  });
  const requests = wire.Frame.createRequestsVector(b, boxes);
  let strip = 0;
  if (spec.strip) {
    wire.Frame.startStripVector(b, spec.strip.length);
    for (const node of [...spec.strip].reverse()) wire.Vec2f.createVec2f(b, ...node);
    strip = b.endVector();
  }
  let grid = 0;
  if (spec.grid) {
    const cells = wire.Grid.createCellsVector(b, spec.grid.cells);
    wire.Grid.startGrid(b);
    wire.Grid.addCorner(b, wire.Vec2f.createVec2f(b, ...spec.grid.corner));
    wire.Grid.addCell(b, spec.grid.cell);
    wire.Grid.addColumns(b, spec.grid.columns);
    wire.Grid.addCells(b, cells);
    grid = wire.Grid.endGrid(b);
  }
  let plan = 0;
  if (spec.plan) {
    wire.Frame.startPlanVector(b, spec.plan.length);
    for (const p of [...spec.plan].reverse()) wire.Vec2f.createVec2f(b, ...p);
    plan = b.endVector();
  }
  let candidates = 0;
  if (spec.candidates) {
    wire.Frame.startCandidatesVector(b, spec.candidates.length);
    for (const c of [...spec.candidates].reverse()) wire.Candidate.createCandidate(b, ...c);
    candidates = b.endVector();
  }
  const histogram = spec.histogram ? wire.Frame.createHistogramVector(b, spec.histogram.density) : 0;
  const what = spec.what === undefined ? 0 : b.createString(spec.what);
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
    spec.mission ?? wire.Mission.Idle, wire.Behaviour.Rest, 0));
  if (strip) wire.Frame.addStrip(b, strip);
  if (spec.strip) {
    wire.Frame.addForces(b, wire.Forces.createForces(b, ...(spec.internal ?? [0, 0]),
      ...(spec.external_left ?? [0, 0]), 0, 0));
  }
  if (what) wire.Frame.addWhat(b, what);
  if (grid) wire.Frame.addGrid(b, grid);
  if (plan) wire.Frame.addPlan(b, plan);
  if (candidates) wire.Frame.addCandidates(b, candidates);
  if (histogram) {
    wire.Frame.addHistogram(b, histogram);
    wire.Frame.addHistogramThreshold(b, spec.histogram!.threshold);
  }
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
