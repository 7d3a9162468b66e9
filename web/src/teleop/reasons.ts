// web/src/teleop/reasons.ts: why a robot that is driven by hand does less than the stick asks, in words with numbers.
import { degrees } from "../geometry";
import { Words } from "../link/frame";
import { measure, wall_of } from "../state/driven";
import { SceneState } from "../state/scene";
import { ground_ahead } from "../state/terrain";
import { fixed, titled } from "../words";

const kLimits: Record<string, { what: string; why: string }> = {
  crowded: { what: "Slower in a crowded place", why: "Things are near on several sides, so less speed ahead is allowed." },
  obstacle_ahead: { what: "Slower before an obstacle", why: "Something is near ahead." },
  wall: { what: "Following the wall", why: "The robot turns so that it keeps its distance to the wall beside it." },
  guard: { what: "The guard holds back", why: "The robot could not stop before what it sees." },
  link: { what: "Slower over a slow link", why: "Your answer to what you see would come too late for more." },
  turnover: { what: "Slower on the slope", why: "It would turn over in a faster turn." },
  turnover_ahead: { what: "Stopped before a slope", why: "The ground ahead is too steep to stand on." },
  turnover_here: { what: "The slope is too steep", why: "It may turn over where it stands: back away slowly, or turn on the spot." },
  turnover_back: { what: "Slower backwards", why: "Nothing looks at the ground behind, and the robot is tall." },
  ground: { what: "Slower for the ground ahead", why: "The floor sensors do not see a level floor." },
  ground_silent: { what: "The floor sensors are silent", why: "The robot waits for them." },
  arm: { what: "The arm is near something", why: "The motion would bring it too near." },
  elastic: { what: "The robot finds the way", why: "Your stick pulls its goal along; it goes round what is in between." },
};
/** Why the command is below the wanted one; null: nothing limits it. */
function limit_words(limit: string): { what: string; why: string } | null {
  return limit === "" ? null : kLimits[limit] ?? { what: titled(limit), why: "" };
}

/** `tone`: the colour of its cause. */
export interface Reason { head: string; tail: string; tone: "external" | "internal" | "muted" }

const kNone: Reason = { head: "", tail: "Nothing limits it.", tone: "muted" };
const kIdle: Reason = { ...kNone, tail: "" }; // nobody drives
const kLess = 0.01; // [m/s], [rad/s]

const side = (left: boolean) => (left ? "left" : "right");

/** Why the speed is below the `wanted` one [m/s]. */
export function speed_reason(scene: SceneState, wanted: number): Reason {
  const f = scene.frame;
  if (!f || !scene.stick) return kIdle;
  if (Math.abs(f.command.v) > Math.abs(wanted) - kLess) return kNone;
  const room = measure(scene, "teleop.v_sprs"), nearest = measure(scene, "teleop.nearest");
  const share = `${fixed((100 * f.command.v) / wanted, 0)} %`;
  if (f.limit === "crowded") return { head: "Crowded:", tail: `room for ${fixed(room, 2)} m/s (Eq. 1-3)`, tone: "external" };
  if (f.limit === "obstacle_ahead") return { head: `Nearest at ${fixed(nearest, 2)} m:`, tail: `${share} of it (Eq. 4)`, tone: "external" };
  if (f.limit === "guard") return { head: "Guard:", tail: `${share} of it, to stop before what it sees`, tone: "external" };
  if (f.limit === "" || f.limit === "wall") return kNone; // the base is still on its way
  return { head: `${limit_words(f.limit)!.what}:`, tail: `${share} of it`, tone: "external" };
}

/** Why the robot turns otherwise than `wanted` [rad/s]. */
export function turn_reason(scene: SceneState, wanted: number): Reason {
  const f = scene.frame;
  if (!f || !scene.stick) return kIdle;
  const turn = measure(scene, "teleop.w_d"), wall = wall_of(scene);
  if (turn !== null && wall) {
    return {
      head: `Wall on the ${side(wall.theta > 0)}`, tail: `turns it ${side(turn > 0)} (Eq. 8)`, tone: "internal",
    };
  }
  if (f.limit === "guard" && Math.abs(f.command.omega - wanted) > kLess) {
    return { head: "Guard:", tail: "to turn clear of what it sees", tone: "external" };
  }
  return kNone;
}

/** What a driven robot does and why. */
export function driven_words(scene: SceneState): Words {
  const f = scene.frame;
  const words = limit_words(f?.limit ?? "");
  const wall = wall_of(scene), nearest = measure(scene, "teleop.nearest"), turn = measure(scene, "teleop.w_d");
  const beside = wall ? ` Wall ${fixed(wall.rho, 2)} m away, ${fixed(Math.abs(degrees(wall.theta)), 0)}° to the ${side(wall.theta > 0)}.` : "";
  if (!f || !words) return { what: "The robot follows your stick", why: `Nothing limits it.${beside}` };
  if (f.limit === "wall" && wall && turn !== null) {
    const towards = 90 - Math.abs(degrees(wall.theta));
    return {
      what: `Following the wall on your ${side(wall.theta > 0)}`,
      why: `Wall ${fixed(wall.rho, 2)} m away, nose ${fixed(Math.abs(towards), 0)}° ${towards >= 0 ? "towards" : "away from"} it: ` +
        `turning ${side(turn > 0)} ${fixed(Math.abs(degrees(turn)), 1)} °/s.`,
    };
  }
  const ahead = f.limit === "ground" ? ground_ahead(scene) : null;
  if (ahead) {
    const stands = Math.abs(f.command.v) < kLess;
    return { what: stands ? "Stopped before the ground ahead" : words.what, why: `${titled(ahead.words)}.` };
  }
  const near = nearest !== null ? ` The nearest is ${fixed(nearest, 2)} m from its middle.` : "";
  return { what: words.what, why: `${words.why}${near}` };
}
