// web/src/teleop/drawn_stick.tsx: a stick for a finger or the mouse. It holds its pointer, so it cannot get stuck, and
// shows the force that a real one would push with, and where it begins.
import { JSX, TargetedPointerEvent } from "preact";
import { useRef } from "preact/hooks";
import { fixed } from "../words";
import { Stick } from "./seat";

const kReach = 60;  // [units of the drawing] of the knob at full stick
const kWell = 92;   // of the well's rim
const kArrow = 48;  // of full force
const kHead = 13;   // of the arrow
const kLeast = 0.02; // of full force, that is drawn

export interface StickProps {
  stick: Stick;
  force: { forward: number; left: number };
  /** The bounds that the laws set, in shares of full stick: no speed above `room`, and the turn along a wall. */
  room: number | null;
  wall_turn: number | null;
  /** Takes the stick as it is drawn, and null when it is let go. Null: nobody may hold it. */
  hold: ((stick: Stick | null) => void) | null;
  barred?: boolean;
}

export function DrawnStick(props: StickProps): JSX.Element {
  const { force, hold } = props;
  const held = useRef<number | null>(null);
  const move = (e: TargetedPointerEvent<SVGSVGElement>) => {
    const box = e.currentTarget.getBoundingClientRect();
    const unit = 200 / Math.min(box.width, box.height);
    const x = (e.clientX - box.left - box.width / 2) * unit / kReach;
    const y = (e.clientY - box.top - box.height / 2) * unit / kReach;
    const over = Math.max(1, Math.hypot(x, y));
    hold?.({ forward: -y / over, turn: -x / over });
  };
  const press = (e: TargetedPointerEvent<SVGSVGElement>) => {
    if (!hold || held.current !== null || e.button > 0) return;
    held.current = e.pointerId;
    e.currentTarget.setPointerCapture(e.pointerId);
    move(e);
    e.preventDefault();
  };
  const end = (e: TargetedPointerEvent<SVGSVGElement>) => {
    if (e.pointerId !== held.current) return;
    held.current = null;
    hold?.(null);
  };
  const { forward, turn } = props.stick;
  const x = -turn * kReach, y = -forward * kReach;
  return (
    <div class="stick">
      <svg class={`hand-stick ${hold ? "" : "off"} ${props.barred ? "barred" : ""}`} viewBox="-100 -100 200 200"
        role="img" aria-label={`Stick: ${Math.round(forward * 100)} % ahead, ${Math.round(turn * 100)} % to the left`}
        data-testid="hand-stick" onPointerDown={press} onPointerUp={end} onPointerCancel={end} onLostPointerCapture={end}
        onPointerMove={(e) => e.pointerId === held.current && move(e)}>
        <circle class="well" r={kWell} />
        <path class="cross" d={`M${-kWell} 0H${kWell}M0 ${-kWell}V${kWell}`} />
        {props.room !== null && props.room < 1 && <Room share={props.room} />}
        {props.wall_turn !== null && <WallTurn share={props.wall_turn} />}
        <line class="lever" x1="0" y1="0" x2={x} y2={y} />
        <circle class="knob" cx={x} cy={y} r="24" />
        <Push x={x} y={y} dx={-force.left * kArrow} dy={-force.forward * kArrow} />
      </svg>
      <p class="push-words" data-testid="push-words">{push_words(force)}</p>
    </div>
  );
}

function Room(props: { share: number }): JSX.Element {
  const y = -Math.max(0, props.share) * kReach;
  const half = Math.sqrt(kWell * kWell - y * y);
  return (
    <>
      <path class="over" d={`M${-half} ${y}A${kWell} ${kWell} 0 0 1 ${half} ${y}z`} />
      <path class="room" d={`M${-half} ${y}H${half}`} />
      <text class="room-words" x="84" y={y + 15} text-anchor="end">room</text>
    </>
  );
}

function WallTurn(props: { share: number }): JSX.Element {
  const x = -Math.max(-1, Math.min(1, props.share)) * kReach;
  const half = Math.sqrt(kWell * kWell - x * x);
  return (
    <>
      <path class="wall-turn" d={`M${x} ${-half}V${half}`} />
      <text class="wall-words" x={x + (x > 0 ? -6 : 6)} y="50" text-anchor={x > 0 ? "end" : "start"}>wall turn</text>
    </>
  );
}

/** The force as an arrow from the knob. */
function Push(props: { x: number; y: number; dx: number; dy: number }): JSX.Element | null {
  const { x, y, dx, dy } = props;
  const length = Math.hypot(dx, dy);
  if (length < kLeast * kArrow) return null;
  const turn = (Math.atan2(dy, dx) * 180) / Math.PI;
  const shaft = Math.max(0, length - kHead);
  return (
    <g class="push" transform={`translate(${x} ${y}) rotate(${turn})`}>
      <path d={`M0 0H${shaft}`} /><path class="head" d={`M${length} 0L${length - kHead} -8V8z`} />
    </g>
  );
}

/** "Pushes back 19 %, left 46 %"; empty without a force. */
export function push_words(force: { forward: number; left: number }): string {
  const part = (value: number, plus: string, minus: string) =>
    Math.abs(value) < kLeast ? [] : [`${value > 0 ? plus : minus} ${fixed(100 * Math.abs(value), 0)} %`];
  const parts = [...part(force.forward, "ahead", "back"), ...part(force.left, "left", "right")];
  return parts.length > 0 ? `Pushes ${parts.join(", ")}` : "";
}
