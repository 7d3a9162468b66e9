// web/src/views/drive.tsx: the Drive view: the scene with its cards and tools, panel and transport.
import { JSX } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { App, use_app, use_ui } from "../app";
import { Draft } from "../draw/scene";
import { Insets } from "../draw/view";
import { Gestures, Tool } from "../edit/gestures";
import { scene_bounds } from "../state/scene";
import { SceneCanvas, scale_insets } from "../ui/canvas";
import { icons } from "../ui/icons";
import { SceneThree } from "../three/view";
import { Banner, Explain, Staleness } from "./cards";
import { LayerButton, LayerPanel, panel_cover, use_filtered } from "./layers";
import { GoalHint, PreviewCard } from "./preview";
import { crosshair_key, use_scene_keys } from "./keys";
import { Figures, Tuning } from "./panel";
import { Transport } from "./transport";
import { ValueBox } from "./value_box";

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
  use_filtered((wanted) => app.want_filtered(wanted));
  use_scene_keys(app, hand);

  return (
    <>
      <main class="scene" ref={main} aria-label="Scene">
        {three
          ? <SceneThree />
          : <SceneCanvas scene={app.scene} view={app.view} gestures={hand.gestures}
              label="The world from above. Arrow keys move the crosshair or the selection. Enter places an object."
              cursor={app.usable_tool} bounds={() => scene_bounds(app.scene)}
              insets={() => free_insets(main.current!)}
              on_ready={(redraw) => (app.redraw = redraw)} on_key={(e) => crosshair_key(app, hand, e)}
              overlay={() => ({
                selection: app.ui.value.selection, hovered: hand.hovered, draft: hand.draft,
                force_scale: app.ui.value.force_scale, hidden: app.ui.value.hidden, ghost: null, future: false,
                insets: scale_insets(main.current!), preview: app.ui.value.preview?.goal ?? null,
              })} />}
        <Tools />
        {!three && <ValueBox hand={hand} />}
        {!three && <GoalHint />}
        <Banner />
        <Staleness />
        <div class="cards"><div class="stack"><PreviewCard /><Explain /></div></div>
      </main>
      {layers && <LayerPanel scene={app.scene} on_close={() => app.show_layers(false)} />}
      <Transport />
      <aside class="panel" aria-label="Figures and gains">
        <Figures />
        <div class="tuning wide-only"><Tuning /></div>
      </aside>
      {sheet && <div class="sheet" role="region" aria-label="Controller, gains and signals" data-testid="sheet">
        <button class="sheet-close" onClick={() => app.ui.set({ sheet: false })}>
          Controller, gains and signals{icons.down}
        </button>
        <div class="tuning"><Tuning /></div>
      </div>}
    </>
  );
}

function make_hand(app: App): Hand {
  const hand: Hand = { draft: {}, hovered: null, gestures: null as unknown as Gestures };
  hand.gestures = new Gestures({
    scene: app.scene,
    view: app.view,
    tool: () => app.usable_tool,
    can_edit: () => app.ui.value.session?.robot.editable ?? false,
    set_goal: (goal) => app.want_goal(goal),
    add_goal: (goal) => app.want_goal(goal, true),
    add: (obstacle) => void app.add(obstacle),
    move: (id, pose, from, done) => app.drag(id, pose, from, done),
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
  });
  return hand;
}

/** The margins that tools, cards and panel cover, so that the fitted world lies beside them. */
function free_insets(main: HTMLElement): Insets {
  const insets = { left: 24, top: 24, right: 24, bottom: 48 };
  const box = main.getBoundingClientRect();
  const tools = main.querySelector(".tools")?.getBoundingClientRect();
  if (tools) insets.left = tools.right - box.left + 16;
  const values = main.querySelector(".values:not(.hint)")?.getBoundingClientRect();
  if (values && values.height > 0) insets.top = values.bottom - box.top + 12;
  insets.right = Math.max(insets.right, panel_cover(main) + 16);
  const cards = main.querySelector(".cards")?.getBoundingClientRect();
  if (cards && cards.height > 0) insets.bottom = box.bottom - cards.top + 12;
  return insets;
}

function Tools(): JSX.Element {
  const app = use_app();
  const { session, tool, three, layers: open, undo, redo } =
    use_ui("session", "tool", "three", "layers", "undo", "redo");
  const drives = session?.robot.drives ?? false;
  const editable = session?.robot.editable ?? false;
  const threed = (
    <button class={`text-tool ${three ? "on" : ""}`} aria-pressed={three} data-testid="three"
      aria-label="3D view" title="3D (3)" onClick={() => app.ui.set({ three: !three })}>3D</button>
  );
  const layers = <LayerButton class="layers-tool" open={open} on_press={(open) => app.show_layers(open)} />;
  // The 3D view only shows: a pixel there is no single place of the world.
  if (three) return <div class="tools" role="toolbar" aria-label="Tools">{layers}{threed}</div>;
  const button = (name: Tool, label: string, key: string, can: boolean) => can && (
    <button class={tool === name ? "on" : ""} aria-pressed={tool === name}
       aria-label={label} title={`${label} (${key})`} data-testid={`tool-${name}`}
      onClick={() => app.pick_tool(name)}>
      {icons[name as "goal"]}
    </button>
  );
  return (
    <div class="tools" role="toolbar" aria-label="Tools" aria-orientation="vertical">
      {button("pan", "Look round: drag to move the view, press to select", "V", true)}
      {button("goal", "Goal: press for the position, drag for the heading", "G", drives)}
      {button("cylinder", "Cylinder: press for the position, drag for the size", "C", editable)}
      {button("box", "Box: press for the position, drag for the size", "B", editable)}
      {button("measure", "Measure a distance", "M", true)}
      {(drives || editable) && <button aria-label={undo ? `Undo: ${undo}` : "Undo"} title={undo ? `Undo: ${undo} (Ctrl+Z)` : "Nothing to undo"}
        disabled={!undo} data-testid="undo" onClick={() => void app.undo()}>{icons.undo}</button>}
      {(drives || editable) && <button class="wide-only" aria-label={redo ? `Do again: ${redo}` : "Do again"} disabled={!redo}
        title={redo ? `Do again: ${redo} (Ctrl+Shift+Z)` : "Nothing to do again"}
        onClick={() => void app.redo()}>{icons.redo}</button>}
      <button aria-label="Fit the world into the view" title="Fit (F)" data-testid="fit"
        onClick={() => app.fit_view()}>{icons.fit}</button>
      {layers}
      {threed}
    </div>
  );
}
