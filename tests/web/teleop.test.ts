// tests/web/teleop.test.ts: the operator's seat: its sources, its dead man, and the gamepad's axes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Legends } from "../../web/src/link/legend";
import { decode_frame } from "../../web/src/link/frame";
import { driven_words, speed_reason, turn_reason } from "../../web/src/teleop/reasons";
import { force_of, full_stick, ring_sectors, wall_of, way_of } from "../../web/src/state/driven";
import { fold_frame, new_scene, show_frame } from "../../web/src/state/scene";
import { Pad, PadEar, PadMap, curved, find_pad, fits, is_map, read_maps, read_pad } from "../../web/src/teleop/pads";
import { push_words } from "../../web/src/teleop/drawn_stick";
import { OperatorLink } from "../../web/src/teleop/operator_link";
import { Seat } from "../../web/src/teleop/seat";
import * as wire from "../../web/src/wire/telemetry_generated";
import { frame_bytes, push_stick } from "./wire";

function pad(axes: number[], pressed: number[] = [], mapping = "standard", buttons = 17): Pad {
  const all = Array.from({ length: buttons }, (_, i) => ({ pressed: pressed.includes(i), value: pressed.includes(i) ? 1 : 0 }));
  return { id: "a pad", mapping, axes, buttons: all };
}

test("keys add up, and opposite ones cancel", () => {
  const seat = new Seat();
  assert.ok(seat.key("KeyW", true));
  assert.ok(seat.key("ArrowLeft", true));
  assert.ok(!seat.key("KeyQ", true));
  assert.deepEqual(seat.next(), { forward: 1, turn: 1 });
  seat.key("KeyS", true);
  assert.deepEqual(seat.next(), { forward: 0, turn: 1 });
});

test("letting go sends the middle a few times, then nothing", () => {
  const seat = new Seat();
  assert.equal(seat.next(), null);
  seat.draw({ forward: 0.5, turn: -2 });
  assert.deepEqual(seat.next(), { forward: 0.5, turn: -1 });
  seat.draw(null);
  for (let i = 0; i < 3; ++i) assert.deepEqual(seat.next(), { forward: 0, turn: 0 });
  assert.equal(seat.next(), null);
});

test("after a loss nothing moves until every source has been in the middle", () => {
  const seat = new Seat();
  seat.pad({ forward: 1, turn: 0 });
  assert.deepEqual(seat.next(), { forward: 1, turn: 0 });
  seat.drop();
  assert.ok(seat.barred);
  assert.equal(seat.next(), null);
  seat.pad({ forward: 0.3, turn: 0 });
  assert.equal(seat.next(), null);
  seat.pad(null);
  seat.next();
  seat.pad({ forward: 0.3, turn: 0 });
  assert.deepEqual(seat.next(), { forward: 0.3, turn: 0 });
});

test("a key that was held through a loss is forgotten", () => {
  const seat = new Seat();
  seat.key("KeyW", true);
  seat.next();
  seat.drop(); // its release is never heard
  assert.deepEqual(seat.wish, { forward: 0, turn: 0 });
  seat.next();
  assert.ok(seat.key("KeyW", true, true), "the keyboard repeats a key that is still held");
  assert.deepEqual(seat.next(), { forward: 0, turn: 0 });
  assert.equal(seat.key("KeyW", false), true);
  seat.key("KeyW", true);
  assert.deepEqual(seat.next(), { forward: 1, turn: 0 });
});

test("a gamepad drives only while a bumper is held; B is Stop; axes are negated", () => {
  assert.equal(read_pad(pad([0, -1, 0, 0])).stick, null);
  assert.deepEqual(read_pad(pad([0, -1, 0, 0], [4])).stick, { forward: 1, turn: 0 });
  assert.deepEqual(read_pad(pad([0, 0, 1, 0], [5])).stick, { forward: 0, turn: -1 });
  assert.deepEqual(read_pad(pad([0, 0, 0, 0], [4, 6])).stick, { forward: -1, turn: 0 });
  assert.deepEqual(read_pad(pad([0, -1, 0, 0], [4, 7])).stick, { forward: 1, turn: 0 }, "never above full");
  assert.ok(read_pad(pad([0, 0, 0, 0], [1])).stop);
});

