// web/src/arm/inspect.ts: the links of an arm, the goal of its hand and its plan under a pointer, and their cards.
import type { Card, Row } from "../edit/facts";
import type { Eye, Shown, Thing } from "../edit/inspect";
import { Point, degrees, distance, least, to_segment } from "../geometry";
import type { SceneState } from "../state/scene";
import { fixed } from "../words";
import { LinkAxis, kLinks, link_axes } from "./chain";
import { hand_goal_of } from "./desk";
import { kArmLayers } from "./layers";
import { arm_of, planned } from "./plan";
import { pointing_of } from "./pose";
import { Vec3, add, length, minus, scaled } from "./vector";

const kGoal = 14;  // [px] about the goal of the hand
const kSlack = 2;  // [px] about a link

const gap = (eye: Eye, [x, y, z]: Vec3): number => {
  const at = eye.to_screen({ x, y }, z);
  return at ? distance(at, eye.px) : Infinity;
};

/** The goal of the hand, or a link in the view from above. */
export function arm_at(scene: SceneState, eye: Eye): Thing | null {
  const goal = hand_goal_of(scene);
  if (scene.arm && goal && gap(eye, [goal.x, goal.y, goal.z]) <= kGoal) return { kind: "hand_goal" };
  const at = arm_of(scene);
  if (!scene.arm || !at || eye.scale === undefined) return null; // in 3D the bodies tell
  const hits = link_axes(scene.arm, at).filter((l) => l.name !== "mast" && on_link(eye, l));
  return hits.length > 0 ? { kind: "link", link: hits.reduce((a, b) => (high(b) > high(a) ? b : a)).name } : null;
}

const high = (l: LinkAxis) => l.from[2] + l.to[2];

function on_link(eye: Eye, { from, to, radius }: LinkAxis): boolean {
  const [a, b] = [from, to].map(([x, y, z]) => eye.to_screen({ x, y }, z));
  return !!a && !!b && to_segment(eye.px, a, b) <= radius * (eye.scale ?? 0) + kSlack;
}

/** The place of the plan whose hand or base is under the pointer. */
export function plan_at(scene: SceneState, shown: Shown, eye: Eye): Thing | null {
  if (shown.hidden.has(kArmLayers.plan.name)) return null;
  const all = planned(scene).map(({ base, arm }, index) =>
    ({ index, px: Math.min(gap(eye, arm.hand.at), gap(eye, [base.x, base.y, 0])) }));
  const found = least(all, (p) => p.px);
  return found && found.px <= eye.slack ? { kind: "planned", index: found.index } : null;
}

const metres = (label: string, value: number): Row => ({ label, value: value === Infinity ? "nothing near" : fixed(value, 2), unit: value === Infinity ? "" : "m" });
const place = (label: string, at: Vec3): Row => ({ label, value: at.map((v) => fixed(v, 2)).join(", "), unit: "m" });
const angles = (label: string, all: number[]): Row => ({ label, value: all.map((q) => fixed(degrees(q), 0)).join(", "), unit: "°" });
const flat = ([x, y]: Vec3): Point => ({ x, y });

const kNames = { mast: "Mast", upper_arm: "Upper arm", forearm: "Forearm", hand: "Hand" };
/** The joints before each link that move it, from the first to behind the last. */
const kMovedBy = { mast: [0, 0], upper_arm: [0, 3], forearm: [3, 5], hand: [5, 7] };

export function link_card(scene: SceneState, name: keyof typeof kNames): Card | null {
  const { arm, frame } = scene;
  const at = arm_of(scene);
  if (!arm || !at || !frame?.joints) return null;
  const link = link_axes(arm, at)[kLinks.indexOf(name)];
  const [first, end] = kMovedBy[name];
  const clear = frame.arm?.clearance[kLinks.indexOf(name) + 1];
  const middle = scaled(add(link.from, link.to), 0.5);
  const joints = frame.joints.slice(first, end);
  const rows = [...(clear === undefined ? [] : [metres("Clear of things", clear)]),
    ...(frame.arm && name !== "mast" ? [metres("Arm to the robot itself", frame.arm.own)] : []),
    ...(end > first ? [angles(end - first > 1 ? `Joints ${first + 1} to ${end}` : `Joint ${end}`, joints)] : []),
    place(name === "hand" ? "Its tip x, y, z" : "Its end x, y, z", link.to), metres("Length", length(minus(link.to, link.from))), metres("Radius", link.radius)];
  return { title: kNames[name], note: "of the arm, as measured", rows, law: null, at: flat(middle), height: middle[2], radius: link.radius, long: true };
}

export function hand_goal_card(scene: SceneState): Card | null {
  const goal = hand_goal_of(scene);
  const at = arm_of(scene);
  if (!goal) return null;
  const { bearing, pitch, turn } = pointing_of(goal);
  const rows = [place("x, y, z", [goal.x, goal.y, goal.z]), angles("Bearing, pitch, turn", [bearing, pitch, turn]),
    ...(goal.arm_angle === undefined ? [] : [angles("Arm angle", [goal.arm_angle])]),
    ...(at ? [metres("From the hand", length(minus([goal.x, goal.y, goal.z], at.hand.at)))] : [])];
  return { title: "Goal of the hand", note: goal.base_stays ? "the base stays" : "", rows, law: null, at: goal, height: goal.z, radius: 0.05 };
}

export function planned_card(scene: SceneState, index: number): Card | null {
  const all = planned(scene);
  const there = all.at(index);
  if (!there) return null;
  const { base, joints, arm } = there;
  const rows = [place("Hand x, y, z", arm.hand.at), { label: "Base x, y", value: `${fixed(base.x, 2)}, ${fixed(base.y, 2)}`, unit: "m" },
    angles("Base heading", [base.heading]), angles("Joints", [...joints])];
  return { title: `Plan, place ${index + 1} of ${all.length}`, note: `plan ${scene.arm_plan?.plan ?? 0}`, rows, law: null, at: flat(arm.hand.at),
    height: arm.hand.at[2], radius: 0 };
}
