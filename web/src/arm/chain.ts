// web/src/arm/chain.ts: where the links of an arm are, by its joints: algo/arm/arm_chain.cpp on the page.
import { ArmInfo } from "../contract";
import { Pose } from "../geometry";
import { Axes, Vec3, add, cross, dot, length, minus, scaled } from "./vector";

/** A frame in W: its axes and its origin. */
interface ArmFrame { axes: Axes; at: Vec3 }

/** Where an arm is, in W. `hand` has its z axis along the hand. */
export interface ArmPlace { shoulder: Vec3; elbow: Vec3; wrist: Vec3; hand: ArmFrame }

const kTwist = [-1, -1, 1, -1, 1, -1, 0]; // the sine of alpha_i

/** `before` times Rz(theta) Tz(d) Tx(a) Rx(alpha), where `twist` is the sine of alpha. */
function after_joint({ axes: [x, y, z], at }: ArmFrame, theta: number, twist: number, d: number, a: number): ArmFrame {
  const c = Math.cos(theta), s = Math.sin(theta);
  const ahead = add(scaled(x, c), scaled(y, s));
  const aside = add(scaled(y, c), scaled(x, -s));
  const axes: Axes = twist === 0 ? [ahead, aside, z] : [ahead, scaled(z, twist), scaled(aside, -twist)];
  return { axes, at: add(at, scaled(z, d), scaled(ahead, a)) };
}

/** Frames 0 to 7 for joints `q` [rad] behind a shoulder at `mount`: docs/equations.md, "J. The arm". */
export function arm_frames(arm: ArmInfo, q: ArrayLike<number>, mount: ArmFrame): ArmFrame[] {
  const along_z = [0, 0, arm.upper_arm, 0, arm.forearm, 0, arm.hand];
  const along_x = [0, 0, 0, arm.elbow_offset, 0, 0, 0];
  const frames = [mount];
  kTwist.forEach((twist, i) => frames.push(after_joint(frames[i], q[i], twist, along_z[i], along_x[i])));
  return frames;
}

/** The shoulder's frame of a robot at `base`. */
function mount_of(arm: ArmInfo, base: Pose): ArmFrame {
  const [c, s] = [Math.cos(base.heading), Math.sin(base.heading)];
  const [x, y, z] = arm.shoulder;
  const turn = base.heading + arm.heading;
  const [cm, sm] = [Math.cos(turn), Math.sin(turn)];
  return {
    axes: [[cm, sm, 0], [-sm, cm, 0], [0, 0, 1]],
    at: [base.x + c * x - s * y, base.y + s * x + c * y, z],
  };
}

export function arm_place(arm: ArmInfo, base: Pose, q: ArrayLike<number>): ArmPlace {
  const frames = arm_frames(arm, q, mount_of(arm, base));
  return { shoulder: frames[0].at, elbow: frames[3].at, wrist: frames[5].at, hand: frames[7] };
}

/** The straight links by name, the mast's foot on the base first. */
export const kLinks = ["mast", "upper_arm", "forearm", "hand"] as const;
export type Link = (typeof kLinks)[number];
export interface LinkAxis { name: Link; from: Vec3; to: Vec3; radius: number }

export function link_axes(arm: ArmInfo, at: ArmPlace): LinkAxis[] {
  const foot: Vec3 = [at.shoulder[0], at.shoulder[1], arm.base_height];
  const corners = [foot, at.shoulder, at.elbow, at.wrist, at.hand.at];
  return kLinks.map((name, i) => (
    { name, from: corners[i], to: corners[i + 1], radius: name === "mast" ? arm.mast_radius : arm.link_radius }));
}

const kOnAxis = 1e-9; // [m], part of a unit vector

/** The arm angle [rad]: how far the elbow is turned about the line from shoulder to wrist, from the side where it is
 * lowest. Null where the elbow lies on that line. */
export function arm_angle(arm: ArmInfo, q: ArrayLike<number>): number | null {
  const frames = arm_frames(arm, q, { axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], at: [0, 0, 0] });
  const wrist = frames[5].at, elbow = frames[3].at;
  const far = length(wrist);
  if (far < kOnAxis) return null;
  const axis = scaled(wrist, 1 / far);
  const normal = (v: Vec3) => minus(v, scaled(axis, dot(v, axis)));
  const down = normal([0, 0, -1]);
  const reference = length(down) < kOnAxis ? normal([1, 0, 0]) : down;
  const off = normal(elbow);
  if (length(off) < kOnAxis) return null;
  return Math.atan2(dot(off, cross(reference, axis)), dot(off, reference));
}

/** Why the arm cannot bring its hand to a pose from the present place of the base, and whether it could from no place;
 * null: the distances permit it. `wrist` and `shoulder` in W. */
export function reach_words(arm: ArmInfo, shoulder: Vec3, wrist: Vec3): { words: string; never: boolean } | null {
  const far = arm.upper_arm + Math.hypot(arm.elbow_offset, arm.forearm);
  const up = wrist[2] - shoulder[2];
  const metres = (v: number) => `${v.toFixed(2)} m`;
  if (Math.abs(up) > far) {
    return { never: true, words: `The wrist would be ${metres(Math.abs(up))} ${up > 0 ? "above" : "below"} the shoulder, and the farthest it can be is ${metres(far)}.` };
  }
  const apart = length(minus(wrist, shoulder));
  return apart > far ? { never: false, words: `The wrist would be ${metres(apart)} from the shoulder, and the farthest it can be is ${metres(far)}.` } : null;
}
