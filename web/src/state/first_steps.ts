// web/src/state/first_steps.ts: how far someone came with the first steps; the browser remembers it.
import { keep, kept } from "./store";

export const kGoalStep = 0;
export const kObstacleStep = 1;
export const kCompareStep = 2;
export const kAllDone = 3;
const kKept = "tautline.steps";

/** The step at which a visit begins. */
export function kept_step(): number {
  return kept(kKept, kGoalStep, (text) => Math.min(kAllDone, Math.max(kGoalStep, Math.floor(Number(text)) || 0)));
}
export function keep_step(step: number): void {
  keep(kKept, String(step));
}
