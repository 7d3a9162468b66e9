// tests/web/edit.test.ts: gestures to requests, undo and redo, the view's transform, words.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RequestJson } from "../../web/src/contract";
import { View } from "../../web/src/draw/view";
import { add_edit, move_edit, new_box, new_cylinder, remove_edit, set_goal_edit } from "../../web/src/edit/edits";
import { GestureTarget, Gestures, Tool } from "../../web/src/edit/gestures";
import { EditHistory } from "../../web/src/edit/history";
import { wrap_angle } from "../../web/src/geometry";
import { covers, obstacle_from_json, obstacle_to_json, outline } from "../../web/src/obstacle";
import { new_scene } from "../../web/src/state/scene";
import { clock, fixed, link_words, run_word, state_word, titled } from "../../web/src/words";

/** 100 px/m, world origin in the middle of 800 x 600: (x, y) m is at (400 + 100 x, 300 - 100 y). */
function hands(tool: Tool, editable = true) {
  const done: string[] = [];
  const view = new View();
  Object.assign(view, { width: 800, height: 600, scale: 100, x: 0, y: 0 });
  const scene = new_scene();
  scene.obstacles = [{ ...new_cylinder(2, 1, 0.3), id: 4 }];
  const target: GestureTarget = {
    scene, view, tool: () => tool, can_edit: () => editable,
    set_goal: (g) => done.push(`goal ${g.x} ${g.y} ${g.heading === null ? "any" : g.heading.toFixed(3)}`),
    add_goal: (g) => done.push(`then ${g.x} ${g.y}`),
    add: (o) => done.push(`add ${o.kind} ${o.pose.x} ${o.pose.y} ${o.radius || `${o.length}x${o.width}`}`),
    move: (id, pose, _, last) => done.push(`${last ? "moved" : "moving"} ${id} ${pose.x} ${pose.y}`),
    select: (s) => done.push(`select ${s?.kind ?? "nothing"}`), draft: () => undefined, hover: () => undefined,
    changed: () => undefined,
  };
  const gestures = new Gestures(target);
  const drag = (from: [number, number], to: [number, number], button = 0) => {
    gestures.down(1, { x: from[0], y: from[1] }, button);
    gestures.move(1, { x: to[0], y: to[1] });
    gestures.up(1, { x: to[0], y: to[1] });
  };
  return { done, view, gestures, drag, scene };
}

test("a goal: pressed where, dragged for the heading; a click leaves the heading open", () => {
  const { done, drag } = hands("goal");
  drag([500, 200], [500, 150]); // (1, 1) m, dragged up: pi / 2
  drag([500, 200], [502, 201]);
  assert.deepEqual(done, ["select goal", "goal 1 1 1.571", "select goal", "goal 1 1 any"]);
});

test("with Shift a goal is added, also where one is already", () => {
  const { done, gestures, scene } = hands("goal");
  scene.goal = { x: 1, y: 1, heading: null };
  gestures.down(1, { x: 500, y: 200 }, 0, true);
  gestures.up(1, { x: 500, y: 200 });
  assert.deepEqual(done, ["then 1 1"]);
});

test("a cylinder: a click makes one of default size, a drag one as large as drawn", () => {
  const { done, drag } = hands("cylinder");
  drag([300, 300], [301, 300]);
  drag([300, 300], [350, 300]);
  assert.deepEqual(done, ["add cylinder -1 0 0.3", "add cylinder -1 0 0.5"]);
});

test("a box is drawn from its middle", () => {
  const { done, drag } = hands("box");
  drag([300, 300], [340, 280]); // 0.4 m and 0.2 m from the middle
  assert.deepEqual(done, ["add box -1 0 0.8x0.4"]);
});

test("an obstacle is dragged with any tool except measure, by the point that was gripped", () => {
  const { done, drag } = hands("goal");
  drag([610, 200], [710, 200]); // gripped 0.1 m right of its middle at (2, 1)
  assert.deepEqual(done, ["select obstacle", "moving 4 3 1", "moved 4 3 1"]);
  const measuring = hands("measure");
  measuring.drag([610, 200], [710, 200]);
  assert.deepEqual(measuring.done, []);
});

test("a press on an obstacle without a drag only selects it", () => {
  const { done, drag } = hands("cylinder");
  drag([600, 200], [602, 201]);
  assert.deepEqual(done, ["select obstacle"]);
});

test("escape puts a dragged obstacle back", () => {
  const { done, gestures } = hands("goal");
  gestures.down(1, { x: 600, y: 200 }, 0);
  gestures.move(1, { x: 700, y: 200 });
  gestures.cancel();
  gestures.up(1, { x: 700, y: 200 });
  assert.deepEqual(done, ["select obstacle", "moving 4 3 1", "moved 4 2 1"]);
});

