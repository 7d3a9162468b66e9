// web/src/edit/map_file.ts: occupancy maps of map_server (PGM and YAML) to and from obstacles.
import { ScenarioDocument } from "../contract";
import { Bounds, Point, empty_bounds } from "../geometry";
import { Obstacle, ObstacleJson, covers, include_obstacle, is_ground } from "../obstacle";
import { MapInfo } from "./map_yaml";

/** Grey values, row by row from the top. */
export interface Picture { width: number; height: number; most: number; grey: Uint16Array }

export const kMostObstacles = 2000; // of a world
const kLongestMap = 2000;           // [m] edge
const kHeight = 1;                  // [m] of what a map shows
const kCell = 0.05;                 // [m] of an exported map
const kMargin = 0.5;                // [m] about an exported world
const kMostCells = 4000;            // along an edge of an exported map
const kRoom = 0.5;                  // [m] about the start

/** Reads a PGM file of either kind, P2 (text) or P5 (binary). */
export function read_pgm(bytes: Uint8Array, file: string): Picture {
  let at = 0;
  const word = (): string => {
    for (;;) {
      while (at < bytes.length && bytes[at] <= 32) ++at;
      if (bytes[at] !== 35) break; // a comment to the end of the line
      while (at < bytes.length && bytes[at] !== 10) ++at;
    }
    const begin = at;
    while (at < bytes.length && bytes[at] > 32) ++at;
    return String.fromCharCode(...bytes.subarray(begin, at));
  };
  const magic = word();
  if (magic !== "P5" && magic !== "P2") throw new Error(`${file} is no PGM picture: it begins with neither P5 nor P2.`);
  const whole = (text: string): number => (/^\d+$/.test(text) ? Number(text) : NaN);
  const [width, height, most] = [whole(word()), whole(word()), whole(word())];
  if (!(width > 0 && height > 0 && most > 0 && most < 65536)) {
    throw new Error(`${file}: width, height and greatest value must be whole numbers above 0.`);
  }
  if (width * height > 64e6) throw new Error(`${file} has ${width} x ${height} cells; 64 million is the limit.`);
  const grey = new Uint16Array(width * height);
  if (magic === "P2") {
    for (let i = 0; i < grey.length; ++i) {
      const text = word();
      if (text === "") throw new Error(`${file} ends too early.`);
      if (!(whole(text) <= most)) throw new Error(`${file}: a grey value must be a whole number up to ${most}, not "${text.slice(0, 20)}".`);
      grey[i] = whole(text);
    }
    if (word() !== "") throw new Error(`${file} holds more values than width times height.`);
    return { width, height, most, grey };
  }
  const size = most > 255 ? 2 : 1;
  at += separator_of(bytes.subarray(at), grey.length * size, file);
  for (let i = 0; i < grey.length; ++i) {
    const value = size === 1 ? bytes[at + i] : bytes[at + 2 * i] * 256 + bytes[at + 2 * i + 1];
    grey[i] = Math.min(value, most);
  }
  return { width, height, most, grey };
}

/** The bytes before the `wanted` ones of `rest`: one white space, or CR LF if the bytes fit only so. White space may follow them. */
function separator_of(rest: Uint8Array, wanted: number, file: string): number {
  if (rest.length <= wanted) throw new Error(`${file} ends too early.`);
  const separator = rest.length === wanted + 2 && rest[0] === 13 && rest[1] === 10 ? 2 : 1;
  const more = rest.subarray(separator + wanted);
  if (more.some((byte) => ![9, 10, 13, 32].includes(byte))) {
    throw new Error(`${file} holds ${more.length} bytes more than its width and height say.`);
  }
  return separator;
}

/** The world that a map shows: a box for each rectangle of occupied cells. Unknown cells are left free. */
export function world_of_map(picture: Picture, info: MapInfo, name: string): ScenarioDocument {
  const { width, height } = picture;
  if (Math.max(width, height) * info.resolution > kLongestMap) throw new Error(`The map is longer than ${kLongestMap} m.`);
  const taken = cells_above(picture, info);
  const obstacles: ObstacleJson[] = [];
  const { resolution: cell, origin } = info;
  for (const [column, row, columns, rows] of rectangles(taken, width, height)) {
    obstacles.push({
      id: obstacles.length + 1, type: "box", heading: 0, height: kHeight,
      x: origin.x + (column + columns / 2) * cell, y: origin.y + (height - row - rows / 2) * cell,
      length: columns * cell, width: rows * cell,
    });
  }
  if (obstacles.length === 0) throw new Error("The map shows no wall.");
  if (obstacles.length > kMostObstacles) {
    throw new Error(`The map needs ${obstacles.length} boxes; a world holds ${kMostObstacles}. Use a coarser map.`);
  }
  return { name, title: name, start: { ...free_place(taken, picture, info), heading: 0 }, obstacles };
}

