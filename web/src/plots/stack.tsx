// web/src/plots/stack.tsx: the chosen signals of one or several runs as plots below each other, with
// one piece of time and one cursor.
import { JSX } from "preact";
import { useRef, useState } from "preact/hooks";
import { is_shown, signals_of_all, store_choices, stored_choices } from "../state/measures";
import { keep, kept } from "../state/store";
import css from "../style/plots.css?text";
import { adopt } from "../ui/sheet";
import "../ui/swatch";
import { fixed } from "../words";
import { PlotBar } from "./bar";
import { PlotCanvas } from "./canvas";
import { kAxis } from "./chart";
import { Picker } from "./picker";
import { SaveDialog, SaveProps } from "./save_dialog";
import { Span, Zoom, choice_of, panned, shown_span, zoomed } from "./span";
import { Plot, PlotRun, chart_of, plots_with, value_words, whole_of } from "./traces";

adopt(css);

interface StackProps {
  runs: PlotRun[];     // the first one's ticks are those of the cursor
  live: boolean;
  time: number | null; // [s] of the shown instant; null: the newest
  usual: number;       // [s] of the end that are shown at first
  height: number;      // [px] of a plot
  /** Shows another instant; absent: the cursor only shows values. */
  seek?: (t: number) => void;
  follows: boolean;    // the pointer's instant is shown as it moves
  folds: boolean;      // a button hides the plots, so that the scene has their room
  save: SaveProps;
}

const kFolded = "tautline.plots.folded";
const kRoomFor = 560; // [px] of a window's height in which plots leave the scene enough
const stored_folded = () => kept(kFolded, innerHeight < kRoomFor, (text) => text === "true");

