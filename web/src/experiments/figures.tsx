// web/src/experiments/figures.tsx: rates with intervals as bars, and quartiles as boxes.
import { JSX } from "preact";
import { fixed } from "../words";
import { Arm } from "./contract";
import { tone_of } from "./results_table";
import { interval_words, percent } from "./words";

interface Props { title: string; arms: Arm[]; baseline: string | null; picked: string | null }

const kRow = 30;     // [px] of a controller
const kLabel = 116;  // [px] of its name
const kWidth = 340;  // [px]
const kRight = 12;   // [px]
const kMostLetters = 16;

function Plot(props: { title: string; note: string; arms: Arm[]; from: string; to: string; row: (arm: Arm, y: number) => JSX.Element | null; tone: (label: string) => string }): JSX.Element {
  const height = props.arms.length * kRow + 26;
  return (
    <figure class="experiment-plot">
      <figcaption><b>{props.title}</b><span class="quiet">{props.note}</span></figcaption>
      <svg viewBox={`0 0 ${kWidth} ${height}`} role="img" aria-label={`${props.title}, ${props.note}. The table has the numbers.`}>
        <path class="rule" d={[0, 0.5, 1].map((share) => `M${at(share)} 4V${height - 22}`).join("")} />
        {props.arms.map((arm, i) => (
          <g key={arm.label} class={`tone-${props.tone(arm.label)}`}>
            <text class="name" x="0" y={i * kRow + 21}>{arm.label.length > kMostLetters ? `${arm.label.slice(0, kMostLetters - 1)}…` : arm.label}
              <title>{arm.label}</title></text>
            {props.row(arm, i * kRow + 16)}
          </g>
        ))}
        <text x={kLabel} y={height - 6}>{props.from}</text>
        <text x={kWidth - kRight} y={height - 6} text-anchor="end">{props.to}</text>
      </svg>
    </figure>
  );
}

/** [px] of a share between the ends of the scale. */
function at(share: number): number {
  return kLabel + (kWidth - kRight - kLabel) * Math.min(1, Math.max(0, share));
}

export function Bars(props: Props): JSX.Element {
  const tone = (label: string) => tone_of(label, props.baseline, props.picked);
  const row = (arm: Arm, y: number) => {
    const { reached } = arm.rates;
    if (!reached || reached.rate === null || !reached.interval) return null;
    const [low, high] = reached.interval;
    return <>
      <rect class="bar" x={kLabel} y={y - 8} width={at(reached.rate) - kLabel} height="16"><title>{percent(reached)}, 95 % interval {interval_words(reached)}</title></rect>
      <path class="whisker" d={`M${at(low)} ${y}H${at(high)}M${at(low)} ${y - 5}V${y + 5}M${at(high)} ${y - 5}V${y + 5}`} />
    </>;
  };
  return <Plot title={props.title} note="with 95 % intervals" arms={props.arms} from="0 %" to="100 %" row={row} tone={tone} />;
}

export function Boxes(props: Props & { figure: string; unit: string }): JSX.Element {
  const tone = (label: string) => tone_of(label, props.baseline, props.picked);
  const figures = props.arms.map((arm) => arm.figures[props.figure]).filter((f) => f && f.n > 0);
  const low = Math.min(0, ...figures.map((f) => f.least ?? 0));
  const high = Math.max(...figures.map((f) => f.largest ?? 0), low + 1e-9);
  const x = (value: number) => at((value - low) / (high - low));
  const row = (arm: Arm, y: number) => {
    const f = arm.figures[props.figure];
    if (!f || f.n === 0) return <text class="none" x={kLabel + 4} y={y + 5}>no run</text>;
    const [least, lower, median, upper, largest] = [f.least!, f.lower_quartile!, f.median!, f.upper_quartile!, f.largest!].map(x);
    return <>
      <path class="whisker" d={`M${least} ${y}H${lower}M${upper} ${y}H${largest}M${least} ${y - 5}V${y + 5}M${largest} ${y - 5}V${y + 5}`} />
      <rect class="box-plot" x={lower} y={y - 8} width={Math.max(1, upper - lower)} height="16"><title>median {fixed(f.median, 2)} {props.unit}, n = {f.n}</title></rect>
      <path class="median" d={`M${median} ${y - 8}V${y + 8}`} />
    </>;
  };
  return <Plot title={props.title} note="box: quartiles, line: median, ends: least and largest" arms={props.arms}
    from={`${fixed(low, 1)} ${props.unit}`} to={`${fixed(high, 1)} ${props.unit}`} row={row} tone={tone} />;
}
