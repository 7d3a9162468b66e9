// web/src/edit/people_file.ts: a world of people who were recorded on a square or in a street. The server makes the
// same one of the same file (server/lab/crowd/crowd_scenario.cpp).
import { ScenarioDocument } from "../contract";
import { Bounds, Point, distance, empty_bounds, include } from "../geometry";
import { ObstacleJson, PathJson } from "../obstacle";
import { kWalkerRadius } from "./edits";
import { kMostObstacles } from "./map_file";

export const kFrameTime = 0.04;  // [s] between two frames of a recording
const kPersonHeight = 1.7;       // [m]
const kFarthest = 1e4;           // [m] of a place from the origin
const kLastFrame = 1e9;          // of a recording
const kMostKeys = 10_000;        // of a path
const kLongestPath = 1e6;        // [s]
const kEdge = 0.5;               // [m] of start and goal inside the rectangle of all places
const kLeftOut = 1.5;            // [m] from the robot's start within which nobody stands
const kUntilAgain = 5;           // [s] from the end of the recording until it begins anew

type Key = PathJson["keys"][number]; // t [s], x, y [m]
/** One person: there from the first key to the last, on straight lines in between. */
export interface Walker { id: string; keys: Key[] }

/** The people in lines `frame id x y` [m]; throws a sentence that names the file and the line. */
export function read_people(text: string, file: string): Walker[] {
  const people = new Map<string, Place[]>();
  text.split("\n").forEach((line, i) => {
    const words = line.split(/[ \t\r,]+/).filter((word) => word !== "");
    if (words.length === 0) return;
    const at = `${file}, line ${i + 1}`;
    if (words.length !== 4) throw new Error(`${at}: ${words.length} words instead of "frame id x y".`);
    const [frame, x, y] = [number_of(words[0], kLastFrame), number_of(words[2], kFarthest), number_of(words[3], kFarthest)];
    if (frame === null) throw new Error(`${at}: "${words[0]}" is no number of a frame.`);
    if (x === null || y === null) throw new Error(`${at}: "${words[2]} ${words[3]}" is no place in metres.`);
    const places = people.get(words[1]) ?? [];
    people.set(words[1], places);
    places.push({ key: [frame * kFrameTime, x, y], line: i + 1 });
  });
  if (people.size === 0) throw new Error(`${file} holds nobody.`);
  return [...people].map(([id, places]) => ({ id, keys: ordered(places, id, file) }));
}

/** Somebody's place, and the line that tells it. */
interface Place { key: Key; line: number }

/** The keys in order of time. A line that says the same again counts once; throws if two lines differ. */
function ordered(places: Place[], id: string, file: string): Key[] {
  const kept: Place[] = [];
  for (const place of places.sort((a, b) => a.key[0] - b.key[0])) {
    const last = kept[kept.length - 1];
    const [t, x, y] = place.key;
    if (!last || last.key[0] !== t) kept.push(place);
    else if (last.key[1] !== x || last.key[2] !== y) {
      throw new Error(`${file}, line ${place.line}: person ${id} is at another place in frame ${frame_of(t)} than in line ${last.line}.`);
    }
  }
  return kept.map(({ key }) => key);
}

/** The frame at `time`, as the file has it. */
function frame_of(time: number): number {
  return Number((time / kFrameTime).toPrecision(10));
}

/** The number that is the whole of `word`, within +-`most`. */
function number_of(word: string, most: number): number | null {
  const value = /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(word) ? Number(word) : NaN;
  return Math.abs(value) <= most ? value : null;
}

/**
 * A world in which they come, walk and go, and the robot of `robot` crosses their place towards +x. Nobody is in it who
 * is seen once only, or who stands beside the robot at the beginning. Throws a sentence.
 */