const kMap: PadMap = { ahead: { axis: 3, sign: 1 }, turn: { axis: 0, sign: -1 }, run: 6, stop: 2 };

test("a gamepad without the standard mapping moves nothing until it has a map", () => {
  const strange = (pressed: number[]) => pad([-1, 0, 0, 1], pressed, "", 8);
  assert.deepEqual(read_pad(strange([1, 4])), { stick: null, stop: false, strange: true });
  assert.deepEqual(read_pad(strange([1, 4]), kMap), { stick: null, stop: false, strange: false }, "its button is not held");
  assert.deepEqual(read_pad(strange([6]), kMap).stick, { forward: 1, turn: 1 });
  assert.ok(read_pad(strange([2]), kMap).stop);
  assert.ok(read_pad(pad([-1, 0], [6], "", 8), kMap).strange, "a pad of the same id with fewer axes");
  assert.ok(!fits(kMap, pad([0, 0, 0, 0], [], "", 6)));
});

test("of several gamepads the one that may move something is heard", () => {
  const strange = pad([0], [], ""), usual = pad([0, 0, 0, 0]);
  assert.equal(find_pad(() => [null, strange, usual]), usual);
  assert.equal(find_pad(() => [strange]), strange);
  assert.equal(find_pad(() => undefined), null);
  assert.equal(find_pad(() => { throw new Error("barred by a policy"); }), null);
});

test("kept maps are read only where they are whole", () => {
  assert.ok(is_map(kMap));
  for (const wrong of [null, 7, {}, { ...kMap, run: 2 }, { ...kMap, stop: -1 }, { ...kMap, run: 1.5 },
    { ...kMap, ahead: { axis: 0, sign: 1 } }, { ...kMap, turn: { axis: 1, sign: 0 } }, { ...kMap, turn: null }]) {
    assert.ok(!is_map(wrong), JSON.stringify(wrong));
  }
  assert.deepEqual(read_maps(JSON.stringify([["a", kMap], ["b", {}], [1, kMap], "c"])), [["a", kMap]]);
  assert.deepEqual(read_maps("{}"), []);
});

/** Feeds states to `ear`, each long enough for it to see that nothing changes. */
function hears(ear: PadEar, ...states: Pad[]): void {
  for (const state of states) for (let i = 0; i < 10; ++i) ear.hear(state);
}

test("a gamepad is set up by moving it: axes, their signs, then buttons", () => {
  const ear = new PadEar();
  const state = (axes: number[], pressed: number[] = []) => pad(axes, pressed, "", 8);
  const rest = [0.05, -1, 0, 0]; // axis 1 is a lever that stays where it is put
  ear.begin("ahead");
  assert.ok(ear.waits);
  hears(ear, state(rest), state([0.05, -1, 0, -0.9]));
  assert.deepEqual(ear.map.ahead, { axis: 3, sign: -1 });
  assert.equal(ear.role, "turn");
  hears(ear, state([0.05, -1, 0, -0.9]));
  assert.equal(ear.map.turn, undefined, "a stick on its way back answers nothing");
  hears(ear, state(rest), state([0.05, 0.5, 0, 0]));
  assert.match(ear.remark, /does not rest/);
  hears(ear, state(rest), state([0.05, -1, 0, 0.9]));
  assert.match(ear.remark, /has a use/);
  hears(ear, state(rest), state([0.95, -1, 0, 0]), state(rest), state(rest, [6]), state(rest, [6]));
  assert.deepEqual([ear.map.turn, ear.map.run, ear.role], [{ axis: 0, sign: 1 }, 6, "stop"]);
  hears(ear, state(rest), state(rest, [6]));
  assert.match(ear.remark, /has a use/);
  assert.equal(ear.complete, null);
  hears(ear, state(rest), state(rest, [2]));
  assert.deepEqual(ear.complete, { ahead: { axis: 3, sign: -1 }, turn: { axis: 0, sign: 1 }, run: 6, stop: 2 });
  assert.equal(ear.role, null);
  ear.begin("run");
  assert.equal(ear.complete, null, "until it is answered anew");
  hears(ear, state(rest, [1]));
  assert.equal(ear.map.run, undefined, "a button that is held from before answers nothing");
  hears(ear, state(rest), state(rest, [1]));
  assert.equal(ear.complete!.run, 1);
});

