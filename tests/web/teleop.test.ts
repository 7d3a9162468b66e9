// tests/web/teleop.test.ts: the operator's seat: its sources, its dead man, and the gamepad's axes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Pad, Seat, curved, read_pad } from "../../web/src/teleop/seat";

function pad(axes: number[], pressed: number[] = [], mapping = "standard"): Pad {
  const buttons = Array.from({ length: 17 }, (_, i) => ({ pressed: pressed.includes(i), value: pressed.includes(i) ? 1 : 0 }));
  return { mapping, axes, buttons };
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

test("a gamepad without the standard mapping moves nothing", () => {
  const wish = read_pad(pad([0, -1, 0, 0], [1, 4], ""));
  assert.deepEqual(wish, { stick: null, stop: false, strange: true });
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
