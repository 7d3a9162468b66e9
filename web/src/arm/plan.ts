// web/src/arm/plan.ts: the plan of base and arm as a row of places.
import { ArmInfo } from "../contract";
import { Pose } from "../geometry";
import type { SceneState } from "../state/scene";
import { ArmPlace, arm_place } from "./chain";

export interface PlannedPlace { base: Pose; joints: Float32Array; arm: ArmPlace }

const kNumbers = 10; // of a pose: x, y, heading and seven joints
const found = new WeakMap<Float32Array, PlannedPlace[]>();

/** The places of the plan, the first one where it began; none once the robot is there. Found once for a plan. */
export function planned(scene: SceneState): PlannedPlace[] {
  const { arm, arm_plan, frame } = scene;
  const ghost = arm_plan?.ghost;
  if (!arm || !ghost || frame?.arm?.state === "arrived") return [];
  const known = found.get(ghost);
  if (known) return known;
  const all = places_in(arm, ghost);
  found.set(ghost, all);
  return all;
}

function places_in(arm: ArmInfo, ghost: Float32Array): PlannedPlace[] {
  return Array.from({ length: Math.floor(ghost.length / kNumbers) }, (_, i) => {
    const [x, y, heading] = ghost.subarray(i * kNumbers, i * kNumbers + 3);
    const base = { x, y, heading };
    const joints = ghost.subarray(i * kNumbers + 3, (i + 1) * kNumbers);
    return { base, joints, arm: arm_place(arm, base, joints) };
  });
}

/** The indices of at most `most` of `count` places, evenly spread; the last one is among them. */
export function spread(count: number, most: number): number[] {
  const shown = Math.min(count, most);
  return Array.from({ length: shown }, (_, i) => (shown > 1 ? Math.round((i * (count - 1)) / (shown - 1)) : count - 1));
}

/** The goal of the hand and where the arm is, at the shown instant. */
export function arm_of(scene: SceneState): ArmPlace | null {
  const { arm, frame } = scene;
  return arm && frame?.joints ? arm_place(arm, frame.pose, frame.joints) : null;
}
