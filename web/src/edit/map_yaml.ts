// web/src/edit/map_yaml.ts: the description of a map of map_server. It takes and refuses what the server does
// (server/run/map_file.cpp); the files in tests/maps hold both to it.
import { Point } from "../geometry";

/** The fields of a map's YAML file that matter here. */
export interface MapInfo { image: string; resolution: number; origin: Point; negate: boolean; occupied: number; free: number }

const kKnown = ["image", "mode", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"];
const kMostLetters = 10_000;
const kFarthestOrigin = 1e6; // [m]
const kMostYaw = 1e-9;       // [rad] that counts as none

/** Throws a sentence that names the file and the field. */
export function read_map_info(yaml: string, file: string): MapInfo {
  const fail = (why: string): never => { throw new Error(`${file}: ${why}`); };
  const fields = fields_of(yaml, fail);
  const word = (key: string): string => {
    const value = fields.get(key) ?? fail(`${key} is missing.`);
    return typeof value === "string" && value !== "" ? value : fail(`${key} must be a word.`);
  };
  const number = (key: string, low: number, high: number, usual?: number): number => {
    if (usual !== undefined && !fields.has(key)) return usual;
    const value = number_of(word(key));
    return value >= low && value <= high ? value : fail(`${key} must be a number from ${low} to ${high}.`);
  };
  const resolution = number("resolution", 0.005, 1);
  const origin = origin_of(fields.get("origin"), fail);
  const negate = fields.has("negate") && (truth_of(word("negate")) ?? fail("negate must be 0 or 1."));
  const occupied = number("occupied_thresh", 0, 1, 0.65);
  const free = number("free_thresh", 0, 1, 0.196);
  if (free > occupied) fail("free_thresh must not be above occupied_thresh.");
  const mode = fields.has("mode") ? word("mode") : "trinary";
  if (mode !== "trinary" && mode !== "scale") fail(`mode "${mode}" cannot be read, only trinary and scale.`);
  return { image: word("image"), resolution, origin, negate, occupied, free };
}

type Value = string | string[];
type Fail = (why: string) => never;

function origin_of(list: Value | undefined, fail: Fail): Point {
  if (list === undefined) return fail("origin is missing.");
  if (typeof list === "string" || list.length < 2 || list.length > 3) return fail("origin must be [x, y, yaw].");
  const [x, y, yaw] = [...list, "0"].map(number_of);
  if (![x, y, yaw].every((v) => Math.abs(v) <= kFarthestOrigin)) fail("origin must be three numbers.");
  if (Math.abs(yaw) > kMostYaw) fail("origin is turned; only a yaw of 0 can be read.");
  return { x, y };
}

/** NaN for other words than numbers. */
function number_of(word: string): number {
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(word) ? Number(word) : NaN;
}

function truth_of(word: string): boolean | null {
  if (!/^([a-z]*|[A-Z]?[a-z]*|[A-Z]*|[01])$/.test(word)) return null;
  if (/^(1|y|yes|true|on)$/i.test(word)) return true;
  return /^(0|n|no|false|off)$/i.test(word) ? false : null;
}

/** The part of YAML in which maps are described: one level of `key: value`, a value being a word or a list of words. */
function fields_of(yaml: string, fail: Fail): Map<string, Value> {
  if (yaml.length > kMostLetters) fail("it is too long for the description of a map.");
  const fields = new Map<string, Value>();
  for (const { key, lines } of entries_of(yaml, fail)) {
    if (!kKnown.includes(key)) fail(`"${key.slice(0, 40)}" is no field of a map.`);
    if (fields.has(key)) fail(`${key} is given twice.`);
    fields.set(key, value_of(key, lines, fail));
  }
  if (fields.size === 0) fail('it has no lines of "key: value".');
  return fields;
}

/** Each key, with what follows it on its own line and on the lines that belong to it. */
function entries_of(yaml: string, fail: Fail): { key: string; lines: string[] }[] {
  const entries: { key: string; lines: string[] }[] = [];
  let indent: number | null = null; // of the keys
  for (const raw of yaml.split(/\r?\n/)) {
    if (/^(---|\.\.\.)(\s|$)/.test(raw)) { // between two documents; the first one counts
      if (entries.length > 0) break;
      continue;
    }
    const line = without_comment(raw);
    if (line.trim() === "") continue;
    const depth = line.search(/\S/);
    indent ??= depth;
    const text = line.trim();
    const last = entries[entries.length - 1];
    if (last && (depth > indent || /^-(\s|$)/.test(text) || open_list(last.lines))) {
      last.lines.push(text);
      continue;
    }
    const found = /^("[^"]*"|'[^']*'|[^:]+?)\s*:(?:\s+(.*))?$/.exec(text);
    if (!found || /^-\s/.test(text)) return fail('it has no lines of "key: value".');
    entries.push({ key: unquoted(found[1]), lines: found[2] ? [found[2]] : [] });
  }
  return entries;
}

/** `line` up to a # that begins a comment: one after a space, and not within quotes. */
function without_comment(line: string): string {
  return /^(?:"[^"]*"|'[^']*'|\S#|[^#])*/.exec(line)![0];
}

/** Whether `lines` begin a list in brackets and do not end it. */
function open_list(lines: string[]): boolean {
  return lines.length > 0 && lines[0].startsWith("[") && !lines[lines.length - 1].endsWith("]");
}

function value_of(key: string, lines: string[], fail: Fail): Value {
  if (lines.length > 0 && lines.every((line) => /^-(\s|$)/.test(line))) return lines.map((line) => unquoted(line.slice(1).trim()));
  if (open_list(lines)) fail(`it is no YAML: the list of ${key} has no end.`);
  const text = lines.join(" ");
  if (!text.startsWith("[")) return text === "~" || text === "null" ? "" : unquoted(text);
  return text.slice(1, -1).replace(/,\s*$/, "").split(",").map((item) => unquoted(item.trim()));
}

function unquoted(word: string): string {
  return /^"[^"]*"$|^'[^']*'$/.test(word) ? word.slice(1, -1) : word;
}
