// web/src/edit/facts.ts: the numbers of a thing in the scene, as the wire brings them, for its card.
import { hand_goal_card, link_card, planned_card } from "../arm/inspect";
import { Point, Pose, degrees, distance, wrap_angle } from "../geometry";
import {
  LayerView, Place, arcs, arrows, circles, kGround, kScanHeight, kStripHeight, kUnknownCell, places, sectors,
} from "../layer";
import { kFree, kMaxRange } from "../link/frame";
import { slope_of, tilt_of, top_at } from "../ground";
import { Obstacle, obstacle_title } from "../obstacle";
import { Token, is_scaled, token_of } from "../state/layers";
import { SceneState, robot_pose } from "../state/scene";
import { PlacedSweep, sweep_points } from "../state/sweeps";
import { clock, fixed } from "../words";
import { Thing, cell_at, filtered_of } from "./inspect";
import { Law, external_law, force_law, layer_law, pushes_once } from "./laws";

export interface Row { label: string; value: string; unit: string; token?: Token }
export interface Card {
  title: string;
  note: string;
  rows: Row[];
  law: Law | null;
  at: Point;       // in W
  height: number;  // [m] in 3D
  radius: number;  // [m] that the card leaves free about `at`
  long?: boolean;  // its middle may be far from the pointer
}

const kUsedHalf = (74.5 * Math.PI) / 180; // [rad] beams that exert forces: equations.md C
const kSame = 0.004; // [m] within which a beam's end is a nearest return: ranges come in millimetres

const metres = (label: string, value: number | null | undefined, token?: Token): Row =>
  ({ label, value: fixed(value, value != null && Math.abs(value) < 0.1 ? 3 : 2), unit: "m", token });
const turned = (label: string, angle: number): Row =>
  ({ label, value: `${angle > 0 ? "+" : ""}${fixed(degrees(angle), 1)}`, unit: "°" });
const position = (p: Point): Row => ({ label: "Position x, y", value: `${fixed(p.x, 2)}, ${fixed(p.y, 2)}`, unit: "m" });

/** The card of `thing` now; null once the thing is gone. */
export function card_of(scene: SceneState, thing: Thing): Card | null {
  switch (thing.kind) {
    case "beam": return beam_card(scene, thing.scanner, thing.beam);
    case "echo": return echo_card(scene, thing.key);
    case "mark": return mark_card(scene, thing.layer, thing.index);
    case "cell": return cell_card(scene, thing.layer, thing.at);
    case "sector": return sector_card(scene, thing.layer, thing.index);
    case "path": return path_card(scene, thing.t);
    case "goal": return goal_card(scene, thing.index);
    case "obstacle": return obstacle_card(scene, thing.id);
    case "ground": return ground_card(scene, thing.id, thing.at);
    case "link": return link_card(scene, thing.link);
    case "hand_goal": return hand_goal_card(scene);
    case "planned": return planned_card(scene, thing.index);
    case "robot": return robot_card(scene);
  }
}

/** A name that stays while the same thing is shown. */
export function thing_key(thing: Thing): string {
  return JSON.stringify("at" in thing ? { ...thing, at: [thing.at.x.toFixed(1), thing.at.y.toFixed(1)] } : thing);
}

/** The card in one sentence. */
export function card_words(card: Card): string {
  const rows = card.rows.map((r) => `${r.label} ${r.value}${r.unit && ` ${r.unit === "°" ? "degrees" : r.unit}`}`);
  const law = card.law ? [`${card.law.law}, ${card.law.source}`] : [];
  return `${[card.title, card.note].filter(Boolean).join(", ")}. ${[...rows, ...law].join(". ")}.`;
}

export function measure_of(scene: SceneState, name: string): number | null {
  return scene.frame?.measures.find((m) => m.name === name)?.value ?? null;
}

interface Side { side: "left" | "right"; point: Point; beam: number | null }

