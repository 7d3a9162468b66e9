// web/src/state/terrain.ts: what a scene tells of the ground ahead and of the robot's stand: the values that the terrain
// card draws, as the frame brings them.
import { Point, distance, to_child } from "../geometry";
import { places } from "../layer";
import { measure } from "./driven";
import type { SceneState } from "./scene";

/** The classes of ground in the order of algo::GroundClass; "ground.class" is the index. */
const kClasses = ["slope up", "slope down", "step up", "step down", "trench", "flat", "pending", "unknown"] as const;
export type GroundClass = (typeof kClasses)[number];

/** The ground that four sensors read. [m], [rad], upwards positive; null: no value now. */
export interface Ahead {
  kind: GroundClass;
  words: string;             // the verdict of the frame; without one the name of the class
  height: number | null;
  slope: number | null;
  width: number | null;      // of a trench
  confidence: number | null; // 0 .. 1
  distance: number | null;   // from the nose to the edge, where an edge is known
}

const kMostTurn = 10; // [rad/s] that is drawn

/** Turn rates that do not turn the robot over [rad/s]; left is positive. */
export interface Band { min: number; max: number; commanded: number; top: number }

const kAtRobot = 0.01; // [m] from its centre: the wire has steps of a millimetre

export function ground_ahead(scene: SceneState): Ahead | null {
  const at = measure(scene, "ground.class");
  if (at === null) return null;
  const kind = kClasses[at] ?? "unknown";
  const words = scene.layers.get("ground.verdict")?.text.filter(Boolean).join(", ") || kind;
  return {
    kind, words, height: measure(scene, "ground.height"), slope: measure(scene, "ground.slope"),
    width: measure(scene, "ground.width"), confidence: measure(scene, "ground.confidence"), distance: edge_distance(scene),
  };
}

/** [m] From the hull to the edge ahead. The verdict stands at its middle; without an edge it stands at the robot. */
function edge_distance(scene: SceneState): number | null {
  const verdict = scene.layers.get("ground.verdict");
  const { frame, hull, radius } = scene;
  const at = verdict && frame ? places(verdict, frame.pose)[0] : undefined;
  if (!at || !frame || distance(at, frame.pose) < kAtRobot) return null;
  return Math.max(0, to_child(frame.pose, at).x - (hull?.half_length ?? radius));
}

export function turn_band(scene: SceneState): Band | null {
  const value = (name: string) => scene.frame?.measures.find((m) => m.name === name)?.value ?? NaN;
  const [min, max] = [value("turnover.w_min"), value("turnover.w_max")];
  if (Number.isNaN(min) || Number.isNaN(max)) return null;
  const top = Math.min(kMostTurn, scene.top.omega); // a bound may be infinite: nothing turns the robot over
  return { min: Math.max(-top, min), max: Math.min(top, max), commanded: scene.frame?.command.omega ?? 0, top };
}

/** Roll and pitch at the place ahead, and how much more tilt the robot stands [rad]. */
export function predicted_stand(scene: SceneState): { roll: number; pitch: number; margin: number | null } | null {
  const [roll, pitch] = [measure(scene, "turnover.roll_predicted"), measure(scene, "turnover.pitch_predicted")];
  const margin = measure(scene, "turnover.margin");
  return roll === null || pitch === null ? null : { roll, pitch, margin };
}

/** The laser line across the way: its points from left to right, y to the left and z up in R, and how far ahead [m]; the
 * slope of the ground under it, up and left side up positive [rad], where it is known. */
export interface LineAcross { points: { y: number; z: number }[]; ahead: number; slope: number | null; roll: number | null }

export function line_across(scene: SceneState): LineAcross | null {
  const layer = scene.layers.get("terrain.line");
  if (!layer || !scene.frame) return null;
  const { pose } = scene.frame;
  const all = places(layer, pose).filter((p) => Number.isFinite(p.x) && Number.isFinite(p.z ?? NaN))
    .map((p) => ({ ...to_child(pose, p as Point), z: p.z! }));
  if (all.length < 2) return null;
  const ahead = all.reduce((sum, p) => sum + p.x, 0) / all.length;
  const points = all.map(({ y, z }) => ({ y, z })).sort((a, b) => b.y - a.y);
  return { points, ahead, slope: measure(scene, "terrain.profile_slope"), roll: measure(scene, "terrain.profile_roll") };
}
