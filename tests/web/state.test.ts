// tests/web/state.test.ts: frames folded into the scene, and a stored run played and scrubbed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RunDocument, RunItem } from "../../web/src/contract";
import { arc_points } from "../../web/src/draw/weighing";
import { decode_frame } from "../../web/src/link/frame";
import { Player } from "../../web/src/link/player";
import { StoredRun, kPageFrames, split_frames } from "../../web/src/link/stored";
import { Columns } from "../../web/src/state/columns";
import { fold_frame, goal_distance, new_scene, scene_bounds, sweep_points } from "../../web/src/state/scene";
import { Hold, Mission } from "../../web/src/wire/telemetry_generated";
import { FrameSpec, add_cylinder, frame_bytes, framed, move, remove, set_parameter } from "./wire";

const frame = (spec: FrameSpec) => decode_frame(frame_bytes(spec));

test("a frame is read back whole", () => {
  const f = frame({
    tick: 41, stamp: 1.066, pose: [1, 2, 0.5], goal: [3, 4, null], mission: Mission.Driving, hold: Hold.StaleScan,
    strip: [[1, 2], [1.5, 2.25]], internal: [0.125, 0], external_left: [0, -0.5], truth: [1.25, 2, 0.5, 0.75, true],
    requests: [add_cylinder(7, 1.5, -2, 0.25), set_parameter("k_r", 0.5)],
  });
  assert.equal(f.tick, 41);
  assert.deepEqual(f.pose, { x: 1, y: 2, heading: 0.5 });
  assert.deepEqual(f.goal, { x: 3, y: 4, heading: null });
  assert.equal(f.mission, "driving");
  assert.equal(f.hold, "stale_scan");
  assert.deepEqual(f.strip[1], { position: { x: 1.5, y: 2.25 }, internal: { x: 0.125, y: 0 }, external: { x: 0, y: -0.5 } });
  assert.equal(f.truth?.collided, true);
  assert.equal(f.requests.length, 2);
  const [first, second] = f.requests;
  assert.ok(first.type === "add_obstacle" && first.obstacle.radius === 0.25 && first.obstacle.pose.y === -2);
  assert.deepEqual(second, { type: "set_parameter", name: "k_r", value: 0.5 });
  assert.throws(() => decode_frame(new Uint8Array(3)), /too short/);
});

test("what a controller weighs is read back, from wherever the bytes lie", () => {
  const bytes = frame_bytes({
    tick: 1, pose: [1, 2, 0], plan: [[1, 2], [1.5, 2.25]],
    candidates: [[0.25, -0.5, 1.5, 0.125, true, true], [0.5, 0, 1.5, 0.5, false, false]],
    histogram: { density: [0, 1.5, 400], threshold: 300 },
    grid: { corner: [-1, 0.5], cell: 0.125, columns: 2, cells: [0, 254, 127, 255] },
  });
  for (let shift = 0; shift < 4; ++shift) {
    const moved = new Uint8Array(bytes.length + shift);
    moved.set(bytes, shift);
    const f = decode_frame(moved.subarray(shift));
    assert.deepEqual(f.plan, [{ x: 1, y: 2 }, { x: 1.5, y: 2.25 }]);
    assert.deepEqual(f.candidates[0],
      { v: 0.25, omega: -0.5, horizon: 1.5, cost: 0.125, allowed: true, chosen: true });
    assert.deepEqual([...f.histogram], [0, 1.5, 400]);
    assert.equal(f.histogram_threshold, 300);
    assert.deepEqual(f.grid?.corner, { x: -1, y: 0.5 });
    assert.deepEqual([...f.grid!.cells], [0, 254, 127, 255]);
  }
});

