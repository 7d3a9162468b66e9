// web/src/state/remembered.ts: the theme, the tool, the view in 2D or 3D and the cameras of each scenario, which the
// browser keeps from visit to visit.
import { Camera } from "../draw/view";
import type { Tool } from "../edit/gestures";
import { keep, kept } from "./store";

export type Theme = "dark" | "light";

const kTheme = "tautline.theme";
const kTool = "tautline.tool";
const kThree = "tautline.three";
const kCameras = "tautline.cameras";
const kOrbits = "tautline.orbits";
const kMostCameras = 40; // the one that was kept first goes first
const kTools: Record<Tool, true> = {
  pan: true, goal: true, hand: true, start: true, pose: true, cylinder: true, box: true, wall: true, polygon: true, mover: true, measure: true, ramp: true, step: true, trench: true,
};

export function stored_theme(): Theme {
  const preferred = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
  return kept<Theme>(kTheme, preferred, (text) => (text === "dark" || text === "light" ? text : preferred));
}
export const store_theme = (theme: Theme): void => keep(kTheme, theme);

export const stored_tool = (): Tool => kept<Tool>(kTool, "pan", (text) => (text in kTools ? (text as Tool) : "pan"));
export const store_tool = (tool: Tool): void => keep(kTool, tool);

export const stored_three = (): boolean => kept(kThree, false, (text) => text === "true");
export const store_three = (three: boolean): void => keep(kThree, String(three));

/** A value of each scenario, of which the browser keeps the newest. */
function by_scenario<T>(key: string, valid: (value: unknown) => boolean) {
  const all = () => kept<[string, T][]>(key, [], (text) => {
    const list: unknown = JSON.parse(text);
    return Array.isArray(list) ? (list as [string, T][]).filter((entry) => Array.isArray(entry) && valid(entry[1])) : [];
  });
  const get = (scenario: string): T | null => all().find(([name]) => name === scenario)?.[1] ?? null;
  const set = (scenario: string, value: T | null): void => {
    if (!value && !get(scenario)) return;
    const others = all().filter(([name]) => name !== scenario);
    keep(key, JSON.stringify([...others, ...(value ? [[scenario, value]] : [])].slice(-kMostCameras)));
  };
  return { get, set };
}

function numbers(values: unknown[]): boolean {
  return values.every(Number.isFinite);
}

/** Where a hand has put the view from above; without one the world is fitted. */
export const cameras = by_scenario<Camera>(kCameras, (value) => {
  const c = value as Camera | null;
  return typeof c === "object" && c !== null && numbers([c.x, c.y, c.scale]);
});

/** The eye of the 3D view and the point that it looks at [m], W. */
export interface Orbit { eye: number[]; target: number[] }

export const orbits = by_scenario<Orbit>(kOrbits, (value) => {
  const o = value as Orbit | null;
  const point = (p: unknown) => Array.isArray(p) && p.length === 3 && numbers(p);
  return typeof o === "object" && o !== null && point(o.eye) && point(o.target);
});
