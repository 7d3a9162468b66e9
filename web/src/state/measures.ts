// web/src/state/measures.ts: all signals of a run, with the measures of its controller and the channels of its robot; how
// they share plots; and which of them are shown.
import { ChannelInfo } from "../contract";
import { Signal, kDash, kFrameSignals, kSensors } from "./signals";
import { keep, kept } from "./store";

/** Labels and meanings of the measures that controllers give today. */
const kMeasures: Record<string, [label: string, meaning: string]> = {
  "strip.length": ["Length", "Length of the strip from the robot to its end"],
  "strip.internal": ["Internal force", "Pull of the strip towards a straight line (Eq. 2), a displacement"],
  "strip.left": ["External force, left", "Push from the nearest return on the left (Eq. 7 and 13), a displacement"],
  "strip.right": ["External force, right", "Push from the nearest return on the right (Eq. 7 and 13), a displacement"],
  "strip.push": ["Push aside", "Part of the external force that is turned to the chosen side (E.4), a displacement"],
  "strip.elastic": ["Elastic force", "Sum of internal and external force, a displacement"],
  "strip.side": ["Side", "The side on which the obstacle is passed: 1 left, -1 right, 0 none"],
  "strip.share": ["Share", "Share of the strip's length that lies before the pass point"],
  "moving.count": ["Tracks", "Moving objects that are tracked now"],
  "plan.length": ["Length", "Length of the planned path"],
  "window.allowed": ["Allowed commands", "Commands of the dynamic window from which the robot can still stop"],
  "ground.class": ["Class", "Ground ahead: 0 slope up, 1 slope down, 2 step up, 3 step down, 4 trench, 5 flat, 6 pending, 7 unknown"],
  "ground.height": ["Height", "Height of the step ahead; below 0 it goes down"],
  "ground.slope": ["Slope", "Slope of the ground ahead; up is positive"],
  "ground.width": ["Width", "Width of the trench ahead"],
  "ground.confidence": ["Confidence", "Share of the readings that agree with the class"],
  "turnover.w_min": ["Least free turn rate", "The least turn rate that does not turn the robot over"],
  "turnover.w_max": ["Greatest free turn rate", "The greatest turn rate that does not turn the robot over"],
  "turnover.roll_predicted": ["Predicted roll", "Roll at the place ahead; left side up is positive"],
  "turnover.pitch_predicted": ["Predicted pitch", "Pitch at the place ahead; nose down is positive"],
  "turnover.margin": ["Margin", "How much more tilt the robot stands"],
  "histogram.free": ["Free sectors", "Sectors of the histogram with a density below the threshold"],
};

/** Measures with the name of a meaning have its colour; the others get one in turn. */
const kMeaning: Record<string, Pick<Signal, "colour" | "dash">> = {
  internal: { colour: "internal", dash: [] }, elastic: { colour: "elastic", dash: [] },
  left: { colour: "external", dash: [] }, right: { colour: "external", dash: kDash },
  push: { colour: "external", dash: [2, 3] }, length: { colour: "muted", dash: [] },
};
const kInTurn: Pick<Signal, "colour" | "dash">[] = [
  { colour: "accent", dash: [] }, { colour: "filtered", dash: [] }, { colour: "path", dash: kDash },
  { colour: "ok", dash: [2, 3] },
];

const word = (text: string) => (text.charAt(0).toUpperCase() + text.slice(1)).replaceAll("_", " ");

/** A measure of the controller, or a channel of the robot; measures of one thing and one unit share a plot. */
function named_signal(name: string, unit: string, at: number, channels: ChannelInfo[]): Signal {
  const [of, ...rest] = name.split(".");
  const channel = channels.find((c) => name === c.name || name.startsWith(`${c.name}[`));
  const [label, meaning] = kMeasures[name] ?? [word(rest.join(" ") || of), channel
    ? `Channel of the robot: ${channel.kind || channel.name}` : "Measure of the controller"];
  return {
    name, unit, label, meaning, group: channel ? kSensors : `Controller: ${word(of).toLowerCase()}`,
    plot: `${word(of)}${unit ? "" : `: ${label.toLowerCase()}`}`, least: [0, 0.2], digits: 2, usual: unit !== "" && (!channel || channels.length < 4),
    ...(kMeaning[name.split(".").at(-1)!] ?? kInTurn[at % kInTurn.length]),
  };
}

/** What columns tell of their signals. */
interface Known { has: (name: string) => boolean; measures: { name: string; unit: string }[]; channels: ChannelInfo[] }

/** Every signal of which `columns` has a value. */
export function signals_of(columns: Known): Signal[] {
  return [...kFrameSignals.filter((s) => columns.has(s.name)),
    ...columns.measures.map(({ name, unit }, i) => named_signal(name, unit, i, columns.channels))];
}

/** Of several lists, each signal once. */
export function signals_of_all(lists: Known[]): Signal[] {
  const found = new Map<string, Signal>();
  for (const s of lists.flatMap(signals_of)) if (!found.has(s.name)) found.set(s.name, s);
  return [...found.values()];
}

/** Signals that share their axes, in the order of the first of each. Other units never share. */
export function plots_of(signals: Signal[]): { title: string; unit: string; signals: Signal[] }[] {
  const plots = new Map<string, { title: string; unit: string; signals: Signal[] }>();
  for (const s of signals) {
    const key = `${s.plot} ${s.unit}`;
    const plot = plots.get(key) ?? { title: s.plot, unit: s.unit, signals: [] };
    plot.signals.push(s);
    plots.set(key, plot);
  }
  return [...plots.values()];
}

/** Signals that a person switched on or off; the others are shown if they are usual. */
export type Choices = Readonly<Record<string, boolean>>;

export function is_shown(signal: Signal, choices: Choices): boolean {
  return choices[signal.name] ?? signal.usual;
}

const kChoices = "tautline.signals";

/** The choices of the last visit. */
export function stored_choices(): Choices {
  return kept<Choices>(kChoices, {}, (text) => {
    const found: unknown = JSON.parse(text);
    const entries = found !== null && typeof found === "object" ? Object.entries(found) : [];
    return Object.fromEntries(entries.filter(([, on]) => typeof on === "boolean")) as Choices;
  });
}

export function store_choices(choices: Choices): void {
  keep(kChoices, JSON.stringify(choices));
}
