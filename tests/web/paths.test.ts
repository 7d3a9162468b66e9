// tests/web/paths.test.ts: obstacles that move by themselves are drawn where they are.
import assert from "node:assert/strict";
import { test } from "node:test";
import { moved_along, paths_of, place_on } from "../../web/src/state/paths";
import { obstacle_from_json, ObstacleJson } from "../../web/src/obstacle";

const post: ObstacleJson = { type: "cylinder", x: 2, y: 0, radius: 0.3,
  path: { period: 4, keys: [[0, 2, 0], [1, 3, 0], [4, 3, 3]] } };

test("a path is linear between keys and jumps back", () => {
  const [path] = paths_of([{ type: "cylinder", x: 0, y: 0, radius: 1 }, post]);
  assert.equal(path.id, 2);
  assert.deepEqual(place_on(path, 0.5), { x: 2.5, y: 0 });
  assert.deepEqual(place_on(path, 2.5), { x: 3, y: 1.5 });
  assert.deepEqual(place_on(path, 8.5), { x: 2.5, y: 0 });
  assert.deepEqual(place_on({ ...path, phase: 0.5 }, 0), { x: 2.5, y: 0 });
});

test("only what has a path moves", () => {
  const still = obstacle_from_json({ id: 1, type: "cylinder", x: 0, y: 0, radius: 1 });
  const moving = obstacle_from_json({ ...post, id: 2 });
  const [a, b] = moved_along([still, moving], paths_of([{ ...post, id: 2 }]), 1);
  assert.equal(a, still);
  assert.equal(b.pose.x, 3);
});
