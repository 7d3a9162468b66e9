// web/src/views/drive.tsx: the Drive view: the scene with its cards and tools, panel and transport.
import { JSX } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { App, use_app, use_ui } from "../app";
import { Draft } from "../draw/scene";
import { is_ground_tool } from "../edit/drawn";
import { Gestures, Tool } from "../edit/gestures";
import { scene_bounds } from "../state/scene";
import { SceneCanvas, scale_insets } from "../ui/canvas";
import { may } from "../people";
import { Guard, use_me } from "../ui/guard";
import { icons } from "../ui/icons";
import { lazy } from "../ui/lazy";
import { Banner, Explain, Staleness } from "./cards";
import { LayerButton, LayerPanel, use_filtered } from "./layers";
import { FirstSteps } from "./first_steps";
import { free_insets, is_lost } from "./free";
import { PreviewCard } from "./preview";
import { crosshair_key, use_scene_keys } from "./keys";
import { Figures, Tuning } from "./panel";
import { Transport } from "./transport";
import { ValueBox } from "./value_box";
import { ViewOnly } from "./watching";

const HandTool = lazy(async () => (await import("../arm/part")).HandTool);
const SceneThree = lazy(async () => (await import("../three/view")).SceneThree);

/** The state that gestures and keys of the Drive view share: the draft that is drawn, the hover. */
export interface Hand {
  draft: Draft;
  hovered: number | null;
  gestures: Gestures;
}

export function Drive(): JSX.Element {
  const app = use_app();
  const { three, sheet, tool, selection, force_scale, hidden, layers, preview } =
    use_ui("three", "sheet", "tool", "selection", "force_scale", "hidden", "layers", "preview");
  const hand = useMemo(() => make_hand(app), [app]);
  const main = useRef<HTMLElement>(null);

  useEffect(() => app.redraw(), [selection, force_scale, hidden, layers, tool, preview]);
  useEffect(() => {
    app.view.target = null; // there is more room, or less
    app.redraw();
  }, [layers, sheet]);
  use_filtered((wanted) => app.want_filtered(wanted));
  use_scene_keys(app, hand);

  return (
    <>
      <main class="scene" ref={main} aria-label="Scene">
        {three
          ? <SceneThree insets={() => free_insets(main.current!)} />
          : <SceneCanvas scene={() => app.shown} view={app.view} gestures={hand.gestures}
              label="The world from above. Arrow keys move the crosshair or the selection. Enter places an object."
              cursor={app.usable_tool} bounds={() => scene_bounds(app.shown)}
              insets={() => free_insets(main.current!)} lost={() => is_lost(app, main.current!)}
              on_ready={(redraw) => (app.redraw = redraw)} on_key={(e) => crosshair_key(app, hand, e)}
              overlay={() => ({
                selection: app.ui.value.selection, hovered: hand.hovered, draft: hand.draft,
                handles: (app.ui.value.session?.robot.editable ?? false) && !app.ui.value.looking,
                force_scale: app.ui.value.force_scale, hidden: app.ui.value.hidden, ghosts: [], future: app.ui.value.looking,
                insets: scale_insets(main.current!), preview: app.ui.value.preview?.goal ?? null,
                hand: app.desk?.draft,
              })} />}
      </main>
      <section class="contents" aria-label="Tools"><Tools /></section>
      {!three && <Guard need="operator"><ValueBox hand={hand} /></Guard>}
      <div class="cards">
        <Explain />
        <PreviewCard />
        <section class="notes" aria-label="Notes"><Banner /><Staleness /><ViewOnly /><FirstSteps /></section>
      </div>
      {layers && <LayerPanel scene={app.shown} on_close={() => app.show_layers(false)} />}
      <Transport />
      <aside class="panel" aria-label="Figures and gains">
        <Figures />
        <div class="tuning wide-only"><Tuning /></div>
      </aside>
      {sheet && <div class="sheet" role="region" aria-label="Controller, gains and signals" data-testid="sheet">
        <button class="icon sheet-close" aria-label="Close" onClick={() => app.ui.set({ sheet: false })}>{icons.down}</button>
        <div class="tuning"><Tuning /></div>
      </div>}
    </>
  );
}

