// web/src/state/layers.ts: the layers of the page and of the controller, and which of them are
// switched off.
import type { Palette } from "../draw/palette";
import { LayerKind, LayerStyle, LayerView, Tone } from "../layer";
import type { SceneState } from "./scene";
import { keep, kept } from "./store";

export type Token = Exclude<keyof Palette, "font">;

/** The colour of each meaning; Foxglove's views have the same. */
export const kTokens: Record<Tone, Token> = {
  accent: "accent", internal: "internal", external: "external", elastic: "elastic", plan: "accent", moving: "warn",
  muted: "muted", refused: "bad", good: "ok",
};

/** A layer as the panel lists it. */
export interface LayerKey {
  name: string;
  label: string;
  token: Token;
  kind: LayerKind;
  style: LayerStyle;
  scaled: boolean; // its arrows may be drawn enlarged
}

const own = (name: string, label: string, token: Token, kind: LayerKind, style: LayerStyle = "solid"): LayerKey =>
  ({ name, label, token, kind, style, scaled: false });

/** The layers of every robot, with any controller. */
export const kOwn = {
  scan: own("scan", "Raw scan", "scan", "points"),
  filtered: own("filtered", "Filtered scan", "filtered", "points"),
  ranging: own("ranging", "Sonar, infrared", "scan", "arcs"),
  path: own("path", "Travelled path", "path", "polyline"),
  safety: own("safety", "Safety circle", "safe", "circles", "dashed"),
};

/** True for forces: displacements without a unit, which may be drawn enlarged to be seen. */
export function is_scaled(layer: LayerView): boolean {
  return layer.kind === "arrows" && layer.unit === "";
}

/** Adds the keys of new `layers` to `known`. */
export function learn_layers(known: Map<string, LayerKey>, layers: LayerView[]): void {
  for (const layer of layers) {
    if (known.has(layer.name)) continue;
    const { name, label, tone, kind, style } = layer;
    known.set(name, { name, label, token: kTokens[tone], kind, style, scaled: is_scaled(layer) });
  }
}

/** True for layers of the sensors, false for those of the controller. */
export function is_sensed(name: string): boolean {
  return name.startsWith("scan.");
}

interface LayerGroup { title: string; keys: LayerKey[] }

/** The rows of the panel. A log has only sensors and the path. */
export function layer_groups(scene: SceneState, method: string): LayerGroup[] {
  const known = [...scene.known.values()];
  return [
    { title: "Senses", keys: [kOwn.scan, kOwn.filtered, ...(scene.readings.size > 0 ? [kOwn.ranging] : []),
      ...known.filter((k) => is_sensed(k.name))] },
    { title: method, keys: known.filter((k) => !is_sensed(k.name)) },
    { title: "Robot", keys: [kOwn.path, ...(scene.world ? [kOwn.safety] : [])] },
  ].filter((group) => group.keys.length > 0);
}

const kHidden = "tautline.layers.hidden";
const kOpen = "tautline.layers.open";
const kRoomFor = 1240; // [px] of a window in which the panel leaves the scene enough

/** The layers that were switched off at the last visit. */
export function stored_hidden(): ReadonlySet<string> {
  return kept(kHidden, new Set<string>(), (text) => new Set(JSON.parse(text) as string[]));
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