test("readings of sonar and infrared stay where they were taken until they are old", () => {
  const scene = new_scene();
  const reading = (range: number) => ({ mount: { x: 0.5, y: 0, heading: 0.25 }, range, status: 0 });
  fold_frame(scene, { ...frame({ tick: 1, stamp: 0.1, pose: [1, 2, 0] }), infrared: [reading(2)] });
  fold_frame(scene, { ...frame({ tick: 2, stamp: 0.2, pose: [2, 2, 0] }), sonar: [reading(3)] });
  const [first, second] = [...scene.readings.values()];
  assert.deepEqual(first, { kind: "infrared", origin: { x: 1.5, y: 2, heading: 0.25 }, range: 2, hit: true, stamp: 0.1 });
  assert.equal(second.kind, "sonar");
  fold_frame(scene, { ...frame({ tick: 3, stamp: 0.3, pose: [3, 2, 0] }), infrared: [reading(1)] });
  assert.equal(scene.readings.size, 2);
  fold_frame(scene, frame({ tick: 4, stamp: 1.25, pose: [3, 2, 0] }));
  assert.deepEqual([...scene.readings.values()].map((r) => r.range), [1]);
  fold_frame(scene, frame({ tick: 1, stamp: 0, pose: [1, 2, 0] })); // a new run
  assert.equal(scene.readings.size, 0);
});

test("a grid holds until another comes, or another run", () => {
  const scene = new_scene();
  const grid = { corner: [0, 0] as [number, number], cell: 0.1, columns: 1, cells: [254] };
  fold_frame(scene, frame({ tick: 5, grid }));
  fold_frame(scene, frame({ tick: 6 }));
  assert.equal(scene.grid?.cells[0], 254);
  fold_frame(scene, frame({ tick: 0 }));
  assert.equal(scene.grid, null);
});

test("a candidate's arc is the way of its constant twist", () => {
  const c = { v: 0.5, omega: Math.PI / 2, horizon: 1, cost: 0, allowed: true, chosen: true };
  const radius = 0.5 / (Math.PI / 2);
  const end = arc_points({ x: 1, y: 1, heading: 0 }, c).at(-1)!;
  assert.ok(Math.abs(end.x - (1 + radius)) < 1e-12 && Math.abs(end.y - (1 + radius)) < 1e-12);
  const straight = arc_points({ x: 0, y: 0, heading: Math.PI }, { ...c, omega: 0 }).at(-1)!;
  assert.ok(Math.abs(straight.x + 0.5) < 1e-12);
});

test("beams end where the geometry says, from the scanner's own place", () => {
  const scene = new_scene();
  // Robot at (1, 2) facing +y; the scanner 0.5 m ahead of its centre, so at (1, 2.5) facing +y.
  // Three beams at -90, 0, +90 degrees of it: along +x, +y and -x. 2 m, free, a device code.
  fold_frame(scene, frame({ tick: 0, pose: [1, 2, Math.PI / 2], mount: [0.5, 0, 0], ranges: [2000, 65535, 65530] }));
  const { raw, end } = sweep_points(scene.sweeps[0]);
  assert.equal(raw.length, 2, "only the measured beam is a point");
  assert.ok(Math.abs(raw[0] - 3) < 1e-6 && Math.abs(raw[1] - 2.5) < 1e-6, `at ${raw}`);
  assert.ok(Math.abs(end[3] - (2.5 + 8.191)) < 1e-5, "a free beam reaches as far as the scanner does");
  assert.ok(Number.isNaN(end[4]), "a code has no end");
});

test("a tick that goes back begins a new run", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 5, pose: [1, 0, 0] }));
  fold_frame(scene, frame({ tick: 6, pose: [2, 0, 0], goal: [2, 3, null] }));
  assert.equal(scene.rows, 2);
  assert.equal(goal_distance(scene), 3);
  fold_frame(scene, frame({ tick: 0, pose: [0, 0, 0] }));
  assert.equal(scene.rows, 1);
  assert.equal(goal_distance(scene), null);
});

test("a tick without a scan keeps the last one drawn", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 1, ranges: [1000, 1000] }));
  const placed = scene.sweeps[0];
  fold_frame(scene, frame({ tick: 2, pose: [1, 0, 0] }));
  assert.equal(scene.sweeps[0], placed);
});