/** The server's nearest return of each side, with the beam that ends there. */
export function nearest_sides(scene: SceneState): Side[] {
  const layer = scene.layers.get("scan.nearest");
  const pose = scene.frame?.pose;
  if (!layer || !pose) return [];
  const front = scene.filtered.shown ?? scene.sweeps.at(0) ?? null;
  const seen_from = front?.origin ?? pose;
  const points = places(layer, pose);
  return points.map((point, i) => {
    const bearing = wrap_angle(Math.atan2(point.y - seen_from.y, point.x - seen_from.x) - seen_from.heading);
    const side = points.length === 2 ? (i === 0 ? "left" : "right") : bearing >= 0 ? "left" : "right"; // left comes first
    return { side, point, beam: front && beam_at(front, point, side) };
  });
}

/** The used beam of one side that ends at `point`; null if none does, as in another tick's scan. */
function beam_at(placed: PlacedSweep, point: Point, side: Side["side"]): number | null {
  const { end } = sweep_points(placed);
  let best: number | null = null;
  let least = kSame;
  for (let i = 0; 2 * i < end.length; ++i) {
    const angle = placed.sweep.angle_min + i * placed.sweep.angle_increment;
    if (Math.abs(angle) > kUsedHalf + 1e-6 || (angle > -1e-9 ? "left" : "right") !== side) continue;
    const off = distance({ x: end[2 * i], y: end[2 * i + 1] }, point);
    if (off < least) [best, least] = [i, off];
  }
  return best;
}

function range_row(label: string, placed: PlacedSweep | null, beam: number, token: Token): Row[] {
  const range = placed?.sweep.ranges.at(beam);
  if (!placed || range === undefined) return [];
  if (range === kFree) return [{ label, value: `> ${fixed(placed.sweep.range_max, 2)}`, unit: "m", token }];
  if (range > kMaxRange) return [{ label, value: `none, code ${range - kMaxRange}`, unit: "", token }];
  return [metres(label, range / 1000, token)];
}

function beam_card(scene: SceneState, scanner: number, beam: number): Card | null {
  const raw = scene.sweeps.at(scanner) ?? null;
  const filtered = filtered_of(scene, scanner);
  const shown = filtered ?? raw;
  if (!shown || beam >= shown.sweep.ranges.length) return null;
  const { end } = sweep_points(shown);
  const at = { x: end[2 * beam], y: end[2 * beam + 1] };
  if (Number.isNaN(at.x)) return null;
  const bearing = shown.sweep.angle_min + beam * shown.sweep.angle_increment;
  const ahead = Math.abs(shown.sweep.mount.heading) <= Math.PI / 2;
  const used = ahead && Math.abs(bearing) <= kUsedHalf + 1e-6;
  const nearest = used ? nearest_sides(scene).find((s) => s.beam === beam) : undefined;
  const rows = [turned("Bearing", bearing), ...range_row("Range, filtered", filtered, beam, "filtered"),
    ...range_row("Range, raw", raw, beam, "scan")];
  const note = !ahead ? "looks back, not used" : !used ? "not used: beyond 74.5°" : nearest ? `used, nearest ${nearest.side}` : "used";
  const push = nearest && push_of(scene, nearest);
  return { title: `Beam ${beam}`, note, rows: [...rows, ...(push?.rows ?? [])], law: push?.law ?? null, at, height: kScanHeight, radius: 0 };
}

/** The external force that the nearest return of a side exerts on the end of the strip. */
function push_of(scene: SceneState, nearest: Side): { rows: Row[]; law: Law | null } {
  const force = measure_of(scene, `strip.${nearest.side}`);
  const pose = scene.frame?.pose;
  if (force === null || !Number.isFinite(force) || !pose) return { rows: [], law: null };
  const d = distance(pose, nearest.point);
  const rows = [metres("From the centre, d", d), metres("External force", force, "external")];
  const idle = force === 0 && pushes_once(scene.controller);
  const once: Law = { law: "Only the nearest return of all pushes", source: "Eq. 7", numbers: "" };
  const others = nearest_sides(scene).some((s) => distance(pose, s.point) < d);
  return { rows, law: idle && others ? once : external_law(scene, d) };
}

