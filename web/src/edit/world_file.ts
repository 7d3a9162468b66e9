// web/src/edit/world_file.ts: a world from the files that a person chooses: a scenario, a BARN file, a map.
import { ScenarioDocument } from "../contract";
import { ObstacleJson } from "../obstacle";
import { read_pgm, world_of_map } from "./map_file";
import { read_map_info } from "./map_yaml";

export interface GivenFile { name: string; bytes: Uint8Array }

/** A name that the server takes: a-z, 0-9, _ and -, at most 64 characters. */
export function name_of(title: string): string {
  return title.trim().toLowerCase().replace(/[^a-z0-9_-]+/g, "_").replace(/^_+|_+$/g, "").slice(0, 64);
}

/** The worlds in `files`; throws a sentence that names the file and the field. */
export function read_worlds(files: GivenFile[]): ScenarioDocument[] {
  const of = (ends: RegExp) => files.find((f) => ends.test(f.name));
  const pgm = of(/\.pgm$/i);
  const yaml = of(/\.ya?ml$/i);
  if (pgm || yaml) {
    if (!pgm || !yaml) throw new Error("A map is two files: choose the .pgm and the .yaml together.");
    const info = read_map_info(text_of(yaml), yaml.name);
    const image = info.image.replace(/^.*[\\/]/, "");
    const picture = files.find((f) => f.name === image);
    if (!picture) throw new Error(`${yaml.name}: its image is ${image}, not ${pgm.name}.`);
    return [world_of_map(read_pgm(picture.bytes, picture.name), info, stem(picture.name))];
  }
  const json = files.filter((f) => /\.json$/i.test(f.name));
  if (json.length === 0) throw new Error("Choose a scenario or BARN file (.json), a map (.pgm and .yaml), or one file of recorded people (.txt).");
  return json.flatMap(worlds_in);
}

function worlds_in(json: GivenFile): ScenarioDocument[] {
  let document: unknown;
  try {
    document = JSON.parse(text_of(json));
  } catch (error) {
    throw new Error(`${json.name} is not JSON: ${error instanceof Error ? error.message : error}.`);
  }
  if (!document || typeof document !== "object" || Array.isArray(document)) throw new Error(`${json.name} holds no world.`);
  if ("worlds" in document) return barn_worlds(document as BarnFile, json.name);
  if ("hull" in document) throw new Error(`${json.name} is a robot, not a world. Put it into the folder of serve --robots, then reload the page.`);
  const one = document as ScenarioDocument;
  if (one.name !== undefined && typeof one.name !== "string") throw new Error(`${json.name}: name must be a text.`);
  return [{ ...one, name: name_of(one.name ?? stem(json.name)) || "world" }];
}

interface BarnFile { worlds: BarnWorld[] }
interface BarnWorld {
  id?: number; start: number[]; goal: number[]; radius?: number;
  obstacles: (number[] | { radius: number; period: number; keys: [number, number, number][] })[];
}

function barn_worlds({ worlds }: BarnFile, file: string): ScenarioDocument[] {
  if (!Array.isArray(worlds) || worlds.length === 0) throw new Error(`${file}: worlds must hold one world at least.`);
  return worlds.map((w, i) => {
    const at = `${file}: world ${i + 1}`;
    if (!numbers(w?.start, 3)) throw new Error(`${at}: start must be [x, y, heading].`);
    if (!numbers(w.goal, 2)) throw new Error(`${at}: goal must be [x, y].`);
    if (!Array.isArray(w.obstacles)) throw new Error(`${at}: obstacles must be a list.`);
    const [x, y, heading] = w.start;
    const id = Number.isInteger(w.id) ? w.id : i + 1;
    return {
      name: `barn-${id}`, title: `BARN world ${id}`, robot: "jackal", start: { x, y, heading },
      goal: { x: w.goal[0], y: w.goal[1] },
      obstacles: w.obstacles.map((o, k) => barn_obstacle(o, w.radius ?? 0.075, k + 1, at)),
    };
  });
}

function barn_obstacle(o: BarnWorld["obstacles"][number], radius: number, id: number, at: string): ObstacleJson {
  if (Array.isArray(o)) {
    if (!numbers(o, 2)) throw new Error(`${at}: obstacle ${id} must be [x, y].`);
    return { id, type: "cylinder", x: o[0], y: o[1], radius };
  }
  if (!Array.isArray(o?.keys) || o.keys.length === 0) throw new Error(`${at}: obstacle ${id} has no keys.`);
  const [, x, y] = o.keys[0];
  return { id, type: "cylinder", x, y, radius: o.radius, path: { period: o.period, keys: o.keys } };
}

function numbers(value: unknown, count: number): boolean {
  return Array.isArray(value) && value.length === count && value.every((v) => Number.isFinite(v));
}

export function text_of(file: GivenFile): string {
  return new TextDecoder().decode(file.bytes);
}

export function stem(file: string): string {
  return name_of(file.replace(/\.\w+$/, "")) || "world";
}
