// web/src/ui/canvas.tsx: the drawn scene as a component. It follows its size, draws on an animation
// frame after a change, passes pointers to gestures, and fits the view until a hand moves it.
import { JSX, TargetedPointerEvent } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { use_ui } from "../app";
import { Palette, read_palette } from "../draw/palette";
import { Overlay, draw_scene } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Gestures } from "../edit/gestures";
import { Bounds, Point } from "../geometry";
import { SceneState } from "../state/scene";
import { use_latest } from "../state/store";

interface CanvasProps {
  scene: SceneState;
  view: View;
  gestures: Gestures;
  label: string;
  overlay: () => Overlay;
  bounds: () => Bounds;
  insets: () => Insets;
  /** Handed a function that asks for one more drawing. */
  on_ready: (redraw: () => void) => void;
  on_key?: (event: KeyboardEvent) => void;
  cursor?: string;
}

const kScaleRoom = 190; // [px] that the scale bar and its words take
const kFitMs = 140; // [ms] time constant of the view's own moves

export function SceneCanvas(props: CanvasProps): JSX.Element {
  const { theme } = use_ui("theme");
  const element = useRef<HTMLCanvasElement>(null);
  const latest = use_latest(props);
  const palette = useRef<Palette | null>(null);
  const redraw = useRef<() => void>(() => undefined);

  useEffect(() => {
    const canvas = element.current!;
    const g = canvas.getContext("2d")!;
    const still = matchMedia("(prefers-reduced-motion: reduce)");
    let pending = 0;
    let last = performance.now();
    let first = true;

    const size = () => {
      const ratio = Math.min(3, devicePixelRatio || 1);
      const { view } = latest.current;
      view.width = canvas.clientWidth;
      view.height = canvas.clientHeight;
      canvas.width = Math.round(view.width * ratio);
      canvas.height = Math.round(view.height * ratio);
      first = true;
      request();
    };
    const draw = (now: number) => {
      pending = 0;
      const { view, scene } = latest.current;
      // Messages ask a removed canvas to draw until the next one exists. Both would fit the one
      // view and undo each other's moves without end.
      if (!canvas.isConnected || view.width < 2 || view.height < 2) return;
      const ratio = canvas.width / view.width;
      g.setTransform(ratio, 0, 0, ratio, 0, 0);
      palette.current ??= read_palette();
      let moving = false;
      if (view.fitted && !latest.current.gestures.busy) {
        const target = view.fit_target(latest.current.bounds(), latest.current.insets());
        const share = first || still.matches ? 1 : 1 - Math.exp(-(now - last) / kFitMs);
        moving = view.approach(target, Math.max(0.05, share));
        first = false;
      }
      last = now;
      draw_scene(g, view, palette.current, scene, latest.current.overlay());
      tell_view(canvas, view, moving);
      if (moving) request();
    };
    const request = () => {
      if (!pending) {
        if (performance.now() - last > 100) last = performance.now() - 16;
        pending = requestAnimationFrame(draw);
      }
    };
    redraw.current = request;
    latest.current.on_ready(request);

    const wheel = (e: WheelEvent) => {
      e.preventDefault();
      const p = place_of(e, canvas);
      latest.current.view.zoom_at(p.x, p.y, Math.exp(-e.deltaY * (e.deltaMode === 1 ? 0.05 : 0.0016)));
      request();
    };
    canvas.addEventListener("wheel", wheel, { passive: false });
    const observer = new ResizeObserver(size);
    observer.observe(canvas);
    size();
    return () => {
      observer.disconnect();
      cancelAnimationFrame(pending);
    };
  }, []);

  useEffect(() => {
    palette.current = null; // the theme's colours are read again
    redraw.current();
  }, [theme, props.scene]);

  const { gestures } = props;
  const down = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    e.currentTarget.focus({ preventScroll: true });
    e.currentTarget.setPointerCapture(e.pointerId);
    gestures.down(e.pointerId, place_of(e, e.currentTarget), e.button, e.shiftKey);
    e.preventDefault();
    redraw.current();
  };
  const move = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    gestures.move(e.pointerId, place_of(e, e.currentTarget));
    if (gestures.busy) redraw.current();
  };
  const up = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    gestures.up(e.pointerId, place_of(e, e.currentTarget));
    redraw.current();
  };
  return (
    <canvas ref={element} class="scene-canvas" tabIndex={0} role="application"
      aria-label={props.label} aria-describedby="scene-words" data-testid="scene"
      data-cursor={props.cursor} onPointerDown={down} onPointerMove={move} onPointerUp={up}
      onPointerCancel={() => gestures.cancel()} onKeyDown={props.on_key}
      onContextMenu={(e) => e.preventDefault() /* the right button pans */} />
  );
}

/** [px] Of a pointer from the corner of the canvas. */
function place_of(e: { clientX: number; clientY: number }, canvas: HTMLElement): Point {
  const box = canvas.getBoundingClientRect();
  return { x: e.clientX - box.left, y: e.clientY - box.top };
}

/** The scale bar stands at the lower right of `view`, above the sentence if that reaches there. */
export function scale_insets(view: HTMLElement): Insets {
  const insets = { left: 0, top: 0, right: 0, bottom: 22 };
  const box = view.getBoundingClientRect();
  const card = view.querySelector(".explain")?.getBoundingClientRect();
  if (card && card.right > box.right - kScaleRoom) insets.bottom = box.bottom - card.top + 14;
  return insets;
}

/** Writes the view (centre x, y [m], scale [px/m]) on the element, so that a script can point at a
 * place of the world. Empty while the view moves. */
function tell_view(canvas: HTMLCanvasElement, view: View, moving: boolean): void {
  const now = moving ? "" : [view.x, view.y, view.scale].map((v) => v.toFixed(4)).join(" ");
  if (canvas.dataset.view !== now) canvas.dataset.view = now;
}
