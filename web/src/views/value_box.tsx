// web/src/views/value_box.tsx: the numbers of the selected or the next object, to type.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { is_ground_tool, is_sketch } from "../edit/drawn";
import { use_pulse } from "../state/store";
import { Hand } from "./drive";
import { lazy } from "../ui/lazy";

// Fetched when a tool or a selection first needs them.
const GoalValues = lazy(async () => (await import("./values")).GoalValues);
const PoseValues = lazy(async () => (await import("./values")).PoseValues);
const StartValues = lazy(async () => (await import("./values")).StartValues);
const NewValues = lazy(async () => (await import("./values")).NewValues);
const NewGround = lazy(async () => (await import("./values")).NewGround);
const SketchValues = lazy(async () => (await import("./values")).SketchValues);
const ObstacleValues = lazy(async () => (await import("./values")).ObstacleValues);

export function ValueBox(props: { hand: Hand }): JSX.Element | null {
  const app = use_app();
  const { selection, session } = use_ui("selection", "tool", "session");
  use_pulse(150);
  if (!session) return null;
  const { draft, gestures } = props.hand;
  const tool = app.usable_tool;
  if (is_sketch(tool) && gestures.sketch.length > 0) return <SketchValues tool={tool} hand={props.hand} />;
  if (selection?.kind === "obstacle") {
    const o = app.selected_obstacle;
    if (!o) return null;
    const held = draft.moved;
    const shown = held?.id === o.id ? { ...o, pose: held.pose } : draft.obstacle?.id === o.id ? draft.obstacle : o;
    return <ObstacleValues key={o.id} obstacle={shown} editable={session.robot.editable} />;
  }
  if ((selection?.kind === "goal" || tool === "goal") && session.robot.drives) {
    const index = selection?.kind === "goal" ? selection.index ?? null : null;
    const goal = index === null ? app.editor.shown_goal : app.scene.route.goals[index] ?? null;
    return <GoalValues key={index} goal={draft.goal ?? goal} index={index} selected={selection !== null} />;
  }
  if (tool === "pose" && app.scene.frame) return <PoseValues pose={draft.pose ?? app.scene.frame.pose} />;
  if (tool === "start" && app.scene.start) return <StartValues start={draft.start ?? app.scene.start} />;
  if (is_ground_tool(tool)) return <NewGround kind={tool} />;
  if (tool === "cylinder" || tool === "box" || tool === "wall") return <NewValues key={tool} kind={tool} />;
  return null;
}
