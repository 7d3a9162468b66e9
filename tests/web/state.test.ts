// tests/web/state.test.ts: frames folded into the scene.
import assert from "node:assert/strict";
import { test } from "node:test";
import { SessionState } from "../../web/src/contract";
import { decode_frame, decode_frames, decode_sweep } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Columns } from "../../web/src/state/columns";
import { layer_groups } from "../../web/src/state/layer_groups";
import { begin_run, fold_frame, fold_session, goal_distance, new_scene, scene_bounds, take_robot } from "../../web/src/state/scene";
import { FilteredScan, sweep_points } from "../../web/src/state/sweeps";
import { LayerFrame, LayerKind, LayerStyle, Mission, Tone } from "../../web/src/wire/telemetry_generated";
import { FrameSpec, LayerSpec, add_cylinder, frame_bytes, goal, grid, line, move, scan_bytes, set_parameter } from "./wire";

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

test("clearance is unknown until a reading has come, although the wire says 0", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 0 }));
  fold_frame(scene, frame({ tick: 1, ranges: [2000, 2000, 2000], clearance: 1.5 }));
  fold_frame(scene, frame({ tick: 2, clearance: 1.25 }));
  assert.deepEqual([...scene.columns.get("clearance")], [NaN, 1.5, 1.25]);
});
