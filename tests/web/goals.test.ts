// tests/web/goals.test.ts: the goals of a stored run, reached and ahead.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Frame } from "../../web/src/link/frame";
import { first_route, rerouted, route_at } from "../../web/src/state/goals";

test("the goals of a stored run come from its scenario, its requests and the goals that a frame has ahead", () => {
  const at = (x: number) => ({ x, y: 0, heading: null });
  let route = first_route({ name: "w", goal: { x: 1, y: 0 }, waypoints: [{ x: 2, y: 0 }], loop: true });
  assert.deepEqual(route, { goals: [at(1), at(2)], next: 0, loop: true });
  const frame = (goal: number | null, ahead: number) =>
    ({ goal: goal === null ? null : at(goal), goals_ahead: Array.from({ length: ahead }, () => at(9)) }) as unknown as Frame;
  assert.equal(route_at(route, frame(1, 1)).next, 0);
  assert.equal(route_at(route, frame(2, 0)).next, 1);
  route = rerouted(route, { type: "add_goal", goal: at(3) });
  assert.deepEqual(route.goals.map((g) => g.x), [1, 2, 3]);
  assert.equal(rerouted(route, { type: "stop", engaged: true }), route);
  route = rerouted(route, { type: "set_goal", goals: [at(5)], next: 0, loop: false });
  assert.deepEqual(route, { goals: [at(5)], next: 0, loop: false });
  route = rerouted(route, { type: "clear_goal" });
  assert.deepEqual(route_at(route, frame(null, 0)), { goals: [], next: 0, loop: false });
});