/** `tool`: the one that a press uses. Without `edits` no press changes the world. */
export function make_hand(app: App, { tool = () => app.usable_tool, edits = true, view = app.view } = {}): Hand {
  const hand: Hand = { draft: {}, hovered: null, gestures: null as unknown as Gestures };
  hand.gestures = new Gestures({
    get scene() {
      return app.shown;
    },
    view,
    tool,
    can_edit: () => edits && app.people.may("operator") && (app.ui.value.session?.robot.editable ?? false),
    will_edit: () => app.go_live(),
    looks_back: () => app.ui.value.looking,
    set_goal: (goal) => app.editor.want_goal(goal),
    add_goal: (goal) => app.editor.want_goal(goal, true),
    change_goal: (index, goal) => app.editor.change_goal(index, goal),
    set_start: (pose) => app.editor.set_start(pose),
    set_pose: (pose) => void app.editor.set_pose(pose),
    add: (obstacle) => void app.editor.add(obstacle),
    change: (label, from, to) => void app.editor.change(label, from, to),
    snap: (p) => app.editor.snap(p),
    appends: () => app.ui.value.appending,
    selection: () => app.ui.value.selection,
    refuse: (sentence) => app.toast("warn", sentence),
    move: (id, pose, from, done) => app.editor.drag(id, pose, from, done),
    select: (selection) => app.ui.set({ selection }),
    draft: (draft) => {
      hand.draft = draft;
      app.redraw();
    },
    hover: (id) => {
      if (id === hand.hovered) return;
      hand.hovered = id;
      app.redraw();
    },
    changed: () => app.redraw(),
    arm: () => (app.scene.arm ? app.desk : null),
  });
  return hand;
}

function Tools(): JSX.Element {
  const app = use_app();
  const { session, tool, three, layers: open, undo, redo } =
    use_ui("session", "tool", "three", "layers", "undo", "redo");
  const may_drive = may(use_me(), "operator");
  const drives = may_drive && (session?.robot.drives ?? false);
  const editable = may_drive && (session?.robot.editable ?? false);
  const threed = (
    <button class={`text-tool ${three ? "on" : ""}`} aria-pressed={three} data-testid="three"
      aria-label="3D view" title="3D (3)" onClick={() => app.show_three(!three)}>3D</button>
  );
  const layers = <LayerButton class="layers-tool" open={open} on_press={(open) => app.show_layers(open)} />;
  // The 3D view only shows: a pixel there is no single place of the world.
  const fit = (
    <button aria-label="Fit the world into the view" title="Fit (F)" data-testid="fit"
      onClick={() => app.fit_view()}>{icons.fit}</button>
  );
  const hand = drives && session?.robot.arm && <HandTool />;
  if (three) return <div class="tools" role="toolbar" aria-label="Tools">{hand}{fit}{layers}{threed}</div>;
  const button = (name: Tool, label: string, key: string, can: boolean, on = tool === name, mark: string = name) => can && (
    <button class={on ? "on" : ""} aria-pressed={on}
       aria-label={label} title={`${label} (${key})`} data-testid={`tool-${mark}`}
      onClick={() => app.pick_tool(name)}>
      {icons[mark as "goal"]}
    </button>
  );
  const ground = is_ground_tool(tool);
  return (
    <div class="tools" role="toolbar" aria-label="Tools" aria-orientation="vertical">
      {button("pan", "Select: press an object, drag the view or the selected object", "V", true)}
      {button("goal", "Goal: press for the position, drag for the heading", "G", drives)}
      {hand}
      {button("pose", "Pose on the map: press for the position, drag for the heading", "I", may_drive && !!session?.map)}
      {button("start", "Start: press for the position, drag for the heading", "S", editable)}
      {button("wall", "Wall: drag from end to end, or press both ends", "W", editable)}
      {button("cylinder", "Cylinder: press for the position, drag for the size", "C", editable)}
      {button("box", "Box: press for the position, drag for the size", "B", editable)}
      {button("polygon", "Polygon: press its corners", "O", editable)}
      {button("mover", "Walking person: press the corners of the path", "K", editable)}
      {button(ground ? tool : "ramp", "Ramp, step or trench: drag the way over it, uphill", "R, E, T", editable, ground, "ground")}
      {button("measure", "Measure a distance", "M", true)}
      {(drives || editable) && <button aria-label={undo ? `Undo: ${undo}` : "Undo"} title={undo ? `Undo: ${undo} (Ctrl+Z)` : "Nothing to undo"}
        disabled={!undo} data-testid="undo" onClick={() => void app.editor.undo()}>{icons.undo}</button>}
      {redo && <button class="wide-only" aria-label={`Do again: ${redo}`} title={`Do again: ${redo} (Ctrl+Shift+Z)`}
        onClick={() => void app.editor.redo()}>{icons.redo}</button>}
      {fit}
      {layers}
      {threed}
    </div>
  );
}
