// web/src/teleop/eye.tsx: the world as the driver sees it: from behind the robot, from above, or from anywhere.
import { JSX } from "preact";
import { useMemo, useRef, useState } from "preact/hooks";
import { use_app } from "../app";
import { Insets, View } from "../draw/view";
import { SceneState } from "../state/scene";
import { keep, kept, use_latest } from "../state/store";
import { SceneCanvas } from "../ui/canvas";
import { Segments } from "../ui/controls";
import { lazy } from "../ui/lazy";
import { make_hand } from "../views/drive";
import { CornerMap, about, seat_overlay } from "./corner";

const SceneThree = lazy(async () => (await import("../three/view")).SceneThree);

const kFarOff = 0.8; // [m] from the middle, until the view follows
const kInsets = { left: 12, top: 12, right: 12, bottom: 12 };

const kEyes = [
  { name: "follow", label: "Follow", help: "In 3D, from behind the robot" },
  { name: "above", label: "Above", help: "From above" },
  { name: "free", label: "Free", help: "In 3D: drag to look round" },
];
type Eye = "follow" | "above" | "free";
const kEye = "tautline.teleop.eye";
const is_eye = (text: string): text is Eye => kEyes.some((e) => e.name === text);

/** `sets_goal`: a press sets a goal, from above, where the place is plain. */
export function DriverView(props: { sets_goal: boolean }): JSX.Element {
  const [eye, set_eye] = useState<Eye>(() => kept<Eye>(kEye, "above", (text) => (is_eye(text) ? text : "above")));
  const look = (name: string) => {
    keep(kEye, name);
    set_eye(name as Eye);
  };
  const above = eye === "above" || props.sets_goal;
  return (
    <>
      {above ? <FromAbove sets_goal={props.sets_goal} /> : <SceneThree insets={() => kInsets} chase={eye === "follow"} on_above={() => look("above")} />}
      {!above && <CornerMap on_press={() => look("above")} />}
      <div class="eye"><Segments label="View" name="eye" choices={kEyes} value={eye} on_pick={look} /></div>
    </>
  );
}

function FromAbove(props: { sets_goal: boolean }): JSX.Element {
  const app = use_app();
  const view = useMemo(() => new View(), []);
  const box = useRef<HTMLDivElement>(null);
  const latest = use_latest(props);
  const hand = useMemo(
    () => make_hand(app, { tool: () => (latest.current.sets_goal ? "goal" : "pan"), edits: false, view }), [app]);
  return (
    <div ref={box}><SceneCanvas scene={() => app.shown} view={view} gestures={hand.gestures}
      label="The robot and its surroundings from above" bounds={() => about(app.shown)}
      insets={() => free_of(box.current!.parentElement!)} lost={() => strayed(view, app.shown)}
      on_ready={(redraw) => (app.redraw = redraw)}
      overlay={() => seat_overlay(app.ui.value, kInsets)} /></div>
  );
}

const kSpans = 0.7; // of the view's width, from which on the sentence leaves no room beside it

/** The margins of the free part of `view`: on a phone the sentence covers all above. */
function free_of(view: HTMLElement): Insets {
  const say = view.querySelector(".say")?.getBoundingClientRect(), all = view.getBoundingClientRect();
  const covers = say && say.width > kSpans * all.width;
  return { ...kInsets, top: covers ? say.bottom - all.top : kInsets.top };
}

function strayed(view: View, scene: SceneState): boolean {
  const at = scene.frame?.pose;
  const { x, y } = view.target ?? view;
  return at !== undefined && Math.hypot(at.x - x, at.y - y) > kFarOff;
}
