// tests/web/draw.test.ts: each kind of layer draws its values at the right place.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as for_driver from "../../web/src/draw/driven";
import { draw_layer, stacked } from "../../web/src/draw/layers";
import { Palette } from "../../web/src/draw/palette";
import { draw_for_driver, draw_scene } from "../../web/src/draw/scene";
import { draw_ranging, kConeAlpha } from "../../web/src/draw/sensing";
import { View } from "../../web/src/draw/view";
import { LayerKind, LayerView, arcs, grid_place, sectors } from "../../web/src/layer";
import { decode_frame, decode_sweep } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { kOwn } from "../../web/src/state/layers";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import * as wire from "../../web/src/wire/telemetry_generated";
import { frame_bytes, push_stick, scan_bytes } from "./wire";

/** A canvas that writes down what is drawn on it, in the window's pixels. */
class Recorder {
  calls: { name: string; args: number[]; colour: string; width: number; alpha: number; dash: number[]; text?: string }[] = [];
  fillStyle = "";
  strokeStyle = "";
  lineWidth = 1;
  globalAlpha = 1;
  lineCap = "";
  lineJoin = "";
  font = "";
  textAlign = "";
  textBaseline = "";
  private dash_: number[] = [];
  private saved_: [number, number, number, number, number[]][] = [];
  private x_ = 0;
  private y_ = 0;
  private turn_ = 0;

  save() {
    this.saved_.push([this.x_, this.y_, this.turn_, this.globalAlpha, this.dash_]);
  }
  restore() {
    [this.x_, this.y_, this.turn_, this.globalAlpha, this.dash_] = this.saved_.pop()!;
  }
  translate(x: number, y: number) {
    [this.x_, this.y_] = this.map(x, y);
  }
  rotate(angle: number) {
    this.turn_ += angle;
  }
  setLineDash(dash: number[]) {
    this.dash_ = dash;
  }
  beginPath() {}
  closePath() {}
  roundRect() {}
  measureText() {
    return { width: 10 };
  }
  moveTo(x: number, y: number) {
    this.note("moveTo", this.map(x, y));
  }
  lineTo(x: number, y: number) {
    this.note("lineTo", this.map(x, y));
  }
  quadraticCurveTo(cx: number, cy: number, x: number, y: number) {
    this.note("curveTo", [...this.map(cx, cy), ...this.map(x, y)]);
  }
  arc(x: number, y: number, radius: number, from: number, to: number) {
    this.note("arc", [...this.map(x, y), radius, from, to]);
  }
  rect(x: number, y: number, w: number, h: number) {
    this.note("rect", [...this.map(x, y), ...this.map(x + w, y + h)]);
  }
  fillRect(x: number, y: number, w: number, h: number) {
    this.note("fillRect", [...this.map(x, y), w, h]);
  }
  fill() {
    this.note("fill", [], this.fillStyle);
  }
  stroke() {
    this.note("stroke", []);
  }
  strokeText() {}
  fillText(text: string, x: number, y: number) {
    this.note("text", this.map(x, y), this.fillStyle, text);
  }
  of(name: string) {
    return this.calls.filter((c) => c.name === name);
  }
  private map(x: number, y: number): [number, number] {
    const [c, s] = [Math.cos(this.turn_), Math.sin(this.turn_)];
    return [this.x_ + c * x - s * y, this.y_ + s * x + c * y];
  }
  private note(name: string, args: number[], colour = this.strokeStyle, text?: string) {
    this.calls.push({ name, args, colour, width: this.lineWidth, alpha: this.globalAlpha, dash: this.dash_, text });
  }
}

// One metre is 100 px, the middle of the window (400, 300) is (0, 0), the robot stands at (1, 2) facing +y.
const view = Object.assign(new View(), { width: 800, height: 600, scale: 100 });
const palette = new Proxy({}, { get: (_, name) => String(name) }) as Palette;
const robot = { x: 1, y: 2, heading: Math.PI / 2 };

const layer = (kind: LayerKind, values: number[], more: Partial<LayerView> = {}): LayerView => ({
  name: "a.layer", label: "A layer", unit: "", kind, robot: false, tone: "external", style: "solid", axes: 2, level: 0,
  values: Float32Array.from(values), cells: new Uint8Array(0), text: [], ...more,
});
function drawn(of: LayerView, times = 1): Recorder {
  const g = new Recorder();
  draw_layer({ g: g as unknown as CanvasRenderingContext2D, view, palette, robot, radius: 0.35, times }, of);
  assert.equal(g.globalAlpha, 1, "the next drawing starts as this one did");
  return g;
}
function near(actual: number[], wanted: number[]) {
  assert.equal(actual.length, wanted.length);
  actual.forEach((a, i) => assert.ok(Math.abs(a - wanted[i]) < 1e-3, `${actual} is not ${wanted}`));
}
const xy = (g: Recorder, name: string) => g.of(name).map((c) => c.args.slice(0, 2).map((v) => Math.round(v * 100) / 100));