test("an obstacle that cannot be moved is only selected", () => {
  const { done, drag } = hands("goal", false);
  drag([600, 200], [700, 200]);
  assert.deepEqual(done, ["select obstacle"]);
});

test("at rest a drag moves the view, a press shows the object, and no request is sent", () => {
  const { done, view, drag, scene } = hands("pan");
  scene.goal = { x: 1, y: 1, heading: null };
  drag([100, 100], [102, 101]); // a tap on nothing
  drag([600, 200], [602, 201]); // on the obstacle
  drag([500, 200], [501, 200]); // on the goal
  assert.deepEqual(done, ["select nothing", "select obstacle", "select goal"]);
  assert.ok(view.fitted, "a press leaves the view as it is");
  drag([600, 200], [700, 200]); // from the obstacle: it stays
  drag([500, 200], [300, 200]); // and so does the goal
  assert.equal(done.length, 3);
  assert.equal(view.fitted, false);
});

test("the right button pans and sends no request", () => {
  const { done, view, drag } = hands("goal");
  drag([400, 300], [500, 250], 2); // the world goes right and up, so the middle goes left and down
  assert.deepEqual(done, []);
  assert.ok(Math.abs(view.x + 1) < 1e-9 && Math.abs(view.y + 0.5) < 1e-9);
  assert.equal(view.fitted, false);
});

test("two fingers pan and zoom, and the first one draws nothing", () => {
  const { done, view, gestures } = hands("goal");
  gestures.down(1, { x: 300, y: 300 }, 0);
  gestures.down(2, { x: 500, y: 300 }, 0);
  gestures.move(1, { x: 200, y: 300 });
  gestures.move(2, { x: 600, y: 300 }); // twice as far apart
  gestures.up(1, { x: 200, y: 300 });
  gestures.up(2, { x: 600, y: 300 });
  assert.deepEqual(done, []);
  assert.ok(Math.abs(view.scale - 200) < 1e-6, `scale ${view.scale}`);
});

test("zooming keeps the point under the cursor", () => {
  const { view } = hands("goal");
  const before = view.to_world(650, 120);
  view.zoom_at(650, 120, 1.7);
  const after = view.to_world(650, 120);
  assert.ok(Math.abs(before.x - after.x) < 1e-9 && Math.abs(before.y - after.y) < 1e-9);
});

test("a fitted world lies inside the area left by the cards", () => {
  const view = new View();
  Object.assign(view, { width: 1000, height: 700 });
  const insets = { left: 80, top: 70, right: 24, bottom: 130 };
  const bounds = { min_x: -0.5, min_y: -1, max_x: 5.5, max_y: 5 };
  Object.assign(view, view.fit_target(bounds, insets));
  for (const [x, y] of [[-0.5, -1], [5.5, 5]]) {
    const p = view.to_screen({ x, y });
    assert.ok(p.x >= 80 - 1e-6 && p.x <= 976 + 1e-6, `x ${p.x}`);
    assert.ok(p.y >= 70 - 1e-6 && p.y <= 570 + 1e-6, `y ${p.y}`);
  }
});

/** A server that numbers added obstacles and remembers what stands where. */
function world() {
  const standing = new Map<number, number>();
  let next = 10;
  let refuse = false;
  const history = new EditHistory(async (r: RequestJson) => {
    if (refuse) throw new Error("Not now.");
    if (r.type === "add_obstacle") {
      standing.set(++next, r.obstacle.x ?? 0);
      return { id: next };
    }
    if (r.type === "remove_obstacle" && !standing.delete(r.id)) throw new Error(`no obstacle ${r.id}`);
    if (r.type === "move_obstacle") {
      if (!standing.has(r.id)) throw new Error(`no obstacle ${r.id}`);
      standing.set(r.id, r.x);
    }
    return {};
  });
  return { standing, history, set_refuse: (v: boolean) => (refuse = v) };
}

test("undo and redo reach an obstacle that was restored with another id", async () => {
  const { standing, history } = world();
  const { id } = await history.perform(add_edit(new_cylinder(1, 0, 0.3)));
  assert.equal(id, 11);
  await history.perform(move_edit(11, { x: 1, y: 0, heading: 0 }, { x: 2, y: 0, heading: 0 }));
  await history.perform(remove_edit({ ...new_cylinder(2, 0, 0.3), id: 11 }));
  assert.equal(standing.size, 0);
  await history.undo(); // comes back as 12
  assert.deepEqual([...standing], [[12, 2]]);
  await history.undo(); // its move is undone although it was a move of 11
  assert.deepEqual([...standing], [[12, 1]]);
  await history.undo(); // and its adding
  assert.equal(standing.size, 0);
  await history.redo();
  await history.redo();
  assert.deepEqual([...standing], [[13, 2]]);
  await history.redo();
  assert.equal(standing.size, 0);
  assert.equal(history.can_redo, null);
});

