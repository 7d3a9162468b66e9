// tests/web/arm.test.ts: the arm on the page: where its links are, poses in the words of a person, the handles of the
// gizmo, the fields of a frame, the marks of the scene, cards and requests, and undo beside another person's goal.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import type { App } from "../../web/src/app";
import { arm_angle, arm_frames, arm_place, link_axes, reach_words } from "../../web/src/arm/chain";
import { ArmDesk, hand_goal_of } from "../../web/src/arm/desk";
import "../../web/src/arm/draw";
import { Handle, HandleName, Ray, begin_drag, handle_at, handles_of } from "../../web/src/arm/gizmo";
import { planned, spread } from "../../web/src/arm/plan";
import { axes_of, pointing_of, quaternion_of, quaternion_to, wrist_of } from "../../web/src/arm/pose";
import { Vec3, kUnit, length, minus } from "../../web/src/arm/vector";
import type { ArmInfo, HandGoalJson } from "../../web/src/contract";
import type { Palette } from "../../web/src/draw/palette";
import { Overlay, draw_scene } from "../../web/src/draw/scene";
import { View } from "../../web/src/draw/view";
import { card_of } from "../../web/src/edit/facts";
import { thing_at } from "../../web/src/edit/inspect";
import { change_since } from "../../web/src/edit/stands";
import { wrap_angle } from "../../web/src/geometry";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { obstacle_from_json, obstacle_to_json } from "../../web/src/obstacle";
import { layer_groups } from "../../web/src/state/layer_groups";
import { signals_of } from "../../web/src/state/measures";
import { SceneState, fold_frame, held_of, new_scene } from "../../web/src/state/scene";
import { FrameSpec, frame_bytes } from "./wire";

const kArm: ArmInfo = {
  shoulder: [0, -0.22, 0.95], heading: 0, upper_arm: 0.3, elbow_offset: 0, forearm: 0.28, hand: 0.15, link_radius: 0.04,
  mast_radius: 0.05, base_height: 0.46, limits: [170, 120, 170, 140, 170, 110, 175].map((v) => (v * Math.PI) / 180),
  rates: [], rest: [-0.38, 1.57, -0.4, -1.39, 0, 0, 0],
};
const near = (a: number, b: number, tolerance: number, words = "") =>
  assert.ok(Math.abs(a - b) <= tolerance, `${words}: ${a}, not ${b} ± ${tolerance}`);
const same = (a: readonly number[], b: readonly number[], tolerance: number, words = "") => {
  assert.equal(a.length, b.length, words);
  a.forEach((v, i) => near(v, b[i], tolerance, `${words} [${i}]`));
};

interface Golden {
  models: { name: string; a4: number; d3: number; d5: number; d7: number;
    fk: { q: number[]; T: number[][]; elbow: number[]; wrist: number[]; arm_angle?: number }[] }[];
}
const golden = JSON.parse(readFileSync(join(process.env.TAUTLINE_TESTS!, "golden/arm.json"), "utf8")) as Golden;

test("links, hand and arm angle are those of the golden vectors", () => {
  let poses = 0;
  for (const { name, a4, d3, d5, d7, fk } of golden.models) {
    const arm = { ...kArm, elbow_offset: a4, upper_arm: d3, forearm: d5, hand: d7 };
    for (const { q, T, elbow, wrist, arm_angle: psi } of fk) {
      const frames = arm_frames(arm, q, { axes: kUnit, at: [0, 0, 0] });
      const words = `${name} ${q}`;
      same(frames[3].at, elbow, 1e-12, words);
      same(frames[5].at, wrist, 1e-12, words);
      same(frames[7].at, T.slice(0, 3).map((row) => row[3]), 1e-12, words);
      frames[7].axes.forEach((axis, k) => same(axis, T.slice(0, 3).map((row) => row[k]), 1e-12, words));
      if (psi !== undefined) near(wrap_angle(arm_angle(arm, q)! - psi), 0, 1e-9, words);
      ++poses;
    }
  }
  assert.ok(poses >= 40, `${poses} poses`);
});

