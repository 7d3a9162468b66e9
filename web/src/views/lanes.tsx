// web/src/views/lanes.tsx: the signals of a stored run over its whole time, with a cursor. A second
// run has the second colour.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { use_ui } from "../app";
import { StoredRun } from "../link/stored";
import { Plot, every, gapped, resampled } from "../plots/plot";
import { use_latest } from "../state/store";
import { Pick } from "../ui/controls";
import { fixed } from "../words";
import { measure_words } from "./signals";

interface Lane { name: string; column: string; unit: string; least: [number, number]; digits: number }
const kLanes: Lane[] = [
  { name: "Clearance", column: "clearance", unit: "m", least: [0, 1], digits: 2 },
  { name: "Speed", column: "v", unit: "m/s", least: [0, 0.2], digits: 2 },
  { name: "Turn rate", column: "omega", unit: "rad/s", least: [-0.2, 0.2], digits: 2 },
];
const kMostPoints = 2000;

interface LanesProps {
  run: StoredRun; other: StoredRun | null; time: number; on_pick: (t: number) => void;
}

export function Lanes(props: LanesProps): JSX.Element {
  const [picked, pick] = useState<string | null>(null);
  const { measures } = props.run.columns;
  const measure = measures.find((m) => m.name === picked) ?? measures.at(0);
  const rows: [Lane, JSX.Element | undefined][] = kLanes.map((lane) => [lane, undefined]);
  if (measure) {
    const words = measures.map(({ name }) => measure_words(name));
    const choices = words.map(({ of, label }, i) => ({
      name: measures[i].name,
      label: words.some((other, k) => k !== i && other.label === label) ? `${of}: ${label.toLowerCase()}` : label,
    }));
    rows.push([{ name: measure.name, column: measure.name, unit: measure.unit, least: [0, 0.2], digits: 2 },
      <Pick label="Measure of the controller" name="lane-measure" value={measure.name} choices={choices}
        on_pick={pick} />]);
  }
  return (
    <>
      {rows.map(([lane, title]) =>
        <LaneRow key={lane.column + (props.other ? "2" : "1")} lane={lane} title={title} {...props} />)}
    </>
  );
}

function LaneRow(props: LanesProps & { lane: Lane; title?: JSX.Element }): JSX.Element {
  const { lane, run, other } = props;
  const { theme } = use_ui("theme");
  const box = useRef<HTMLDivElement>(null);
  const plot = useRef<Plot | null>(null);
  const pick = use_latest(props.on_pick);
  useEffect(() => {
    const lines = [{ label: lane.name, colour: "accent" as const, width: 1.8 }];
    const both = other ? [...lines, { label: "second", colour: "elastic" as const, width: 1.8 }] : lines;
    plot.current = new Plot(box.current!, both, 46, lane.least, (t) => pick.current(t));
    return () => plot.current?.destroy();
  }, []);
  useEffect(() => plot.current?.theme(), [theme]);
  useEffect(() => {
    const t = thinned(run, "t");
    const second = other ? [resampled(t, other.columns.get("t"), other.columns.get(lane.column))] : [];
    plot.current?.update([t, gapped(thinned(run, lane.column)), ...second], 0, run.duration, props.time);
  });
  const row = run.columns.row_at(props.time);
  const value = run.rows > 0 ? run.columns.at(lane.column, row) : null;
  return (
    <div class="lane">
      {props.title ?? <span>{lane.name}</span>}
      <div class="plot" ref={box} />
      <b class="num">{fixed(value, lane.digits)} {lane.unit}</b>
    </div>
  );
}

/** A column of the run with no more points than a screen can show. */
function thinned(run: StoredRun, column: string): Float64Array {
  const all = run.columns.get(column);
  return every(all, Math.ceil(all.length / kMostPoints));
}
