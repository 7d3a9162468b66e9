// web/src/three/arm.ts: an arm in 3D: its links, the plan of base and arm, the goal of its hand.
import * as THREE from "three";
import { LinkAxis, link_axes } from "../arm/chain";
import { hand_goal_of } from "../arm/desk";
import { kArmLayers } from "../arm/layers";
import { arm_of, planned, spread } from "../arm/plan";
import { axes_of, goal_at, place_of, wrist_of } from "../arm/pose";
import { Vec3 } from "../arm/vector";
import type { ArmInfo, HandGoalJson } from "../contract";
import type { Palette } from "../draw/palette";
import { kGround } from "../layer";
import { goal_from_json } from "../state/goals";
import type { SceneState } from "../state/scene";
import { dashes } from "./layers";
import { flat, goal as base_goal, outline_at, ribbon, tube } from "./shapes";

const kShownPlaces = 6; // of a plan
const kPalm = { wide: 0.11, thick: 0.03, deep: 0.03 }; // [m] across the end of the hand: shows how it is turned

const kUp = new THREE.Vector3(0, 1, 0); // along which three.js makes cylinders
const vector = ([x, y, z]: Vec3) => new THREE.Vector3(x, y, z);

function capsule({ from, to, radius, name }: LinkAxis, material: THREE.Material): THREE.Mesh {
  const along = vector(to).sub(vector(from));
  const mesh = new THREE.Mesh(new THREE.CapsuleGeometry(radius, along.length(), 6, 20), material);
  mesh.position.copy(vector(from)).addScaledVector(along, 0.5);
  mesh.quaternion.setFromUnitVectors(kUp, along.normalize());
  mesh.userData.link = name;
  return mesh;
}

/** The end of a hand, wide along its x axis. */
function palm(goal: HandGoalJson, material: THREE.Material): THREE.Mesh {
  const { wide, thick, deep } = kPalm;
  const mesh = new THREE.Mesh(new THREE.BoxGeometry(wide, thick, deep), material);
  const [x, y, z] = axes_of(goal).map(vector);
  mesh.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, y, z));
  mesh.position.copy(vector(place_of(goal)));
  mesh.userData.link = "hand";
  return mesh;
}

const see_through = (color: string, opacity: number) =>
  new THREE.MeshStandardMaterial({ color, roughness: 0.6, transparent: true, opacity, depthWrite: false });

/** The links where they are. Joints between them are drawn in another colour, so that a bend is seen. */
export function build_arm(scene: SceneState, p: Palette): THREE.Object3D[] {
  const at = arm_of(scene);
  if (!scene.arm || !at) return [];
  const paint = (color: string) => new THREE.MeshStandardMaterial({ color, roughness: 0.55 });
  const joint = (place: Vec3, radius: number) => {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(radius, 20, 14), paint(p.obstline));
    ball.position.copy(vector(place));
    return ball;
  };
  const radius = 1.15 * scene.arm.link_radius;
  return [
    ...link_axes(scene.arm, at).map((link) => capsule(link, paint(p.robot))), palm(goal_at(at), paint(p.obstline)),
    joint(at.shoulder, 1.15 * scene.arm.mast_radius), joint(at.elbow, radius), joint(at.wrist, radius),
  ];
}

/** The plan: the base's way on the floor, the hand's way, and the arm at some places of it. */
export function build_plan(scene: SceneState, p: Palette, hidden: ReadonlySet<string>): THREE.Object3D[] {
  const { arm } = scene;
  const places = planned(scene);
  if (!arm || places.length === 0 || hidden.has(kArmLayers.plan.name)) return [];
  const way = dashes(places.map(({ base }) => ({ x: base.x, y: base.y, z: null })));
  const out: THREE.Object3D[] = way.map((piece) => ribbon(piece, 0.025, kGround, p.accent));
  out.push(tube(places.map(({ arm: a }) => a.hand.at), 0.007, p.accent));
  for (const i of spread(places.length, kShownPlaces)) {
    const last = i === places.length - 1;
    const material = see_through(p.accent, last ? 0.4 : 0.14);
    for (const link of link_axes(arm, places[i].arm)) if (link.name !== "mast") out.push(capsule(link, material));
    if (last) out.push(outline_at(places[i].base, scene, p.accent));
  }
  return out;
}

/** The hand at its goal, or at `draft`, and where the base drives after that. */
export function build_hand_goal(scene: SceneState, p: Palette, draft: HandGoalJson | null): THREE.Object3D[] {
  const { arm } = scene;
  const goal = draft ?? hand_goal_of(scene);
  if (!arm || !goal) return [];
  const then = goal_from_json(goal.then);
  return [...hand_at(arm, goal, p, draft ? 0.85 : 0.55), ...(then ? [base_goal(then, p)] : [])];
}

function hand_at(arm: ArmInfo, goal: HandGoalJson, p: Palette, opacity: number): THREE.Object3D[] {
  const material = see_through(p.ok, opacity);
  const foot = place_of(goal);
  const pole = tube([[foot[0], foot[1], 0], foot], 0.004, p.ok); // how high it is, and over what
  const spot = new THREE.Mesh(new THREE.RingGeometry(0.05, 0.07, 32), flat(p.ok));
  spot.position.set(foot[0], foot[1], kGround);
  return [capsule({ name: "hand", from: wrist_of(goal, arm.hand), to: foot, radius: arm.link_radius }, material), palm(goal, material), pole, spot];
}
