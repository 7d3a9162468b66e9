// tests/web/state.test.ts: frames folded into the scene, and a stored run played and scrubbed.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RunDocument, RunItem, SessionState } from "../../web/src/contract";
import { decode_frame, decode_frames, decode_sweep } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Player } from "../../web/src/link/player";
import { StoredRun, kPageFrames, split_frames } from "../../web/src/link/stored";
import { Columns } from "../../web/src/state/columns";
import { layer_groups } from "../../web/src/state/layers";
import { SceneState, begin_run, fold_frame, fold_session, goal_distance, new_scene, scene_bounds, take_robot } from "../../web/src/state/scene";
import { FilteredScan, sweep_points } from "../../web/src/state/sweeps";
import { LayerFrame, LayerKind, LayerStyle, Mission, Tone } from "../../web/src/wire/telemetry_generated";
import { FrameSpec, LayerSpec, add_cylinder, frame_bytes, framed, move, push_stick, remove, scan_bytes, set_parameter } from "./wire";

const frame = (spec: FrameSpec) => decode_frame(frame_bytes(spec), new Legends());

test("a frame is read back whole", () => {
  const f = frame({
    tick: 41, stamp: 1.066, pose: [1, 2, 0.5], goal: [3, 4, null], mission: Mission.Driving, hold: "stale_scan",
    truth: [1.25, 2, 0.5, 0.75, true],
    requests: [add_cylinder(7, 1.5, -2, 0.25), set_parameter("k_r", 0.5)], words: ["Driving", "2 m to go."],
    measures: [["strip.left", "m", 0.5], ["strip.side", "", -1]], moved: [[4, 1.5, 2.5, -0.25], [9, 0, 1, 0]],
  });
  assert.equal(f.tick, 41);
  assert.deepEqual(f.pose, { x: 1, y: 2, heading: 0.5 });
  assert.deepEqual(f.goal, { x: 3, y: 4, heading: null });
  assert.equal(f.mission, "driving");
  assert.equal(f.hold, "stale_scan");
  assert.deepEqual(f.words, { what: "Driving", why: "2 m to go." });
  assert.deepEqual(f.measures, [{ name: "strip.left", unit: "m", value: 0.5 }, { name: "strip.side", unit: "", value: -1 }]);
  assert.deepEqual(f.moved[0], { id: 4, pose: { x: 1.5, y: 2.5, heading: -0.25 } });
  assert.equal(f.moved.length, 2);
  assert.equal(f.truth?.collided, true);
  assert.equal(f.requests.length, 2);
  const [first, second] = f.requests;
  assert.ok(first.type === "add_obstacle" && first.obstacle.radius === 0.25 && first.obstacle.pose.y === -2);
  assert.deepEqual(second, { type: "set_parameter", name: "k_r", value: 0.5 });
  assert.throws(() => decode_frame(new Uint8Array(3), new Legends()), /too short/);
});

test("a layer is read back at any alignment", () => {
  const bytes = frame_bytes({ tick: 1, layers: [
    { name: "histogram", label: "Polar histogram", kind: LayerKind.Polar, values: [0, 1.5, 400], level: 300, unit: "1/m",
      frame: LayerFrame.Robot, tone: Tone.External, style: LayerStyle.Faint },
    { name: "grid", kind: LayerKind.Grid, values: [-1, 0.5, 0.125, 2], cells: [0, 254, 127, 255] },
    { name: "names", kind: LayerKind.Text, values: [1, 2, 3, 4, 5, 6], axes: 3, text: "one\ntwo" },
    { name: "later", kind: 99 as LayerKind, values: [1] },
  ] });
  for (let shift = 0; shift < 4; ++shift) {
    const moved = new Uint8Array(bytes.length + shift);
    moved.set(bytes, shift);
    const { layers } = decode_frame(moved.subarray(shift), new Legends());
    assert.deepEqual(layers.map((l) => l.name), ["histogram", "grid", "names"], "a kind of later is left out");
    const [polar, grid, names] = layers;
    assert.deepEqual({ ...polar, values: [...polar.values], cells: [] }, {
      name: "histogram", label: "Polar histogram", kind: "polar", values: [0, 1.5, 400], level: 300, unit: "1/m",
      robot: true, tone: "external", style: "faint", axes: 2, cells: [], text: [],
    });
    assert.deepEqual([[...grid.values], [...grid.cells]], [[-1, 0.5, 0.125, 2], [0, 254, 127, 255]]);
    assert.deepEqual([names.axes, names.text, names.label], [3, ["one", "two"], "names"]);
  }
});