function echo_card(scene: SceneState, key: string): Card | null {
  const r = scene.readings.get(key);
  const pose = robot_pose(scene);
  if (!r || !pose) return null;
  const at = { x: r.origin.x + r.range * Math.cos(r.origin.heading), y: r.origin.y + r.range * Math.sin(r.origin.heading) };
  const rows = [turned("Bearing", wrap_angle(r.origin.heading - pose.heading)), metres("Range", r.range, "scan"),
    { label: "Age", value: fixed((scene.frame?.stamp ?? r.stamp) - r.stamp, 2), unit: "s" }];
  return { title: r.kind === "sonar" ? "Sonar" : "Infrared", note: r.kind === "sonar" ? "somewhere on its arc" : "", rows, law: null, at,
    height: kScanHeight, radius: 0 };
}

function mark_card(scene: SceneState, name: string, index: number): Card | null {
  const layer = scene.layers.get(name);
  const pose = scene.frame?.pose;
  if (!layer || !pose) return null;
  switch (layer.kind) {
    case "points":
    case "polyline": return node_card(scene, layer, pose, index);
    case "arrows": return arrow_card(scene, layer, pose, index);
    case "circles": return circle_card(scene, layer, pose, index);
    case "arcs": return arc_card(layer, pose, index);
    default: return null;
  }
}

function node_card(scene: SceneState, layer: LayerView, pose: Pose, index: number): Card | null {
  const all = places(layer, pose);
  const at = all.at(index);
  if (!at || !Number.isFinite(at.x)) return null;
  const rows = [position(at)];
  if (layer.kind === "polyline") {
    const way = (from: number, to: number) => all.slice(from, to).reduce((sum, p, i) => {
      const step = distance(p, all[from + i + 1]);
      return Number.isFinite(step) ? sum + step : sum;
    }, 0);
    rows.push(metres("Along it from its start", way(0, index), token_of(layer)), metres("On to its end", way(index, all.length - 1)));
  }
  rows.push(metres("From the robot", distance(pose, at)));
  const of = all.length > 1 ? `${layer.label}, node ${index + 1} of ${all.length}` : layer.label;
  return { title: of, note: "", rows, law: layer_law(layer.name), at, height: at.z ?? kStripHeight, radius: 0 };
}

function arrow_card(scene: SceneState, layer: LayerView, pose: Pose, index: number): Card | null {
  const arrow = arrows(layer, pose).at(index);
  if (!arrow) return null;
  const { at, by } = arrow;
  const length = Math.hypot(by.x, by.y, by.z ?? 0);
  const token = token_of(layer);
  const unit = is_scaled(layer) ? "m" : layer.unit;
  const of = (name: string) => measure_of(scene, name);
  const side = layer.name === "strip.external" ? side_of_force(scene, layer, pose, index) : undefined;
  const rows = [{ label: is_scaled(layer) ? "Force" : unit === "m" ? "Distance" : "Speed", value: fixed(length, 3), unit, token },
    turned("Towards, in W", Math.atan2(by.y, by.x)),
    { label: "Along x, y", value: `${fixed(by.x, 3)}, ${fixed(by.y, 3)}`, unit },
    ...(side ? [metres("Nearest return, d", distance(pose, side.point), "filtered")] : [])];
  const law = side ? external_law(scene, distance(pose, side.point)) : force_law(scene, layer.name, of);
  return { title: layer.label, note: side ? `from the ${side.side}` : "", rows, law, at, height: at.z ?? kStripHeight, radius: 0 };
}

/** Both forces come left first; a single one is of the side that pushes. */
function side_of_force(scene: SceneState, layer: LayerView, pose: Pose, index: number): Side | undefined {
  const both = arrows(layer, pose).length > 1;
  const side = both ? (["left", "right"] as const)[index]
    : (measure_of(scene, "strip.left") ?? 0) > (measure_of(scene, "strip.right") ?? 0) ? "left" : "right";
  return nearest_sides(scene).find((s) => s.side === side);
}