export function world_of_people(walkers: Walker[], file: string, robot: ScenarioDocument): ScenarioDocument {
  const title = file.replace(/\.\w+$/, "");
  const [from, until] = span_of(walkers);
  const { start, goal } = way_through(bounds_of(walkers), title);
  const beside = ({ keys: [[t, x, y]] }: Walker) => t === from && distance({ x, y }, start) < kLeftOut;
  check_span(walkers, [from, until], file);
  const period = to_thousandth(until - from + kUntilAgain);
  const people = walkers.filter((w) => w.keys.length > 1 && !beside(w));
  if (people.length === 0) throw new Error(`${file}: nobody in it walks.`);
  if (people.length > kMostObstacles) throw new Error(`${file} holds ${people.length} people; a world holds ${kMostObstacles}.`);
  for (const walker of people) check_places(walker, from, file);
  const { waypoints: _waypoints, robots: _robots, ...same } = robot;
  return {
    ...same, name: "", title: `People of ${title}`,
    description: `${people.length} people come, walk and go as they were recorded; they do not see the robot. `
      + `After ${period.toFixed(0)} s the recording begins anew.`,
    start: { x: to_thousandth(start.x), y: to_thousandth(start.y), heading: 0 },
    goal: { x: to_thousandth(goal.x), y: to_thousandth(goal.y) },
    obstacles: people.map(({ keys }, i) => person(i + 1, keys, from, period)),
  };
}

/** Throws a sentence if the recording and a pause are longer than a path. */
function check_span(walkers: Walker[], [from, until]: [number, number], file: string): void {
  const most = kLongestPath - kUntilAgain;
  if (until - from <= most) return;
  const last = walkers.find(({ keys }) => keys[keys.length - 1][0] === until)!;
  throw new Error(`${file} lasts ${(until - from).toFixed(0)} s, from frame ${frame_of(from)} to frame ${frame_of(until)} of `
    + `person ${last.id}; a world holds ${most} s.`);
}

/** Throws a sentence if no path can hold the person's places. */
function check_places({ id, keys }: Walker, from: number, file: string): void {
  if (keys.length > kMostKeys) throw new Error(`${file}: person ${id} is in ${keys.length} frames; a world holds ${kMostKeys} of one person.`);
  const millisecond = ([t]: Key) => to_thousandth(t - from);
  const close = keys.findIndex((key, i) => i > 0 && millisecond(key) === millisecond(keys[i - 1]));
  if (close < 0) return;
  throw new Error(`${file}: frames ${frame_of(keys[close - 1][0])} and ${frame_of(keys[close][0])} of person ${id} fall on one `
    + "millisecond; a world's times are whole milliseconds.");
}

function person(id: number, keys: PathJson["keys"], from: number, period: number): ObstacleJson {
  const rounded = keys.map(([t, x, y]): [number, number, number] => [to_thousandth(t - from), to_thousandth(x), to_thousandth(y)]);
  const [[, x, y]] = rounded;
  return { id, type: "cylinder", x, y, radius: kWalkerRadius, height: kPersonHeight, path: { period, comes_and_goes: true, keys: rounded } };
}

/** To a millimetre or millisecond: the recordings are no finer, and worlds stay small. */
function to_thousandth(value: number): number {
  return Math.floor(value * 1000 + 0.5) / 1000;
}

/** [s] */
function span_of(walkers: Walker[]): [number, number] {
  let [from, until] = [Infinity, -Infinity];
  for (const { keys } of walkers) {
    from = Math.min(from, keys[0][0]);
    until = Math.max(until, keys[keys.length - 1][0]);
  }
  return [from, until];
}

function bounds_of(walkers: Walker[]): Bounds {
  const bounds = empty_bounds();
  for (const { keys } of walkers) for (const [, x, y] of keys) include(bounds, x, y);
  return bounds;
}

/** Through the middle of their places towards +x. */
function way_through(b: Bounds, title: string): { start: Point; goal: Point } {
  const [width, depth] = [b.max_x - b.min_x, b.max_y - b.min_y];
  if (Math.min(width, depth) < 4 * kEdge) {
    throw new Error(`${title}: its people stay within ${width.toFixed(1)} x ${depth.toFixed(1)} m; a crossing needs ${4 * kEdge} m.`);
  }
  const [x, y] = [(b.min_x + b.max_x) / 2, (b.min_y + b.max_y) / 2];
  const half = Math.abs(width) / 2 - kEdge;
  return { start: { x: x - half, y }, goal: { x: x + half, y } };
}
