// web/src/teleop/drawn_stick.tsx: a stick for a finger or the mouse. It holds its pointer, so it cannot get stuck, and
// shows the force that a real one would push with.
import { JSX, TargetedPointerEvent } from "preact";
import { useRef } from "preact/hooks";
import { Seat } from "./seat";

const kReach = 60; // [units of the drawing] of the knob at full stick
const kArrow = 34; // of full force

export function DrawnStick(props: { seat: Seat; disabled: boolean; force: { forward: number; left: number } }): JSX.Element {
  const { seat, force } = props;
  const held = useRef<number | null>(null);
  const move = (e: TargetedPointerEvent<SVGSVGElement>) => {
    const box = e.currentTarget.getBoundingClientRect();
    const unit = 200 / Math.min(box.width, box.height);
    const x = (e.clientX - box.left - box.width / 2) * unit / kReach;
    const y = (e.clientY - box.top - box.height / 2) * unit / kReach;
    const over = Math.max(1, Math.hypot(x, y));
    seat.draw({ forward: -y / over, turn: -x / over });
  };
  const press = (e: TargetedPointerEvent<SVGSVGElement>) => {
    if (props.disabled || held.current !== null || e.button > 0) return;
    held.current = e.pointerId;
    e.currentTarget.setPointerCapture(e.pointerId);
    move(e);
    e.preventDefault();
  };
  const end = (e: TargetedPointerEvent<SVGSVGElement>) => {
    if (e.pointerId !== held.current) return;
    held.current = null;
    seat.draw(null);
  };
  const { forward, turn } = seat.wish;
  const x = -turn * kReach, y = -forward * kReach;
  return (
    <svg class={`hand-stick ${props.disabled ? "off" : ""} ${seat.barred ? "barred" : ""}`} viewBox="-100 -100 200 200"
      role="img" aria-label={`Stick: ${Math.round(forward * 100)} % ahead, ${Math.round(turn * 100)} % to the left`}
      data-testid="hand-stick" onPointerDown={press} onPointerUp={end} onPointerCancel={end} onLostPointerCapture={end}
      onPointerMove={(e) => e.pointerId === held.current && move(e)}>
      <circle class="well" r="92" />
      <path class="cross" d="M-92 0H92M0-92V92" />
      <line class="lever" x1="0" y1="0" x2={x} y2={y} />
      <circle class="knob" cx={x} cy={y} r="28" />
      {(force.forward !== 0 || force.left !== 0) &&
        <path class="push" d={`M${x} ${y}l${-force.left * kArrow} ${-force.forward * kArrow}`} />}
    </svg>
  );
}