/** A tracked thing: its velocity is the arrow that begins in its middle. */
function circle_card(scene: SceneState, layer: LayerView, pose: Pose, index: number): Card | null {
  const circle = circles(layer, pose).at(index);
  if (!circle) return null;
  const velocities = scene.layers.get("moving.velocity");
  const by = velocities && arrows(velocities, pose).find((a) => distance(a.at, circle.at) < 1e-3)?.by;
  const rows = [position(circle.at), metres("Radius", circle.radius),
    ...(by ? [{ label: "Speed", value: fixed(Math.hypot(by.x, by.y), 2), unit: "m/s", token: token_of(layer) },
      turned("Towards, in W", Math.atan2(by.y, by.x))] : [])];
  return { title: `${layer.label}, ${index + 1}`, note: by ? "tracked in the scans" : "", rows, law: null, at: circle.at,
    height: kScanHeight, radius: circle.radius };
}

function arc_card(layer: LayerView, pose: Pose, index: number): Card | null {
  const [length, turn] = [layer.values[2 * index], layer.values[2 * index + 1]];
  const line: Place[] | undefined = arcs(layer, pose).at(index);
  if (length === undefined || turn === undefined || !line) return null;
  const rows = [metres("Driven", length, token_of(layer)), turned("Turned", turn)];
  return { title: layer.label, note: "", rows, law: null, at: line[line.length - 1], height: kGround, radius: 0 };
}

function cell_card(scene: SceneState, name: string, at: Point): Card | null {
  const layer = scene.layers.get(name);
  const pose = scene.frame?.pose;
  const cell = layer && pose && cell_at(layer, pose, at);
  if (!layer || !cell) return null;
  const value = (): Row => {
    if (cell.byte === kUnknownCell) return { label: "Value", value: "unknown", unit: "" };
    if (name === "histogram.grid") return { label: "Returns counted, C", value: String(Math.round(((cell.byte - 127) * 15) / 127)), unit: "of 15" };
    if (name === "certainty.grid") return { label: "Certainty, −1 to 1", value: fixed((cell.byte - 127) / 127, 2), unit: "" };
    return { label: "Occupied", value: cell.byte === 254 ? "yes" : cell.byte === 0 ? "no" : fixed(cell.byte / 254, 2), unit: "" };
  };
  const rows = [{ ...value(), token: token_of(layer) }, position(cell.middle), metres("Edge", cell.cell)];
  return { title: `${layer.label}, cell ${cell.column}, ${cell.row}`, note: "", rows, law: layer_law(name), at: cell.middle,
    height: kGround, radius: cell.cell / 2 };
}

function sector_card(scene: SceneState, name: string, index: number): Card | null {
  const layer = scene.layers.get(name);
  const pose = scene.frame?.pose;
  const sector = layer && pose && sectors(layer, pose).find((s) => s.index === index);
  if (!layer || !sector) return null;
  const middle = (sector.from + sector.to) / 2;
  const rows = [{ label: "Density", value: fixed(layer.values[index], 0), unit: layer.unit, token: token_of(layer) },
    { label: "Free below", value: fixed(layer.level, 0), unit: layer.unit }, turned("Bearing in W", wrap_angle(middle))];
  const r = scene.radius + 0.2;
  return { title: `${layer.label}, sector ${index}`, note: sector.free ? "free" : "blocked", rows, law: layer_law(name),
    at: { x: pose.x + r * Math.cos(middle), y: pose.y + r * Math.sin(middle) }, height: kGround, radius: 0 };
}

function path_card(scene: SceneState, t: number): Card | null {
  const { columns } = scene;
  const row = columns.row_at(t);
  if (columns.length === 0) return null;
  const at = { x: columns.at("x", row), y: columns.at("y", row) };
  const time = columns.at("t", row);
  const truth = { x: columns.at("truth.x", row), y: columns.at("truth.y", row) };
  const rows = [{ label: "Time", value: clock(time), unit: "" }, position(at),
    { label: "Speed", value: fixed(columns.at("odometry.v", row), 2), unit: "m/s" },
    ...(Number.isFinite(truth.x) ? [metres("Odometry off by", distance(at, truth))] : [])];
  return { title: "Travelled path", note: "by odometry", rows, law: null, at, height: kGround, radius: 0 };
}

