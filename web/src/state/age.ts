// web/src/state/age.ts: the age of the drawn data. Times of arrival are by performance.now() [ms],
// stamps by the run clock [s].
import { SessionState } from "../contract";
import { SceneState } from "./scene";
import { PlacedSweep } from "./sweeps";

const kNewsLimit = 1.0; // [s] a working robot sends many frames a second
const kScanLimit = 0.5; // [s] at least; a robot with a slow scanner waits longer before it stops
const kAtRest = 0.01;   // [m/s], [rad/s] below the resolution of odometry

/** [s] Since the last frame; null while that is young, or the run rests. */
export function news_age(scene: SceneState, session: SessionState | null, open: boolean, now: number):
  number | null {
  if (scene.heard_at === null) return null;
  const age = (now - scene.heard_at) / 1000;
  if (!open) return age;
  const resting = !session || session.pace.paused || session.run?.status === "finished";
  return resting || age < kNewsLimit ? null : age;
}

/** [s] Age of a sweep at the newest tick; null while the robot may still drive by it. */
export function sweep_age(scene: SceneState, placed: PlacedSweep): number | null {
  const age = (scene.frame?.stamp ?? 0) - placed.sweep.stamp;
  return age > Math.max(kScanLimit, scene.scan_timeout) ? age : null;
}

/** [s] Age of the oldest scanner's sweep; null while the robot may drive by all of them. */
export function scan_age(scene: SceneState): number | null {
  const ages = scene.sweeps.map((s) => sweep_age(scene, s)).filter((a): a is number => a !== null);
  return ages.length > 0 ? Math.max(...ages) : null;
}

/** Speed of the robot by its wheels: [m/s], or [rad/s] if it only turns; 0 at rest. */
export function motion(scene: SceneState): { value: number; unit: string } {
  const { v = 0, omega = 0 } = scene.frame?.twist ?? {};
  if (Math.abs(v) >= kAtRest) return { value: v, unit: "m/s" };
  return { value: Math.abs(omega) >= kAtRest ? omega : 0, unit: "rad/s" };
}

/** "4 s", then "2 min 5 s". */
export function age_words(seconds: number): string {
  const s = Math.floor(seconds);
  return s < 60 ? `${s < 10 ? seconds.toFixed(1) : s} s` : `${Math.floor(s / 60)} min ${s % 60} s`;
}

/** "13.8 s ago", then "2 min 5 s ago": of an instant that somebody looks back at. */
export function ago_words(seconds: number): string {
  return `${seconds < 60 ? `${seconds.toFixed(1)} s` : age_words(seconds)} ago`;
}
