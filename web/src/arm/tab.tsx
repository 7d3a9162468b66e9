// web/src/arm/tab.tsx: the Arm tab: what the arm does and why, the goal of its hand, its joints, carrying, and how near
// its links are to things.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import type { SceneState } from "../state/scene";
import { use_pulse } from "../state/store";
import css from "../style/arm.css?text";
import { Guard } from "../ui/guard";
import { adopt } from "../ui/sheet";
import { Named } from "../ui/tip";
import { Tone, fixed } from "../words";
import { CarryForm } from "./carry_form";
import { HandForm } from "./hand_form";
import { JointSliders } from "./joint_sliders";

adopt(css);

const kPulse = 100; // [ms]

export function ArmTab(): JSX.Element | null {
  const app = use_app();
  const { looking } = use_ui("session", "looking", "selection", "tool");
  use_pulse(kPulse);
  const scene = app.shown;
  const { desk } = app;
  if (!scene.arm) return null;
  return (
    <div class="arm-tab">
      <State scene={scene} />
      {looking && <p class="quiet">This is an earlier instant. Its arm cannot be moved.</p>}
      {!looking && desk && <Guard need="operator">
        <HandForm desk={desk} />
        <JointSliders desk={desk} arm={scene.arm} />
        <CarryForm desk={desk} />
      </Guard>}
      <Clearance scene={scene} />
    </div>
  );
}

const kStates: Record<string, [word: string, tone: Tone]> = {
  rest: ["At rest", "muted"], turns: ["Turning the joints", "info"], plans: ["Looking for a way", "info"],
  goes: ["On its way", "ok"], waits: ["Waiting", "warn"], arrived: ["Arrived", "ok"], given_up: ["No way to the goal", "warn"],
};

/** The state in a word, and the robot's own sentence. */
function State(props: { scene: SceneState }): JSX.Element {
  const { frame, words } = props.scene;
  const state = frame?.arm?.state ?? "rest";
  const held = frame !== null && frame.hold !== "none";
  const [word, tone] = held ? ["Held", "bad"] : kStates[state];
  const why = held || state !== "rest" ? words?.why : "Give the hand a goal, or turn the joints.";
  return (
    <p class={`arm-state tone-${tone}`} role="status" data-testid="arm-state">
      <b>{word}</b> <span data-testid="arm-why">{why}</span>
    </p>
  );
}

const kNear = 0.05; // [m] nearer the robot waits: docs/arm.md
const kParts = ["Base", "Mast", "Upper arm", "Forearm", "Hand"];
const kMeaning = "From its surface to the nearest thing that the robot knows, within 3 m. Nearer than 0.05 m it waits, and 0.03 m is never passed.";

function Clearance(props: { scene: SceneState }): JSX.Element | null {
  const arm = props.scene.frame?.arm;
  if (!arm) return null;
  const rows = [...kParts.map((label, k) => ({ label, value: arm.clearance[k] ?? NaN, meaning: kMeaning })),
    { label: "To itself", value: arm.own, meaning: "From forearm and hand to the robot's own base, mast and upper arm. 5 mm is never passed." }];
  return (
    <section>
      <h2>Clearance</h2>
      <dl class="arm-clear" data-testid="arm-clearance">
        {rows.map(({ label, value, meaning }) => {
          const near = value < kNear && label !== "To itself";
          return (
            <div key={label} class={near ? "tone-warn near" : ""}>
              <dt><Named label={label} meaning={meaning} /></dt>
              <dd class="num">{value === Infinity ? "nothing near" : <>{near && "near: "}{fixed(value, 2)} m</>}</dd>
            </div>
          );
        })}
      </dl>
    </section>
  );
}