test("the arm goes with its base, from the mount on", () => {
  const at = arm_place(kArm, { x: 2, y: 1, heading: Math.PI / 2 }, [0, 0, 0, 0, 0, 0, 0]);
  same(at.shoulder, [2.22, 1, 0.95], 1e-12, "the shoulder, at the right of the robot");
  same(at.hand.at, [2.22, 1, 0.95 - 0.73], 1e-12, "all joints at 0 hang down");
  const links = link_axes(kArm, at);
  assert.deepEqual(links.map((l) => l.name), ["mast", "upper_arm", "forearm", "hand"]);
  same(links.map((l) => length(minus(l.to, l.from))), [0.49, 0.3, 0.28, 0.15], 1e-12, "lengths");
});

test("a direction in degrees is a quaternion and back, straight down as well", () => {
  const down = pointing_of(quaternion_to({ bearing: 0, pitch: -Math.PI / 2, turn: 0 }));
  near(down.pitch, -Math.PI / 2, 1e-6);
  near(wrap_angle(down.bearing), 0, 1e-6);
  const table = pointing_of({ qw: 0.540302305868, qx: 0, qy: 0.841470984808, qz: 0 }); // 2 rad about y, from up
  same([table.bearing, table.pitch, table.turn], [0, Math.PI / 2 - 2, 0], 1e-9, "arm_table");
  for (const bearing of [-3, -1, 0, 2]) for (const pitch of [-1.5, -0.3, 0, 1.2]) for (const turn of [-2.5, 0, 0.7, 3.1]) {
    const q = quaternion_to({ bearing, pitch, turn });
    const back = pointing_of(q);
    same([back.bearing, back.pitch, back.turn], [bearing, pitch, turn], 1e-9, `${bearing} ${pitch} ${turn}`);
    const again = quaternion_of(axes_of(q));
    const sign = Math.sign(again.qw * q.qw + again.qx * q.qx + again.qy * q.qy + again.qz * q.qz);
    same([again.qw, again.qx, again.qy, again.qz].map((v) => sign * v), [q.qw, q.qx, q.qy, q.qz], 1e-12, "by axes");
    same(axes_of(q)[2], [Math.cos(bearing) * Math.cos(pitch), Math.sin(bearing) * Math.cos(pitch), Math.sin(pitch)], 1e-12, "direction");
  }
});

const goal = (more: Partial<HandGoalJson> = {}): HandGoalJson => ({ x: 1, y: 0, z: 1, ...quaternion_to({ bearing: 0, pitch: 0, turn: 0 }), ...more });

test("the distances say whether the arm reaches a pose, from here or from anywhere", () => {
  const shoulder: Vec3 = [0, -0.22, 0.95];
  assert.equal(reach_words(kArm, shoulder, [0.5, -0.22, 0.95]), null);
  assert.deepEqual(reach_words(kArm, shoulder, wrist_of(goal({ y: -0.22, z: 0.95 }), 0.15)),
    { never: false, words: "The wrist would be 0.85 m from the shoulder, and the farthest it can be is 0.58 m." });
  assert.deepEqual(reach_words(kArm, shoulder, [0, 0, 1.6]),
    { never: true, words: "The wrist would be 0.65 m above the shoulder, and the farthest it can be is 0.58 m." });
});

/** A sight from the south, 2 m away and level with the goal, that holds (x, z) of the plane y = 0. */
const from_south = (x: number, z: number): Ray => ({ from: [x, -2, z], along: [0, 1, 0] });
const from_above = (x: number, y: number): Ray => ({ from: [x, y, 3], along: [0, 0, -1] });
const handle = (name: HandleName, g = goal()): Handle => handles_of(g, 0.3).find((h) => h.name === name)!;

