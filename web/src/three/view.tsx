// web/src/three/view.tsx: the 3D view as a component; three.js is fetched when it is first shown.
import { JSX, TargetedPointerEvent } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { read_palette } from "../draw/palette";
import type { Insets } from "../draw/view";
import type { HandleName } from "../arm/gizmo";
import { pointing_of } from "../arm/pose";
import type { HandGoalJson } from "../contract";
import { Point, degrees } from "../geometry";
import { use_latest, use_listener, use_pulse } from "../state/store";
import { Inspector } from "../ui/inspector";
import { Probe } from "../ui/probe";
import { fixed } from "../words";
import type { World3 } from "./world";

/** Why this browser cannot show 3D; null if it can. */
function no_webgl(): string | null {
  const probe = document.createElement("canvas");
  const context = probe.getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context ? null
    : "This browser offers no WebGL 2, so the 3D view cannot be drawn. The view from above shows the same.";
}

const kHandles: Record<HandleName, (g: HandGoalJson) => string> = {
  x: (g) => `Along x: ${fixed(g.x, 2)} m`, y: (g) => `Along y: ${fixed(g.y, 2)} m`, z: (g) => `Height: ${fixed(g.z, 2)} m`,
  level: (g) => `Over the floor: ${fixed(g.x, 2)}, ${fixed(g.y, 2)} m`,
  bearing: (g) => `Bearing: ${fixed(degrees(pointing_of(g).bearing), 0)}°`, pitch: (g) => `Pitch: ${fixed(degrees(pointing_of(g).pitch), 0)}°`,
  turn: (g) => `Turn about itself: ${fixed(degrees(pointing_of(g).turn), 0)}°`,
};

/** The handle of the hand's goal under the pointer, with its number. */
function GizmoWords(props: { handle: () => HandleName | null }): JSX.Element | null {
  const { desk, ui } = use_app();
  use_ui("tool", "selection", "view");
  use_pulse(100);
  const goal = ui.value.view === "drive" && desk?.chosen ? desk.goal : null;
  const handle = props.handle();
  return goal && (
    <p class={`gizmo-words card ${handle ? "" : "idle"}`} data-testid="gizmo-words">{handle ? kHandles[handle](goal) : "Drag an axis to move the hand's goal, a ring to turn it"}</p>
  );
}

/** `insets`: the margins that tools and cards cover. With `chase` the camera rides behind the robot. `on_above`: goes
 * to the view from above. */
export function SceneThree(props: { insets: () => Insets; chase?: boolean; on_above?: () => void }): JSX.Element {
  const app = use_app();
  const { theme, follow } = use_ui("theme", "follow");
  const box = useRef<HTMLDivElement>(null);
  const world = useRef<World3 | null>(null);
  const latest = use_latest(props);
  const [problem, set_problem] = useState<string | null>(null);
  const probe = useMemo(() => new Probe(), []);
  const eye = (px: Point, slack: number) => world.current?.eye(px, slack) ?? null;
  const place = (e: TargetedPointerEvent<HTMLElement>): Point => {
    const corner = e.currentTarget.getBoundingClientRect();
    return { x: e.clientX - corner.left, y: e.clientY - corner.top };
  };

  useEffect(() => {
    const missing = no_webgl();
    if (missing) {
      set_problem(missing);
      return;
    }
    let gone = false;
    const started = async () => {
      const { World3 } = await import("./world");
      if (gone || !box.current) return;
      world.current = new World3(box.current, read_palette(), () => app.shown, () => ({
          ...app.ui.value, chase: latest.current.chase, desk: app.ui.value.view === "drive" && app.scene.arm ? app.desk : null,
        }));
      app.redraw = () => world.current?.request();
      app.fit_three = () => world.current?.fit();
    };
    started().catch(() => set_problem("The 3D part of the page could not be fetched. The view from above shows the same."));
    return () => {
      gone = true;
      app.fit_three = () => undefined;
      world.current?.dispose();
      world.current = null;
    };
  }, []);
  use_listener("pagehide", () => world.current?.keep_orbit());
  useEffect(() => world.current?.set_palette(read_palette()), [theme]);
  useEffect(() => world.current?.request(), [follow, props.chase]);

  if (problem) {
    return (
      <div class="no-webgl" role="alert" data-testid="no-webgl">
        <p>{problem}</p>
        <button class="small primary" onClick={() => (props.on_above ?? (() => app.show_three(false)))()}>Show it from above</button>
      </div>
    );
  }
  return (
    <div class="three" ref={box} data-testid="scene-3d" onPointerDown={(e) => probe.pressed(place(e))}
      onPointerMove={(e) => probe.moved(place(e), e.buttons === 0 ? e.pointerType : "drag")}
      onPointerUp={(e) => probe.released(place(e), e.pointerType)}
      onPointerLeave={() => probe.left()}>
      <Inspector scene={() => app.shown} probe={probe} box={() => box.current} eye={eye} shown={() => app.ui.value}
        insets={props.insets} resting={() => world.current !== null} selection={() => null} crosshair={() => null} />
      {!props.chase && <GizmoWords handle={() => world.current?.handle ?? null} />}
      {!props.chase && <button class={`follow small ${follow ? "on" : ""}`} aria-pressed={follow}
        onClick={() => app.ui.set({ follow: !follow })}>Follow the robot</button>}
    </div>
  );
}
