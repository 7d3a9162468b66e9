// tests/web/ground.test.ts: ramps, steps and trenches as the page holds, draws and edits them; the robot's tilt; what the
// terrain card reads from frames.
import assert from "node:assert/strict";
import { test } from "node:test";
import { draw_scene, lacks_ground } from "../../web/src/draw/scene";
import { Palette } from "../../web/src/draw/palette";
import { View } from "../../web/src/draw/view";
import { dragged_obstacle, is_ground_tool } from "../../web/src/edit/drawn";
import { add_edit, change_edit, new_box, new_ground } from "../../web/src/edit/edits";
import { card_of } from "../../web/src/edit/facts";
import { handles_of } from "../../web/src/edit/handles";
import { thing_at } from "../../web/src/edit/inspect";
import { map_of_world } from "../../web/src/edit/map_file";
import { snapped } from "../../web/src/edit/snap";
import { change_since } from "../../web/src/edit/stands";
import { downhill, height_at, slope_of, tilt_of, top_at } from "../../web/src/ground";
import { degrees } from "../../web/src/geometry";
import { texts } from "../../web/src/layer";
import { Legends } from "../../web/src/link/legend";
import { decode_frame } from "../../web/src/link/frame";
import { Obstacle, is_ground, obstacle_from_json, obstacle_name, obstacle_to_json, outline, topmost } from "../../web/src/obstacle";
import { EventLog } from "../../web/src/state/events";
import { layer_groups } from "../../web/src/state/layer_groups";
import { fold_frame, new_scene, senses_ground } from "../../web/src/state/scene";
import { ground_ahead, line_across, predicted_stand, turn_band } from "../../web/src/state/terrain";
import * as wire from "../../web/src/wire/telemetry_generated";
import { result_word } from "../../web/src/words";
import { FrameSpec, add_shape, frame_bytes } from "./wire";

const ramp = { id: 1, type: "ramp", x: 2, y: 0, heading: 0, length: 2, width: 1, low: 0.1, height: 0.3 } as const;
const step = { id: 2, type: "step", x: 5, y: 0, heading: 0, length: 1, width: 1, height: 0.013 } as const;
const trench = { id: 3, type: "trench", x: 8, y: 0, heading: 0, length: 0.4, width: 1, depth: 0.2 } as const;
const all = () => [ramp, step, trench].map((json) => obstacle_from_json(json));
const near = (a: number, b: number, within = 1e-9) => assert.ok(Math.abs(a - b) <= within, `${a}, not ${b}`);
const decoded = (spec: FrameSpec) => decode_frame(frame_bytes(spec), new Legends());

test("ground survives conversion to JSON and back, and no other field comes with it", () => {
  for (const json of [ramp, step, trench]) {
    const back = { ...obstacle_to_json(obstacle_from_json(json)), id: json.id };
    assert.deepEqual(JSON.parse(JSON.stringify(back)), json);
  }
});

test("a ramp of one height is a step, and a step with two is a ramp, as the server names them", () => {
  const [o] = all();
  assert.equal(obstacle_to_json({ ...o, low: 0.3 }).type, "step");
  assert.equal(obstacle_to_json({ ...all()[1], low: 0 }).type, "ramp");
  const down = obstacle_from_json({ ...ramp, low: 0.3, height: 0 });
  assert.deepEqual([down.low, down.height], [0.3, 0], "a height of 0 is no missing height");
});

test("the wire brings the same shapes", () => {
  const add = (kind: wire.ShapeKind, low: number, height: number) => {
    const [request] = decoded({ tick: 1, requests: [add_shape(7, kind, [2, 1], low, height)] }).requests;
    assert.ok(request.type === "add_obstacle");
    return [request.obstacle.kind, request.obstacle.low, request.obstacle.height, request.obstacle.length, request.obstacle.width];
  };
  assert.deepEqual(add(wire.ShapeKind.Ramp, 0.1, 0.3), ["ramp", 0.1, 0.3, 2, 1]);
  assert.deepEqual(add(wire.ShapeKind.Ramp, 0.2, 0), ["ramp", 0.2, 0, 2, 1]);
  assert.deepEqual(add(wire.ShapeKind.Ramp, 0.2, 0.2), ["step", 0.2, 0.2, 2, 1]);
  assert.deepEqual(add(wire.ShapeKind.Trench, -0.2, 1), ["trench", -0.2, 0, 2, 1]);
});

