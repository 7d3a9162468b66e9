// web/src/views/layers.tsx: the button of the layers, and whether filtered scans are wanted.
import { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { use_app } from "../app";
import { kOwn } from "../state/layers";
import { use_latest, use_store } from "../state/store";
import { icons } from "../ui/icons";
import { lazy } from "../ui/lazy";

export const LayerPanel = lazy(async () => (await import("./layer_panel")).LayerPanel);

/** Tells whether filtered scans are needed: their layer is on and the tab is visible. */
export function use_filtered(tell: (wanted: boolean) => void): void {
  const app = use_app();
  const on = use_store(app.ui, (u) => !u.hidden.has(kOwn.filtered.name));
  const latest = use_latest(tell);
  useEffect(() => {
    const update = () => latest.current(on && document.visibilityState === "visible");
    update();
    document.addEventListener("visibilitychange", update);
    return () => {
      document.removeEventListener("visibilitychange", update);
      latest.current(false);
    };
  }, [on]);
}

export function LayerButton(props: { open: boolean; on_press: (open: boolean) => void; class?: string }): JSX.Element {
  return (
    <button class={`${props.class ?? ""} ${props.open ? "on" : ""}`} aria-label="Layers: the meaning of the colours"
      aria-expanded={props.open} title="Layers (L)" data-testid="layers"
      onClick={() => props.on_press(!props.open)}>{icons.layers}</button>
  );
}
