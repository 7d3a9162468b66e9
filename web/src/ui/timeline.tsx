// web/src/ui/timeline.tsx: the time of a run as a bar, with its events. A stored run can be dragged
// along it; a live run only shows it.
import { JSX } from "preact";
import { RunEvent } from "../state/events";
import { clock } from "../words";

export function Timeline(props: {
  time: number; end: number; loaded?: number; events: RunEvent[];
  on_seek?: (t: number) => void;
}): JSX.Element {
  const end = Math.max(props.end, 1e-6);
  const share = (t: number) => `${Math.min(100, Math.max(0, (t / end) * 100))}%`;
  return (
    <div class="timeline">
      <div class="rail-line" />
      {props.loaded !== undefined && props.loaded < 1 &&
        <div class="rail-loaded" ref={(e) => e?.style.setProperty("width", `${props.loaded! * 100}%`)} />}
      <div class="rail-done" ref={(e) => e?.style.setProperty("width", share(props.time))} />
      {props.events.map((event) => (
        <i key={`${event.t}-${event.label}`} class={`mark-event ${event.kind}`}
          title={`${clock(event.t)} ${event.label}`}
          ref={(e) => e?.style.setProperty("left", share(event.t))} />
      ))}
      {props.on_seek
        ? <input type="range" min={0} max={end} step={0.01} value={props.time} aria-label="Time in the run"
            data-testid="timeline" aria-valuetext={clock(props.time)}
            onInput={(e) => props.on_seek!(Number(e.currentTarget.value))} />
        : <span class="knob" ref={(e) => e?.style.setProperty("left", share(props.time))} />}
    </div>
  );
}