test("heights and slopes of the ground: between both ends of a ramp, and of the highest piece", () => {
  const [r, s, t] = all();
  // 0.1 m at x = 1, 0.3 m at x = 3: 0.15 m a quarter of the way
  near(top_at(r, { x: 1.5, y: 0.4 }), 0.15);
  near(degrees(slope_of(r)), degrees(Math.atan2(0.2, 2)));
  near(slope_of({ ...r, low: 0.3, height: 0.1 }), -slope_of(r));
  assert.deepEqual([slope_of(s), slope_of(t)], [0, 0]);
  near(top_at(s, s.pose), 0.013);
  near(top_at(t, t.pose), -0.2);
  near(height_at([r, s, t], { x: 0, y: 0 }), 0);
  near(height_at([r, { ...s, pose: r.pose }], r.pose), 0.2);
  near(height_at([t], t.pose), -0.2);
  near(height_at([new_box(8, 0, 1, 1)], { x: 8, y: 0 }), 0, 0); // a box is no ground
  const turned = { ...r, pose: { x: 0, y: 0, heading: Math.PI / 2 } };
  near(top_at(turned, { x: 0, y: 1 }), 0.3); // uphill along its heading
});

test("the way down lies ahead with the nose down, and to the right with the left side up", () => {
  near(downhill({ roll: 0, pitch: 0.1 }).bearing, 0);
  near(downhill({ roll: 0, pitch: 0.1 }).angle, 0.1);
  near(downhill({ roll: 0.1, pitch: 0 }).bearing, -Math.PI / 2);
  near(downhill({ roll: -0.1, pitch: 0 }).bearing, Math.PI / 2);
  near(Math.abs(downhill({ roll: 0, pitch: -0.1 }).bearing), Math.PI);
});

test("a drag draws ground the way over it, and a click one of usual size", () => {
  const r = dragged_obstacle("ramp", { x: 1, y: 1 }, { x: 1, y: 3 }, true)!;
  assert.deepEqual([r.kind, r.pose.x, r.pose.y, r.length, r.low, r.height], ["ramp", 1, 2, 2, 0, 0.15]);
  near(r.pose.heading, Math.PI / 2);
  const t = dragged_obstacle("trench", { x: 0, y: 0 }, { x: 0.3, y: 0 }, true)!;
  near(t.length, 0.3);
  assert.ok(t.low < 0 && t.height === 0);
  const s = dragged_obstacle("step", { x: 4, y: 2 }, { x: 4, y: 2 }, false)!;
  assert.deepEqual([s.pose.x, s.pose.y, s.pose.heading], [4, 2, 0]);
  assert.equal(s.low, s.height);
  assert.deepEqual(["ramp", "step", "trench", "box", "pan"].map((tool) => is_ground_tool(tool as "ramp")), [true, true, true, false, false]);
});

test("ground goes on at the height of the ground where their ends meet", () => {
  const [r] = all(); // 0.1 m at x = 1, 0.3 m at x = 3
  const heights = (kind: "ramp" | "step" | "trench", from: number, to: number) => {
    const o = dragged_obstacle(kind, { x: from, y: 0 }, { x: to, y: 0 }, true, [r])!;
    return [o.low, o.height];
  };
  assert.deepEqual(heights("step", 3, 5), [0.3, 0.3]);
  assert.deepEqual(heights("ramp", 5, 3), [0, 0.3], "up from the floor to its high end");
  const on = heights("ramp", 3, 5);
  near(on[0], 0.3);
  near(on[1], 0.45);
  assert.deepEqual(heights("ramp", 1, 3), [0.1, 0.3]);
  assert.deepEqual(heights("ramp", 4, 5), [0, 0.15], "it meets none");
  assert.deepEqual(heights("trench", 3, 4), [-0.1, 0]);
});

test("a drawing snaps to the corners of ground and to the middles of its ends, where the next piece goes on", () => {
  const [r] = all(); // from x = 1 to x = 3, 1 m wide
  assert.deepEqual(snapped({ x: 3.04, y: 0.03 }, [r], 0.1, true), { x: 3, y: 0 });
  assert.deepEqual(snapped({ x: 3.04, y: 0.47 }, [r], 0.1, true), { x: 3, y: 0.5 });
  assert.deepEqual(snapped({ x: 2.04, y: 0.47 }, [r], 0.1, true), { x: 2, y: 0.5 }, "a side has no middle: the grid");
});

