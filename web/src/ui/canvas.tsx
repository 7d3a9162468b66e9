// web/src/ui/canvas.tsx: the drawn scene as a component: sizes itself, draws on animation frames
// when something changed, feeds pointers to gestures, keeps the view fitted until a hand moves it.
import { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { Palette, read_palette } from "../draw/palette";
import { Overlay, draw_scene } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Gestures } from "../edit/gestures";
import { Bounds } from "../geometry";
import { SceneState } from "../state/scene";

interface CanvasProps {
  scene: SceneState;
  view: View;
  gestures: Gestures;
  label: string;
  theme: string;
  overlay: () => Overlay;
  bounds: () => Bounds;
  insets: () => Insets;
  /** Handed a function that asks for one more drawing. */
  on_ready: (redraw: () => void) => void;
  on_key?: (event: KeyboardEvent) => void;
  cursor?: string;
}

const kFitMs = 140; // time constant of the view's own moves

export function SceneCanvas(props: CanvasProps): JSX.Element {
  const element = useRef<HTMLCanvasElement>(null);
  const latest = useRef(props);
  latest.current = props;
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
      // Messages ask the canvas that was left until the next is there. Both would fit the one view, each
      // undoing the other's move, for ever.
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

    const at = (e: { clientX: number; clientY: number }) => {
      const box = canvas.getBoundingClientRect();
      return { x: e.clientX - box.left, y: e.clientY - box.top };
    };
    const down = (e: PointerEvent) => {
      canvas.focus({ preventScroll: true });
      canvas.setPointerCapture(e.pointerId);
      latest.current.gestures.down(e.pointerId, at(e), e.button, e.shiftKey);
      e.preventDefault();
      request();
    };
    const move = (e: PointerEvent) => {
      latest.current.gestures.move(e.pointerId, at(e));
      if (latest.current.gestures.busy) request();
    };
    const up = (e: PointerEvent) => {
      latest.current.gestures.up(e.pointerId, at(e));
      request();
    };
    const cancel = () => {
      latest.current.gestures.cancel();
      request();
    };
    const wheel = (e: WheelEvent) => {
      e.preventDefault();
      const p = at(e);
      latest.current.view.zoom_at(p.x, p.y, Math.exp(-e.deltaY * (e.deltaMode === 1 ? 0.05 : 0.0016)));
      request();
    };
    const menu = (e: Event) => e.preventDefault(); // the right button pans
    const key = (e: KeyboardEvent) => latest.current.on_key?.(e);
    const observer = new ResizeObserver(size);
    observer.observe(canvas);
    canvas.addEventListener("pointerdown", down);
    canvas.addEventListener("pointermove", move);
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", cancel);
    canvas.addEventListener("wheel", wheel, { passive: false });
    canvas.addEventListener("contextmenu", menu);
    canvas.addEventListener("keydown", key);
    size();
    return () => {
      observer.disconnect();
      cancelAnimationFrame(pending);
    };
  }, []);

  useEffect(() => {
    palette.current = null; // the theme's colours are read again
    redraw.current();
  }, [props.theme, props.scene]);

  return (
    <canvas ref={element} class="scene-canvas" tabIndex={0} role="application"
      aria-label={props.label} aria-describedby="scene-words" data-testid="scene"
      data-cursor={props.cursor} />
  );
}

/** Says on the element itself what it shows (centre x, y [m], scale [px/m]), so that a script can
 * point at a place of the world. Nothing while the view is on its way. */
function tell_view(canvas: HTMLCanvasElement, view: View, moving: boolean): void {
  const now = moving ? "" : [view.x, view.y, view.scale].map((v) => v.toFixed(4)).join(" ");
  if (canvas.dataset.view !== now) canvas.dataset.view = now;
}
