// web/src/plots/bar.tsx: the buttons above the plots, and the instant of the cursor.
import { ComponentChildren, JSX } from "preact";
import { icons } from "../ui/icons";

interface BarProps {
  folded: boolean | null; // null: the plots cannot be hidden
  on_fold: () => void;
  picking: boolean;
  on_pick: () => void;
  zoomed: boolean;
  on_zoom: (factor: number) => void;
  whole: string; // what the button back shows, in words
  on_whole: () => void;
  on_save: () => void;
  children: ComponentChildren; // the instant
}

export function PlotBar(props: BarProps): JSX.Element {
  const button = (name: string, label: string, hint: string, icon: JSX.Element, act: () => void, off = false) => (
    <button class="icon" aria-label={label} title={`${label}${hint}`} data-testid={`plot-${name}`} disabled={off} onClick={act}>{icon}</button>
  );
  return (
    <div class="plot-bar">
      {props.folded !== null && <button class="ghost" aria-expanded={!props.folded} data-testid="plots-fold"
        onClick={props.on_fold}>Plots{icons.down}</button>}
      {!props.folded && <button class="ghost pick-signals" aria-expanded={props.picking} data-testid="pick-signals"
        onClick={props.on_pick}>Signals{icons.down}</button>}
      <span class="plot-acts">
        {!props.folded && <>
          {button("in", "Zoom in", " (+)", icons.zoom_in, () => props.on_zoom(0.5))}
          {button("out", "Zoom out", " (-)", icons.zoom_out, () => props.on_zoom(2))}
          {button("whole", props.whole, " (0, or double click)", icons.whole, props.on_whole, !props.zoomed)}
        </>}
        {button("save", "Save pictures and tables", "", icons.download, props.on_save)}
      </span>
      <output class="num plot-time" data-testid="plot-time">{props.children}</output>
    </div>
  );
}
