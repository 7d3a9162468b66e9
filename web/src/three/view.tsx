// web/src/three/view.tsx: the 3D view as a component; three.js is fetched when it is first shown.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { read_palette } from "../draw/palette";
import type { World3 } from "./world";

/** Why this browser cannot show 3D; null if it can. */
function no_webgl(): string | null {
  const probe = document.createElement("canvas");
  const context = probe.getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context ? null
    : "This browser offers no WebGL 2, so the 3D view cannot be drawn. The view from above shows the same.";
}

export function SceneThree(): JSX.Element {
  const app = use_app();
  const { theme, follow } = use_ui("theme", "follow");
  const box = useRef<HTMLDivElement>(null);
  const world = useRef<World3 | null>(null);
  const [problem, set_problem] = useState<string | null>(null);

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
      world.current = new World3(box.current, read_palette(), app.scene, () => app.ui.value);
      app.redraw = () => world.current?.request();
    };
    started().catch(() => set_problem("The 3D part of the page could not be fetched. The view from above shows the same."));
    return () => {
      gone = true;
      world.current?.dispose();
      world.current = null;
    };
  }, []);
  useEffect(() => world.current?.set_palette(read_palette()), [theme]);
  useEffect(() => world.current?.request(), [follow]);

  if (problem) {
    return (
      <div class="no-webgl" role="alert" data-testid="no-webgl">
        <p>{problem}</p>
        <button class="small primary" onClick={() => app.ui.set({ three: false })}>Show it from above</button>
      </div>
    );
  }
  return (
    <div class="three" ref={box} data-testid="scene-3d">
      <button class={`follow small ${follow ? "on" : ""}`} aria-pressed={follow}
        onClick={() => app.ui.set({ follow: !follow })}>Follow the robot</button>
    </div>
  );
}