test("corners resize ground, and a handle turns it; heights stay", () => {
  const [r] = all();
  const handles = handles_of(r);
  const wider = handles[2].to({ x: 4, y: 1 })!;
  assert.deepEqual([wider.length, wider.width, wider.low, wider.height], [3, 1.5, 0.1, 0.3]);
  assert.equal(handles[2].label, "Resize ramp");
  assert.ok(handles.some((h) => h.kind === "turn"));
  const narrow = handles_of({ ...all()[2], length: 0.015 })[2].to({ x: 8.0075, y: 1 })!; // only its width changes
  near(narrow.length, 0.015);
  near(narrow.width, 1.5);
});

test("an obstacle on a ramp is picked before the ramp", () => {
  const [r] = all();
  const box = { ...new_box(2, 0, 0.4, 0.4), id: 9 };
  assert.equal(topmost([box, r], { x: 2, y: 0 }, 0)?.id, 9);
  assert.equal(topmost([box, r], { x: 1.2, y: 0 }, 0)?.id, 1);
  assert.equal(topmost([box, r], { x: 0, y: 3 }, 0), null);
});

test("undo knows when somebody else has changed the height of ground", () => {
  const scene = new_scene();
  const [r] = all();
  const edit = change_edit("Change ramp 1", r, { ...r, height: 0.4 });
  scene.obstacles = [{ ...r, height: 0.4 }];
  assert.equal(change_since(edit.forward, scene), null);
  scene.obstacles = [{ ...r, height: 0.5 }];
  assert.match(change_since(edit.forward, scene)!, /Ramp 1 has been changed since/);
  assert.equal(add_edit(all()[2]).label, "Add trench");
});

test("ground is no obstacle of a map", () => {
  assert.throws(() => map_of_world(all(), "hills"), /Nothing stands/);
  const box = new_box(0, 0, 1, 1);
  assert.deepEqual(map_of_world([box, ...all()], "a").pgm, map_of_world([box], "a").pgm);
});

/** A view of 100 px/m about (2, 0), and a pointer at (x, y) [m]. */
const eye_at = (x: number, y: number) => ({
  px: { x: 100 * x, y: -100 * y }, slack: 4, at: { x, y }, scale: 100, to_screen: (p: { x: number; y: number }) => ({ x: 100 * p.x, y: -100 * p.y }),
});

test("inspecting ground tells its height and its slope in degrees at the pointer", () => {
  const scene = new_scene();
  scene.obstacles = all();
  const thing = thing_at(scene, { hidden: new Set(), force_scale: 1 }, eye_at(2.5, 0.2))!;
  assert.deepEqual(thing, { kind: "ground", id: 1, at: { x: 2.5, y: 0.2 } });
  const rows = Object.fromEntries(card_of(scene, thing)!.rows.map((r) => [r.label, `${r.value} ${r.unit}`]));
  assert.equal(rows["Height here"], "0.25 m");
  assert.equal(rows.Slope, "+5.7 °");
  const deep = card_of(scene, thing_at(scene, { hidden: new Set(), force_scale: 1 }, eye_at(8, 0))!)!;
  assert.equal(deep.title, "Trench 3");
  assert.equal(deep.rows.find((r) => r.label === "Height here")!.value, "−0.20");
  scene.obstacles = [];
  assert.equal(card_of(scene, thing), null, "it is gone");
});

test("the legend lists ground where there is some", () => {
  const scene = new_scene();
  const listed = () => layer_groups(scene).flatMap((g) => g.keys).some((k) => k.name === "ground" && !k.always);
  assert.equal(listed(), false);
  scene.obstacles = all();
  assert.equal(listed(), true);
});

/** Draws `scene`; the texts that were written and the number of fills. */
function drawn(scene: ReturnType<typeof new_scene>, hidden: string[] = []): { texts: string[]; gradients: number[][] } {
  const texts: string[] = [], gradients: number[][] = [];
  const g = new Proxy({} as Record<string, unknown>, {
    get: (of, name) => (name in of ? of[name as string] : (...args: unknown[]) => {
      if (name === "fillText") texts.push(args[0] as string);
      if (name === "createLinearGradient") gradients.push(args as number[]);
      return { width: 10, addColorStop: () => undefined };
    }),
    set: (of, name, value) => ((of[name as string] = value), true),
  });
  const palette = new Proxy({}, { get: () => "#888888" }) as Palette;
  const view = Object.assign(new View(), { width: 2000, height: 800, scale: 200, x: 4, y: 0 });
  draw_scene(g as unknown as CanvasRenderingContext2D, view, palette, scene, {
    selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set(hidden), ghosts: [], future: false,
    insets: { left: 0, top: 0, right: 0, bottom: 0 },
  });
  return { texts, gradients };
}

