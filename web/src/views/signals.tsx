// web/src/views/signals.tsx: the last seconds of a live run: the signals of every robot, and the
// measures of its controller by name.
import { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Line, Plot, every, gapped } from "../plots/plot";
import { MeasureKey } from "../state/columns";
import { use_pulse } from "../state/store";
import { fixed } from "../words";

const kWindow = 20; // [s] of run clock
const kMostPoints = 900;

interface SignalLine extends Line { column: string; unit: string }
interface SignalSpec { name: string; lines: SignalLine[]; least: [number, number] }

const kSignals: SignalSpec[] = [
  { name: "Clearance", least: [0, 1],
    lines: [{ label: "Clearance", colour: "filtered", column: "clearance", unit: "m" }] },
  { name: "Speed, turn rate", least: [-0.1, 0.2],
    lines: [{ label: "Speed", colour: "ok", column: "v", unit: "m/s" },
      { label: "Turn rate", colour: "path", column: "omega", unit: "rad/s", dash: [5, 3] }] },
];

/** Measures with the name of a meaning have its colour; the others get one in turn. */
const kMeaning: Record<string, Pick<Line, "colour" | "dash">> = {
  internal: { colour: "internal" }, elastic: { colour: "elastic" },
  left: { colour: "external" }, right: { colour: "external", dash: [5, 3] },
};
const kInTurn: Pick<Line, "colour" | "dash">[] = [
  { colour: "accent" }, { colour: "filtered" }, { colour: "path", dash: [5, 3] }, { colour: "ok", dash: [2, 3] },
];

/** "strip.left" as "Left" below "Strip". */
export function measure_words(name: string): { of: string; label: string } {
  const parts = name.split(".");
  const word = (text: string) => (text.charAt(0).toUpperCase() + text.slice(1)).replaceAll("_", " ");
  return { of: word(parts[0]), label: word(parts.slice(1).join(" ") || parts[0]) };
}

/** Measures of one thing and one unit share a plot. */
function measure_signals(measures: MeasureKey[]): SignalSpec[] {
  const groups = new Map<string, MeasureKey[]>();
  for (const m of measures) {
    const key = `${measure_words(m.name).of} ${m.unit}`;
    groups.set(key, [...(groups.get(key) ?? []), m]);
  }
  return [...groups.values()].map((group) => {
    const { of, label } = measure_words(group[0].name);
    const { unit } = group[0];
    const lines = group.map(({ name }, i) => ({
      label: measure_words(name).label, column: name, unit,
      ...(kMeaning[name.split(".").at(-1)!] ?? kInTurn[i % kInTurn.length]),
    }));
    const name = group.length === 1 ? `${of}: ${label.toLowerCase()}` : unit ? `${of}, ${unit}` : of;
    return { name, lines, least: [0, 0.2] };
  });
}

export function Signals(): JSX.Element {
  const app = use_app();
  use_pulse(500); // a controller's measures come with its frames
  const specs = [...kSignals, ...measure_signals(app.scene.columns.measures)];
  return (
    <section class="signals">
      <h2>Signals <small>last {kWindow} s</small></h2>
      {specs.map((s) => <Signal key={s.lines.map((l) => l.column + l.unit).join()} spec={s} />)}
    </section>
  );
}

function Signal(props: { spec: SignalSpec }): JSX.Element {
  const app = use_app();
  const { theme } = use_ui("theme");
  const box = useRef<HTMLDivElement>(null);
  const values = useRef<HTMLElement[]>([]);
  const plot = useRef<Plot | null>(null);
  const { name, lines, least } = props.spec;
  useEffect(() => {
    plot.current = new Plot(box.current!, lines, 66, least);
    let seen = -1;
    let seen_at = NaN;
    const update = () => {
      const { columns } = app.scene;
      const end = columns.length;
      const t = end > 0 ? columns.at("t", end - 1) : 0;
      if (end === seen && t === seen_at) return;
      seen = end;
      seen_at = t;
      const from = columns.row_at(t - kWindow);
      const step = Math.floor((end - from) / kMostPoints);
      const cut = (column: string) => every(columns.get(column).subarray(from, end), step);
      plot.current!.update([cut("t"), ...lines.map((l) => gapped(cut(l.column)))],
        Math.max(0, t - kWindow), Math.max(t, kWindow), null);
      lines.forEach((l, i) => {
        const value = end > 0 ? columns.at(l.column, end - 1) : null;
        values.current[i].textContent = `${fixed(value, 2)}${l.unit && ` ${l.unit}`}`;
      });
    };
    const timer = setInterval(update, 100);
    update();
    return () => {
      clearInterval(timer);
      plot.current?.destroy();
    };
  }, []);
  useEffect(() => plot.current?.theme(), [theme]);
  const value = (i: number) => (
    <b class="num" ref={(e) => void (e && (values.current[i] = e))} />
  );
  return (
    <figure class="signal" aria-label={`${name} over the last ${kWindow} seconds`}>
      <figcaption><span>{name}</span>{lines.length === 1 && value(0)}</figcaption>
      <div class="plot" ref={box} />
      {lines.length > 1 && <span class="key">
        {lines.map((l, i) => (
          <span key={l.column}><i class={`swatch c-${l.colour} ${l.dash ? "dashed" : ""}`} />{l.label} {value(i)}</span>
        ))}
      </span>}
    </figure>
  );
}
