// web/src/teleop/corner.tsx: beside a view in 3D, a small map of the robot from above; below the scene, what its marks
// mean to a driver.
import { JSX } from "preact";
import { useEffect, useMemo, useRef } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Palette, read_palette } from "../draw/palette";
import { Overlay, draw_scene } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Bounds } from "../geometry";
import { SceneState } from "../state/scene";

const kAround = 3; // [m] shown about the robot
const kNoInsets = { left: 0, top: 0, right: 0, bottom: 0 };

/** The bounds of what the driver needs to see. */
export function about(scene: SceneState): Bounds {
  const at = scene.frame?.pose ?? { x: 0, y: 0 };
  return { min_x: at.x - kAround, max_x: at.x + kAround, min_y: at.y - kAround, max_y: at.y + kAround };
}

/** Nothing is selected, drafted or edited at the seat. */
export function seat_overlay(shown: Pick<Overlay, "force_scale" | "hidden">, insets: Insets): Overlay {
  const { force_scale, hidden } = shown;
  return {
    selection: null, hovered: null, draft: {}, handles: false, force_scale, hidden, ghosts: [], future: false, insets,
    preview: null,
  };
}

/** Drawn whenever the view is rendered, which is ten times a second. A press makes it the large one. */
export function CornerMap(props: { on_press: () => void }): JSX.Element {
  const app = use_app();
  const { theme, hidden, force_scale } = use_ui("theme", "hidden", "force_scale");
  const canvas = useRef<HTMLCanvasElement>(null);
  const view = useMemo(() => new View(), []);
  const palette = useRef<{ theme: string; colours: Palette } | null>(null);
  useEffect(() => {
    const { clientWidth: width, clientHeight: height } = canvas.current!;
    const ratio = Math.min(3, devicePixelRatio || 1);
    if (view.width !== width || view.height !== height) {
      view.resize(width, height, 0, 0);
      Object.assign(canvas.current!, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    }
    if (width < 2 || height < 2) return; // a window without room hides it
    if (palette.current?.theme !== theme) palette.current = { theme, colours: read_palette() };
    view.approach(view.fit_target(about(app.shown), kNoInsets), 1);
    const g = canvas.current!.getContext("2d")!;
    g.setTransform(ratio, 0, 0, ratio, 0, 0);
    draw_scene(g, view, palette.current.colours, app.shown, seat_overlay({ force_scale, hidden }, kNoInsets));
  });
  return (
    <button class="corner-map" data-testid="corner-map" aria-label="The robot from above: make this the large view"
      title="Make this the large view" onClick={props.on_press}><canvas ref={canvas} aria-hidden="true" /></button>
  );
}

const kMarks = [
  { name: "What a sonar hears", mark: <path class="ring" d="M2 9 11 1l9 8z" /> },
  { name: "What slows the robot", mark: <path class="slows" d="M2 9 11 1l9 8z" /> },
  { name: "The wall model", mark: <path class="wall" d="M1 5h20" /> },
  { name: "As the stick asks", mark: <path class="asked" d="M1 5h20" /> },
  { name: "As the robot moves", mark: <path class="moved" d="M1 5h20" /> },
];

export function Legend(): JSX.Element {
  return (
    <ul class="card legend-card" aria-label="Marks">
      {kMarks.map(({ name, mark }) => <li key={name}><svg viewBox="0 0 22 10" aria-hidden="true">{mark}</svg>{name}</li>)}
    </ul>
  );
}
