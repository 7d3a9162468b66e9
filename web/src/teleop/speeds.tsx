// web/src/teleop/speeds.tsx: commanded and executed speed and turn as bars, and between them the reason for the
// difference, as a funnel.
import { JSX } from "preact";
import { degrees } from "../geometry";
import { full_stick, measure } from "../state/driven";
import { SceneState } from "../state/scene";
import { fixed } from "../words";
import { Reason, speed_reason, turn_reason } from "./reasons";
import { Stick } from "./seat";

const kWide = 400; // [units of the drawing] of a bar
const kFunnel = 34; // high

/** `stick`: the driver's. */
export function Speeds(props: { scene: SceneState; stick: Stick }): JSX.Element {
  const { scene, stick } = props;
  const full = full_stick(scene), f = scene.frame;
  const v = stick.forward * full.v, omega = stick.turn * full.omega;
  return (
    <div class="bars" data-testid="speeds">
      <Bars title="Speed" wanted={v / full.v} sent={(f?.command.v ?? 0) / full.v} done={(f?.twist.v ?? 0) / full.v}
        room={ratio(measure(scene, "teleop.v_sprs"), full.v)} words={(share) => [fixed(share * full.v, 2), "m/s"]}
        why={speed_reason(scene, v)} />
      <Bars title="Turn" centred wanted={omega / full.omega} sent={(f?.command.omega ?? 0) / full.omega}
        done={(f?.twist.omega ?? 0) / full.omega} room={null} words={(share) => turn_words(share * full.omega)}
        why={turn_reason(scene, omega)} />
    </div>
  );
}

const ratio = (value: number | null, of: number): number | null => (value === null ? null : value / of);

function turn_words(omega: number): [string, string] {
  const rate = degrees(omega);
  const text = fixed(Math.abs(rate), 1);
  return [text, text === "0.0" ? "°/s" : rate > 0 ? "°/s L" : "°/s R"];
}

/** Shares of full stick: what the stick asks for, what is sent to the base, what the base does, and what there is room for. */
function Bars(props: {
  title: string; centred?: boolean; wanted: number; sent: number; done: number; room: number | null;
  words: (share: number) => [string, string]; why: Reason;
}): JSX.Element {
  const { why, centred = false, wanted, sent } = props;
  const row = (label: string, share: number, tone: string, marks: [number, string][]) => {
    const [value, unit] = props.words(share);
    return (
      <div class="bar-row">
        <span class="lab">{label}</span>
        <svg viewBox={`0 0 ${kWide} 14`} preserveAspectRatio="none" aria-hidden="true">
          <rect class="trough" width={kWide} height="14" rx="3" />
          <path class={tone} d={box(centred, share)} />
          {centred && <path class="mark" d={`M${kWide / 2} 0V14`} />}
          {marks.map(([at, tone]) => <path key={tone} class={`mark ${tone}`} d={`M${place(centred, at)} 0V14`} />)}
        </svg>
        <b class="num">{value} <u>{unit}</u></b>
      </div>
    );
  };
  const limited = why.head !== "";
  return (
    <div class="bars-of" role="group" aria-label={props.title}>
      <h2>{props.title}<small class={`c-${why.tone}`}>{why.head.replace(":", "")}</small></h2>
      {row("Commanded", wanted, "wanted", [])}
      <div class="funnel">
        <svg viewBox={`0 0 ${kWide} ${kFunnel}`} preserveAspectRatio="none" aria-hidden="true">
          {!centred && why.tail !== "" && <path class="kept" d={funnel(centred, Math.min(Math.abs(wanted), Math.abs(sent)), sent)} />}
          {limited && <path class={`c-${why.tone} lost`} d={centred ? funnel(true, wanted, sent) : cut(wanted, sent)} />}
        </svg>
        <p class={`c-${why.tone}`}>{why.head && <b>{why.head} </b>}{why.tail}</p>
      </div>
      {row("Executed", props.done, "done", [
        ...(limited ? [[sent, "sent"] as [number, string]] : []),
        ...(props.room !== null && props.room < 1 ? [[props.room, "room"] as [number, string]] : [])])}
    </div>
  );
}

const held = (share: number) => Math.max(-1, Math.min(1, Number.isFinite(share) ? share : 0));

/** Where a share lies on a bar; left turns to the left of its middle. */
function place(centred: boolean, share: number): number {
  return centred ? (kWide / 2) * (1 - held(share)) : kWide * Math.abs(held(share));
}

function box(centred: boolean, share: number): string {
  const to = place(centred, share), from = centred ? kWide / 2 : 0;
  return `M${from} 0H${to}V14H${from}z`;
}

/** From `above` on the upper bar to `below` on the lower one. */
function funnel(centred: boolean, above: number, below: number): string {
  const from = centred ? kWide / 2 : 0;
  return `M${from} 0H${place(centred, above)}L${place(centred, below)} ${kFunnel}H${from}z`;
}

function cut(wanted: number, sent: number): string {
  return `M${place(false, sent)} 0H${place(false, wanted)}L${place(false, sent)} ${kFunnel}z`;
}
