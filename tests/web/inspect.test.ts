// tests/web/inspect.test.ts: the thing under a pointer, its numbers and its card's place.
import assert from "node:assert/strict";
import { test } from "node:test";
import { View } from "../../web/src/draw/view";
import { Card, card_of, card_words, nearest_sides, thing_key } from "../../web/src/edit/facts";
import { Eye, card_place, thing_at } from "../../web/src/edit/inspect";
import { decode_frame, decode_sweep } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { obstacle_from_json } from "../../web/src/obstacle";
import { SceneState, fold_frame, new_scene } from "../../web/src/state/scene";
import { LayerKind, LayerStyle, Tone } from "../../web/src/wire/telemetry_generated";
import { FrameSpec, frame_bytes, scan_bytes } from "./wire";

const view = Object.assign(new View(), { width: 800, height: 600, scale: 100 });
const shown = (...hidden: string[]) => ({ hidden: new Set(hidden), force_scale: 1 });

/** Beams of 1.5 m at 0 to 180 degrees about (0, 0); the middle one is 1 m long. */
const kBeams = 181;
const ranges = Array.from({ length: kBeams }, (_, i) => (i === 100 ? 1000 : 1500));
/** As the wire rounds, of the filtered range. */
const on_wire = (v: number) => Math.round(1.004 * v * 1024) / 1024;
const kEnd = { x: Math.cos((10 * Math.PI) / 180), y: Math.sin((10 * Math.PI) / 180) };

function scene_of(more: Partial<FrameSpec> = {}, controller = "modified"): SceneState {
  const scene = new_scene();
  scene.controller = controller;
  Object.assign(scene, { parameters: { k_r: 0.6, k_c: 0.8, strip_step: 0.2 } });
  const nearest = { name: "scan.nearest", kind: LayerKind.Points, style: LayerStyle.Dashed, values: [kEnd.x, kEnd.y].map(on_wire) };
  fold_frame(scene, decode_frame(frame_bytes({
    tick: 3, ranges, scan_stamp: 0.05, goal: [3, 0, null], layers: [nearest], measures: [["strip.left", "m", 0.3125]], ...more,
  }), new Legends()));
  scene.filtered.take(decode_sweep(scan_bytes({ ranges: ranges.map((r) => (r === 1000 ? 1004 : r)), stamp: 0.05 }))!);
  return scene;
}
function eye(x: number, y: number, slack = 8): Eye {
  return { px: view.to_screen({ x, y }), slack, at: { x, y }, to_screen: (p) => view.to_screen(p), scale: view.scale };
}
const at = (scene: SceneState, x: number, y: number, hidden: string[] = []) => thing_at(scene, shown(...hidden), eye(x, y));
const card = (scene: SceneState, x: number, y: number): Card => card_of(scene, at(scene, x, y)!)!;
const row = (c: Card, label: string) => {
  const found = c.rows.find((r) => r.label === label);
  return found && `${found.value} ${found.unit}`.trim();
};

test("a beam: number, bearing, both ranges, and the force of the nearest one with its equation", () => {
  const c = card(scene_of(), kEnd.x, kEnd.y);
  assert.deepEqual([c.title, c.note], ["Beam 100", "used, nearest left"]);
  assert.deepEqual([row(c, "Bearing"), row(c, "Range, filtered"), row(c, "Range, raw")], ["+10.0 °", "1.00 m", "1.00 m"]);
  assert.equal(row(c, "External force"), "0.31 m");
  assert.deepEqual([c.law!.source, c.law!.numbers], ["Eq. 13, E.3", "0.10 + 0.60 (1.35 − 1.00) m"]);
});

test("the equation is that of the controller that drives, inside and outside its reach", () => {
  const source = (controller: string, more = {}) => card(scene_of(more, controller), kEnd.x, kEnd.y).law?.source;
  assert.deepEqual(["original", "modified_published", "modified_linear", "via_kept", "dwa"].map((c) => source(c)),
    ["Eq. 7", "Eq. 13, E.2", "Eq. 13, E.2", "Eq. 13, E.3", undefined]);
  const scene = scene_of({}, "modified_published");
  scene.safety_distance = 0.5;
  assert.equal(card(scene, kEnd.x, kEnd.y).law!.source, "Eq. 14, E.2");
});

test("a controller without forces has none on its beams", () => {
  const c = card(scene_of({ measures: [] }, "dwa"), kEnd.x, kEnd.y);
  assert.deepEqual([row(c, "External force"), c.law], [undefined, null]);
});

test("beams beyond the used field say so; free and failed ones have no end to point at", () => {
  const scene = scene_of();
  assert.equal(card(scene, 1.5 * Math.cos(1.45), 1.5 * Math.sin(1.45)).note, "not used: beyond 74.5°");
  const broken = scene_of({ ranges: ranges.map(() => 65530) });
  broken.filtered.clear();
  assert.equal(at(broken, kEnd.x, kEnd.y), null);
});

test("the nearest return names its beam only if the drawn scan has it", () => {
  assert.deepEqual(nearest_sides(scene_of()).map((s) => [s.side, s.beam]), [["left", 100]]);
  const other = { name: "scan.nearest", kind: LayerKind.Points, values: [0.5, 0.5] };
  assert.deepEqual(nearest_sides(scene_of({ layers: [other] })).map((s) => [s.side, s.beam]), [["left", null]]);
});

