// web/src/views/new_values.tsx: the numbers of the next obstacle, and the end of a sketch.
import { JSX } from "preact";
import { use_app } from "../app";
import { SketchTool } from "../edit/drawn";
import { kThickness, kUsualRadius, kUsualSide, new_box, new_cylinder, new_wall } from "../edit/edits";
import { radians, to_parent } from "../geometry";
import { robot_pose } from "../state/scene";
import { NumberField } from "../ui/controls";
import { Hand } from "./drive";
import { Form, tenths, use_typed } from "./value_form";

const kAhead = 2; // [m] from the robot to a new obstacle: in its way, but clear of its hull

export function NewValues(props: { kind: "cylinder" | "box" | "wall" }): JSX.Element {
  const app = use_app();
  const pose = robot_pose(app.scene);
  const { x, y } = pose ? to_parent(pose, kAhead, 0) : { x: 0, y: 0 };
  const usual = {
    x: tenths(x), y: tenths(y), radius: kUsualRadius, length: kUsualSide, width: kUsualSide, turn: 0,
    x1: tenths(x), y1: tenths(y), x2: tenths(x), y2: tenths(y + 1), thick: kThickness,
  };
  const [v, type, forget] = use_typed(usual);
  const apply = async () => {
    const made = props.kind === "cylinder" ? new_cylinder(v.x, v.y, v.radius)
      : props.kind === "box" ? new_box(v.x, v.y, v.length, v.width, radians(v.turn))
        : new_wall({ x: v.x1, y: v.y1 }, { x: v.x2, y: v.y2 }, v.thick);
    if (await app.editor.add(made)) forget();
  };
  const field = (name: keyof typeof v, unit = "m", step = 0.1) => (
    <NumberField key={name} label={name} unit={unit} name={`new-${name}`} value={v[name]} step={step}
      on_change={(value) => type({ [name]: value ?? usual[name] })} />
  );
  return (
    <Form label={`New ${props.kind}`} name="new-values" class="unasked" on_submit={() => void apply()}>
      <b>New {props.kind}</b>
      {props.kind === "wall" ? [field("x1"), field("y1"), field("x2"), field("y2"), field("thick", "m", 0.05)]
        : [field("x"), field("y")]}
      {props.kind === "cylinder" && field("radius", "m", 0.05)}
      {props.kind === "box" && [field("length"), field("width"), field("turn", "°", 5)]}
      <button type="submit" class="small primary" data-testid="new-add">Add</button>
    </Form>
  );
}

const kHow: Record<SketchTool, string> = {
  wall: "Press its other end.",
  polygon: "Press its corners. Press the first one again to close it.",
  mover: "Press the corners of its path. Press the last one again to end it.",
};

/** The sketch in progress, for fingers and keys that cannot press a point twice. */
export function SketchValues(props: { tool: SketchTool; hand: Hand }): JSX.Element {
  const { gestures } = props.hand;
  const enough = gestures.sketch.length >= (props.tool === "polygon" ? 3 : 2);
  return (
    <Form label="Sketch" name="sketch-values" on_submit={() => gestures.finish_sketch()}>
      <b>{{ wall: "Wall", polygon: "Polygon", mover: "Walking person" }[props.tool]}</b>
      <span class="quiet">{kHow[props.tool]}</span>
      <button type="submit" class="small primary" disabled={!enough} data-testid="sketch-done">Done</button>
      <button type="button" class="ghost small" data-testid="sketch-drop" onClick={() => gestures.cancel()}>Drop</button>
    </Form>
  );
}