test("from above a ramp has its slope, contour lines and end heights, a step its height, a trench its depth", async () => {
  const scene = new_scene();
  assert.equal(lacks_ground(scene), false);
  scene.obstacles = all();
  assert.equal(lacks_ground(scene), true, "until the part that draws it has come");
  await import("../../web/src/draw/ground");
  assert.equal(lacks_ground(scene), false);
  const { texts, gradients } = drawn(scene);
  for (const text of ["5.7°", "0.10 m", "0.30 m", "0.20 m", "0.013 m", "−0.20 m"]) assert.ok(texts.includes(text), `${text} of ${texts}`);
  assert.equal(texts.filter((t) => t === "0.20 m").length, 1, "the contour line in the middle");
  // 200 px a metre about x = 4; higher ground is drawn later: the shade of the ramp goes from its low end to its high one
  assert.deepEqual(gradients.at(-1)!.map(Math.round), [400, 400, 800, 400]);
  assert.ok(!drawn(scene, ["ground"]).texts.includes("5.7°"), "its layer is switched off");
});

test("the view from above tells a tilt from one degree on", async () => {
  await import("../../web/src/draw/ground");
  const scene = new_scene();
  fold_frame(scene, decoded({ tick: 1, tilt: [0.1, 0, 0.01] }));
  assert.ok(!drawn(scene).texts.some((t) => t.endsWith("°")));
  fold_frame(scene, decoded({ tick: 2, tilt: [0.1, 0.1, 0.1] }));
  assert.ok(drawn(scene).texts.includes("8°"), "acos(cos 0.1 cos 0.1) is 8.1 degrees");
});

test("a frame brings tilt and inclination; the measured one holds until the next", () => {
  const scene = new_scene();
  fold_frame(scene, decoded({ tick: 1 }));
  assert.deepEqual([scene.frame!.tilt, scene.inclination, tilt_of(scene)], [null, null, null]);
  fold_frame(scene, decoded({ tick: 2, inclination: [0.25, -0.5] }));
  fold_frame(scene, decoded({ tick: 3 }));
  assert.deepEqual(scene.inclination, { roll: 0.25, pitch: -0.5 });
  assert.deepEqual(tilt_of(scene), { z: 0, roll: 0.25, pitch: -0.5 });
  fold_frame(scene, decoded({ tick: 4, tilt: [0.5, 0.125, 0] }));
  assert.deepEqual(tilt_of(scene), { z: 0.5, roll: 0.125, pitch: 0 }, "the truth goes before");
});

test("a robot with an inclinometer shows it only where the ground may not be level", () => {
  const scene = new_scene();
  fold_frame(scene, decoded({ tick: 1, inclination: [0, 0] }));
  assert.equal(senses_ground(scene), false);
  scene.obstacles = all();
  assert.equal(senses_ground(scene), true);
  scene.obstacles = [];
  scene.world = false; // real
  assert.equal(senses_ground(scene), true);
  const other = new_scene();
  fold_frame(other, decoded({ tick: 1, measures: [["turnover.w_max", "rad/s", 0.5]] }));
  assert.equal(senses_ground(other), true);
});

const verdict = { name: "ground.verdict", kind: wire.LayerKind.Text, values: [2.25, 0], text: "step up 1.3 cm" };

test("the card reads class, values and verdict of the ground ahead, and the way to its edge", () => {
  const scene = new_scene();
  fold_frame(scene, decoded({ tick: 1 }));
  assert.equal(ground_ahead(scene), null);
  fold_frame(scene, decoded({
    tick: 2, pose: [1, 0, 0], layers: [verdict],
    measures: [["ground.class", "", 2], ["ground.height", "m", 0.0625], ["ground.slope", "rad", NaN], ["ground.width", "m", NaN], ["ground.confidence", "", 0.75]],
  }));
  // The verdict stands at the middle of the edge, 1.25 m ahead of the centre, the nose 0.35 m.
  assert.deepEqual(ground_ahead(scene), { kind: "step up", words: "step up 1.3 cm", height: 0.0625, slope: null, width: null, confidence: 0.75, distance: 1.25 - 0.35 });
  fold_frame(scene, decoded({ tick: 3, pose: [2.25, 0, 0], layers: [verdict], measures: [["ground.class", "", 5]] }));
  assert.equal(ground_ahead(scene)!.distance, null, "without an edge it stands at the robot");
  for (const [at, kind] of ["slope up", "slope down", "step up", "step down", "trench", "flat", "pending", "unknown"].entries()) {
    fold_frame(scene, decoded({ tick: 4 + at, measures: [["ground.class", "", at]] }));
    assert.deepEqual([ground_ahead(scene)!.kind, ground_ahead(scene)!.words, ground_ahead(scene)!.distance], [kind, kind, null]);
  }
});

