// web/src/views/goal_values.tsx: the numbers of a goal, and of the start.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { Pose, degrees, radians } from "../geometry";
import { Goal } from "../link/frame";
import { NumberField } from "../ui/controls";
import { icons } from "../ui/icons";
import { Form, tenths, use_typed } from "./value_form";

/** `index`: of a goal in a list of several. */
export function GoalValues(props: { goal: Goal | null; index: number | null; selected: boolean }): JSX.Element {
  const app = use_app();
  const { appending, tool } = use_ui("appending", "tool");
  const { goal: g, index } = props;
  const [v, type, forget, changed] = use_typed({
    x: g?.x ?? null, y: g?.y ?? null, turn: g?.heading == null ? null : tenths(degrees(g.heading)),
  }, [g?.x, g?.y, g?.heading]);
  const set = (goal: Goal | null) => (index === null ? app.editor.want_goal(goal) : app.editor.change_goal(index, goal));
  const apply = () => {
    if (v.x === null || v.y === null) {
      app.toast("warn", "A goal needs both x and y.");
      return;
    }
    set({ x: v.x, y: v.y, heading: v.turn === null ? null : radians(v.turn) });
    forget();
  };
  const title = index === null ? "Goal" : `Goal ${index + 1}`;
  return (
    <Form label={title} name="goal-values" class={props.selected ? "" : "unasked"} on_submit={apply}>
      <b class="tone-ok">{title}</b>
      <NumberField label="x" unit="m" name="goal-x" value={v.x} on_change={(x) => type({ x })} />
      <NumberField label="y" unit="m" name="goal-y" value={v.y} on_change={(y) => type({ y })} />
      <NumberField label="heading" unit="°" name="goal-heading" value={v.turn} step={5} empty="any"
        on_change={(turn) => type({ turn })} />
      <button type="submit" class="small primary" disabled={!changed} data-testid="goal-set">{app.on_hardware ? "Preview" : "Set"}</button>
      {g && <button type="button" class="icon" aria-label={index === null ? "Clear the goal" : "Remove this goal"}
        title={index === null ? "Clear the goal (Delete)" : "Remove this goal (Delete)"}
        onClick={() => set(null)}>{icons.trash}</button>}
      {tool === "goal" && !app.on_hardware &&
        <label class="check"><input type="checkbox" checked={appending} data-testid="goal-append"
          onChange={(e) => app.ui.set({ appending: e.currentTarget.checked })} /><span>Add to the list</span></label>}
    </Form>
  );
}

/** Of the robot on the map that it knows. */
export function PoseValues(props: { pose: Pose }): JSX.Element {
  const app = use_app();
  const { x, y, heading } = props.pose;
  const [v, type, forget] = use_typed({ x, y, turn: tenths(degrees(heading)) }, []);
  const apply = () => {
    void app.editor.set_pose({ x: v.x, y: v.y, heading: radians(v.turn) });
    forget();
  };
  return (
    <Form label="Pose on the map" name="pose-values" on_submit={apply}>
      <b>Pose</b>
      <span class="quiet">within 2 m and 25°</span>
      <NumberField label="x" unit="m" name="pose-x" value={v.x} on_change={(x) => type({ x: x ?? props.pose.x })} />
      <NumberField label="y" unit="m" name="pose-y" value={v.y} on_change={(y) => type({ y: y ?? props.pose.y })} />
      <NumberField label="heading" unit="°" name="pose-heading" value={v.turn} step={5}
        on_change={(turn) => type({ turn: turn ?? tenths(degrees(heading)) })} />
      <button type="submit" class="small primary" data-testid="pose-set">Set</button>
      <button type="button" class="small" data-testid="pose-search" onClick={() => void app.editor.set_pose(null)}>Search the map</button>
    </Form>
  );
}

export function StartValues(props: { start: Pose }): JSX.Element {
  const app = use_app();
  const { x, y, heading } = props.start;
  const [v, type, , changed] = use_typed({ x, y, turn: tenths(degrees(heading)) }, [x, y, heading]);
  return (
    <Form label="Start" name="start-values" on_submit={() => app.editor.set_start({ x: v.x, y: v.y, heading: radians(v.turn) })}>
      <b>Start</b>
      <span class="quiet">taken at the next reset</span>
      <NumberField label="x" unit="m" name="start-x" value={v.x} on_change={(x) => type({ x: x ?? props.start.x })} />
      <NumberField label="y" unit="m" name="start-y" value={v.y} on_change={(y) => type({ y: y ?? props.start.y })} />
      <NumberField label="heading" unit="°" name="start-heading" value={v.turn} step={5}
        on_change={(turn) => type({ turn: turn ?? tenths(degrees(heading)) })} />
      <button type="submit" class="small primary" disabled={!changed} data-testid="start-set">Set</button>
    </Form>
  );
}