test("16-bit and wide values give the same result", () => {
  const lines = (x: number): LayerSpec[] => [
    { name: "plan", kind: LayerKind.Polyline, values: [] },
    { name: "strip", kind: LayerKind.Polyline, values: [x, -0.5, NaN, NaN, -31.5, 0.25] },
    { name: "nodes", kind: LayerKind.Points, values: [1, 2] },
  ];
  for (const x of [1.5, 31.9990234375, 32, 0.1, -4000]) {
    const f = decode_frame(frame_bytes({ tick: 1, layers: lines(x), measures: [["share", "", 0.75]] }), new Legends());
    assert.deepEqual(f.layers.map((l) => [l.name, ...l.values]),
      [["strip", Math.fround(x), -0.5, NaN, NaN, -31.5, 0.25], ["nodes", 1, 2]], `x ${x}`);
    assert.deepEqual(f.measures, [{ name: "share", unit: "", value: 0.75 }]);
  }
});

test("layers and measures are named by an earlier legend, or one in the same page of frames", () => {
  const layers: LayerSpec[] = [
    { name: "strip", kind: LayerKind.Polyline, values: [0, 0, 1, 1] },
    { name: "forces", kind: LayerKind.Arrows, values: [] },
    { name: "nodes", kind: LayerKind.Points, values: [2, 3] },
  ];
  const spec = { layers, measures: [["strip.left", "m", 0.5]] as [string, string, number][] };
  const told = frame_bytes({ tick: 1, ...spec });
  const silent = frame_bytes({ tick: 2, ...spec, words: null });
  assert.ok(silent.length < told.length - 150, "names are not in it");
  const unknown = decode_frame(silent, new Legends());
  assert.deepEqual([unknown.layers, unknown.measures, unknown.words], [[], [], null], "nothing is guessed");
  for (const order of [[told, silent], [silent, told]]) {
    const f = decode_frames(order).find((each) => each.tick === 2)!;
    assert.deepEqual(f.layers.map((l) => [l.name, ...l.values]), [["strip", 0, 0, 1, 1], ["nodes", 2, 3]], "none that is empty");
    assert.deepEqual(f.measures, [{ name: "strip.left", unit: "m", value: 0.5 }]);
  }
  const other = frame_bytes({ tick: 3, layers: [layers[2]], words: null });
  const legends = new Legends();
  decode_frame(told, legends);
  assert.deepEqual(decode_frame(other, legends).layers, [], "values of another legend are not read by this one");
});

test("channels of further sensors are columns that hold until their next reading", () => {
  const scene = new_scene();
  take_robot(scene, { channels: [
    { name: "battery.voltage", kind: "scripted", unit: "V", values: 1 },
    { name: "field", kind: "magnetic", unit: "uT", values: 2 }] });
  fold_frame(scene, frame({ tick: 0 }));
  fold_frame(scene, frame({ tick: 1, readings: [[0, [25.5]]] }));
  fold_frame(scene, frame({ tick: 2, readings: [[1, [3, 4]], [7, [1]]] }));
  fold_frame(scene, frame({ tick: 3, readings: [[0, [24]]] }));
  assert.deepEqual(scene.columns.measures, [{ name: "battery.voltage", unit: "V" }, { name: "field[0]", unit: "uT" },
    { name: "field[1]", unit: "uT" }]);
  assert.deepEqual([...scene.columns.get("battery.voltage")], [NaN, 25.5, 25.5, 24]);
  assert.deepEqual([...scene.columns.get("field[1]")], [NaN, NaN, 4, 4]);
  begin_run(scene);
  fold_frame(scene, frame({ tick: 0 }));
  assert.ok(Number.isNaN(scene.columns.at("battery.voltage", 0)), "a new run holds nothing of the old one");
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

const grid = (byte: number): LayerSpec => ({ name: "grid", kind: LayerKind.Grid, values: [0, 0, 0.1, 1], cells: [byte] });
const line: LayerSpec = { name: "strip", label: "Strip", kind: LayerKind.Polyline, values: [0, 0, 1, 1] };
const goal: [number, number, null] = [1, 0, null];

test("a grid stays until another comes, the goal ends, or another run begins", () => {
  const scene = new_scene();
  const byte = () => scene.layers.get("grid")?.cells[0];
  fold_frame(scene, frame({ tick: 5, goal, layers: [grid(254), line] }));
  fold_frame(scene, frame({ tick: 6, goal }));
  assert.equal(byte(), 254);
  assert.equal(scene.layers.has("strip"), false, "all others are of one instant");
  fold_frame(scene, frame({ tick: 7, goal, layers: [grid(9)] }));
  assert.equal(byte(), 9);
  fold_frame(scene, frame({ tick: 8 }));
  assert.equal(byte(), undefined);
  fold_frame(scene, frame({ tick: 9, goal, layers: [grid(9)] }));
  fold_frame(scene, frame({ tick: 0, goal }));
  assert.equal(byte(), undefined);
});

test("words stay until others come, or another run begins", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 5, words: ["Driving", "2 m to go."] }));
  fold_frame(scene, frame({ tick: 6, words: ["", ""] }));
  assert.deepEqual(scene.words, { what: "Driving", why: "2 m to go." });
  fold_frame(scene, frame({ tick: 7, words: ["Arrived", ""] }));
  assert.deepEqual(scene.words, { what: "Arrived", why: "" });
  begin_run(scene);
  assert.equal(scene.words, null);
});