test("an axis moves along itself alone, and the middle over the level", () => {
  const x = begin_drag(handle("x"), goal(), from_south(1.2, 1))(from_south(1.5, 1.4));
  same([x.x, x.y, x.z], [1.3, 0, 1], 1e-9, "x");
  const z = begin_drag(handle("z"), goal(), from_south(1, 1.2))(from_south(0.3, 1.05));
  same([z.x, z.y, z.z], [1, 0, 0.85], 1e-9, "z");
  const level = begin_drag(handle("level"), goal(), from_above(1, 0))(from_above(1.25, -0.5));
  same([level.x, level.y, level.z], [1.25, -0.5, 1], 1e-9, "level");
  const along = begin_drag(handle("z"), goal(), from_above(1, 0))(from_above(1.4, 0)); // the sight is the axis
  same([along.x, along.y, along.z], [1, 0, 1], 1e-9, "an axis that points at the eye stays");
});

test("a ring turns the angle that a person types, from before and from its edge", () => {
  const bearing = begin_drag(handle("bearing"), goal(), from_above(1.2, 0))(from_above(1, 0.2));
  near(pointing_of(bearing).bearing, Math.PI / 2, 1e-9, "a quarter to the left");
  const pitch = begin_drag(handle("pitch"), goal(), from_south(1.2, 1))(from_south(1.2 * 0 + 1 + 0.2 * Math.cos(0.5), 1 + 0.2 * Math.sin(0.5)));
  near(pointing_of(pitch).pitch, 0.5, 0.01, "up, in whole degrees");
  const turn = begin_drag(handle("turn"), goal(), { from: [3, 0.2, 1], along: [-1, 0, 0] })({ from: [3, 0, 1.2], along: [-1, 0, 0] });
  near(Math.abs(pointing_of(turn).turn), Math.PI / 2, 1e-9, "about itself");
  same(axes_of(turn)[2], [1, 0, 0], 1e-9, "and goes on pointing there");
  const edge = begin_drag(handle("bearing"), goal(), from_south(1, 1))(from_south(1.1, 1)); // the ring is a line from here
  assert.ok(pointing_of(edge).bearing > 0.3, "its near side goes to the right: to the left about the vertical");
});

test("a pointer takes the nearest handle within its slack, a finger from farther off", () => {
  const to_screen = ([x, , z]: Vec3) => ({ x: 400 + 300 * (x - 1), y: 300 - 300 * (z - 1) });
  const all = handles_of(goal(), 0.3);
  const at = (x: number, y: number, slack: number) => handle_at(all, { x, y }, slack, to_screen)?.name ?? null;
  assert.equal(at(480, 302, 12), "x");
  assert.equal(at(400, 225, 12), "z");
  assert.equal(at(400, 300, 12), "level");
  assert.equal(at(700, 500, 26), null);
  assert.equal(at(504, 300, 12), "x");
  assert.equal(at(515, 300, 12), null, "beyond a mouse's slack");
  assert.equal(at(515, 300, 26), "x");
});

const kGhost = [0, 0, 0, ...kArm.rest, 1, 0, 0.5, ...kArm.rest, 2, 0, 0.5, -1, 1, 0, 1, 0, 0, 0];
function scene_of(...frames: Partial<FrameSpec>[]): SceneState {
  const scene = new_scene();
  scene.arm = kArm;
  frames.forEach((f, tick) => fold_frame(scene, decode_frame(frame_bytes({ tick, joints: kArm.rest, ...f }), new Legends())));
  return scene;
}

