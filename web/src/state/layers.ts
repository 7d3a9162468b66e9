// web/src/state/layers.ts: the layers of the page and of the controller, and which of them are switched off.
import type { Palette } from "../draw/palette";
import { LayerKind, LayerStyle, LayerView, Tone } from "../layer";
import { sweep_age } from "./age";
import { kRing } from "./stick";
import type { SceneState } from "./scene";
import { keep, kept } from "./store";

export type Token = Exclude<keyof Palette, "font">;

/** The colour of each meaning; Foxglove's views have the same. */
const kTokens: Record<Tone, Token> = {
  accent: "accent", internal: "internal", external: "external", elastic: "elastic", plan: "accent", moving: "warn",
  muted: "muted", refused: "bad", good: "ok",
};

/** The straight line from the strip's end to the goal. It is no part of the strip and heeds no obstacle. */
const kStraightOn = "strip.ahead";

/** The colour of a layer. */
export function token_of(layer: { name: string; tone: Tone }): Token {
  if (layer.name === kRing) return "filtered"; // drawn as sectors, which are sensed
  return layer.name === kStraightOn ? "ok" : kTokens[layer.tone];
}
/** True for lines that nobody has driven or proved: they are drawn thin and dotted. */
export function is_sketched(layer: { name: string; tone: Tone }): boolean {
  return layer.tone === "plan" || layer.name === kStraightOn;
}

/** A layer as the legend lists it. */
export interface LayerKey {
  name: string;
  label: string;
  token: Token;
  kind: LayerKind | "mesh" | "solid"; // of its swatch
  style: LayerStyle;
  scaled: boolean; // its arrows may be drawn enlarged
  always: boolean; // has no switch
}

export const own = (name: string, label: string, token: Token, kind: LayerKey["kind"], style: LayerStyle = "solid",
  always = false): LayerKey => ({ name, label, token, kind, style, scaled: false, always });

/** The layers of every robot, with any controller. */
export const kOwn = {
  scan: own("scan", "Raw scan", "scan", "points"),
  filtered: own("filtered", "Filtered scan", "filtered", "points"),
  ranging: own("ranging", "Sonar, infrared", "scan", "arcs"),
  bumpers: own("bumpers", "Bumper, pressed", "bad", "arcs", "solid", true),
  path: own("path", "Travelled, by odometry", "path", "polyline"),
  wanted: own("teleop.wanted", "Stick, 3 s on", "accent", "polyline", "dashed"),
  executed: own("teleop.executed", "Robot, 3 s on", "path", "polyline"),
  truth: own("truth", "True path and hull", "muted", "polyline", "dashed"),
  route: own("route", "Route of goals", "ok", "polyline", "dashed"),
  goal: own("goal", "Goal", "ok", "circles", "solid", true),
  safety: own("safety", "Safety circle", "safe", "circles", "dashed"),
  robot: own("robot", "Robot, its hull", "robot", "circles", "solid", true),
  start: own("start", "Start", "muted", "arrows", "solid", true),
  ways: own("ways", "Ways of movers", "obstline", "polyline", "dashed"),
  ground: own("ground", "Ramps, trenches", "high", "solid"),
  obstacles: own("obstacles", "Obstacles", "obstline", "solid", "solid", true),
  map: own("map", "Known map", "muted", "grid"),
  sure: own("map.sure", "Pose on the map, 95 %", "path", "circles"),
  mesh: own("mesh", "Grid, 1 m", "muted", "mesh"),
};

/** True for forces: displacements without a unit, which may be drawn enlarged to be seen. */
export function is_scaled(layer: LayerView): boolean {
  return layer.kind === "arrows" && layer.unit === "" && layer.name !== kRing;
}

/** `hidden` without the forces among the `known` layers. */
export function forces_shown(hidden: ReadonlySet<string>, known: Map<string, LayerKey>): ReadonlySet<string> {
  return new Set([...hidden].filter((name) => !known.get(name)?.scaled));
}

/** Adds the keys of new `layers` to `known`. */
export function learn_layers(known: Map<string, LayerKey>, layers: LayerView[]): void {
  for (const layer of layers) {
    if (known.has(layer.name)) continue;
    const { name, label } = layer;
    const { kind, style } = name === kRing ? { kind: "arcs" as const, style: "solid" as const } : layer;
    known.set(name, { name, label, token: token_of(layer), kind, style, scaled: is_scaled(layer), always: false });
  }
}

/** True for layers of the sensors, false for those of the controller. */
export function is_sensed(name: string): boolean {
  return name.startsWith("scan.") || name === kRing;
}

/** The layers to draw: those that are on, and none that was sensed in an old scan. */
export function visible_layers(scene: SceneState, hidden: ReadonlySet<string>): LayerView[] {
  const old = scene.sweeps.some((s) => sweep_age(scene, s) !== null);
  return [...scene.layers.values()].filter((l) => !hidden.has(l.name) && !(old && is_sensed(l.name)));
}

const kHidden = "tautline.layers.hidden";
const kOpen = "tautline.layers.open";
const kRoomFor = 1240; // [px] of a window in which the panel leaves the scene enough

/** The layers that were switched off at the last visit. */
export function stored_hidden(): ReadonlySet<string> {
  return kept(kHidden, new Set([kStraightOn]), (text) => new Set(JSON.parse(text) as string[]));
}

/** `hidden` with the layer `name` switched the other way, and kept for the next visit. */
export function toggled(hidden: ReadonlySet<string>, name: string): ReadonlySet<string> {
  const next = new Set(hidden);
  if (!next.delete(name)) next.add(name);
  keep(kHidden, JSON.stringify([...next]));
  return next;
}

/** Whether the panel was open at the last visit; at first it is open in a wide window. */
export function stored_open(): boolean {
  return kept(kOpen, innerWidth >= kRoomFor, (text) => text === "true");
}

export function store_open(open: boolean): void {
  keep(kOpen, String(open));
}