test("events: changes of mission and hold, and a drag is one mark", () => {
  const scene = new_scene();
  const driving = { mission: Mission.Driving };
  fold_frame(scene, frame({ tick: 0, ...driving }));
  for (let tick = 1; tick < 40; ++tick) {
    fold_frame(scene, frame({ tick, ...driving, requests: [move(1, tick, 0)] }));
  }
  fold_frame(scene, frame({ tick: 40, ...driving, hold: Hold.Bumper }));
  fold_frame(scene, frame({ tick: 41, mission: Mission.Arrived }));
  assert.deepEqual(scene.events.list.map((e) => e.label), ["Obstacle moved", "Bumper pressed", "Arrived"]);
});

test("that a run begins without a scan is no event; that it loses its scan later is", () => {
  const scene = new_scene();
  for (const tick of [0, 1]) fold_frame(scene, frame({ tick, hold: Hold.StaleScan }));
  fold_frame(scene, frame({ tick: 2 }));
  assert.equal(scene.events.list.length, 0);
  fold_frame(scene, frame({ tick: 100, hold: Hold.StaleScan }));
  assert.deepEqual(scene.events.list.map((e) => e.label), ["Scan too old"]);
});

test("a long run is thinned, and keeps its beginning and its end", () => {
  const columns = new Columns(64);
  for (let tick = 0; tick < 1000; ++tick) columns.push(frame({ tick, stamp: tick }));
  assert.ok(columns.length <= 64);
  assert.equal(columns.at("t", 0), 0);
  assert.ok(columns.at("t", columns.length - 1) > 900);
  const t = columns.get("t");
  for (let i = 1; i < t.length; ++i) assert.ok(t[i] > t[i - 1]);
});

test("row_at finds the last row not after a time", () => {
  const columns = new Columns();
  for (const stamp of [0, 1, 2, 4]) columns.push(frame({ tick: stamp, stamp }));
  assert.deepEqual([-1, 0, 1.5, 2, 3.9, 99].map((t) => columns.row_at(t)), [0, 0, 1, 2, 2, 3]);
});

test("rows of the record come before those already here", () => {
  const columns = new Columns();
  columns.push(frame({ tick: 10, stamp: 10, pose: [5, 0, 0] }));
  const row = (tick: number) => ({ tick, t: tick, x: tick / 2, y: 0, heading: 0, v: 0, omega: 0, clearance: 1 });
  columns.prepend([row(8), row(9)]);
  assert.deepEqual([...columns.get("x")], [4, 4.5, 5]);
  assert.ok(Number.isNaN(columns.at("elastic", 0)), "what the record's columns do not hold stays open");
});

test("a fitted view shows goal, obstacles, start and robot", () => {
  const scene = new_scene();
  scene.start = { x: 0, y: 0, heading: 0 };
  fold_frame(scene, frame({ tick: 0, pose: [1, 1, 0], goal: [5, 4, null] }));
  const b = scene_bounds(scene);
  assert.ok(b.min_x <= -0.35 && b.min_y <= -0.35 && b.max_x >= 5.2 && b.max_y >= 4.2);
});

test("frames of an answer are split by their lengths; a cut answer is said", () => {
  const parts = [frame_bytes({ tick: 0 }), frame_bytes({ tick: 1, ranges: [1, 2, 3] })];
  const whole = framed(parts);
  assert.deepEqual(split_frames(whole).map((f) => decode_frame(f).tick), [0, 1]);
  assert.throws(() => split_frames(whole.slice(0, whole.length - 1)), /runs past the end/);
  assert.throws(() => split_frames(whole.slice(0, parts[0].length + 4 + 2)), /stray bytes/);
});

const item: RunItem = {
  id: 3, status: "finished", outcome: "reached", scenario: "case1", controller: "modified", filter: "none",
  vehicle: "bullet", seed: 1, parameters: { filter_half_width: 1 }, version: "0", started: "", ticks: 1000, time: 26,
  lost_ticks: 0, bytes: 0, metrics: null,
  document: { robot: { radius: 0.3, half_track: 0.2 } as RunDocument["robot"], scenario: { name: "case1", start: { x: 0, y: 0, heading: 0 }, obstacles: [{ type: "cylinder", x: 1, y: 1, radius: 0.3 }] } },
};

