// web/src/link/legend.ts: the names, units and kinds of a frame's layers and measures. Frames bring
// them when they have changed and every two seconds; the page remembers them.
import { LayerView, kLayerKinds, kLayerStyles, kTones } from "../layer";
import * as wire from "../wire/telemetry_generated";

/** A number of the controller's method. */
export interface Measure { name: string; unit: string; value: number }

type LayerLook = Omit<LayerView, "values" | "cells" | "text">;
export interface Legend {
  layers: (LayerLook | null)[]; // null: a kind that this page does not know
  measures: { name: string; unit: string }[];
}

const kMost = 64; // legends; a run has a few, and the oldest one goes first

/** Legends by their number, which is the same in every run. */
export class Legends {
  private held_ = new Map<number, Legend>();

  /** Takes the legend that `f` brings, if it brings one. */
  learn(f: wire.Frame): void {
    const news = f.news();
    if (!news || (news.layersLength() === 0 && !news.measures()) || this.held_.has(legend_of(f))) return;
    const layers: (LayerLook | null)[] = [];
    for (let i = 0; i < news.layersLength(); ++i) layers.push(look_of(news.layers(i)!));
    const names = news.measures()?.split("\n") ?? [];
    const units = news.units()?.split("\n") ?? [];
    const measures = names.map((name, i) => ({ name, unit: units[i] ?? "" }));
    this.held_.set(legend_of(f), { layers, measures });
    if (this.held_.size > kMost) this.held_.delete(this.held_.keys().next().value!);
  }

  find(number: number): Legend | null {
    return this.held_.get(number) ?? null;
  }
}

/** The number of the legend of `f`. */
export function legend_of(f: wire.Frame): number {
  return f.decision()?.legend() ?? 0;
}

function look_of(info: wire.LayerInfo): LayerLook | null {
  const name = info.name() ?? "";
  const kind = kLayerKinds[info.kind()];
  return kind === undefined ? null : {
    name,
    label: info.label() ?? name,
    unit: info.unit() ?? "",
    kind,
    robot: info.frame() === wire.LayerFrame.Robot,
    tone: kTones[info.tone()] ?? "muted",
    style: kLayerStyles[info.style()] ?? "solid",
    axes: info.axes(),
    level: info.level(),
  };
}

const kSteps = 1024; // of a metre, a radian, ...
const kNoNumber = -32768;

/** The layers of `f` that have values, and its measures; none before their legend is known. */
export function shown(f: wire.Frame, legend: Legend | null): { layers: LayerView[]; measures: Measure[] } {
  if (!legend) return { layers: [], measures: [] };
  const narrow = f.shownArray();
  const numbers = narrow ?? f.shownWideArray() ?? new Int16Array(0);
  const value_of = (n: number | undefined): number =>
    n === undefined || (narrow && n === kNoNumber) ? NaN : narrow ? n / kSteps : n;
  const more = new Map<number, wire.LayerMore>();
  for (let i = 0; i < f.moreLength(); ++i) more.set(f.more(i)!.layer(), f.more(i)!);
  const layers: LayerView[] = [];
  let at = 0;
  legend.layers.forEach((look, i) => {
    const count = numbers[at++] ?? 0;
    if (count > 0 && look) {
      layers.push({
        ...look,
        values: Float32Array.from(numbers.subarray(at, at + count), value_of),
        cells: more.get(i)?.cellsArray()?.slice() ?? new Uint8Array(0),
        text: more.get(i)?.text()?.split("\n") ?? [],
      });
    }
    at += count;
  });
  const measures = legend.measures.map((m, i) => ({ ...m, value: value_of(numbers[at + i]) }));
  return { layers, measures };
}