test("frames bring joints, clearances, goal and plan; a plan stays until another number comes", () => {
  const hand_goal = { ...goal(), arm_angle: 0.25 };
  const first = decode_frame(frame_bytes({ tick: 0, joints: kArm.rest, arm: { state: 3, clearance: [1, 2, 0.5, Infinity, 0.25], own: 0.0625, hand_goal, plan: 4, ghost: kGhost } }), new Legends());
  assert.deepEqual(first.joints, kArm.rest);
  assert.deepEqual([first.arm!.state, first.arm!.clearance, first.arm!.own], ["goes", [1, 2, 0.5, Infinity, 0.25], 0.0625]);
  same([first.arm!.hand_goal!.x, first.arm!.hand_goal!.qw, first.arm!.hand_goal!.arm_angle!], [1, hand_goal.qw, 0.25], 1e-12);
  assert.deepEqual(held_of(first).includes("plan"), true, "a stored run finds the frame that brought it");

  const scene = scene_of({ arm: { plan: 4, ghost: kGhost } }, { arm: { plan: 4 } });
  assert.equal(planned(scene).length, 3);
  same(planned(scene)[2].arm.shoulder, arm_place(kArm, { x: 2, y: 0, heading: 0.5 }, kArm.rest).shoulder, 1e-6);
  assert.equal(planned(scene_of({ arm: { plan: 4, ghost: kGhost } }, { arm: { plan: 5 } })).length, 0);
  assert.equal(planned(scene_of({ arm: { plan: 4, ghost: kGhost } }, {})).length, 0);
  assert.deepEqual([spread(3, 9), spread(100, 3), spread(0, 3), spread(5, 1)], [[0, 1, 2], [0, 50, 99], [], [4]]);
});

test("joints, their rates and the links' clearances are signals with the CSV's names", () => {
  const scene = scene_of({ arm: { clearance: [1, 2, 0.5, Infinity, 0.25], own: 0.0625 } });
  const all = signals_of(scene.columns);
  const names = all.map((s) => s.name);
  for (const name of ["joint[0]", "joint[6]", "joint_moves[3]", "clearance.upper_arm", "clearance.own"]) assert.ok(names.includes(name), name);
  near(scene.columns.at("joint[1]", 0), 1.57, 1e-12);
  assert.equal(all.find((s) => s.name === "joint[0]")!.usual, true);
  assert.ok(!signals_of(scene_without().columns).some((s) => s.group.startsWith("Arm")), "no robot without an arm has them");
});

function scene_without(): SceneState {
  const scene = new_scene();
  fold_frame(scene, decode_frame(frame_bytes({ tick: 0 }), new Legends()));
  return scene;
}

test("links, goal and plan are in the legend of a robot with an arm", () => {
  const rows = (scene: SceneState) => layer_groups(scene).flatMap((g) => g.keys.map((k) => k.name));
  const with_arm = rows(scene_of({ arm: {} }));
  for (const name of ["arm", "arm.goal", "arm.plan"]) assert.ok(with_arm.includes(name) && !rows(scene_without()).includes(name), name);
});

/** What is drawn of `scene`: the texts, and the lines in pixels with their width. */
function drawn(scene: SceneState, more: Partial<Overlay> = {}) {
  const texts: string[] = [];
  const strokes: { width: number; colour: string }[] = [];
  const state: Record<string, unknown> = {};
  const g = new Proxy(state, {
    get: (of, name) => {
      if (name === "fillText") return (text: string) => texts.push(text);
      if (name === "measureText") return () => ({ width: 10 });
      if (name === "stroke") return () => strokes.push({ width: of.lineWidth as number, colour: of.strokeStyle as string });
      return name in of ? of[name as string] : () => undefined;
    },
  }) as unknown as CanvasRenderingContext2D;
  const palette = new Proxy({}, { get: (_, name) => (name === "font" ? "sans" : String(name)) }) as Palette;
  const view = Object.assign(new View(), { width: 800, height: 600, scale: 100 });
  draw_scene(g, view, palette, scene, {
    selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set(), ghosts: [], future: false,
    insets: { left: 0, top: 0, right: 0, bottom: 0 }, ...more,
  });
  return { texts, strokes };
}