test("points: a disc each, in W or from the robot; dashed ones are tied to it", () => {
  const at = drawn(layer("points", [1, 0, -1, 0.5]));
  assert.deepEqual(xy(at, "arc"), [[500, 300], [300, 250]]);
  assert.deepEqual([...new Set(at.of("fill").map((c) => c.colour))], ["external"]);
  assert.equal(at.of("moveTo").length, 0);
  // 1 m ahead of the robot at (1, 2) facing +y is (1, 3).
  const tied = drawn(layer("points", [1, 0], { robot: true, style: "dashed", tone: "moving" }));
  assert.deepEqual([xy(tied, "moveTo"), xy(tied, "lineTo"), xy(tied, "arc")], [[[500, 100]], [[500, 0]], [[500, 0]]]);
  assert.equal(tied.of("fill")[0].colour, "warn");
  assert.ok(tied.of("stroke")[0].dash.length > 0);
});

test("points in space are drawn at their ground position", () => {
  assert.deepEqual(xy(drawn(layer("points", [1, 0, 7, -1, 0.5, 8], { axes: 3 })), "arc"), [[500, 300], [300, 250]]);
});

test("a polyline goes through its positions; NaN starts a new line", () => {
  const dashed = drawn(layer("polyline", [0, 0, 1, 0, NaN, NaN, 0, 1, 1, 1, 2, 1, 3, 1], { style: "dashed", tone: "plan" }));
  assert.deepEqual(xy(dashed, "moveTo"), [[400, 300], [400, 200]]);
  assert.deepEqual(xy(dashed, "lineTo"), [[500, 300], [500, 200], [600, 200], [700, 200]]);
  assert.equal(dashed.of("stroke")[0].colour, "accent");
  assert.ok(dashed.of("stroke")[0].dash.length > 0);
  const solid = drawn(layer("polyline", [0, 0, 1, 0, 2, 1, 3, 1]));
  assert.deepEqual([solid.of("moveTo")[0].args, ...xy(solid, "lineTo")], [[400, 300], [500, 300], [600, 200], [700, 200]]);
  assert.deepEqual(xy(solid, "arc"), [[400, 300], [500, 300], [600, 200], [700, 200]], "each node is a dot");
  assert.equal(solid.of("curveTo").length, 0, "nothing is rounded off");
});

test("the line from the strip's end to the goal does not look like the strip", () => {
  const ahead = drawn(layer("polyline", [0, 0, 3, 0], { name: "strip.ahead", tone: "accent", style: "dashed" }));
  assert.equal(ahead.of("stroke")[0].colour, "ok");
});

test("arrows: from a place by a vector; forces enlarged, velocities never", () => {
  const tip = (g: Recorder) => g.of("moveTo").at(-1)!.args;
  near(drawn(layer("arrows", [0, 0, 0, 0.5])).of("moveTo")[0].args, [400, 300]);
  near(tip(drawn(layer("arrows", [0, 0, 0, 0.5]))), [400, 250]);
  near(tip(drawn(layer("arrows", [0, 0, 0, 0.5]), 2)), [400, 200]);
  near(tip(drawn(layer("arrows", [0, 0, 0, 0.5], { unit: "m/s" }), 2)), [400, 250]);
  // From the robot: 0.5 m to its left is towards -x.
  near(tip(drawn(layer("arrows", [0, 0, 0, 0.5], { robot: true }))), [450, 100]);
});

test("circles have their given radius; faint ones are faint", () => {
  const g = drawn(layer("circles", [1, 0, 0.25, -1, 0, 0.5], { style: "faint" }));
  assert.deepEqual(g.of("arc").map((c) => c.args.slice(0, 3)), [[500, 300, 25], [300, 300, 50]]);
  assert.ok(g.of("stroke").every((c) => c.alpha < 1));
});

test("arcs begin at the robot and have their given angle and length", () => {
  const [[start, ...rest]] = arcs(layer("arcs", [Math.PI / 2, Math.PI / 2]), { x: 0, y: 0, heading: 0 });
  assert.deepEqual([start.x, start.y], [0, 0]);
  near([rest.at(-1)!.x, rest.at(-1)!.y], [1, 1]); // a quarter of a circle of radius 1
  const straight = drawn(layer("arcs", [0.5, 0]));
  near(straight.of("moveTo")[0].args, [500, 100]);
  near(straight.of("lineTo").at(-1)!.args, [500, 50]);
  assert.ok(drawn(layer("arcs", [0.5, 0], { tone: "muted" })).of("stroke")[0].width < straight.of("stroke")[0].width);
});

