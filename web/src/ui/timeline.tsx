// web/src/ui/timeline.tsx: the time of a run as a slider, with its events above it. What is not recorded
// is hatched.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { Barred } from "../link/rewind";
import { RunEvent } from "../state/events";
import { clock } from "../words";
import { EventMarks } from "./marks";

const kKeys: Record<string, number> = {
  ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10, Home: -Infinity, End: Infinity,
};

interface TimelineProps {
  time: number; end: number; // [s]
  name: string; label: string;
  words: string;             // of the time, for screen readers
  past?: boolean;            // an earlier instant of a live run
  disabled?: boolean; title?: string;
  loaded?: number;           // 0..1
  barred?: Barred[];
  events: RunEvent[];
  on_seek: (t: number) => void;
}

/** Arrow keys move by a second, Page keys by ten. */
export function Timeline(props: TimelineProps): JSX.Element {
  const end = Math.max(props.end, 1e-6);
  const { time, loaded, barred = [], on_seek } = props;
  const [track, width] = use_width();
  const percent = (t: number) => `${Math.min(100, Math.max(0, (t / end) * 100))}%`;
  const key = (e: KeyboardEvent) => {
    if (!(e.key in kKeys) || e.ctrlKey || e.metaKey || e.altKey) return;
    on_seek(Math.min(end, Math.max(0, time + kKeys[e.key])));
    e.preventDefault();
    e.stopPropagation();
  };
  return (
    <div class={`timeline ${props.past ? "past" : ""}`} title={props.title}>
      <div class="track" ref={track}>
        <div class="rail-line" />
        {loaded !== undefined && loaded < 1 &&
          <div class="rail-loaded" ref={(e) => e?.style.setProperty("width", `${loaded * 100}%`)} />}
        <div class="rail-done" ref={(e) => e?.style.setProperty("width", percent(time))} />
        {barred.map((b) => (
          <div key={b.from} class="rail-barred" title={b.words} data-testid="barred" ref={(e) => {
            e?.style.setProperty("left", percent(b.from));
            e?.style.setProperty("right", `calc(100% - ${percent(b.to)})`);
          }} />
        ))}
      </div>
      <input type="range" min={0} max={end} step={0.01} value={time} aria-label={props.label} disabled={props.disabled}
        data-testid={props.name} aria-valuetext={props.words} onKeyDown={key}
        onInput={(e) => on_seek(Number(e.currentTarget.value))} />
      <EventMarks events={props.events} end={end} width={width} on_press={(t) => !props.disabled && on_seek(t)} />
      {barred.length > 0 && <span class="hidden-words">
        {barred.map((b) => `Not recorded from ${clock(b.from)} to ${clock(b.to)}: ${b.words}`).join(" ")}
      </span>}
    </div>
  );
}

/** The element's width [px], as it changes. */
function use_width(): [{ current: HTMLDivElement | null }, number] {
  const element = useRef<HTMLDivElement>(null);
  const [width, set_width] = useState(0);
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => set_width(Math.round(entry.contentRect.width)));
    observer.observe(element.current!);
    return () => observer.disconnect();
  }, []);
  return [element, width];
}
