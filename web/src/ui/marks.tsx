// web/src/ui/marks.tsx: the events of a run as marks over its time, each a button with an icon and words.
import { JSX } from "preact";
import { useRef, useState } from "preact/hooks";
import { EventKind, RunEvent } from "../state/events";
import { clock } from "../words";
import { icons } from "./icons";

const kIcons: Record<EventKind, JSX.Element> = {
  bad: icons.warning, hold: icons.pause, stop: icons.stop, good: icons.check, goal: icons.goal, edit: icons.box,
  gain: icons.tune,
};
/** The kinds from the gravest on: marks that lie close together have the icon of the first one. */
const kRanks = Object.keys(kIcons) as EventKind[];
const kApart = 24;     // [px] between two marks
const kMostWords = 4;  // events that one mark tells

/** The events of one mark. */
export function grouped(events: RunEvent[], end: number, width: number): RunEvent[][] {
  const groups: RunEvent[][] = [];
  for (const event of events) {
    const last = groups.at(-1);
    if (last && ((event.t - last[0].t) / end) * width < kApart) last.push(event);
    else groups.push([event]);
  }
  return groups;
}

/** The gravest event of a group. */
export function chief(group: RunEvent[]): RunEvent {
  return kRanks.map((kind) => group.find((e) => e.kind === kind)).find((e) => e !== undefined)!;
}

export function group_words(group: RunEvent[]): string {
  const told = group.slice(0, kMostWords).map((e) => `${clock(e.t)} ${e.label}`);
  const more = group.length - told.length;
  return told.join(", ") + (more > 0 ? `, and ${more} more` : "");
}

/** One stop of the Tab key; arrow keys go from mark to mark. */
export function EventMarks(props: {
  events: RunEvent[]; end: number; width: number; on_press: (t: number) => void;
}): JSX.Element | null {
  const [active, set_active] = useState(0);
  const box = useRef<HTMLDivElement>(null);
  const groups = props.width > 0 ? grouped(props.events, props.end, props.width) : [];
  if (groups.length === 0) return null;
  const at = Math.min(active, groups.length - 1);
  const key = (e: KeyboardEvent) => {
    const to = { ArrowLeft: at - 1, ArrowRight: at + 1, Home: 0, End: groups.length - 1 }[e.key];
    if (to === undefined) return;
    box.current?.querySelectorAll("button")[to]?.focus();
    e.preventDefault();
    e.stopPropagation();
  };
  // The group listens for all its marks, so that a long run adds no listeners.
  const mark_of = (e: Event): number => {
    const button = (e.target as HTMLElement).closest("button");
    return button ? [...box.current!.querySelectorAll("button")].indexOf(button) : -1;
  };
  const focus = (e: Event) => {
    const i = mark_of(e);
    if (i >= 0) set_active(i);
  };
  const press = (e: Event) => {
    const i = mark_of(e);
    if (i >= 0) props.on_press(chief(groups[i]).t);
  };
  return (
    <div class="marks" role="group" aria-label="Events" ref={box} onKeyDown={key} onFocusIn={focus} onClick={press}>
      {groups.map((group, i) => {
        const { t, kind } = chief(group);
        const words = group_words(group);
        const share = t / props.end;
        return (
          <button key={group[0].t} class={`mark-event ${kind} ${share > 0.6 ? "late" : ""}`} aria-label={words}
            tabIndex={i === at ? 0 : -1} data-testid="mark"
            ref={(e) => e?.style.setProperty("left", `${Math.min(1, share) * 100}%`)}>
            {kIcons[kind]}<span aria-hidden="true">{words}</span>
          </button>
        );
      })}
    </div>
  );
}
