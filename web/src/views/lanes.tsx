// web/src/views/lanes.tsx: the signals of a stored run over its whole time, with a cursor; a second
// run's in the second colour.
import { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { StoredRun } from "../link/stored";
import { Plot, resampled } from "../plots/plot";
import { Column } from "../state/columns";
import { fixed } from "../words";

interface Lane { name: string; column: Column; unit: string; least: [number, number]; digits: number }
const kLanes: Lane[] = [
  { name: "Clearance", column: "clearance", unit: "m", least: [0, 1], digits: 2 },
  { name: "Speed", column: "v", unit: "m/s", least: [0, 0.2], digits: 2 },
  { name: "Turn rate", column: "omega", unit: "rad/s", least: [-0.2, 0.2], digits: 2 },
  { name: "Elastic force", column: "elastic", unit: "m", least: [0, 0.2], digits: 2 },
];
const kMostPoints = 2000;

export function Lanes(props: {
  run: StoredRun; other: StoredRun | null; time: number; theme: string; on_pick: (t: number) => void;
}): JSX.Element {
  return (
    <>
      {kLanes.map((lane) => <LaneRow key={lane.name + (props.other ? "2" : "1")} lane={lane} {...props} />)}
    </>
  );
}

function LaneRow(props: {
  lane: Lane; run: StoredRun; other: StoredRun | null; time: number; theme: string;
  on_pick: (t: number) => void;
}): JSX.Element {
  const { lane, run, other } = props;
  const box = useRef<HTMLDivElement>(null);
  const plot = useRef<Plot | null>(null);
  const pick = useRef(props.on_pick);
  pick.current = props.on_pick;
  useEffect(() => {
    const lines = [{ label: lane.name, colour: "accent" as const, width: 1.8 }];
    const both = other ? [...lines, { label: "second", colour: "elastic" as const, width: 1.8 }] : lines;
    plot.current = new Plot(box.current!, both, 46, lane.least, (t) => pick.current(t));
    return () => plot.current?.destroy();
  }, []);
  useEffect(() => plot.current?.theme(), [props.theme]);
  useEffect(() => {
    const t = thinned(run, "t");
    const columns: ArrayLike<number>[] = [t, thinned(run, lane.column)];
    if (other) {
      columns.push(resampled(t, other.columns.get("t"), other.columns.get(lane.column)) as ArrayLike<number>);
    }
    plot.current?.update(columns, 0, run.duration, props.time);
  });
  const row = run.columns.row_at(props.time);
  const value = run.rows > 0 ? run.columns.at(lane.column, row) : null;
  return (
    <div class="lane">
      <span>{lane.name}</span>
      <div class="plot" ref={box} />
      <b class="num">{fixed(value, lane.digits)} {lane.unit}</b>
    </div>
  );
}

/** A column of the run with no more points than a screen can show. */
function thinned(run: StoredRun, column: Column): Float64Array {
  const all = run.columns.get(column);
  const step = Math.max(1, Math.ceil(all.length / kMostPoints));
  return step === 1 ? all.slice() : all.filter((_, i) => i % step === 0);
}
