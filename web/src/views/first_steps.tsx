// web/src/views/first_steps.tsx: three steps for someone who is here for the first time, one at a time.
// A step that was done leads to the next one.
import { JSX } from "preact";
import { App, use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { Tool } from "../edit/gestures";
import { kAllDone, kGoalStep, kObstacleStep } from "../state/first_steps";
import { use_pulse } from "../state/store";
import { may } from "../people";
import { use_me } from "../ui/guard";
import { icons } from "../ui/icons";

/** Whether the built-in demo goes round by itself, because nobody has set a goal yet. */
function demo_runs(session: SessionState): boolean {
  return session.scenario.name === "demo" && session.loop;
}

/** `tool`: the one that the step takes; once it is picked the words say where to press. */
interface Step { words: string; tool?: Tool; picked?: string; label: string; key?: string; act: (app: App) => void }

/** The 3D view takes no tools. */
function take(app: App, tool: Tool): void {
  app.ui.set({ three: false });
  app.pick_tool(tool);
}

function step_of(step: number, session: SessionState, lost: boolean): Step {
  if (step === kGoalStep && lost) {
    return {
      words: "Tell the robot where it is.", tool: "pose", picked: "Press where the robot is; drag for its heading.",
      label: "Give its pose", key: "I", act: (app) => take(app, "pose"),
    };
  }
  if (step === kGoalStep) {
    const real = session.source === "hardware";
    return {
      words: real ? "Set a goal, arm the motors, press Go." : demo_runs(session)
        ? "A demo is running. Set a goal to take over." : "Send the robot somewhere.",
      tool: "goal", picked: "Press where the goal shall be; drag for the heading.", label: "Set a goal", key: "G",
      act: (app) => take(app, "goal"),
    };
  }
  if (step === kObstacleStep) {
    return {
      words: "Put something in its way.", tool: "cylinder", picked: "Press in front of the robot; drag for the size.",
      label: "Drop an obstacle", key: "C", act: (app) => take(app, "cylinder"),
    };
  }
  return {
    words: "Try another controller on the same way, then look at both runs.", label: "See the runs",
    act: (app) => {
      app.to_step(kAllDone);
      app.go("runs");
    },
  };
}

export function FirstSteps(): JSX.Element | null {
  const app = use_app();
  const { step, tool, preview, session } = use_ui("step", "tool", "preview", "session");
  use_pulse(500); // frames tell whether the robot is lost
  const may_drive = may(use_me(), "operator");
  if (!may_drive || !session?.robot.drives || preview || step >= kAllDone) return null;
  if (session.source === "hardware" && step > kGoalStep) return null;
  const fix = app.scene.frame?.map_pose?.fix ?? "located";
  const { words, tool: takes, picked, label, key, act } = step_of(step, session, fix !== "located");
  const ready = takes !== undefined && tool === takes;
  return (
    <div class="card steps" data-testid="steps">
      <small class="num">{step + 1}/{kAllDone}</small>
      <span>{ready ? picked : words}</span>
      {!ready && <button class="small primary" data-testid="steps-act" onClick={() => act(app)}>
        {takes && icons[takes as "goal"]}{label}{key && <kbd class="wide">{key}</kbd>}</button>}
      <button class="icon" aria-label="Do not show these steps" title="Do not show these steps" data-testid="steps-close"
        onClick={() => app.to_step(kAllDone)}>{icons.close}</button>
    </div>
  );
}