test("from above the links are bars of their width, and the goal says its height", () => {
  const plain = drawn(scene_of({ arm: {} }));
  const wide = plain.strokes.filter((s) => s.colour === "robot" && Math.abs(s.width - 8) < 1e-9).length;
  assert.equal(wide, 3, "upper arm, forearm and hand, 2 * 0.04 m at 100 px/m");
  assert.equal(drawn(scene_of({ arm: { hand_goal: goal({ z: 0.95 }) } })).texts.includes("z 0.95 m"), true);
  assert.equal(drawn(scene_of({ arm: {} }), { draft: { hand: goal({ z: 1.25 }) } }).texts.includes("z 1.25 m"), true);
  const accents = (more: Partial<Overlay>) => drawn(scene_of({ arm: { plan: 1, ghost: kGhost } }), more).strokes.filter((s) => s.colour === "accent").length;
  assert.ok(accents({}) >= 5 && accents({ hidden: new Set(["arm.plan"]) }) === 0, "a plan that can be switched off");
});

test("a link, the goal of the hand and a place of the plan tell their numbers", () => {
  const stretched = [0, -1.2, 0, -0.3, 0, 0, 0];
  const scene = scene_of({ joints: stretched, arm: { clearance: [1, 2, 0.5, 0.375, 0.25], own: 0.0625, hand_goal: goal({ x: 3, y: 2 }), plan: 2, ghost: kGhost } });
  const view = Object.assign(new View(), { width: 800, height: 600, scale: 100 });
  const at = (x: number, y: number) => {
    const px = view.to_screen({ x, y });
    return thing_at(scene, { hidden: new Set(), force_scale: 1 }, { px, slack: 8, at: { x, y }, to_screen: (p) => view.to_screen(p), scale: view.scale });
  };
  const elbow = arm_place(kArm, { x: 0, y: 0, heading: 0 }, stretched);
  const middle = [0, 1].map((k) => (elbow.elbow[k] + elbow.wrist[k]) / 2);
  assert.deepEqual(at(middle[0], middle[1]), { kind: "link", link: "forearm" });
  const card = card_of(scene, { kind: "link", link: "forearm" })!;
  assert.equal(card.title, "Forearm");
  assert.ok(card.rows.some((r) => r.label === "Clear of things" && r.value === "0.38") && card.rows.some((r) => r.label === "Joints 4 to 5"));
  assert.deepEqual(at(3, 2), { kind: "hand_goal" });
  assert.ok(card_of(scene, { kind: "hand_goal" })!.rows.some((r) => r.label === "Bearing, pitch, turn"));
  const last = planned(scene)[2];
  assert.deepEqual(at(last.arm.hand.at[0], last.arm.hand.at[1]), { kind: "planned", index: 2 });
  assert.equal(card_of(scene, { kind: "planned", index: 2 })!.title, "Plan, place 3 of 3");
});

test("a table keeps the room below it when it is sent back", () => {
  const table = { type: "box" as const, x: 2.7, y: 0, heading: 0, length: 0.7, width: 1.2, bottom: 0.7, height: 0.74 };
  assert.deepEqual(obstacle_to_json(obstacle_from_json({ id: 1, ...table })), { ...table, reflectivity: undefined, specular: undefined });
});

/** A desk whose app writes down what it is asked. */
function desk_of(scene: SceneState) {
  const edits: { label: string; forward: unknown; backward: unknown }[] = [];
  const app = {
    scene, shown: scene, on_hardware: false, usable_tool: "pan", go_live: () => undefined, redraw: () => undefined, say: () => undefined,
    people: { may: () => true },
    ui: { value: { looking: false, session: { robot: { drives: true } }, selection: null }, set: () => undefined },
    editor: { edit: async (edit: (typeof edits)[number]) => void edits.push(edit) },
    link: { call: async () => ({}) },
  };
  return { desk: new ArmDesk(app as unknown as App), edits };
}

