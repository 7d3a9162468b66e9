// web/src/link/route.ts: the place that an address names, such as #/runs/12?t=27.4&with=9,10: view,
// run, time in it, runs compared with it, and the camera.
import type { Camera } from "../draw/view";

const kViews: Record<string, ViewName> = { "": "drive", drive: "drive", teleop: "teleop", runs: "runs", experiments: "experiments", system: "system" };
/** `nowhere`: the address names no view. */
export type ViewName = "drive" | "teleop" | "runs" | "experiments" | "system" | "nowhere";

export interface Route {
  view: ViewName;
  run: number | null;     // opened in the Runs view
  experiment: string | null; // opened in the Experiments view
  time: number | null;    // [s] run clock
  compare: readonly number[]; // further runs, in their order
  camera: Camera | null;  // null: the world is fitted into the view
}

export const kMostCompared = 3; // beside the open run
const kFarthest = 1e5;           // [m] of a camera: no place of a world is farther

/** Reads a location's hash. What it cannot read counts as not there. */
export function parse_route(hash: string): Route {
  const [path, query = ""] = hash.replace(/^#\/?/, "").split("?");
  const [name, id = ""] = path.split("/");
  const run = run_number(id);
  const experiment = name === "experiments" && /^[0-9a-f]{16}$/.test(id) ? id : null;
  const known = Object.hasOwn(kViews, name) && (id === "" || (name === "runs" && run !== null) || experiment !== null);
  const view = known ? kViews[name] : "nowhere";
  if (run === null || view !== "runs") return { view, run: null, experiment, time: null, compare: [], camera: null };
  const given = new URLSearchParams(query);
  const others = (given.get("with") ?? "").split(",").map(run_number).filter((r) => r !== null && r !== run);
  const [time] = numbers(given.get("t"), 1) ?? [null];
  const [x, y, scale] = numbers(given.get("view"), 3) ?? [0, 0, 0];
  return {
    view, run, experiment: null, time: time !== null && time >= 0 ? time : null,
    compare: [...new Set(others as number[])].slice(0, kMostCompared),
    camera: scale > 0 && Math.max(Math.abs(x), Math.abs(y)) <= kFarthest ? { x, y, scale } : null,
  };
}

/** The hash of `route`. A time, a comparison and a camera belong to an open run. */
export function print_route(route: Pick<Route, "view"> & Partial<Route>): string {
  const { view, run = null, experiment = null, time = null, compare = [], camera = null } = route;
  if (experiment !== null) return `#/experiments/${experiment}`;
  if (run === null) return view === "nowhere" ? "#/" : `#/${view}`;
  const parts = [
    ...(time === null ? [] : [`t=${rounded(time, 3)}`]),
    ...(compare.length > 0 ? [`with=${compare.join(",")}`] : []),
    ...(camera ? [`view=${rounded(camera.x, 2)},${rounded(camera.y, 2)},${rounded(camera.scale, 1)}`] : []),
  ];
  return `#/${view}/${run}${parts.length > 0 ? `?${parts.join("&")}` : ""}`;
}

function run_number(text: string | undefined): number | null {
  return text !== undefined && /^[1-9]\d{0,14}$/.test(text) ? Number(text) : null;
}

/** `count` finite numbers with commas between them. */
function numbers(text: string | null, count: number): number[] | null {
  const list = (text ?? "").split(",").map((part) => (part.trim() === "" ? NaN : Number(part)));
  return list.length === count && list.every(Number.isFinite) ? list : null;
}

function rounded(value: number, digits: number): number {
  return Number(value.toFixed(digits));
}
