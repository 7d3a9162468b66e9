// web/src/views/obstacle_values.tsx: the numbers of the selected obstacle, by its kind.
import { JSX } from "preact";
import { use_app } from "../app";
import { corners_of, duplicate, new_wall, remove_edit, speed_of, walk } from "../edit/edits";
import { degrees, radians, to_parent } from "../geometry";
import { slope_of } from "../ground";
import { Obstacle, is_ground, is_robot, obstacle_title } from "../obstacle";
import { NumberField } from "../ui/controls";
import { icons } from "../ui/icons";
import { fixed } from "../words";
import { Form, tenths, use_typed } from "./value_form";

type Values = Record<string, number>;
interface FieldInfo { name: string; label: string; unit: string; step?: number; min?: number; digits?: number }

/** Of what an arm passes above or below. */
const kHeights: FieldInfo[] = ["bottom", "height"].map((name) => ({ name, label: name, unit: "m", step: 0.05, min: 0 }));

const kPlace: FieldInfo[] = [{ name: "x", label: "x", unit: "m" }, { name: "y", label: "y", unit: "m" }];
const kTurn: FieldInfo = { name: "turn", label: "turn", unit: "°", step: 5 };
const length = (name: string, label = name): FieldInfo => ({ name, label, unit: "m", step: 0.05, min: 0 });

/** Of ground: a robot minds a millimetre of a step. */
const rise = (name: string): FieldInfo => ({ ...length(name), step: 0.01, digits: 3 });

/** The fields of an obstacle of this kind. */
function fields_of(o: Obstacle): FieldInfo[] {
  if (o.path) {
    return [...(o.kind === "cylinder" ? [length("radius")] : []),
      ...(o.path.comes_and_goes ? [] : [{ name: "speed", label: "speed", unit: "m/s", min: 0 }])];
  }
  switch (o.kind) {
    case "cylinder":
      return [...kPlace, length("radius")];
    case "box":
      return [...kPlace, kTurn, length("length"), length("width")];
    case "polygon":
      return [...kPlace, kTurn];
    case "ramp":
      return [...kPlace, kTurn, length("length"), length("width"), rise("low"), rise("height")];
    case "step":
      return [...kPlace, kTurn, length("length"), length("width"), rise("height")];
    case "trench":
      return [...kPlace, kTurn, length("length"), length("width"), rise("depth")];
    case "wall":
      return [...["x1", "y1", "x2", "y2"].map((name) => ({ name, label: name, unit: "m" })), length("width", "thick")];
  }
}

function values_of(o: Obstacle): Values {
  const a = to_parent(o.pose, -o.length / 2, 0);
  const b = to_parent(o.pose, o.length / 2, 0);
  return {
    x: o.pose.x, y: o.pose.y, turn: tenths(degrees(o.pose.heading)), radius: o.radius, length: o.length,
    width: o.width, low: o.low, bottom: o.bottom, height: o.height, depth: -o.low, x1: a.x, y1: a.y, x2: b.x, y2: b.y, speed: o.path ? speed_of(o.path) : 0,
  };
}

/** `o` with the typed values; the others keep all their digits. */
function with_values(o: Obstacle, v: Values, typed: (name: string) => boolean): Obstacle {
  const out = { ...o, pose: { ...o.pose } };
  for (const name of ["radius", "length", "width", "low", "bottom", "height"] as const) if (typed(name)) out[name] = v[name];
  if (typed("height") && !is_ground(o)) out.extra = { ...o.extra, height: v.height };
  if (o.kind === "step") out.low = out.height;
  if (typed("depth")) out.low = -v.depth;
  if (o.kind === "wall") {
    if (!["x1", "y1", "x2", "y2"].some(typed)) return out;
    const wall = new_wall({ x: v.x1, y: v.y1 }, { x: v.x2, y: v.y2 }, out.width);
    return { ...out, pose: wall.pose, length: wall.length };
  }
  if (o.path) {
    return typed("speed") ? { ...out, path: { ...walk(corners_of(o.path), v.speed), phase: o.path.phase ?? 0 } } : out;
  }
  if (typed("x")) out.pose.x = v.x;
  if (typed("y")) out.pose.y = v.y;
  if (typed("turn")) out.pose.heading = radians(v.turn);
  return out;
}

/** What the title leaves out. */
function measure_of(o: Obstacle): string {
  if (o.path) return `${o.away ? "away, " : ""}walks ${speed_of(o.path).toFixed(2)} m/s`;
  if (o.kind === "wall") return `${o.length.toFixed(2)} m long`;
  if (o.kind === "ramp") return `${fixed(degrees(slope_of(o)), 1)}°`;
  return o.kind === "polygon" ? `${o.points.length} corners` : "";
}

export function ObstacleValues(props: { obstacle: Obstacle; editable: boolean }): JSX.Element {
  const app = use_app();
  const o = props.obstacle;
  const now = values_of(o);
  const [v, type, forget, changed] = use_typed(now,
    [o.path ? 0 : o.pose.x, o.path ? 0 : o.pose.y, o.pose.heading, o.radius, o.length, o.width, o.low, o.bottom, o.height]);
  const apply = () => {
    if (o.path && !(v.speed > 0)) return app.toast("warn", "A speed must be above 0.");
    const to = with_values(o, v, (name) => v[name] !== now[name]);
    void app.editor.change(`Change ${obstacle_title(o).toLowerCase()}`, o, to).then((done) => done && forget());
  };
  const can = props.editable && !is_robot(o);
  return (
    <Form label={obstacle_title(o)} name="obstacle-values" on_submit={apply}>
      <b>{obstacle_title(o)}</b>
      <span class="quiet num">{measure_of(o)}</span>
      {[...fields_of(o), ...(app.scene.arm && !is_ground(o) ? kHeights : [])].map((f) => (
        <NumberField key={f.name} label={f.label} unit={f.unit} name={`obstacle-${f.name}`} value={v[f.name]}
          step={f.step} min={f.min} digits={f.digits} on_change={(value) => type({ [f.name]: value ?? now[f.name] })} />
      ))}
      {can && <>
        <button type="submit" class="small primary" disabled={!changed} data-testid="obstacle-set">Set</button>
        <button type="button" class="icon" aria-label="Duplicate" title="Duplicate (Ctrl+D)" data-testid="obstacle-copy"
          onClick={() => void app.editor.add(duplicate(o))}>{icons.copy}</button>
        <button type="button" class="icon" aria-label="Remove" title="Remove (Delete)" data-testid="obstacle-remove"
          onClick={() => void app.editor.edit(remove_edit(o))}>{icons.trash}</button>
      </>}
      <button type="button" class="icon" aria-label="Close" title="Close (Escape)"
        onClick={() => app.ui.set({ selection: null })}>{icons.close}</button>
    </Form>
  );
}