test("a verdict without an edge is not written over the robot", () => {
  const scene = new_scene();
  fold_frame(scene, decoded({ tick: 1, layers: [verdict] }));
  const layer = scene.layers.get("ground.verdict")!;
  assert.deepEqual(texts(layer, scene.frame!.pose).map((t) => t.text), ["step up 1.3 cm"]);
  assert.deepEqual(texts(layer, { x: 2.25, y: 0, heading: 1 }), []);
});

test("the card reads the free turn rates with the commanded one, and the predicted stand", () => {
  const scene = new_scene();
  scene.top = { v: 1, omega: 2 };
  fold_frame(scene, decoded({
    tick: 1, command: [0.5, 0.25],
    measures: [["turnover.w_min", "rad/s", -0.5], ["turnover.w_max", "rad/s", 0.75], ["turnover.roll_predicted", "rad", 0.125], ["turnover.pitch_predicted", "rad", 0], ["turnover.margin", "rad", NaN]],
  }));
  assert.deepEqual(turn_band(scene), { min: -0.5, max: 0.75, commanded: 0.25, top: 2 });
  assert.deepEqual(predicted_stand(scene), { roll: 0.125, pitch: 0, margin: null });
  fold_frame(scene, decoded({ tick: 2, measures: [["turnover.w_min", "rad/s", -Infinity], ["turnover.w_max", "rad/s", 1]] }));
  assert.deepEqual(turn_band(scene), { min: -2, max: 1, commanded: 0, top: 2 }, "a bound beyond the robot's own is none");
  fold_frame(scene, decoded({ tick: 3 }));
  assert.deepEqual([turn_band(scene), predicted_stand(scene)], [null, null]);
});

test("the laser line is read across the way, from left to right in the robot's frame", () => {
  const scene = new_scene();
  const line = { name: "terrain.line", kind: wire.LayerKind.Points, axes: 3, values: [0.5, 1, 0.25, -0.5, 1, 0] };
  fold_frame(scene, decoded({ tick: 1, pose: [0, 0, Math.PI / 2], layers: [line] }));
  const found = line_across(scene)!;
  near(found.ahead, 1, 1e-6);
  assert.deepEqual([found.slope, found.roll], [null, null]);
  // Heading along y: x = -0.5 of the world is 0.5 m to the left.
  found.points.forEach((p, i) => {
    near(p.y, [0.5, -0.5][i], 1e-6);
    near(p.z, [0, 0.25][i], 1e-6);
  });
});

test("a robot that turns over or falls is a mark of the timeline, once", () => {
  const truth: FrameSpec["truth"] = [0, 0, 0, 1, false];
  for (const [ends, label] of [["overturned", "Turned over"], ["fallen", "Fell"]] as const) {
    const log = new EventLog();
    log.push(decoded({ tick: 1, truth }));
    for (const tick of [2, 3]) log.push(decoded({ tick, truth, ends }));
    assert.deepEqual(log.list.map((e) => [e.label, e.kind]), [[label, "bad"]]);
  }
});

test("overturned and fallen are results in words", () => {
  assert.deepEqual(["overturned", "fallen"].map((r) => result_word(r)), [{ word: "Turned over", tone: "bad" }, { word: "Fallen", tone: "bad" }]);
});

test("names, outlines and kinds", () => {
  const made: Obstacle[] = [new_ground("ramp", { x: 0, y: 0, heading: 0 }), new_ground("trench", { x: 0, y: 0, heading: 0 })];
  assert.deepEqual(made.map(obstacle_name), ["Ramp", "Trench"]);
  assert.ok(made.every((o) => is_ground(o) && outline(o).length === 4));
  assert.ok(!is_ground(new_box(0, 0, 1, 1)));
});