/** 1 where a cell counts as occupied. */
function cells_above({ grey, most }: Picture, { negate, occupied }: MapInfo): Uint8Array {
  return Uint8Array.from(grey, (v) => ((negate ? v : most - v) / most > occupied ? 1 : 0));
}

/** Rectangles [column, row, columns, rows] that cover the cells of value 1, each once. */
function rectangles(cells: Uint8Array, width: number, height: number): [number, number, number, number][] {
  const left = cells.slice();
  const out: [number, number, number, number][] = [];
  const full = (row: number, from: number, to: number) => {
    for (let c = from; c < to; ++c) if (left[row * width + c] === 0) return false;
    return true;
  };
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      if (left[row * width + column] === 0) continue;
      let end = column;
      while (end < width && left[row * width + end] === 1) ++end;
      let bottom = row + 1;
      while (bottom < height && full(bottom, column, end)) ++bottom;
      for (let r = row; r < bottom; ++r) left.fill(0, r * width + column, r * width + end);
      out.push([column, row, end - column, bottom - row]);
    }
  }
  return out;
}

/** The known free place nearest to the origin of W with room for a robot. */
function free_place(taken: Uint8Array, picture: Picture, info: MapInfo): Point {
  const { width, height, grey, most } = picture;
  const { resolution: cell, origin, negate, free } = info;
  const room = Math.ceil(kRoom / cell);
  const roomy = (column: number, row: number) => {
    for (let r = row - room; r <= row + room; ++r) {
      for (let c = column - room; c <= column + room; ++c) {
        if (r < 0 || c < 0 || r >= height || c >= width) return false;
        const p = (negate ? grey[r * width + c] : most - grey[r * width + c]) / most;
        if (taken[r * width + c] === 1 || p > free) return false;
      }
    }
    return true;
  };
  let best: Point | null = null;
  const step = Math.max(1, Math.floor(Math.sqrt(width * height) / 400));
  for (let row = room; row < height - room; row += step) {
    for (let column = room; column < width - room; column += step) {
      const p = { x: origin.x + (column + 0.5) * cell, y: origin.y + (height - row - 0.5) * cell };
      if (best && Math.hypot(p.x, p.y) >= Math.hypot(best.x, best.y)) continue;
      if (roomy(column, row)) best = p;
    }
  }
  if (!best) throw new Error("The map has no free place for a robot.");
  return best;
}

/** The standing obstacles as a map: the bytes of the picture, and the YAML file. Ground is free on a map. */
export function map_of_world(obstacles: Obstacle[], name: string): { pgm: Uint8Array; yaml: string } {
  const standing = obstacles.filter((o) => !o.path && !is_ground(o));
  if (standing.length === 0) throw new Error("Nothing stands in this world: there is no map to draw.");
  const b: Bounds = empty_bounds();
  for (const o of standing) include_obstacle(b, o);
  const size = Math.max(b.max_x - b.min_x, b.max_y - b.min_y) + 2 * kMargin;
  const cell = Math.max(kCell, Math.ceil(size / kMostCells / kCell) * kCell);
  const origin = { x: Math.floor((b.min_x - kMargin) / cell) * cell, y: Math.floor((b.min_y - kMargin) / cell) * cell };
  const width = Math.ceil((b.max_x + kMargin - origin.x) / cell);
  const height = Math.ceil((b.max_y + kMargin - origin.y) / cell);
  const head = new TextEncoder().encode(`P5\n# ${name}\n${width} ${height}\n255\n`);
  const pgm = new Uint8Array(head.length + width * height).fill(254);
  pgm.set(head);
  for (const o of standing) {
    const box = empty_bounds();
    include_obstacle(box, o);
    const first = (v: number) => Math.max(0, Math.floor(v / cell) - 1);
    for (let j = first(box.min_y - origin.y); j < Math.min(height, (box.max_y - origin.y) / cell + 1); ++j) {
      for (let i = first(box.min_x - origin.x); i < Math.min(width, (box.max_x - origin.x) / cell + 1); ++i) {
        const p = { x: origin.x + (i + 0.5) * cell, y: origin.y + (j + 0.5) * cell };
        if (covers(o, p, cell / 2)) pgm[head.length + (height - 1 - j) * width + i] = 0;
      }
    }
  }
  const yaml = [`image: ${name}.pgm`, `resolution: ${Number(cell.toFixed(4))}`,
    `origin: [${origin.x.toFixed(3)}, ${origin.y.toFixed(3)}, 0.0]`, "negate: 0", "occupied_thresh: 0.65",
    "free_thresh: 0.196", ""].join("\n");
  return { pgm, yaml };
}
