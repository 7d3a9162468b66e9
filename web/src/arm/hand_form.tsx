// web/src/arm/hand_form.tsx: the goal of the hand in numbers, and the angle of the arm, which the hand leaves free.
import { JSX } from "preact";
import { use_app } from "../app";
import type { HandGoalJson } from "../contract";
import { degrees, radians } from "../geometry";
import { NumberField } from "../ui/controls";
import { fixed } from "../words";
import { arm_angle } from "./chain";
import { ArmDesk, hand_goal_of, pointed } from "./desk";
import { goal_at, pointing_of } from "./pose";
import { Range } from "./range";

const kFarthest = 180; // [degrees] of the arm angle to either side
const kAngleStep = 5;  // [degrees]
const tenths = (v: number) => Math.round(10 * v) / 10;

export function HandForm(props: { desk: ArmDesk }): JSX.Element | null {
  const app = use_app();
  const { desk } = props;
  const { goal, draft, place } = desk;
  if (!goal) return <p class="quiet">The arm has not told where it is yet.</p>;
  const asked = hand_goal_of(app.scene);
  const change = (to: Partial<HandGoalJson>) => desk.hold({ ...goal, ...to });
  const hand = pointing_of(goal);
  const angle = (name: "bearing" | "pitch" | "turn") => (
    <NumberField label={name} unit="°" name={`hand-${name}`} value={tenths(degrees(hand[name]))} step={5}
      on_change={(v) => v !== null && desk.hold(pointed(goal, { [name]: radians(v) }))} />
  );
  return (
    <section aria-label="Hand">
      <h2>Hand <small>{draft ? "not sent yet" : asked ? "its goal" : "where it is"}</small></h2>
      <form class="arm-form" noValidate data-testid="hand-values" onSubmit={(e) => {
        e.preventDefault();
        void desk.send(desk.goal ?? goal);
      }}>
        {(["x", "y", "z"] as const).map((name) => (
          <NumberField key={name} label={name} unit="m" name={`hand-${name}`} value={goal[name]} step={0.05}
            on_change={(v) => v !== null && change({ [name]: v })} />
        ))}
        {angle("bearing")}{angle("pitch")}{angle("turn")}
        <p class="help">The hand points along bearing (from x to the left) and pitch (up), and is turned about itself.</p>
        <ArmAngle desk={desk} goal={goal} />
        <label class="check"><input type="checkbox" checked={goal.base_stays ?? false} data-testid="hand-stays"
          onChange={(e) => change({ base_stays: e.currentTarget.checked })} /><span>The base stays where it is</span></label>
        <label class="check"><input type="checkbox" checked={goal.then !== undefined} data-testid="hand-then"
          onChange={(e) => change({ then: e.currentTarget.checked ? desk.here : undefined })} />
          <span>{goal.then ? `Then back to ${fixed(goal.then.x, 2)}, ${fixed(goal.then.y, 2)} m` : "Then the base comes back here"}</span></label>
        <Reach desk={desk} goal={goal} />
        <div class="acts">
          <button type="submit" class="small primary" data-testid="hand-go">Go</button>
          {draft ? <button type="button" class="small" data-testid="hand-discard" onClick={() => desk.hold(null)}>Discard</button>
            : asked ? <button type="button" class="small" data-testid="hand-clear" onClick={() => desk.clear()}>Clear goal</button>
            : null}
          {asked && place && <button type="button" class="small" title="Begin with the pose that the hand has now"
            onClick={() => desk.hold({ ...goal_at(place) })}>Start from here</button>}
        </div>
      </form>
    </section>
  );
}

/** The joint that the hand's pose leaves free: how far the elbow is turned about the line from shoulder to wrist. */
function ArmAngle(props: { desk: ArmDesk; goal: HandGoalJson }): JSX.Element | null {
  const app = use_app();
  const { desk, goal } = props;
  const { arm, frame } = app.scene;
  const now = arm && frame?.joints ? arm_angle(arm, frame.joints) : null;
  const value = goal.arm_angle ?? now;
  if (value === null) return null; // a straight arm has none
  return (
    <Range name="arm-angle" label="Arm angle" min={-kFarthest} max={kFarthest} step={kAngleStep} value={degrees(value)}
      words={goal.arm_angle === undefined ? "any" : undefined}
      help="How far the elbow is turned about the line from shoulder to wrist while the hand stays; at 0 it hangs lowest"
      reset={goal.arm_angle === undefined ? undefined : { label: "Let the robot choose the arm angle", act: () => desk.hold({ ...goal, arm_angle: undefined }) }}
      on_slide={(v) => desk.hold({ ...goal, arm_angle: radians(v) })}
      on_set={(v) => desk.drop({ ...goal, arm_angle: radians(v) })} />
  );
}

/** Why the hand does not get to a goal that is not sent yet; of a sent one the robot tells. */
function Reach(props: { desk: ArmDesk; goal: HandGoalJson }): JSX.Element | null {
  const { desk, goal } = props;
  const far = desk.draft && desk.reach(goal);
  if (!far) return null;
  if (!far.never && !goal.base_stays) return <p class="quiet" data-testid="hand-reach">The base has to come nearer first. {far.words}</p>;
  return (
    <p class="problem" role="alert" data-testid="hand-reach">
      {far.never ? "Out of reach from every place of the base." : "Out of reach while the base stays."} {far.words}
    </p>
  );
}
