// web/src/arm/joint_sliders.tsx: the seven joints, each by a slider and by a number; and the fold.
import { JSX } from "preact";
import { use_app } from "../app";
import type { ArmInfo } from "../contract";
import { degrees, radians } from "../geometry";
import type { ArmDesk } from "./desk";
import { Range } from "./range";

const kJoints = ["Shoulder 1", "Shoulder 2", "Shoulder 3", "Elbow", "Wrist 1", "Wrist 2", "Wrist 3"];
const kHelp = [
  "Turns the arm about the upright axis of the shoulder", "Lifts the upper arm; at 0 it hangs down", "Turns the upper arm about itself",
  "Bends the elbow; at 0 the arm is straight", "Turns the forearm about itself", "Bends the wrist; at 0 the hand goes on along the forearm",
  "Turns the hand about itself",
];

export function JointSliders(props: { desk: ArmDesk; arm: ArmInfo }): JSX.Element | null {
  const app = use_app();
  const { desk, arm } = props;
  const joints = app.scene.frame?.joints;
  const asked = desk.joints_asked;
  if (!joints || !asked) return null;
  return (
    <section aria-label="Joints">
      <h2>Joints</h2>
      {joints.map((q, k) => {
        const limit = Math.round(degrees(arm.limits[k]) * 10) / 10;
        return (
          <Range key={k} name={`joint-${k + 1}`} label={kJoints[k]} help={kHelp[k]} min={-limit} max={limit} step={1}
            value={degrees(q)} aim={app.scene.arm_asked?.type === "set_joints" ? degrees(asked[k]) : undefined}
            on_slide={(v) => desk.turn(k, radians(v), false)} on_set={(v) => desk.turn(k, radians(v), true)} />
        );
      })}
      <div class="acts">
        <button type="button" class="small" data-testid="arm-fold" title="Turns all joints to the folded pose"
          onClick={() => void desk.fold()}>Fold the arm</button>
      </div>
    </section>
  );
}