test("a grid shades occupied cells row by row from its corner, darker for higher values", () => {
  const values = [-1, 0.5, 0.5, 2]; // corner, cell, columns
  const g = drawn(layer("grid", values, { cells: Uint8Array.from([0, 254, 127, 255, 160, 254]) }));
  const rects = g.of("rect").map((c) => c.args);
  assert.equal(rects.length, 3, "free, even and unknown cells are left out");
  const sorted = (r: number[]) => [Math.min(r[0], r[2]), Math.min(r[1], r[3]), Math.max(r[0], r[2]), Math.max(r[1], r[3])];
  near(sorted(rects[0]), [300, 100, 350, 150]);                      // 160: first column, third row
  near(sorted(rects[1]), [350, 200, 400, 250]);                      // 254: second column, first row
  near(sorted(rects[2]), [350, 100, 400, 150]);
  const weak = g.calls.slice(g.calls.findIndex((c) => c.name === "rect")).find((c) => c.name === "fill")!;
  assert.ok(weak.alpha < g.of("fill").at(-1)!.alpha);
  const turned = grid_place(layer("grid", [1, 0, 0.5, 2], { robot: true }), robot)!;
  near([turned.corner.x, turned.corner.y, turned.corner.heading], [1, 3, Math.PI / 2]);
  assert.equal(grid_place(layer("grid", []), robot), null);
});

test("a polar is a rose about the robot: sectors by bearing, taken from the level up", () => {
  const g = drawn(layer("polar", [0, 200, 300, 900], { level: 300 }));
  assert.deepEqual(g.of("fill").map((c) => c.colour), ["muted", "external", "external"]);
  const outer = g.of("arc").filter((_, i) => i % 2 === 0).map((c) => c.args);
  near(outer[0].slice(0, 2), [500, 100]);
  near(outer[0].slice(3), [-Math.PI / 2, -Math.PI]); // the second quarter, the screen's y axis down
  assert.ok(outer[0][2] < outer[1][2] && outer[1][2] < outer[2][2], "the denser the taller");
  const [first] = sectors(layer("polar", [5], { level: 1, robot: true }), robot);
  assert.equal(first.from, Math.PI / 2);
  assert.deepEqual(sectors(layer("polar", [5]), robot), [], "without a level nothing is told apart");
});

test("text stands at its positions, a line each", () => {
  const g = drawn(layer("text", [0, 0, 1, 0], { text: ["one", "two"] }));
  assert.deepEqual(g.of("text").map((c) => [c.text, ...c.args]), [["one", 400, 300], ["two", 500, 300]]);
});

test("ground layers lie below the robot, nearer ones above it", () => {
  const of = (kind: LayerKind, style: LayerView["style"] = "solid") => layer(kind, [], { style });
  const { below, above } = stacked([of("arrows"), of("polyline"), of("grid"), of("points", "dashed"), of("arrows", "dashed"), of("circles")]);
  assert.deepEqual(below.map((l) => l.kind), ["grid", "circles", "points"]);
  assert.deepEqual(above.map((l) => l.kind), ["polyline", "arrows", "arrows"]);
});

test("the place of the pointer stands above the scale bar", () => {
  const g = new Recorder();
  const overlay = {
    selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set<string>(), ghosts: [], future: false,
    insets: { left: 0, top: 0, right: 0, bottom: 22 }, pointer: { x: 4.956, y: -3.684 },
  };
  draw_scene(g as unknown as CanvasRenderingContext2D, view, palette, new_scene(), overlay);
  assert.deepEqual(g.of("text").map((c) => c.text), ["1 m", "x 4.96 m, y −3.68 m"]);
});