function goal_card(scene: SceneState, index: number): Card | null {
  const heading = index === 0 ? scene.goal?.heading ?? null : null;
  const at = index === 0 ? scene.goal : scene.goals_ahead.at(index - 1);
  const pose = robot_pose(scene);
  if (!at || !pose) return null;
  const rows = [position(at), ...(heading === null ? [] : [turned("Heading", heading)]),
    metres(index === 0 ? "From the robot, D" : "From the robot", distance(pose, at))];
  const of = scene.goals_ahead.length > 0 ? `Goal ${index + 1} of ${scene.goals_ahead.length + 1}` : "Goal";
  return { title: of, note: index === 0 ? "" : "after the others", rows, law: null, at, height: kGround, radius: 0.22 };
}

function obstacle_card(scene: SceneState, id: number): Card | null {
  const o = scene.obstacles.find((each) => each.id === id);
  if (!o || o.away) return null;
  const moving = scene.frame?.moved.some((m) => m.id === id) ?? false;
  const rows = [position(o.pose), ...size_rows(o), ...(o.bottom > 0 ? [metres("Bottom", o.bottom)] : []), metres("Height", o.height)];
  const radius = o.kind === "cylinder" ? o.radius : Math.min(o.length || 1, o.width || 1) / 2;
  return { title: obstacle_title(o), note: moving ? `moves by itself${stay_of(o)}` : "", rows, law: null, at: o.pose, height: o.height, radius,
    long: o.kind === "wall" };
}

/** When one that comes and goes is here. */
function stay_of({ path }: Obstacle): string {
  return path?.comes_and_goes ? `, here from ${fixed(path.keys[0][0], 1)} to ${fixed(path.keys.at(-1)![0], 1)} s` : "";
}

/** The ground at `at`: its height there, and its slope. */
function ground_card(scene: SceneState, id: number, at: Point): Card | null {
  const o = scene.obstacles.find((each) => each.id === id);
  if (!o) return null;
  const height = top_at(o, at);
  const rows = [position(at), metres("Height here", height), turned("Slope", slope_of(o)),
    ...(o.kind === "ramp" ? [metres("Height, low end", o.low), metres("Height, high end", o.height)] : []),
    metres("Length", o.length), metres("Width", o.width), turned("Turned", o.pose.heading)];
  return { title: obstacle_title(o), note: o.kind === "ramp" ? "rises along its arrow" : "", rows, law: null, at, height, radius: 0.05 };
}

function size_rows(o: Obstacle): Row[] {
  if (o.kind === "cylinder") return [metres("Radius", o.radius)];
  const turn = turned("Turned", o.pose.heading);
  if (o.kind === "polygon") return [{ label: "Corners", value: String(o.points.length), unit: "" }];
  return [metres("Length", o.length), metres(o.kind === "wall" ? "Thickness" : "Width", o.width), turn];
}

function robot_card(scene: SceneState): Card | null {
  const pose = robot_pose(scene);
  if (!pose) return null;
  const f = scene.frame;
  const { hull, radius } = scene;
  const pair = (label: string, twist: { v: number; omega: number }): Row =>
    ({ label, value: `${fixed(twist.v, 2)} m/s, ${fixed(twist.omega, 2)}`, unit: "rad/s" });
  const size: Row = hull
    ? { label: "Hull, length × width", value: `${fixed(2 * hull.half_length, 2)} × ${fixed(2 * hull.half_width, 2)}`, unit: "m" }
    : metres("Hull, radius", radius);
  const truth = f?.truth;
  const tilt = tilt_of(scene);
  const stands = tilt ? [turned("Roll, left side up", tilt.roll), turned("Pitch, nose down", tilt.pitch)] : [];
  const rows = [position(pose), turned("Heading", pose.heading), ...stands, ...(f ? [pair("Moves", f.twist), pair("Commanded", f.command)] : []),
    ...(truth ? [metres("Odometry off by", distance(truth.pose, pose)), metres("True clearance", truth.clearance)] : []), size,
    ...(scene.drives ? [metres("Safety circle, d_safe", scene.safety_distance, "safe")] : [])];
  return { title: "Robot", note: "by odometry", rows, law: null, at: pose, height: 0.2, radius };
}
