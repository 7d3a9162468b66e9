// tests/web/edit.test.ts: gestures to requests, undo and redo, the view's transform, words.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Selection } from "../../web/src/draw/scene";
import { View } from "../../web/src/draw/view";
import { sketched } from "../../web/src/edit/drawn";
import {
  Step, add_edit, corners_of, move_edit, new_box, new_cylinder, new_wall, new_walker, polygon_defect, remove_edit,
  reordered, route_edit, speed_of, without_goal,
} from "../../web/src/edit/edits";
import { handles_of } from "../../web/src/edit/handles";
import { snapped } from "../../web/src/edit/snap";
import { change_since } from "../../web/src/edit/stands";
import { GestureTarget, Gestures, Tool } from "../../web/src/edit/gestures";
import { EditHistory } from "../../web/src/edit/history";
import { NoAnswer } from "../../web/src/link/no_answer";
import { wrap_angle } from "../../web/src/geometry";
import { covers, obstacle_from_json, obstacle_to_json, outline } from "../../web/src/obstacle";
import { new_scene } from "../../web/src/state/scene";
import { clock, fixed, link_words, result_word, state_word, titled } from "../../web/src/words";

/** 100 px/m, world origin in the middle of 800 x 600: (x, y) m is at (400 + 100 x, 300 - 100 y). */
function hands(tool: Tool, editable = true, selection: Selection = null) {
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
    change_goal: (i, g) => done.push(`goal ${i} ${g.x} ${g.y}`),
    set_start: (p) => done.push(`start ${p.x} ${p.y} ${p.heading.toFixed(3)}`),
    change: (label, _, to) => done.push(`${label}: ${to.radius || `${to.length.toFixed(2)}x${to.width.toFixed(2)}`}`),
    snap: (p) => ({ x: Math.round(p.x * 100) / 100, y: Math.round(p.y * 100) / 100 }), appends: () => false,
    selection: () => selection, refuse: (sentence) => done.push(sentence),
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

test("a second finger puts a dragged obstacle back", () => {
  const { done, gestures } = hands("goal");
  gestures.down(1, { x: 600, y: 200 }, 0);
  gestures.move(1, { x: 700, y: 200 });
  gestures.down(2, { x: 300, y: 300 }, 0);
  gestures.move(1, { x: 750, y: 200 });
  gestures.up(1, { x: 750, y: 200 });
  gestures.up(2, { x: 300, y: 300 });
  assert.deepEqual(done, ["select obstacle", "moving 4 3 1", "moved 4 2 1"]);
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

test("the resting tool moves what is selected, and nothing else", () => {
  const { done, drag } = hands("pan", true, { kind: "obstacle", id: 4 });
  drag([600, 210], [700, 210]);
  assert.deepEqual(done, ["select obstacle", "moving 4 3 1", "moved 4 3 1"]);
});

test("a handle resizes the selected obstacle as one edit", () => {
  const { done, drag } = hands("pan", true, { kind: "obstacle", id: 4 });
  drag([630, 200], [650, 200]); // the handle at its right edge, 0.3 m from the middle
  assert.deepEqual(done, ["Resize cylinder: 0.5"]);
});

test("an obstacle that is drawn small is still moved by its middle", () => {
  const { done, drag, view } = hands("pan", true, { kind: "obstacle", id: 4 });
  view.scale = 10; // its radius is 3 px, and a handle reaches over 14
  drag([421, 290], [431, 290]);
  assert.deepEqual(done, ["select obstacle", "moving 4 3 1", "moved 4 3 1"]);
  done.length = 0;
  drag([426, 290], [440, 290]);
  assert.deepEqual(done, ["Resize cylinder: 2"]);
});

test("a wall is dragged, or its two ends are pressed, also on an obstacle", () => {
  const { done, drag } = hands("wall");
  drag([600, 200], [700, 200]);
  drag([400, 300], [401, 300]);
  drag([400, 200], [401, 200]);
  assert.deepEqual(done, ["add wall 2.5 1 1x0.1", "add wall 0 0.5 1x0.1"]);
});

test("a polygon is closed at its first corner, and must be convex", () => {
  const { done, drag, gestures } = hands("polygon");
  for (const [x, y] of [[400, 300], [500, 300], [500, 200], [400, 300]]) drag([x, y], [x, y]);
  assert.match(done[0], /add polygon 0.66\d* 0.33/);
  for (const [x, y] of [[400, 300], [500, 300], [420, 280], [400, 200], [400, 300]]) drag([x, y], [x, y]);
  assert.match(done[1], /convex/);
  assert.equal(gestures.sketch.length, 4, "its corners stay, to be corrected");
  gestures.cancel();
  assert.equal(gestures.sketch.length, 0);
});

test("a walking person goes there and back at the usual speed", () => {
  const { done, drag } = hands("mover");
  for (const [x, y] of [[400, 300], [480, 300], [480, 300]]) drag([x, y], [x, y]);
  assert.deepEqual(done, ["add cylinder 0 0 0.25"]);
  const walker = new_walker([{ x: 0, y: 0 }, { x: 0.8, y: 0 }], 0.25, 0.8);
  assert.deepEqual(walker.path, { period: 2, keys: [[0, 0, 0], [1, 0.8, 0], [2, 0, 0]] });
  assert.deepEqual(corners_of(walker.path!), [{ x: 0, y: 0 }, { x: 0.8, y: 0 }]);
  assert.ok(Math.abs(speed_of(walker.path!) - 0.8) < 1e-12);
  assert.deepEqual(sketched("mover", [], { x: 1, y: 1 }, 0.1), { points: [{ x: 1, y: 1 }] });
});

test("the start is pressed, and dragged for its heading", () => {
  const { done, drag } = hands("start");
  drag([500, 300], [500, 200]);
  drag([300, 300], [301, 300]);
  assert.deepEqual(done, ["start 1 0 1.571", "start -1 0 0.000"]);
});

test("one goal of several is moved by its place in the list", () => {
  const { done, drag, scene } = hands("goal");
  scene.route = { goals: [{ x: 0, y: 0, heading: null }, { x: -1, y: 0, heading: 1 }], next: 0, loop: false };
  scene.goal = scene.route.goals[0];
  drag([300, 300], [300, 200]);
  assert.deepEqual(done, ["select goal", "goal 1 -1 1"]);
});

test("each kind has handles that give another obstacle of its kind", () => {
  const wall = new_wall({ x: 0, y: 0 }, { x: 2, y: 0 }, 0.1);
  const [a, b, turn] = handles_of(wall);
  assert.deepEqual([a.at, b.at], [{ x: 0, y: 0 }, { x: 2, y: 0 }]);
  assert.equal(b.to({ x: 4, y: 0 })!.length, 4);
  assert.equal(b.to({ x: 0, y: 0 }), null, "a wall without length");
  assert.ok(Math.abs(turn.to({ x: 1, y: 5 })!.pose.heading) < 1e-12);
  const box = handles_of(new_box(0, 0, 2, 1))[2].to({ x: 3, y: 1.5 })!;
  assert.deepEqual([box.length, box.width, box.pose.x, box.pose.y], [4, 2, 1, 0.5], "the opposite corner stays");
  const walker = new_walker([{ x: 0, y: 0 }, { x: 1, y: 0 }], 0.25, 1);
  assert.deepEqual(handles_of(walker)[1].to({ x: 2, y: 0 })!.path!.keys, [[0, 0, 0], [2, 2, 0], [4, 0, 0]]);
});

test("a point is pulled to a corner, else to the grid, or to neither", () => {
  const wall = { ...new_wall({ x: 0.25, y: 0 }, { x: 2.25, y: 0 }, 0.1), id: 1 };
  assert.deepEqual(snapped({ x: 0.28, y: 0.02 }, [wall], 0.1, true), { x: 0.25, y: 0 });
  assert.deepEqual(snapped({ x: 0.53, y: 0.48 }, [wall], 0.1, true), { x: 0.5, y: 0.5 });
  assert.deepEqual(snapped({ x: 0.531, y: 0.48 }, [wall], 0.1, false), { x: 0.53, y: 0.48 });
});

test("a polygon says why it is none", () => {
  assert.match(polygon_defect([{ x: 0, y: 0 }, { x: 1, y: 0 }])!, /three corners/);
  assert.equal(polygon_defect([{ x: 0, y: 0 }, { x: 0, y: 1 }, { x: 1, y: 0 }]), null);
});

test("goals are reordered and removed, and the robot keeps its own", () => {
  const goals = [1, 2, 3].map((x) => ({ x, y: 0, heading: null }));
  const names = (r: { goals: { x: number }[]; next: number }) => [r.goals.map((g) => g.x).join(""), r.next];
  assert.deepEqual(names(reordered({ goals, next: 1, loop: true }, 0, 2)), ["231", 0]);
  assert.deepEqual(names(without_goal({ goals, next: 2, loop: false }, 0)), ["23", 1]);
  assert.deepEqual(names(without_goal({ goals, next: 2, loop: false }, 2)), ["12", 1]);
  assert.equal(without_goal({ goals: goals.slice(0, 2), next: 0, loop: true }, 0).loop, false);
  assert.deepEqual(names(without_goal({ goals: goals.slice(0, 1), next: 0, loop: false }, 0)), ["", 0]);
});

/** A server that numbers added obstacles and remembers what stands where. */
function world() {
  const standing = new Map<number, number>();
  let next = 10;
  let refuse = false;
  let changed: string | null = null;
  const send = async (r: Step) => {
    if (refuse) throw new Error("Not now.");
    if (r.type === "add_obstacle") {
      const id = r.obstacle.id || ++next;
      standing.set(id, r.obstacle.x ?? 0);
      return { id };
    }
    if (r.type === "remove_obstacle" && !standing.delete(r.id)) throw new Error(`no obstacle ${r.id}`);
    if (r.type === "move_obstacle") {
      if (!standing.has(r.id)) throw new Error(`no obstacle ${r.id}`);
      standing.set(r.id, r.x);
    }
    return {};
  };
  const history = new EditHistory({ send, stands: async () => changed, changed: () => undefined });
  return {
    standing, history, set_refuse: (v: boolean) => (refuse = v), set_changed: (v: string | null) => (changed = v),
  };
}

test("a removed obstacle comes back with its number, so that older edits reach it", async () => {
  const { standing, history } = world();
  const { id } = await history.perform(add_edit(new_cylinder(1, 0, 0.3)));
  assert.equal(id, 11);
  const here = { ...new_cylinder(2, 0, 0.3), id: 11 };
  await history.perform(move_edit(here, { x: 1, y: 0, heading: 0 }, { x: 2, y: 0, heading: 0 }));
  await history.perform(remove_edit(here));
  assert.equal(standing.size, 0);
  await history.undo();
  assert.deepEqual([...standing], [[11, 2]]);
  await history.undo();
  assert.deepEqual([...standing], [[11, 1]]);
  await history.undo();
  assert.equal(standing.size, 0);
  for (let i = 0; i < 2; ++i) await history.redo();
  assert.deepEqual([...standing], [[11, 2]]);
  await history.redo();
  assert.equal(standing.size, 0);
  assert.equal(history.can_redo, null);
});

test("a load without a way back ends the undo of what was before", async () => {
  const history = new EditHistory({ send: async () => ({ ok: true, id: 1 }), stands: async () => null, changed: () => undefined });
  await history.perform(add_edit(new_cylinder(1, 1, 0.3)));
  assert.ok(history.can_undo);
  await history.perform({ label: "Change the run", forward: { type: "load", body: {} }, backward: null });
  assert.equal(history.can_undo, null);
});

test("undo and redo pressed faster than the server answers run in order", async () => {
  const { standing, history } = world();
  const presses = [history.perform(add_edit(new_cylinder(1, 0, 0.3))), history.undo(), history.redo(), history.undo(),
    history.redo()];
  await Promise.all(presses);
  assert.equal(standing.size, 1);
  assert.equal(history.can_redo, null);
});

test("an undo that is pressed while a drag ends takes back that drag, not the edit before", async () => {
  const { standing, history } = world();
  await history.perform(add_edit(new_cylinder(1, 0, 0.3)));
  let answered = () => undefined as void;
  const answer = new Promise<void>((done) => (answered = done));
  const here = { ...new_cylinder(1, 0, 0.3), id: 11 };
  const drag = history.take(async () => {
    await answer;
    standing.set(11, 2);
    return move_edit(here, { x: 1, y: 0, heading: 0 }, { x: 2, y: 0, heading: 0 });
  });
  const undo = history.undo();
  answered();
  await Promise.all([drag, undo]);
  assert.deepEqual([...standing], [[11, 1]]);
  await history.take(async () => null); // a refused one
  assert.equal(history.can_undo, "Add cylinder");
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
  assert.equal(history.can_undo, "Add box");
});

test("an undo whose answer is late counts as done where the world shows it", async () => {
  let late = false, x = 1;
  const place = (at: number) => ({ x: at, y: 0, heading: 0 });
  const history = new EditHistory({
    send: async (step) => {
      if (step.type === "move_obstacle") x = step.x;
      if (late) throw new NoAnswer("Late.");
      return {};
    },
    stands: async (step) => (step.type === "move_obstacle" && step.x !== x ? "It has been moved since." : null),
    changed: () => undefined,
  });
  const here = { ...new_cylinder(1, 0, 0.3), id: 11 };
  await history.perform(move_edit(here, place(1), place(2)));
  await history.perform(move_edit(here, place(2), place(3)));
  late = true;
  await history.undo();
  assert.equal(x, 2);
  late = false;
  await history.undo();
  assert.equal(x, 1, "the next press takes back the edit before");
  await history.redo();
  await history.redo();
  assert.equal(x, 3);
});

test("an edit that somebody else has changed since is left, with the reason", async () => {
  const { standing, history, set_changed } = world();
  await history.perform(add_edit(new_cylinder(1, 0, 0.3)));
  set_changed("Cylinder 11 has been moved since.");
  await assert.rejects(history.undo(), /Cylinder 11 has been moved since. "Add cylinder" is left/);
  assert.equal(standing.size, 1);
  assert.equal(history.can_undo, null, "it is not ours alone any more");
});

test("changes by others are told apart from our own edits", () => {
  const scene = new_scene();
  const ours = { ...new_cylinder(1, 0, 0.3), id: 3 };
  const moved = move_edit(ours, ours.pose, { x: 2, y: 0, heading: 0 }).forward;
  scene.obstacles = [{ ...ours, pose: { x: 2, y: 0, heading: 0 } }];
  assert.equal(change_since(moved, scene), null);
  scene.obstacles = [{ ...ours, pose: { x: 5, y: 0, heading: 0 } }];
  assert.match(change_since(moved, scene)!, /Cylinder 3 has been moved since/);
  const box = { ...new_box(1, 0, 0.6, 0.4, 0), id: 4 };
  const { forward } = move_edit(box, box.pose, { x: 2, y: 0, heading: -Math.PI });
  scene.obstacles = [{ ...box, pose: { x: 2, y: 0, heading: Math.PI } }];
  assert.equal(change_since(forward, scene), null);
  scene.obstacles = [{ ...box, pose: { x: 2, y: 0, heading: 1 } }];
  assert.match(change_since(forward, scene)!, /Box 4 has been moved since/, "turned");
  const added: Step = { type: "add_obstacle", obstacle: { ...obstacle_to_json({ ...box, pose: { x: 2, y: 0, heading: 0 } }), id: 4 } };
  assert.match(change_since(added, scene)!, /Box 4 has been changed since/, "turned");
  scene.obstacles = [];
  assert.match(change_since(moved, scene)!, /removed since/);
  const list = { goals: [{ x: 1, y: 2, heading: null }], next: 0, loop: false };
  const edit = route_edit("Set goal", { goals: [], next: 0, loop: false }, list);
  assert.match(change_since(edit.forward, scene)!, /goals have been changed/);
  scene.route = { ...list, next: 0 };
  assert.equal(change_since(edit.forward, scene), null);
});

test("an edit of the goals is undone to the whole list, with headings", () => {
  const list = { goals: [{ x: 0, y: 0, heading: 1 }, { x: 1, y: 0, heading: null }], next: 1, loop: true };
  const one = { goals: [{ x: 1, y: 2, heading: null }], next: 0, loop: false };
  assert.deepEqual(route_edit("Set goal", list, one).backward,
    { type: "set_goals", goals: [{ x: 0, y: 0, heading: 1 }, { x: 1, y: 0 }], next: 1, loop: true });
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
  assert.deepEqual(result_word("stuck"), { word: "Stuck", tone: "warn" });
  assert.equal(result_word("recording").word, "Recording");
  assert.deepEqual(result_word("interrupted"), { word: "Interrupted", tone: "muted" });
  assert.equal(state_word(null, null, false).word, "No link");
});