/** A server that holds `count` frames; obstacle 2 is added at tick 100, moved at 200, gone at 300. */
function stored(count: number) {
  const asked: number[] = [];
  const at = (tick: number) => frame_bytes({
    tick, pose: [tick / 100, 0, 0], ranges: tick % 2 === 0 ? [1000, 2000, 3000] : undefined,
    requests: tick === 100 ? [add_cylinder(2, 5, 5, 0.2)] : tick === 200 ? [move(2, 6, 5)] : tick === 300 ? [remove(2)]
      : tick === 150 ? [set_parameter("filter_half_width", 3)] : [],
  });
  const run = new StoredRun(item, async (from, limit) => {
    asked.push(from);
    const end = Math.min(count, from + limit);
    const frames = [];
    for (let t = from; t < end; ++t) frames.push(at(t));
    return { bytes: framed(frames), next: end < count ? end : null };
  });
  return { run, asked };
}

test("a stored run is fetched page by page and can be sought anywhere", async () => {
  const { run, asked } = stored(1000);
  let calls = 0;
  await run.load(() => ++calls);
  assert.deepEqual(asked, [0, kPageFrames, 2 * kPageFrames]);
  assert.equal(run.rows, 1000);
  assert.equal(run.done, true);
  assert.ok(calls >= 3);
  assert.ok(run.seek(999));
  assert.equal(run.scene.frame?.tick, 999);
  assert.equal(run.scene.rows, 1000);
  assert.equal(run.scene.sweeps.length, 1, "an odd tick shows the sweep of the even one before");
});

test("obstacles and parameters are as they were at the shown instant, forward and back", async () => {
  const { run } = stored(400);
  await run.load(() => undefined);
  const at = (row: number) => {
    run.seek(row);
    return run.scene.obstacles.map((o) => [o.id, o.pose.x]);
  };
  assert.equal(run.scene.radius, 0.3, "the robot is the one of that run");
  assert.deepEqual(at(399), [[1, 1]]);
  assert.deepEqual(at(250), [[1, 1], [2, 6]]);
  assert.deepEqual(at(100), [[1, 1], [2, 5]]);
  assert.deepEqual(at(99), [[1, 1]]);
  assert.equal(run.scene.half_width, 1);
  run.seek(150);
  assert.equal(run.scene.half_width, 3);
});

test("of a run that is still being recorded, what was there when it was opened", async () => {
  let there = 500;
  const run = new StoredRun({ ...item, status: "recording", ticks: there }, async (from, limit) => {
    there += 1000; // it grows faster than it is fetched
    const frames = Array.from({ length: Math.min(limit, there - from) }, (_, i) => frame_bytes({ tick: from + i }));
    return { bytes: framed(frames), next: from + limit };
  });
  await run.load(() => undefined);
  assert.equal(run.done, true);
  assert.ok(run.rows >= 500 && run.rows <= 500 + kPageFrames, `${run.rows} rows`);
});

test("a run that cannot be fetched says why and keeps what came", async () => {
  let pages = 0;
  const run = new StoredRun(item, async () => {
    if (++pages > 1) throw new Error("The server cannot be reached.");
    return { bytes: framed([frame_bytes({ tick: 0 })]), next: 1 };
  });
  await run.load(() => undefined);
  assert.equal(run.rows, 1);
  assert.equal(run.done, false);
  assert.match(run.error ?? "", /cannot be reached/);
});

test("the player runs at its speed, stops at the end, starts over, and steps by frames", async () => {
  const { run } = stored(101); // 2.6 s
  await run.load(() => undefined);
  const player = new Player(run, () => undefined);
  player.toggle();
  player.speed = 2;
  player.advance(0.5);
  assert.ok(Math.abs(player.time - 1) < 1e-9);
  assert.equal(run.scene.frame?.tick, 38); // 1 s / 26 ms = 38.46
  player.advance(10);
  assert.equal(player.playing, false);
  assert.equal(run.scene.frame?.tick, 100);
  player.step(-1);
  assert.equal(run.scene.frame?.tick, 99);
  player.toggle();
  player.advance(10);
  player.toggle();
  assert.equal(player.time, 0);
  player.seek(1e9);
  assert.ok(Math.abs(player.time - 2.6) < 1e-9);
});