test("an axis rests in its dead zone, is monotonic, and reaches full", () => {
  assert.equal(curved(0.11), 0);
  assert.ok(Math.abs(curved(1) - 1) < 1e-12);
  assert.equal(curved(NaN), 0);
  let last = 0;
  for (let x = 0; x <= 1; x += 0.01) {
    assert.ok(curved(x) >= last && Math.abs(curved(-x) + curved(x)) < 1e-12);
    last = curved(x);
  }
});

const kMeasures: [string, string, number][] = [["teleop.v_sprs", "m/s", 0.25], ["teleop.nearest", "m", 0.75],
  ["teleop.force_forward", "", -0.5], ["teleop.force_left", "", 0.25]];
const kWallBeside: [string, string, number][] = [["teleop.wall_rho", "m", 0.75], ["teleop.wall_theta", "rad", -1.25],
  ["teleop.w_d", "rad/s", 0.2]];

/** Of a robot that looks along y. */
function driven_scene(more: object = {}, measures = kMeasures) {
  const scene = new_scene();
  scene.top = { v: 0.5, omega: 1 };
  scene.parameters = { "teleop.d_max": 3, "teleop.v_max": 0.8, "teleop.w_max": 0.8 };
  const ranges = [3, 0.75, 3, 2, 2, 3, 3, 3]; // from right to left
  const arrows = ranges.flatMap((r, n) => {
    const bearing = Math.PI / 2 + (n / 7 - 0.5) * Math.PI + (n === 1 ? 0.2 : 0); // in W, and aside of its axis
    return [1, 2, r * Math.cos(bearing), r * Math.sin(bearing)];
  });
  const layers = [{ name: "teleop.ring", kind: wire.LayerKind.Arrows, values: arrows },
    { name: "teleop.wall", kind: wire.LayerKind.Polyline, values: [1, 2, 3, 4] }];
  fold_frame(scene, decode_frame(frame_bytes({
    tick: 1, behaviour: "manual", pose: [1, 2, Math.PI / 2], twist: [0.1, 0], command: [0.2, 0.2], words: ["a", "b"], layers, measures,
    requests: [push_stick(0.8, -0.25, 1)], ...more,
  }), new Legends()));
  return scene;
}

test("a frame brings its stick, which holds while somebody drives", () => {
  const scene = driven_scene();
  assert.deepEqual(scene.stick, { forward: 0.8, turn: -0.25, mode: "wall" });
  assert.equal(scene.frame!.requests.length, 0, "edits and events do not see the stick");
  const next = (tick: number, behaviour: string) =>
    show_frame(scene, decode_frame(frame_bytes({ tick, behaviour }), new Legends()));
  next(2, "manual");
  assert.equal(scene.stick?.forward, 0.8);
  next(3, "rest");
  assert.equal(scene.stick, null);
});

test("full stick asks for the robot's limit or the parameter, whichever is lower", () => {
  assert.deepEqual(full_stick(driven_scene()), { v: 0.5, omega: 0.8 });
  assert.deepEqual(full_stick(new_scene()), { v: 1, omega: 1 });
});

test("a hand is cut off when its socket stays full, not when the page stood still", (t) => {
  let now = 0;
  t.mock.method(performance, "now", () => now);
  const socket = { is_open: true, is_clear: true, call: async <T,>() => ({ now: now / 1000 }) as T };
  const link = new OperatorLink(socket);
  const beat = (after: number, is_clear: boolean) => {
    now += after;
    socket.is_clear = is_clear;
    return link.beat();
  };
  for (let i = 0; i < 30; ++i) assert.ok(beat(50, true));
  assert.ok(link.takes_sticks);
  assert.ok(beat(3000, false), "the picture took three seconds to draw");
  assert.ok(!link.takes_sticks, "a stick would wait behind the rest");
  assert.ok(beat(50, true));
  for (let i = 0; i < 9; ++i) assert.ok(beat(50, false));
  assert.ok(!beat(50, false), "full for half a second");
  assert.ok(beat(50, true));
  socket.is_open = false;
  assert.ok(!beat(50, false));
});

