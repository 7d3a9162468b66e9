// web/src/views/new_ground.tsx: the kind and the numbers of the next ramp, step or trench.
import { JSX } from "preact";
import css from "../style/ground.css?text";
import { use_app } from "../app";
import "../draw/ground"; // the first sketch of ground is drawn as ground
import { kUsualGround, new_ground } from "../edit/edits";
import { radians, to_parent } from "../geometry";
import { GroundKind } from "../obstacle";
import { robot_pose } from "../state/scene";
import { NumberField, Segments } from "../ui/controls";
import { adopt } from "../ui/sheet";
import { Form, tenths, use_typed } from "./value_form";

adopt(css);

const kAhead = 2.5; // [m] from the robot to the middle of new ground
const kKinds = [
  { name: "ramp", label: "Ramp", help: "Drag uphill, from the low end to the high end (R)" },
  { name: "step", label: "Step", help: "Drag the way over it (E)" },
  { name: "trench", label: "Trench", help: "Drag from edge to edge, the way over it (T)" },
];

export function NewGround(props: { kind: GroundKind }): JSX.Element {
  const app = use_app();
  const { kind } = props;
  const pose = robot_pose(app.scene);
  const { x, y } = pose ? to_parent(pose, kAhead, 0) : { x: 0, y: 0 };
  const usual = kUsualGround[kind];
  const first = {
    x: tenths(x), y: tenths(y), turn: 0, length: usual.length, width: usual.width, low: 0, height: usual.rise, depth: usual.rise,
  };
  const [v, type, forget] = use_typed(first);
  const apply = async () => {
    const made = { ...new_ground(kind, { x: v.x, y: v.y, heading: radians(v.turn) }, v.length), width: v.width };
    const ends = kind === "trench" ? { low: -v.depth } : { low: kind === "step" ? v.height : v.low, height: v.height };
    if (await app.editor.add({ ...made, ...ends })) forget();
  };
  const field = (name: keyof typeof v, unit = "m", step = 0.05, digits = 2) => (
    <NumberField key={name} label={name} unit={unit} name={`new-${name}`} value={v[name]} step={step} digits={digits}
      on_change={(value) => type({ [name]: value ?? first[name] })} />
  );
  const rises = kind === "ramp" ? ["low", "height"] as const : kind === "step" ? ["height"] as const : ["depth"] as const;
  return (
    <Form label={`New ${kind}`} name="new-values" class="new-ground" on_submit={() => void apply()}>
      <Segments label="Kind of ground" name="ground-kind" choices={kKinds} value={kind}
        on_pick={(name) => app.pick_tool(name as GroundKind)} />
      {field("x", "m", 0.1)}{field("y", "m", 0.1)}{field("length")}{field("width")}
      {rises.map((name) => field(name, "m", 0.01, 3))}{field("turn", "°", 5)}
      <button type="submit" class="small primary" data-testid="new-add">Add</button>
    </Form>
  );
}