test("a goal is one step of undo, which brings back what was asked before", async () => {
  const scene = scene_of({ arm: {} });
  const { desk, edits } = desk_of(scene);
  await desk.send(goal());
  assert.deepEqual(edits.at(-1)!.backward, { type: "clear_goal" });
  scene.arm_asked = { type: "set_hand_goal", ...goal({ x: 5 }) };
  await desk.send(goal({ z: 1.2 }));
  assert.deepEqual(edits.at(-1)!.backward, scene.arm_asked, "somebody else's goal of the hand");
  await desk.fold();
  assert.deepEqual(edits.at(-1)!, { label: "Fold the arm", forward: { type: "set_joints", position: kArm.rest }, backward: scene.arm_asked });
  scene.arm_asked = null;
  scene.route = { goals: [{ x: 1, y: 2, heading: null }], next: 0, loop: false };
  await desk.send_carry({ x: 4, y: 0, heading: null });
  assert.deepEqual(edits.at(-1)!.backward, { type: "set_goals", goals: [{ x: 1, y: 2 }], next: 0, loop: false });
  scene.route = { goals: [], next: 0, loop: false };
  desk.turn(2, 0.5, false);
  desk.turn(2, 0.75, true);
  await Promise.resolve();
  const turned = edits.at(-1)!;
  assert.deepEqual(turned.forward, { type: "set_joints", position: kArm.rest.map((q, k) => (k === 2 ? 0.75 : q)) });
  assert.deepEqual(turned.backward, { type: "set_joints", position: kArm.rest }, "back to where they were");
});

test("undo leaves a goal alone that somebody else has set since", () => {
  const scene = scene_of({ arm: {} });
  const mine = { type: "set_hand_goal" as const, ...goal() };
  scene.arm_asked = { ...mine, base_stays: false };
  assert.equal(change_since(mine, scene), null, "the server's own copy of it");
  scene.arm_asked = { ...mine, z: 1.3 };
  assert.match(change_since(mine, scene)!, /another goal/);
  const none = { type: "set_goals" as const, goals: [], next: 0, loop: false };
  assert.match(change_since(none, scene)!, /goals have been changed/, "clearing goals again would lose the hand's");
  assert.match(change_since({ type: "clear_goal" }, scene)!, /another goal/);
  scene.arm_asked = { type: "set_joints", position: kArm.rest };
  assert.equal(change_since(none, scene), null);
  assert.equal(change_since({ type: "set_joints", position: kArm.rest }, scene), null);
  assert.match(change_since({ type: "set_joints", position: kArm.rest.map((q) => q + 0.1) }, scene)!, /another goal/);
});

test("the newest goal counts for the live robot, and the frame's for an earlier instant", () => {
  const scene = scene_of({ arm: { hand_goal: goal({ x: 7 }) } });
  assert.equal(hand_goal_of(scene)!.x, 7);
  scene.arm_asked = { type: "set_hand_goal", ...goal({ x: 8 }) };
  assert.equal(hand_goal_of(scene)!.x, 8);
  scene.arm_asked = { type: "set_joints", position: kArm.rest };
  assert.equal(hand_goal_of(scene), null);
});

test("keys move and turn the chosen goal of the hand, and say where it is", async () => {
  const scene = scene_of({ arm: {} });
  scene.arm_asked = { type: "set_hand_goal", ...goal() };
  const { desk, edits } = desk_of(scene);
  const press = (key: string, shiftKey = false) => desk.key({ key, shiftKey } as KeyboardEvent);
  Object.assign(globalThis, { document: { activeElement: null, body: null }, HTMLCanvasElement: class {} });
  assert.equal(press("ArrowUp"), false, "nothing is chosen");
  (desk as unknown as { app_: { usable_tool: string } }).app_.usable_tool = "hand";
  assert.equal(press("ArrowUp"), true);
  await Promise.resolve();
  assert.equal((edits.at(-1)!.forward as HandGoalJson).y, 0.1);
  desk.draft = null;
  press("PageUp", true);
  await Promise.resolve();
  assert.equal((edits.at(-1)!.forward as HandGoalJson).z, 1.01);
  desk.draft = null;
  press("[");
  await Promise.resolve();
  near(pointing_of(edits.at(-1)!.forward as HandGoalJson).bearing, (5 * Math.PI) / 180, 1e-9);
});
