// web/src/state/stick.ts: the stick of somebody who drives by hand, as frames tell it.
import type { Frame } from "../link/frame";

/** Layers of the laws for driving by hand, which the page draws in a way of their own. */
export const kRing = "teleop.ring", kWall = "teleop.wall";

/** As the record has it: ahead and left are positive, of full stick. */
export interface DrivenStick { forward: number; turn: number; mode: string }

/** The newest stick at `f`; null while nobody drives. A stick holds until it is too old for the server. */
export function stick_after(before: DrivenStick | null, f: Pick<Frame, "stick" | "behaviour">): DrivenStick | null {
  return f.behaviour === "manual" ? f.stick ?? before : null;
}