test("undo and redo pressed faster than the server answers run in order", async () => {
  const { standing, history } = world();
  const presses = [history.perform(add_edit(new_cylinder(1, 0, 0.3))), history.undo(), history.redo(), history.undo(),
    history.redo()];
  await Promise.all(presses);
  assert.equal(standing.size, 1);
  assert.equal(history.can_redo, null);
});

test("a refused edit is not kept; a refused undo can be tried again", async () => {
  const { history, set_refuse } = world();
  set_refuse(true);
  await assert.rejects(history.perform(add_edit(new_box(0, 0, 1, 1))), /Not now/);
  assert.equal(history.can_undo, null);
  set_refuse(false);
  await history.perform(add_edit(new_box(0, 0, 1, 1)));
  set_refuse(true);
  await assert.rejects(history.undo(), /Not now/);
  assert.equal(history.can_undo, "Add obstacle");
});

test("a goal edit is undone to no goal, or to the earlier goal with its heading", () => {
  assert.deepEqual(set_goal_edit(null, { x: 1, y: 2, heading: null }).backward, { type: "clear_goal" });
  assert.deepEqual(set_goal_edit({ x: 0, y: 0, heading: 1 }, null).backward, { type: "set_goal", x: 0, y: 0, heading: 1 });
});

test("obstacles survive conversion to JSON and back", () => {
  for (const json of [
    { type: "cylinder", x: 1, y: 2, radius: 0.3, height: 0.5 },
    { type: "box", x: 1, y: 1, heading: 0.5, length: 0.6, width: 0.4 },
    { type: "polygon", points: [[3.1, 3.5], [3.7, 3.5], [3.7, 4.1]] },
    { type: "wall", from: [0, 2], to: [4, 2], thickness: 0.1, reflectivity: 0.9 },
  ] as const) {
    const back = obstacle_to_json(obstacle_from_json(json as never)) as Record<string, unknown>;
    for (const [key, value] of Object.entries(json)) {
      const near = JSON.stringify(back[key], (_, v) => (typeof v === "number" ? Math.round(v * 1e9) / 1e9 : v));
      assert.equal(near, JSON.stringify(value), key);
    }
  }
});

test("a polygon is held by its middle and moves as one piece", () => {
  const o = obstacle_from_json({ type: "polygon", points: [[0, 0], [3, 0], [0, 3]] });
  assert.deepEqual([o.pose.x, o.pose.y], [1, 1]);
  const moved = outline({ ...o, pose: { x: 2, y: 1, heading: 0 } });
  assert.deepEqual(moved.map((p) => [p.x, p.y]), [[1, 0], [4, 0], [1, 3]]);
});

test("a pointer hits a turned box within its slack", () => {
  const box = { ...new_box(0, 0, 2, 1, Math.PI / 2), id: 1 }; // 1 wide along x, 2 along y
  assert.ok(covers(box, { x: 0.45, y: 0.95 }, 0));
  assert.ok(!covers(box, { x: 0.55, y: 0 }, 0));
  assert.ok(covers(box, { x: 0.55, y: 0 }, 0.1));
});

test("angles wrap to (-pi, pi]", () => {
  assert.equal(wrap_angle(Math.PI), Math.PI);
  assert.equal(wrap_angle(-Math.PI), Math.PI);
  assert.ok(Math.abs(wrap_angle(7) - (7 - 2 * Math.PI)) < 1e-12);
});

test("numbers and states in words", () => {
  assert.equal(fixed(-0.004, 2), "0.00");
  assert.equal(fixed(-0.5, 1), "−0.5");
  assert.equal(fixed(null, 2), "–");
  assert.equal(clock(64.96), "01:05.0");
  assert.equal(clock(3725), "1:02:05");
  assert.equal(titled("case1"), "Case 1");
  assert.equal(titled("modified_c1"), "Modified c1");
  const lost = { phase: "lost" as const, retry_at: 3400, rate: 0, latency: null };
  assert.equal(link_words(lost, 1900), "Connection lost. Trying again in 2 s.");
  assert.equal(link_words({ phase: "open", retry_at: 0, rate: 38, latency: 12.4 }, 0), "Connected · 38 frames/s · 12 ms");
  assert.deepEqual(run_word("finished", "stuck"), { word: "Stuck", tone: "warn" });
  assert.equal(run_word("recording", "running").word, "Recording");
  assert.equal(run_word("recording", "reached").word, "Reached");
  assert.deepEqual(run_word("interrupted", "running"), { word: "Interrupted", tone: "muted" });
  assert.equal(state_word(null, null, false).word, "No link");
});