test("the panel lists every layer so far, absent ones too, until another controller drives", () => {
  const scene = new_scene();
  const session = (controller: string) => ({ run: null, controller, source: "simulation" }) as unknown as SessionState;
  const names = () => layer_groups(scene).map((g) => [g.title, ...g.keys.map((k) => k.name)]);
  fold_session(scene, session("modified"));
  const world = ["World", "safety", "goal", "robot", "start", "obstacles", "mesh"];
  const bare = [["Senses", "scan", "filtered"], ["Ways", "path", "route"], world];
  assert.deepEqual(names(), bare);
  const force = { ...line, name: "strip.internal", kind: LayerKind.Arrows };
  const map = { ...line, name: "map", kind: LayerKind.Grid };
  fold_frame(scene, frame({ tick: 0, goal, truth: [0, 0, 0, 1, false], layers: [line, { ...line, name: "scan.nearest" }, force, map] }));
  fold_frame(scene, frame({ tick: 1, goal, truth: [0, 0, 0, 1, false] }));
  assert.deepEqual(names(), [["Senses", "scan", "filtered", "scan.nearest"], ["Forces", "strip.internal"],
    ["Ways", "strip", "path", "truth", "route"], [...world.slice(0, -1), "map", "mesh"]]);
  assert.deepEqual(layer_groups(scene, true)[2].keys.map((k) => [k.name, k.token]).slice(1, 3), [["path", "accent"], ["second", "elastic"]]);
  fold_session(scene, { ...session("dwa"), run: { id: 7, status: "recording", outcome: "" } });
  assert.deepEqual(names(), bare);
});

test("moving obstacles are at the frame's poses, the others at their own", () => {
  const scene = new_scene();
  const cylinder = (id: number, x: number) => ({ id, type: "cylinder", x, y: 0, radius: 0.3 });
  const session = { run: null, source: "simulation", obstacles: [cylinder(1, 1), cylinder(2, 2)] } as unknown as SessionState;
  const poses = () => scene.obstacles.map((o) => [o.pose.x, o.pose.heading]);
  fold_session(scene, session);
  fold_frame(scene, frame({ tick: 0, moved: [[2, 2.5, 0, 0.25]] }));
  assert.deepEqual(poses(), [[1, 0], [2.5, 0.25]]);
  fold_session(scene, session);
  assert.deepEqual(poses(), [[1, 0], [2.5, 0.25]], "the document names where it began, not where it is");
});

test("a filtered scan is placed where the robot was when its tick came, whichever comes first", () => {
  const filtered = new FilteredScan();
  const scan = (stamp: number) => decode_sweep(scan_bytes({ ranges: [1000, 2000, 3000], stamp }))!;
  const tick = (n: number, x: number) => frame({ tick: n, pose: [x, 0, 0], ranges: [1, 2, 3], scan_stamp: n });
  filtered.see(tick(1, 5));
  filtered.take(scan(1));
  assert.equal(filtered.shown?.origin.x, 5);
  filtered.take(scan(2)); // before its frame: the earlier scan stays
  assert.equal(filtered.shown?.sweep.stamp, 1);
  filtered.see(tick(2, 6));
  assert.deepEqual([filtered.shown?.sweep.stamp, filtered.shown?.origin.x], [2, 6]);
  filtered.see(tick(3, 7));
  filtered.take(scan(2)); // late by a frame
  assert.equal(filtered.shown?.origin.x, 6);
  assert.equal(decode_sweep(new Uint8Array(0)), null);
});