/** The cursor, the shown span of time, and the functions that move both. */
function use_times(props: StackProps) {
  const { runs, live, seek } = props;
  const [zoom, set_zoom] = useState<Zoom>(null);
  const [hovered, set_hovered] = useState<number | null>(null);
  const [band, set_band] = useState<Span | null>(null);
  const whole = whole_of(runs);
  const span = shown_span(zoom, whole, props.usual);
  const cursor = hovered ?? props.time;
  const columns = runs[0].columns;
  const row = columns.length === 0 ? null : cursor === null ? columns.length - 1 : columns.row_at(cursor);
  const middle = (span.from + span.to) / 2;

  const show = (next: Span) => set_zoom(choice_of(zoomed(next, next.from, 1, whole), whole, live));
  const scale = (at: number, factor: number) => show(zoomed(span, at, factor, whole));
  const pan = (by: number) => show(panned(span, by, whole));
  const hover = (t: number | null) => {
    set_hovered(t);
    if (t !== null && props.follows) seek?.(t);
  };
  const go_to = (next: number) => {
    if (row === null) return;
    const t = columns.at("t", Math.max(0, Math.min(columns.length - 1, next)));
    set_hovered(seek ? null : t);
    seek?.(t);
    if (t < span.from || t > span.to) pan(t - middle);
  };
  const on_key = (e: KeyboardEvent) => {
    const rows = e.shiftKey ? 10 : 1;
    const at = cursor !== null && cursor >= span.from && cursor <= span.to ? cursor : middle;
    const acts: Record<string, () => void> = {
      ArrowLeft: () => go_to((row ?? 0) - rows), ArrowRight: () => go_to((row ?? 0) + rows),
      Home: () => go_to(0), End: () => go_to(Infinity),
      "+": () => scale(at, 0.5), "=": () => scale(at, 0.5), "-": () => scale(at, 2),
      PageUp: () => pan(span.from - middle), PageDown: () => pan(span.to - middle),
      "0": () => set_zoom(null), Escape: () => (zoom === null ? set_hovered(null) : set_zoom(null)),
    };
    const act = acts[e.key];
    if (!act || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault();
    e.stopPropagation();
    act();
  };
  return {
    span, cursor, zoomed: zoom !== null, back: () => set_zoom(null), scale: (factor: number) => scale(middle, factor), on_key,
    tick: row === null ? null : { t: columns.at("t", row), number: columns.at("tick", row) },
    canvas: { look: { span, cursor, band }, hover, band: set_band, seek: (t: number) => seek?.(t), show, zoom: scale, pan },
  };
}

export function PlotStack(props: StackProps): JSX.Element {
  const box = useRef<HTMLDivElement>(null);
  const [choices, set_choices] = useState(stored_choices);
  const [picking, set_picking] = useState(false);
  const [saving, set_saving] = useState(false);
  const [folded, set_folded] = useState(() => props.folds && stored_folded());
  const times = use_times(props);
  const signals = signals_of_all(props.runs.map((r) => r.columns));
  const plots = plots_with(signals.filter((s) => is_shown(s, choices)), props.runs);
  const { tick, span, cursor } = times;
  return (
    <div class="plots" ref={box} data-testid="plots">
      <PlotBar folded={props.folds ? folded : null} on_fold={() => {
        set_folded(!folded);
        set_picking(false);
        keep(kFolded, String(!folded));
      }} picking={picking} on_pick={() => set_picking(!picking)} zoomed={times.zoomed} on_zoom={times.scale}
        whole={props.live ? "Back to the last seconds" : "The whole run"} on_whole={times.back} on_save={() => set_saving(true)}>
        {tick ? <>{fixed(tick.t, 2)} s<span> · tick {tick.number}</span></> : "–"}
      </PlotBar>
      {picking && <Picker signals={signals} choices={choices} on_choose={(next) => {
        set_choices(next);
        store_choices(next);
      }} on_close={() => {
        set_picking(false);
        box.current?.querySelector<HTMLElement>(".pick-signals")?.focus();
      }} />}
      {!folded && plots.length === 0 && <p class="quiet">No signal is chosen. Press Signals to choose some.</p>}
      {!folded && plots.length > 0 && <div class="plot-rows" role="slider" tabIndex={0} aria-label="Cursor of the plots"
        data-testid="plot-cursor" aria-valuemin={span.from} aria-valuemax={span.to} aria-valuenow={tick?.t ?? span.from}
        aria-valuetext={`${fixed(tick?.t, 2)} s: ${plots.flatMap((p) => p.traces).map((t) => `${t.label} ${value_words(t, cursor)}`).join("; ")}`}
        onKeyDown={times.on_key} onDblClick={times.back}>
        {plots.map((plot) => (
          <div class="plot-row" key={plot.title}>
            <Caption plot={plot} cursor={cursor} />
            <PlotCanvas name={plot.traces[0].signal.name} height={props.height} {...times.canvas}
              chart={(width) => chart_of(plot, span, 2 * width)} />
          </div>
        ))}
        <div class="plot-axis"><PlotCanvas name="axis" height={kAxis} {...times.canvas} chart={null} /></div>
      </div>}
      {saving && <SaveDialog {...props.save} on_close={() => set_saving(false)} sheet={() => ({
        title: props.save.title, span, cursor,
        plots: plots.map((plot) => ({ title: plot.title, chart: chart_of(plot, span, 1600) })),
      })} />}
    </div>
  );
}

/** The name and unit of a plot, and the value of each line at the cursor. */
function Caption(props: { plot: Plot; cursor: number | null }): JSX.Element {
  const { title, traces } = props.plot;
  return (
    <div class="plot-caption">
      <b>{title}</b>
      {traces.map((t) => (
        <span class="plot-value" key={t.label} title={t.signal.meaning}>
          <i class={`swatch c-${t.colour} ${t.dash.length === 0 ? "" : t.dash[0] > 2 ? "dashed" : "dotted"}`} />{t.label}{" "}
          <output class="num" data-testid={`value-${t.signal.name}`} data-run={t.run.label}>{value_words(t, props.cursor)}</output>
        </span>
      ))}
    </div>
  );
}
