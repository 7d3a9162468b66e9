// tests/web/layout.test.ts: the picture that rests, addresses, toasts.
import assert from "node:assert/strict";
import { test } from "node:test";
import { View } from "../../web/src/draw/view";
import { parse_route } from "../../web/src/link/route";
import { Toast, with_toast } from "../../web/src/state/toasts";

test("a scene of another size shows each place where it was on the screen", () => {
  const view = new View();
  Object.assign(view, { width: 800, height: 600, scale: 100, x: 1, y: 2, target: { x: 1, y: 2, scale: 50 } });
  const before = view.to_screen({ x: 3, y: -1 });
  view.resize(700, 420, 30, -12); // its corner went 30 px to the right and 12 px up
  const after = view.to_screen({ x: 3, y: -1 });
  assert.ok(Math.abs(after.x + 30 - before.x) < 1e-9 && Math.abs(after.y - 12 - before.y) < 1e-9);
  // The place that it is still going to moves alike, by its own scale.
  assert.ok(Math.abs(view.target!.x - (1 - 20 / 50)) < 1e-9);
  assert.ok(Math.abs(view.target!.y - (2 + 102 / 50)) < 1e-9);
});

test("a given camera keeps its middle beside cards that come later, until a hand moves it", () => {
  const view = new View();
  Object.assign(view, { width: 800, height: 600 });
  view.show({ x: 1, y: 2, scale: 50 });
  view.resize(400, 300, 10, 0);
  assert.deepEqual(view.camera, { x: 1, y: 2, scale: 50 });
  view.pan(0, 0);
  view.resize(500, 300, 0, 0);
  assert.equal(view.x, 2);
});

test("a view knows whether it shows all of a world; a fit is asked for once", () => {
  const view = new View();
  Object.assign(view, { width: 400, height: 400, scale: 100, x: 0, y: 0 });
  const none = { left: 0, top: 0, right: 0, bottom: 0 };
  const all = { min_x: -2, max_x: 2, min_y: -2, max_y: 2 };
  assert.ok(view.shows(all, none));
  assert.ok(!view.shows(all, { ...none, bottom: 1 }), "a card covers it");
  assert.ok(!view.shows({ ...all, max_x: 2.1 }, none));
  assert.ok(!view.shows({ ...all, min_y: -2.1 }, none));
  view.target = { x: 0, y: 0, scale: 1 };
  view.pan(5, 5);
  assert.equal(view.fitted, false);
  view.fit();
  assert.deepEqual([view.fitted, view.target], [true, null]);
});

test("an address names a view, a run, or nothing", () => {
  const place = (hash: string) => [parse_route(hash).view, parse_route(hash).run];
  assert.deepEqual(place(""), ["drive", null]);
  assert.deepEqual(place("#/drive"), ["drive", null]);
  assert.deepEqual(place("#/runs/7"), ["runs", 7]);
  assert.deepEqual(place("#/runs/7?t=3.5"), ["runs", 7]);
  for (const hash of ["#/nonsense", "#/runs/seven", "#/runs/-1", "#/constructor"]) {
    assert.equal(parse_route(hash).view, "nowhere", hash);
  }
});

test("equal toasts are counted, and at most two are shown", () => {
  let toasts: Toast[] = [];
  const say = (id: number, text: string) => (toasts = with_toast(toasts, { id, tone: "warn", text }));
  say(1, "Obstacle 11 would overlap the robot: 0.65 m too close.");
  say(2, "Obstacle 12 would overlap the robot: 0.6 m too close.");
  assert.deepEqual(toasts.map((t) => [t.id, t.count]), [[2, 2]]);
  say(3, "A goal needs both x and y.");
  say(4, "Not now.");
  assert.deepEqual(toasts.map((t) => t.id), [3, 4]);
});