test("each layer is drawn while its switch is on, and nothing of it while it is off", () => {
  const scene = new_scene();
  const truth: [number, number, number, number, boolean] = [0, 0, 0, 1, false];
  const kinds = [wire.LayerKind.Points, wire.LayerKind.Polyline, wire.LayerKind.Circles];
  const layers = kinds.map((kind, i) => ({ name: `l${i}`, kind, values: [0, 0, 1, 1, 0.5, 0.5] }));
  fold_frame(scene, decode_frame(frame_bytes({ tick: 0, truth }), new Legends()));
  const far = [1.2, 0, 0, 1, false] as typeof truth;
  fold_frame(scene, decode_frame(frame_bytes({ tick: 1, pose: [1, 0, 0], ranges: [1000, 2000, 1000], layers, goal: [2, 2, null], truth: far }), new Legends()));
  scene.goals_ahead = [{ x: 3, y: 3 }];
  scene.filtered.take(decode_sweep(scan_bytes({ ranges: [1500, 1500, 1500] }))!);
  const own = [kOwn.scan, kOwn.filtered, kOwn.path, kOwn.truth, kOwn.route, kOwn.safety, kOwn.mesh];
  const names = [...own.map((k) => k.name), ...layers.map((l) => l.name)];
  const calls = (hidden: string[]) => {
    const g = new Recorder();
    draw_scene(g as unknown as CanvasRenderingContext2D, view, palette, scene, {
      selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set(hidden), ghosts: [], future: false,
      insets: { left: 0, top: 0, right: 0, bottom: 0 },
    });
    return g.calls.length;
  };
  const bare = calls(names);
  let sum = bare;
  for (const name of names) {
    const alone = calls(names.filter((n) => n !== name));
    assert.ok(alone > bare, `${name} is drawn`);
    sum += alone - bare;
  }
  assert.equal(calls([]), sum, "all together are what each is alone");
});

test("an echo of a sonar is an arc, and the cone before it is free", () => {
  const scene = new_scene();
  fold_frame(scene, decode_frame(frame_bytes({ tick: 1, sonar: [[0, 2]] }), new Legends()));
  const g = new Recorder();
  draw_ranging(g as unknown as CanvasRenderingContext2D, view, palette, scene.readings);
  const [cone] = g.of("fill");
  assert.deepEqual([g.of("fill").length, cone.colour, cone.alpha], [1, "scan", kConeAlpha]);
  near(g.of("moveTo")[0].args, [400, 300]);
  assert.deepEqual(g.of("arc").map((c) => c.args[2]), [200, 200]);
  assert.deepEqual(g.of("stroke").map((c) => [c.colour, c.alpha]), [["scan", 0.8]]);
});

test("a driver sees sectors instead of arrows, the wall's numbers, and both ways ahead, each while its switch is on", () => {
  const scene = new_scene();
  scene.top = { v: 0.5, omega: 1 };
  scene.parameters = { "teleop.d_max": 3 };
  const ranges = [3, 1, 3, 2, 3, 3, 3, 3];
  const arrows = ranges.flatMap((r, n) => {
    const bearing = (n / 7 - 0.5) * Math.PI; // the robot looks along x
    return [0, 0, r * Math.cos(bearing), r * Math.sin(bearing)];
  });
  const layers = [{ name: "teleop.ring", kind: wire.LayerKind.Arrows, values: arrows, style: wire.LayerStyle.Dashed },
    { name: "teleop.wall", kind: wire.LayerKind.Polyline, values: [-1, -0.8, 1, -0.8] }];
  fold_frame(scene, decode_frame(frame_bytes({
    tick: 1, behaviour: "manual", limit: "crowded", layers, words: ["a", "b"], twist: [0.2, 0], command: [0.2, 0],
    measures: [["teleop.wall_rho", "m", 0.8], ["teleop.wall_theta", "rad", -Math.PI / 2]],
    requests: [push_stick(0.8, 0, 1)],
  }), new Legends()));
  const shown = (...hidden: string[]) => {
    const g = new Recorder();
    draw_scene(g as unknown as CanvasRenderingContext2D, view, palette, scene, {
      selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set(hidden), ghosts: [], future: false,
      insets: { left: 0, top: 0, right: 0, bottom: 0 },
    });
    const dashed = g.of("stroke").filter((c) => c.colour === "accent" && c.dash.length > 0).length;
    return { words: g.of("text").map((c) => c.text), wedges: g.of("fill").filter((c) => ["filtered", "external"].includes(c.colour)).length,
      orange: g.of("fill").filter((c) => c.colour === "external").length, dashed, path: g.of("stroke").filter((c) => c.colour === "path").length };
  };
  const before = shown(); // the part for driving is not there yet
  assert.ok(before.wedges > 0 && !before.words.includes("1.00"), "arrows");
  draw_for_driver(for_driver);
  const all = shown();
  assert.deepEqual([all.wedges, all.orange, all.dashed, all.path], [8, 1, 1, 1]);
  for (const words of ["1.00", "2.00", "Wall 0.80 m, −90°"]) assert.ok(all.words.includes(words), words);
  assert.ok(!all.words.includes("3.00"), "no echo, no number");
  assert.equal(shown("teleop.ring").wedges, 0);
  assert.ok(!shown("teleop.wall").words.includes("Wall 0.80 m, −90°"));
  assert.equal(shown("teleop.wanted").dashed, 0);
  assert.equal(shown("teleop.executed").path, 0);
});
