// web/src/views/value_box.tsx: the numbers of the selected or the next object, to type.
import { ComponentChildren, JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { kUsualRadius, kUsualSide, move_edit, new_box, new_cylinder, remove_edit } from "../edit/edits";
import { degrees, radians, to_parent } from "../geometry";
import { Goal } from "../link/frame";
import { Obstacle, is_robot, obstacle_name, obstacle_title } from "../obstacle";
import { robot_pose } from "../state/scene";
import { use_pulse } from "../state/store";
import { NumberField } from "../ui/controls";
import { icons } from "../ui/icons";
import { Hand } from "./drive";

const kAhead = 2; // [m] from the robot to a new obstacle: in its way, but clear of its hull

export function ValueBox(props: { hand: Hand }): JSX.Element | null {
  const app = use_app();
  const { selection, tool, session } = use_ui("selection", "tool", "session");
  use_pulse(150);
  if (!session) return null;
  if (selection?.kind === "obstacle") {
    const o = app.selected_obstacle;
    if (!o) return null;
    const held = props.hand.draft.moved;
    const shown = held?.id === o.id ? { ...o, pose: held.pose } : o;
    return <ObstacleValues key={o.id} obstacle={shown} editable={session.robot.editable} />;
  }
  if ((selection?.kind === "goal" || tool === "goal") && session.robot.drives) {
    return <GoalValues goal={props.hand.draft.goal ?? app.shown_goal} selected={selection !== null} />;
  }
  if ((tool === "cylinder" || tool === "box") && session.robot.editable) {
    return <NewValues key={tool} kind={tool} />;
  }
  return null;
}

/** Fields over a value that the server may change, until someone types: the fields, a function that types
 * into them, one that drops what was typed, and whether something was typed. */
function use_typed<T>(value: T): [T, (change: Partial<T>) => void, () => void, boolean] {
  const [typed, set_typed] = useState<Partial<T> | null>(null);
  return [{ ...value, ...typed }, (change) => set_typed({ ...typed, ...change }),
    () => set_typed(null), typed !== null];
}

function tenths(v: number): number {
  return Math.round(10 * v) / 10;
}

/** A card of fields; `on_submit` is called for Enter and for its button. */
function Form(props: {
  label: string; name: string; class?: string; on_submit: () => void; children: ComponentChildren;
}): JSX.Element {
  return (
    <form class={`card values ${props.class ?? ""}`} noValidate aria-label={props.label} data-testid={props.name}
      onSubmit={(e) => {
        e.preventDefault();
        props.on_submit();
      }}>{props.children}</form>
  );
}

function GoalValues(props: { goal: Goal | null; selected: boolean }): JSX.Element {
  const app = use_app();
  const g = props.goal;
  const [v, type, forget, changed] = use_typed({
    x: g?.x ?? null, y: g?.y ?? null, turn: g?.heading == null ? null : tenths(degrees(g.heading)),
  });
  useEffect(forget, [g?.x, g?.y, g?.heading]);
  const apply = () => {
    if (v.x === null || v.y === null) {
      app.toast("warn", "A goal needs both x and y.");
      return;
    }
    app.want_goal({ x: v.x, y: v.y, heading: v.turn === null ? null : radians(v.turn) });
    forget();
  };
  return (
    <Form label="Goal" name="goal-values" class={props.selected ? "" : "unasked"} on_submit={apply}>
      <b class="tone-ok">Goal</b>
      <NumberField label="x" unit="m" name="goal-x" value={v.x} on_change={(x) => type({ x })} />
      <NumberField label="y" unit="m" name="goal-y" value={v.y} on_change={(y) => type({ y })} />
      <NumberField label="heading" unit="°" name="goal-heading" value={v.turn} step={5} empty="any"
        on_change={(turn) => type({ turn })} />
      <button type="submit" class="small primary" disabled={!changed} data-testid="goal-set">{app.on_hardware ? "Preview" : "Set"}</button>
      {g && <button type="button" class="icon" aria-label="Clear the goal" title="Clear the goal (Delete)"
        onClick={() => app.want_goal(null)}>{icons.trash}</button>}
    </Form>
  );
}

function ObstacleValues(props: { obstacle: Obstacle; editable: boolean }): JSX.Element {
  const app = use_app();
  const o = props.obstacle;
  const [v, type, forget, changed] = use_typed({
    x: o.pose.x, y: o.pose.y, turn: tenths(degrees(o.pose.heading)),
  });
  useEffect(forget, [o.pose.x, o.pose.y, o.pose.heading]);
  const apply = () => {
    const pose = { x: v.x, y: v.y, heading: radians(v.turn) };
    void app.edit(move_edit(o.id, o.pose, pose)).then(forget);
  };
  const size = o.kind === "cylinder" ? `radius ${o.radius.toFixed(2)} m`
    : o.kind === "polygon" ? `${o.points.length} corners`
      : `${o.length.toFixed(2)} × ${o.width.toFixed(2)} m`;
  return (
    <Form label={obstacle_name(o)} name="obstacle-values" on_submit={apply}>
      <b>{obstacle_title(o)}</b>
      <span class="quiet num">{size}</span>
      <NumberField label="x" unit="m" name="obstacle-x" value={v.x} on_change={(x) => type({ x: x ?? 0 })} />
      <NumberField label="y" unit="m" name="obstacle-y" value={v.y} on_change={(y) => type({ y: y ?? 0 })} />
      {o.kind !== "cylinder" &&
        <NumberField label="turn" unit="°" name="obstacle-turn" value={v.turn} step={5}
          on_change={(turn) => type({ turn: turn ?? 0 })} />}
      {props.editable && !is_robot(o) && <>
        <button type="submit" class="small primary" disabled={!changed}>Move</button>
        <button type="button" class="icon" aria-label="Remove" title="Remove (Delete)" data-testid="obstacle-remove"
          onClick={() => void app.edit(remove_edit(o))}>{icons.trash}</button>
      </>}
    </Form>
  );
}

function NewValues(props: { kind: "cylinder" | "box" }): JSX.Element {
  const app = use_app();
  const pose = robot_pose(app.scene);
  const { x, y } = pose ? to_parent(pose, kAhead, 0) : { x: 0, y: 0 };
  const [v, type, forget] = use_typed({
    x: tenths(x), y: tenths(y), radius: kUsualRadius, length: kUsualSide, width: kUsualSide, turn: 0,
  });
  const apply = async () => {
    const made = props.kind === "cylinder" ? new_cylinder(v.x, v.y, v.radius)
      : new_box(v.x, v.y, v.length, v.width, radians(v.turn));
    if (await app.add(made)) forget();
  };
  const field = (label: string, name: "x" | "y" | "radius" | "length" | "width" | "turn", unit = "m",
    step = 0.1) => (
    <NumberField label={label} unit={unit} name={`new-${name}`} value={v[name]} step={step}
      on_change={(value) => type({ [name]: value ?? 0 })} />
  );
  return (
    <Form label={`New ${props.kind}`} name="new-values" class="unasked" on_submit={() => void apply()}>
      <b>New {props.kind}</b>
      {field("x", "x")}
      {field("y", "y")}
      {props.kind === "cylinder" ? field("radius", "radius", "m", 0.05)
        : <>{field("length", "length")}{field("width", "width")}{field("turn", "turn", "°", 5)}</>}
      <button type="submit" class="small primary" data-testid="new-add">Add</button>
    </Form>
  );
}
