// web/src/edit/laws.ts: the equations of docs/equations.md behind what the strip controllers show, with the
// numbers put in.
import { SceneState } from "../state/scene";
import { fixed } from "../words";

/** An equation, where it stands, and the same with its numbers. */
export interface Law { law: string; source: string; numbers: string }

type Reading = "original" | "published" | "linear" | "continuous";

/** How a controller reads the external force; equations.md E lists them. */
const kReadings: Record<string, Reading> = {
  original: "original", original_side: "original", modified_published: "published", modified_linear: "linear",
  modified_c1: "continuous", modified: "continuous", via_kept: "continuous",
};

/** Whether only the nearest return of all pushes. */
export function pushes_once(controller: string): boolean {
  return kReadings[controller] === "original";
}

/** The external force from a return at `d` [m] from the robot's centre; null for another kind of controller. */
export function external_law(scene: SceneState, d: number): Law | null {
  const reading = kReadings[scene.controller];
  const { k_r, strip_step: step } = scene.parameters;
  if (!reading || k_r === undefined || step === undefined) return null;
  const reach = scene.safety_distance + scene.radius;
  const n = (v: number) => fixed(v, 2);
  const within = d < reach;
  switch (reading) {
    case "original":
      return within
        ? { law: "K_r (d_o − d)", source: "Eq. 7", numbers: `${n(k_r)} (${n(reach)} − ${n(d)}) m` }
        : { law: "0 from d_o on", source: "Eq. 7", numbers: `d_o = ${n(reach)} m` };
    case "published":
      return within
        ? { law: "K_r (d_r − d)", source: "Eq. 13, E.2", numbers: `${n(k_r)} (${n(reach)} − ${n(d)}) m` }
        : { law: "0.001 m K_r d / (d − d_r)", source: "Eq. 14, E.2",
          numbers: `0.001 × ${n(k_r)} × ${n(d)} / (${n(d)} − ${n(reach)}) m` };
    case "linear":
      return within
        ? { law: "K_r (d_r − d)", source: "Eq. 13, E.2", numbers: `${n(k_r)} (${n(reach)} − ${n(d)}) m` }
        : { law: "0 from d_r on", source: "Eq. 13, E.2", numbers: `d_r = ${n(reach)} m` };
    case "continuous":
      return within
        ? { law: "S/2 + K_r (d_r − d)", source: "Eq. 13, E.3", numbers: `${n(step / 2)} + ${n(k_r)} (${n(reach)} − ${n(d)}) m` }
        : { law: "(S/2)² / (S/2 + K_r (d − d_r))", source: "E.3",
          numbers: `${n(step / 2)}² / (${n(step / 2)} + ${n(k_r)} (${n(d)} − ${n(reach)})) m` };
  }
}

/** The law of a force by the name of its layer; `of` gives the measures of the tick. */
export function force_law(scene: SceneState, layer: string, of: (name: string) => number | null): Law | null {
  const n = (name: string) => fixed(of(name), 3);
  switch (layer) {
    case "strip.internal":
      return { law: "K_c (d1/(d1 + d2) (P_end − P) − (P_via − P))", source: "Eq. 2-4",
        numbers: `K_c = ${fixed(scene.parameters.k_c, 2)}` };
    case "strip.push":
      return { law: "α |F_ext| to the chosen side", source: "E.4", numbers: `side ${of("strip.side") === 1 ? "left" : "right"}` };
    case "strip.elastic":
      return { law: "F_int + F_ext, and the push aside", source: "Eq. 9, E.4",
        numbers: `of lengths ${n("strip.internal")}; ${n("strip.left")} left, ${n("strip.right")} right; ${n("strip.push")} m` };
    default:
      return null;
  }
}

/** Of the nodes, cells and sectors, by the name of their layer. */
const kSources: Record<string, Law> = {
  "strip.nodes": { law: "P_end + F", source: "Eq. 10, 11", numbers: "" },
  "histogram.grid": { law: "C + 1 for each return, at most 15", source: "F.4", numbers: "" },
  "certainty.grid": { law: "O if O ≥ E, else −E", source: "F.2", numbers: "" },
  histogram: { law: "h' = Σ (l + 1 − |q|) h / (2l + 1)", source: "F.5", numbers: "" },
};
export function layer_law(layer: string): Law | null {
  return kSources[layer] ?? null;
}