test("the ring's sectors lie about their axes; the nearest one slows the robot", () => {
  const sectors = ring_sectors(driven_scene({ limit: "obstacle_ahead" }));
  assert.equal(sectors.length, 8);
  sectors.forEach((s, n) => {
    const axis = Math.PI / 2 + (n / 7 - 0.5) * Math.PI;
    assert.ok(Math.abs(Math.sin(s.bearing - axis)) < 1e-6, `sector ${n} at ${s.bearing}`);
    assert.equal(s.echo, [1, 3, 4].includes(n));
    assert.equal(s.limits, n === 1);
  });
  const fewer = driven_scene();
  const ring = fewer.layers.get("teleop.ring")!;
  ring.values = ring.values.filter((_, i) => i >= 12); // the three on the right are silent
  assert.deepEqual(ring_sectors(fewer).map((s) => s.bearing), sectors.slice(3).map((s) => s.bearing));
  assert.ok(ring_sectors(driven_scene()).every((s) => !s.limits), "nothing is slowed");
});

test("the words of a wall lie along it, ahead", () => {
  const wall = wall_of(driven_scene({}, [...kMeasures, ...kWallBeside]))!;
  const [x, y] = [wall.words.x - 1, wall.words.y - 2]; // the robot looks along y: ahead is y, right is x
  assert.ok(y > 0.5 && x > 0, `${x} ${y}`);
  // On the wall's line: x cos + y sin = rho in R, where x_R = y and y_R = -x.
  assert.ok(Math.abs(y * Math.cos(-1.25) - x * Math.sin(-1.25) - 0.75) < 1e-3);
  assert.equal(wall_of(driven_scene()), null);
});

test("ways ahead are arcs", () => {
  const straight = way_of({ x: 0, y: 0, heading: 0 }, 0.5, 0).at(-1)!;
  assert.ok(Math.abs(straight.x - 1.5) < 1e-9 && straight.y === 0);
  const circle = way_of({ x: 0, y: 0, heading: 0 }, 1, (2 * Math.PI) / 3).at(-1)!; // once round in 3 s
  assert.ok(Math.hypot(circle.x, circle.y) < 1e-9);
});

test("each limit has its reason with numbers, and a robot that only starts has none", () => {
  const at = (limit: string, measures = kMeasures) => driven_scene({ limit }, measures);
  assert.match(speed_reason(at("crowded"), 0.4).tail, /room for 0\.25 m\/s/);
  const ahead = speed_reason(at("obstacle_ahead"), 0.4);
  assert.match(`${ahead.head} ${ahead.tail}`, /0\.75 m: 50 % of it \(Eq\. 4\)/);
  assert.match(speed_reason(at("guard"), 0.4).tail, /50 %/);
  assert.equal(speed_reason(at(""), 0.4).head, "");
  assert.equal(speed_reason(at("guard"), 0.2).head, "", "it has what it wants");
  assert.equal(speed_reason(driven_scene({ behaviour: "avoid" }), 0.4).tail, "", "nobody drives");
  const wall = turn_reason(at("wall", [...kMeasures, ...kWallBeside]), -0.2);
  assert.equal(`${wall.head} ${wall.tail}`, "Wall on the right turns it left (Eq. 8)");
  assert.match(driven_words(at("wall", [...kMeasures, ...kWallBeside])).why, /nose 18° towards it: turning left 11\.5 °\/s/);
  assert.equal(driven_words(at("")).what, "The robot follows your stick");
});

test("a limit of the ground names what lies ahead", () => {
  const trench: typeof kMeasures = [["ground.class", "", 4]];
  const slow = driven_words(driven_scene({ limit: "ground" }, trench));
  assert.deepEqual([slow.what, slow.why], ["Slower for the ground ahead", "Trench."]);
  const stands = driven_words(driven_scene({ limit: "ground", command: [0, 0] }, trench));
  assert.equal(stands.what, "Stopped before the ground ahead");
  assert.equal(driven_words(driven_scene({ limit: "turnover_ahead" })).what, "Stopped before a slope");
});

test("the reflected force in numbers and words", () => {
  const force = force_of(driven_scene());
  assert.ok(Math.abs(force.forward + 0.5) < 1e-3 && Math.abs(force.left - 0.25) < 1e-3);
  assert.equal(push_words(force), "Pushes back 50 %, left 25 %");
  assert.equal(push_words({ forward: 0.01, left: 0 }), "");
});
