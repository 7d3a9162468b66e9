// tests/web/clock.test.ts: the server's clock, measured over a link with delays.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ServerClock } from "../../web/src/link/clock";

const near = (a: number | null, b: number) => assert.ok(a !== null && Math.abs(a - b) < 1e-9, `${a} is not ${b}`);

test("before the first answer nothing is known", () => {
  const clock = new ServerClock();
  assert.equal(clock.server_time(3), null);
  assert.equal(clock.round_trip, null);
});

test("the shortest way tells the clocks' difference", () => {
  const clock = new ServerClock();
  clock.take(10, 10.5, 1010.45); // 0.45 s there, 0.05 s back
  clock.take(11, 11.1, 1011.05);
  clock.take(12, 12.9, 1012.1);
  near(clock.server_time(20), 1020);
});

test("the round trip is the median of the last five", () => {
  const clock = new ServerClock();
  for (const way of [9, 9, 0.1, 0.3, 0.2, 5, 0.2]) clock.take(0, way, way / 2);
  near(clock.round_trip, 0.2);
});

test("answers without sense are left out, and another server begins anew", () => {
  const clock = new ServerClock();
  clock.take(2, 1, 5);
  clock.take(1, 2, NaN);
  assert.equal(clock.round_trip, null);
  clock.take(1, 2, 5);
  clock.clear();
  assert.equal(clock.server_time(0), null);
});