test("beams end at their computed points, from the scanner's mount", () => {
  const scene = new_scene();
  // Robot at (1, 2) facing +y; the scanner 0.5 m ahead of its centre, so at (1, 2.5) facing +y.
  // Three beams at -90, 0, +90 degrees of it: along +x, +y and -x. 2 m, free, a device code.
  fold_frame(scene, frame({ tick: 0, pose: [1, 2, Math.PI / 2], mount: [0.5, 0, 0], ranges: [2000, 65535, 65530] }));
  const { hits, end } = sweep_points(scene.sweeps[0]);
  assert.equal(hits.length, 2, "only the measured beam is a point");
  assert.ok(Math.abs(hits[0] - 3) < 1e-6 && Math.abs(hits[1] - 2.5) < 1e-6, `at ${hits}`);
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
  fold_frame(scene, frame({ tick: 40, ...driving, hold: "bumper" }));
  fold_frame(scene, frame({ tick: 41, mission: Mission.Arrived }));
  assert.deepEqual(scene.events.list.map((e) => e.label), ["Obstacle moved", "Bumper pressed", "Arrived"]);
});

test("a run that begins without a scan is no event; losing the scan later is", () => {
  const scene = new_scene();
  for (const tick of [0, 1]) fold_frame(scene, frame({ tick, hold: "stale_scan" }));
  fold_frame(scene, frame({ tick: 2 }));
  assert.equal(scene.events.list.length, 0);
  fold_frame(scene, frame({ tick: 30, hold: "stale_scan" }));
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

test("rows of the record come where their ticks belong", () => {
  const columns = new Columns();
  columns.push(frame({ tick: 10, stamp: 10, pose: [5, 0, 0] }));
  const row = (tick: number) => ({ tick, t: tick, x: tick / 2, y: 0, heading: 0, v: 0, omega: 0, clearance: 1 });
  columns.push(frame({ tick: 14, stamp: 14, pose: [7, 0, 0] }));
  columns.insert([row(12), row(13)]);
  columns.insert([row(8), row(9)]);
  columns.insert([]);
  assert.deepEqual([...columns.get("x")], [4, 4.5, 5, 6, 6.5, 7]);
  assert.ok(Number.isNaN(columns.at("strip.left", 0)), "what the record's columns do not hold stays open");
});

test("a measure is a column from its first value on; missing values are NaN", () => {
  const columns = new Columns();
  columns.push(frame({ tick: 0 }));
  columns.push(frame({ tick: 1, measures: [["strip.left", "m", 0.5]] }));
  columns.push(frame({ tick: 2, measures: [["strip.left", "m", 0.25], ["strip.side", "", 1]] }));
  columns.push(frame({ tick: 3 }));
  assert.deepEqual(columns.measures, [{ name: "strip.left", unit: "m" }, { name: "strip.side", unit: "" }]);
  assert.deepEqual([...columns.get("strip.left")], [NaN, 0.5, 0.25, NaN]);
  assert.deepEqual([...columns.get("strip.side")], [NaN, NaN, 1, NaN]);
  columns.clear();
  columns.push(frame({ tick: 0 }));
  assert.deepEqual([columns.measures, [...columns.get("strip.left")]], [[], [NaN]]);
});

test("a fitted view shows goal, obstacles, start and robot", () => {
  const scene = new_scene();
  scene.start = { x: 0, y: 0, heading: 0 };
  fold_frame(scene, frame({ tick: 0, pose: [1, 1, 0], goal: [5, 4, null] }));
  const b = scene_bounds(scene);
  assert.ok(b.min_x <= -0.35 && b.min_y <= -0.35 && b.max_x >= 5.2 && b.max_y >= 4.2);
});

test("frames of an answer are split by their lengths; a truncated answer is an error", () => {
  const parts = [frame_bytes({ tick: 0 }), frame_bytes({ tick: 1, ranges: [1, 2, 3] })];
  const whole = framed(parts);
  assert.deepEqual(decode_frames(split_frames(whole)).map((f) => f.tick), [0, 1]);
  assert.throws(() => split_frames(whole.slice(0, whole.length - 1)), /runs past the end/);
  assert.throws(() => split_frames(whole.slice(0, parts[0].length + 4 + 2)), /stray bytes/);
});

const item: RunItem = {
  id: 3, status: "finished", outcome: "reached", scenario: "case1", controller: "modified", filter: "none",
  physics: "bullet", seed: 1, parameters: { safety_distance: 1 }, ticks: 1000, time: 26, metrics: null,
  document: { robot: { radius: 0.3, half_length: 0.25, half_width: 0.21, half_track: 0.2 } as RunDocument["robot"], scenario: { name: "case1", start: { x: 0, y: 0, heading: 0 }, obstacles: [{ type: "cylinder", x: 1, y: 1, radius: 0.3 }] } },
};

const none = () => Promise.reject(new Error("nothing filtered"));

/** A server that holds `count` frames; obstacle 2 is added at tick 100, moved at 200, gone at 300. */
function stored(count: number) {
  const asked: number[] = [];
  const at = (tick: number) => frame_bytes({
    tick, pose: [tick / 100, 0, 0], ranges: tick % 2 === 0 ? [1000, 2000, 3000] : undefined,
    requests: tick === 100 ? [add_cylinder(2, 5, 5, 0.2)] : tick === 200 ? [move(2, 6, 5)] : tick === 300 ? [remove(2)]
      : tick === 150 ? [set_parameter("safety_distance", 3)] : [],
  });
  const run = new StoredRun(item, async (from, limit) => {
    asked.push(from);
    const end = Math.min(count, from + limit);
    const frames = [];
    for (let t = from; t < end; ++t) frames.push(at(t));
    return { bytes: framed(frames), next: end < count ? end : null };
  }, none);
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

test("obstacles and parameters match the shown instant, forward and back", async () => {
  const { run } = stored(400);
  await run.load(() => undefined);
  const at = (row: number) => {
    run.seek(row);
    return run.scene.obstacles.map((o) => [o.id, o.pose.x]);
  };
  assert.deepEqual([run.scene.radius, run.scene.hull], [0.3, { half_length: 0.25, half_width: 0.21 }], "the robot is the one of that run");
  assert.deepEqual(at(399), [[1, 1]]);
  assert.deepEqual(at(250), [[1, 1], [2, 6]]);
  assert.deepEqual(at(100), [[1, 1], [2, 5]]);
  assert.deepEqual(at(99), [[1, 1]]);
  assert.equal(run.scene.safety_distance, 1);
  run.seek(150);
  assert.equal(run.scene.safety_distance, 3);
});

test("a run still being recorded is shown up to its end when opened", async () => {
  let there = 500;
  const run = new StoredRun({ ...item, status: "recording", ticks: there }, async (from, limit) => {
    there += 1000; // grows faster than it is fetched
    const frames = Array.from({ length: Math.min(limit, there - from) }, (_, i) => frame_bytes({ tick: from + i }));
    return { bytes: framed(frames), next: from + limit };
  }, none);
  await run.load(() => undefined);
  assert.equal(run.done, true);
  assert.ok(run.rows >= 500 && run.rows <= 500 + kPageFrames, `${run.rows} rows`);
});

test("a failed fetch of a run gives a reason and keeps the fetched part", async () => {
  let pages = 0;
  const run = new StoredRun(item, async () => {
    if (++pages > 1) throw new Error("The server cannot be reached.");
    return { bytes: framed([frame_bytes({ tick: 0 })]), next: 1 };
  }, none);
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

/** A run in which things come seldom and hold: words, grids, readings, people, scans, a goal that goes and returns. */
function varied(tick: number): FrameSpec {
  return {
    tick, pose: [tick / 100, 0, 0], scan_stamp: tick * 0.026, ranges: tick % 3 === 0 ? [1000 + tick, 2000, 3000] : undefined,
    goal: tick > 50 && tick < 60 ? undefined : goal, words: tick % 19 === 0 ? [`Words of ${tick}`, ""] : undefined,
    layers: [line, ...(tick % 23 === 0 ? [grid(tick)] : [])], moved: tick % 2 === 0 ? [[1, tick / 10, 1, 0]] : [],
    sonar: tick % 5 === 0 ? [[0, tick]] : tick % 5 === 2 && tick < 60 ? [[1, tick]] : [],
    requests: tick === 70 ? [add_cylinder(2, 5, 5, 0.2)] : [],
  };
}
const shown = (scene: SceneState) => ({
  words: scene.words, layers: [...scene.layers.values()].map((l) => [l.name, l.cells[0]]), goal: scene.goal,
  obstacles: scene.obstacles.map((o) => [o.id, o.pose.x]), sweeps: scene.sweeps.map((s) => [s.sweep.ranges[0], s.origin.x]),
  readings: [...scene.readings.values()].map((r) => `${r.kind} ${r.range} ${r.stamp}`).sort(),
});

test("a stored run of a driver has its stick at every row, also where a row brings none, and says that it was driven", async () => {
  const stick = (forward: number) => push_stick(forward, 0.5, 2);
  const bytes = Array.from({ length: 12 }, (_, tick) => frame_bytes({
    tick, behaviour: tick >= 3 && tick < 9 ? "manual" : "rest", requests: tick === 3 ? [stick(0.25), stick(0.5)] : tick === 6 ? [stick(1)] : [],
  }));
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), none);
  assert.ok(!run.driven);
  await run.load(() => undefined);
  assert.ok(run.driven);
  const forward = (row: number) => {
    run.seek(row);
    return run.scene.stick?.forward ?? null;
  };
  assert.deepEqual([2, 8, 5, 3, 6, 9, 11].map(forward), [null, 1, 0.5, 0.5, 1, null, null]);
  assert.equal(run.events.list.length, 0, "a stick is no mark of the timeline");
});

test("a stored run shows the live view at any tick, sought in any order", async () => {
  const bytes = Array.from({ length: 120 }, (_, tick) => frame_bytes(varied(tick)));
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), none);
  await run.load(() => undefined);
  const live = new_scene();
  live.obstacles = run.scene.obstacles;
  const legends = new Legends();
  const seen = bytes.map((b) => {
    fold_frame(live, decode_frame(b, legends));
    if (live.frame?.tick === 70) live.obstacles = [...live.obstacles, { ...live.obstacles[0], id: 2, pose: { x: 5, y: 5, heading: 0 } }];
    return shown(live);
  });
  for (const tick of [0, 119, 20, 21, 55, 60, 68, 69, 70, 71, 46, 118]) {
    run.seek(tick);
    assert.deepEqual(shown(run.scene), seen[tick], `tick ${tick}`);
  }
  assert.deepEqual([seen[69].layers.length, seen[69].readings.length, seen[119].readings.length], [2, 2, 1], "there is something to hold");
});

test("filtered scans of a stored run are fetched only while wanted, and belong to the newest scan", async () => {
  const bytes = Array.from({ length: 30 }, (_, tick) => frame_bytes(varied(tick)));
  const asked: number[] = [];
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), async (from, limit) => {
    asked.push(from);
    const messages = bytes.map((_, tick) => (tick % 3 === 0 ? scan_bytes({ ranges: [tick, 2, 3] }) : new Uint8Array(0)));
    const end = Math.min(from + limit, from + 20); // an answer may be shorter than was asked for
    return { bytes: framed(messages.slice(from, end)), next: end < 30 ? end : null };
  });
  await run.load(() => undefined);
  run.seek(10);
  assert.deepEqual([asked, run.scene.filtered.shown], [[], null]);
  run.want_filtered(true);
  let late = 0;
  assert.equal(run.seek(10, () => ++late), true, "the rest of the instant does not wait for it");
  await new Promise((resolve) => setTimeout(resolve));
  assert.equal(late, 1);
  assert.deepEqual([run.scene.filtered.shown?.sweep.ranges[0], run.scene.filtered.shown?.origin.x], [9, 0.09]);
  run.seek(28);
  assert.deepEqual([run.scene.filtered.shown?.sweep.ranges[0], asked], [27, [0, 20]]);
  run.want_filtered(false);
  run.seek(12);
  assert.equal(run.scene.filtered.shown, null);
});

test("clearance is unknown until a reading has come, although the wire says 0", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 0 }));
  fold_frame(scene, frame({ tick: 1, ranges: [2000, 2000, 2000], clearance: 1.5 }));
  fold_frame(scene, frame({ tick: 2, clearance: 1.25 }));
  assert.deepEqual([...scene.columns.get("clearance")], [NaN, 1.5, 1.25]);
});