test("hidden layers are not there", () => {
  const scene = scene_of();
  assert.equal(at(scene, kEnd.x, kEnd.y)?.kind, "beam");
  assert.equal(at(scene, kEnd.x, kEnd.y, ["filtered"])?.kind, "beam", "the raw one");
  assert.equal(at(scene, kEnd.x, kEnd.y, ["filtered", "scan"]), null);
});

test("nodes, forces, tracks and cells, by what is drawn", () => {
  const layers = [
    { name: "strip", label: "Strip", kind: LayerKind.Polyline, values: [0, 0, 0.5, -0.5, 1, -0.5] },
    { name: "strip.internal", label: "Internal force", kind: LayerKind.Arrows, tone: Tone.Internal, values: [-1, -1, 0.5, 0] },
    { name: "moving", label: "Moving obstacles", kind: LayerKind.Circles, tone: Tone.Moving, values: [-2, 1, 0.25] },
    { name: "moving.velocity", label: "Its way", unit: "m/s", kind: LayerKind.Arrows, tone: Tone.Moving, values: [-2, 1, 0, 0.75] },
    { name: "histogram.grid", label: "Histogram grid", kind: LayerKind.Grid, values: [-3, -3, 0.5, 2], cells: [255, 127 + 59, 255, 255] },
  ];
  const scene = scene_of({ layers });
  const node = card(scene, 0.5, -0.5);
  assert.deepEqual([node.title, row(node, "Along it from its start"), row(node, "On to its end")], ["Strip, node 2 of 3", "0.71 m", "0.50 m"]);
  assert.equal(card(scene, 0.8, -0.5).title, "Strip, node 3 of 3", "of a piece, the nearer node");
  const force = card(scene, -0.75, -1);
  assert.deepEqual([force.title, row(force, "Force"), force.law?.source], ["Internal force", "0.500 m", "Eq. 2-4"]);
  const track = card(scene, -2.15, 1);
  assert.deepEqual([row(track, "Speed"), row(track, "Towards, in W"), row(track, "Radius")], ["0.75 m/s", "+90.0 °", "0.25 m"]);
  const cell = card(scene, -2.3, -2.8);
  assert.deepEqual([cell.title, row(cell, "Returns counted, C")], ["Histogram grid, cell 1, 0", "7 of 15"]);
  assert.equal(at(scene, -2.8, -2.8), null, "an unknown cell is not drawn");
});

test("an enlarged force is hit where it is drawn", () => {
  const layers = [{ name: "strip.internal", kind: LayerKind.Arrows, values: [-2, -1, 0.25, 0] }];
  const scene = scene_of({ layers });
  assert.equal(at(scene, -1.2, -1), null);
  const thing = thing_at(scene, { hidden: new Set(), force_scale: 5 }, eye(-1.2, -1));
  assert.equal(thing?.kind, "mark");
  assert.equal(row(card_of(scene, thing!)!, "Force"), "0.250 m", "its number is not enlarged");
});

test("bodies and goals; what has gone has no card", () => {
  const scene = scene_of({ truth: [0.1, 0, 0, 0.9, false] });
  scene.obstacles = [obstacle_from_json({ id: 4, type: "cylinder", x: -2, y: -2, radius: 0.3 })];
  scene.goals_ahead = [{ x: 3, y: 2 }];
  const robot = card(scene, 0.05, 0.1);
  assert.deepEqual([robot.title, row(robot, "Odometry off by"), row(robot, "Safety circle, d_safe")], ["Robot", "0.10 m", "1.00 m"]);
  assert.deepEqual([card(scene, 3, 0).title, row(card(scene, 3, 0), "From the robot, D")], ["Goal 1 of 2", "3.00 m"]);
  assert.equal(card(scene, 3, 2).title, "Goal 2 of 2");
  const thing = at(scene, -2, -2)!;
  assert.equal(row(card_of(scene, thing)!, "Radius"), "0.30 m");
  scene.obstacles = [];
  assert.equal(card_of(scene, thing), null);
  assert.equal(at(scene, -3.9, 2.9), null);
});

test("a card is one sentence for a screen reader, and a thing keeps its name from frame to frame", () => {
  const scene = scene_of();
  assert.match(card_words(card(scene, kEnd.x, kEnd.y)), /^Beam 100, used, nearest left\. Bearing \+10\.0 degrees\..*Eq\. 13, E\.3\.$/);
  const before = thing_key(at(scene, kEnd.x, kEnd.y)!);
  fold_frame(scene, decode_frame(frame_bytes({ tick: 4, ranges, scan_stamp: 0.08 }), new Legends()));
  assert.equal(thing_key(at(scene, kEnd.x, kEnd.y)!), before);
});

test("a card covers nothing of its thing and stays in the room", () => {
  const room = { left: 80, top: 20, right: 780, bottom: 500 };
  const size = { w: 240, h: 160 };
  const about = (x: number, y: number, r: number) => ({ left: x - r, top: y - r, right: x + r, bottom: y + r });
  for (const [x, y] of [[100, 30], [770, 30], [400, 250], [90, 495], [775, 495]]) {
    const thing = about(x, y, 9);
    const p = card_place(thing, size, room);
    assert.ok(p.x >= room.left && p.y >= room.top && p.x + size.w <= room.right && p.y + size.h <= room.bottom, `${x}, ${y}`);
    const apart = p.x >= thing.right || p.x + size.w <= thing.left || p.y >= thing.bottom || p.y + size.h <= thing.top;
    assert.ok(apart, `${x}, ${y} is free`);
  }
  const narrow = { left: 0, top: 0, right: 260, bottom: 600 };
  const below = card_place(about(130, 100, 9), size, narrow);
  assert.ok(below.y > 109, "above there is no room");
});
