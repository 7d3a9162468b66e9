// web/src/ui/canvas.tsx: the drawn scene as a component. It follows its size, draws on an animation
// frame after a change, passes pointers to gestures, and fits the view until a hand moves it. A fit
// is kept until a load, a resize or a person asks for another, or the scene no longer shows enough.
import { JSX, TargetedPointerEvent } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { use_ui } from "../app";
import { Palette, read_palette } from "../draw/palette";
import { Overlay, draw_scene, lacks_arm, lacks_ground } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Gestures } from "../edit/gestures";
import type { Eye } from "../edit/inspect";
import { Bounds, Point } from "../geometry";
import { drawing } from "../state/meter";
import { SceneState } from "../state/scene";
import { use_latest } from "../state/store";
import { lazy } from "./lazy";
import { Probe } from "./probe";

interface CanvasProps {
  scene: () => SceneState;
  view: View;
  gestures: Gestures;
  label: string;
  overlay: () => Overlay;
  bounds: () => Bounds;
  insets: () => Insets;
  /** Whether something that must be seen is not: then the view is fitted anew. */
  lost: () => boolean;
  /** Handed a function that asks for one more drawing. */
  on_ready: (redraw: () => void) => void;
  on_key?: (event: KeyboardEvent) => void;
  cursor?: string; // the tool; with "pan" things tell their numbers
}

const kScaleRoom = 190; // [px] that the scale bar and its words take
const kCards = ".explain, .preview, .notes > *";
const kFitMs = 140; // [ms] time constant of the view's own moves

// Fetched when the pointer or the crosshair first asks what is there.
const Inspector = lazy(async () => (await import("./inspector")).Inspector);

export function SceneCanvas(props: CanvasProps): JSX.Element {
  const { theme } = use_ui("theme");
  const element = useRef<HTMLCanvasElement>(null);
  const latest = use_latest(props);
  const palette = useRef<Palette | null>(null);
  const redraw = useRef<() => void>(() => undefined);
  const probe = useMemo(() => new Probe(), []);
  const [cards, set_cards] = useState(false);
  const show_cards = () => set_cards(true);

  useEffect(() => {
    const canvas = element.current!;
    const g = canvas.getContext("2d")!;
    const still = matchMedia("(prefers-reduced-motion: reduce)");
    let pending = 0;
    let last = performance.now();
    let first = true;
    let corner = canvas.getBoundingClientRect();
    let screen = "";

    const size = () => {
      const ratio = Math.min(3, devicePixelRatio || 1);
      const { view } = latest.current;
      const box = canvas.getBoundingClientRect();
      view.resize(canvas.clientWidth, canvas.clientHeight, box.left - corner.left, box.top - corner.top);
      corner = box;
      // Beside a card that grows the picture rests; in another window it is fitted.
      if (screen !== `${innerWidth} ${innerHeight}`) {
        view.target = null;
        first = true;
      }
      screen = `${innerWidth} ${innerHeight}`;
      canvas.width = Math.round(view.width * ratio);
      canvas.height = Math.round(view.height * ratio);
      request();
    };
    const draw = (now: number) => {
      pending = 0;
      const { view } = latest.current;
      // Messages ask a removed canvas to draw until the next one exists. Both would fit the one
      // view and undo each other's moves without end.
      if (!canvas.isConnected) return;
      if (canvas.clientWidth !== view.width || canvas.clientHeight !== view.height) size(); // before it is observed
      if (view.width < 2 || view.height < 2) return;
      const ratio = canvas.width / view.width;
      g.setTransform(ratio, 0, 0, ratio, 0, 0);
      palette.current ??= read_palette();
      let moving = false;
      if (view.fitted && !latest.current.gestures.busy) {
        if (!view.target || latest.current.lost()) view.target = view.fit_target(latest.current.bounds(), latest.current.insets());
        const share = first || still.matches ? 1 : 1 - Math.exp(-(now - last) / kFitMs);
        moving = view.approach(view.target, Math.max(0.05, share));
        first = false;
      }
      last = now;
      const overlay = latest.current.overlay();
      const pointer = overlay.draft.cursor ?? (probe.mouse && view.to_world(probe.mouse.x, probe.mouse.y));
      const colours = palette.current;
      if (lacks_ground(latest.current.scene())) void import("../draw/ground").then(request, () => undefined);
      if (lacks_arm(latest.current.scene())) void import("../arm/draw").then(request, () => undefined);
      drawing.around(() => draw_scene(g, view, colours, latest.current.scene(), { ...overlay, pointer }));
      tell_view(canvas, view, moving, latest.current.scene().frame?.tick);
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
    const observer = new ResizeObserver(() => {
      size();
      draw(performance.now()); // at once: a canvas of another size is empty
    });
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
  }, [theme]);

  const { gestures } = props;
  const down = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    e.currentTarget.focus({ preventScroll: true });
    e.currentTarget.setPointerCapture(e.pointerId);
    const px = place_of(e, e.currentTarget);
    gestures.down(e.pointerId, px, e.button, e.shiftKey);
    probe.pressed(px);
    show_cards();
    e.preventDefault();
    redraw.current();
  };
  const move = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    const px = place_of(e, e.currentTarget);
    gestures.move(e.pointerId, px);
    probe.moved(px, e.pointerType);
    show_cards();
    if (gestures.busy || e.pointerType === "mouse") redraw.current();
  };
  const up = (e: TargetedPointerEvent<HTMLCanvasElement>) => {
    const px = place_of(e, e.currentTarget);
    gestures.up(e.pointerId, px);
    probe.released(px, e.pointerType);
    redraw.current();
  };
  const leave = () => {
    probe.left();
    redraw.current();
  };
  const eye = (px: Point, slack: number): Eye => {
    const { view } = latest.current;
    return { px, slack, at: view.to_world(px.x, px.y), to_screen: (p) => view.to_screen(p), scale: view.scale };
  };
  const crosshair = () => {
    const { cursor } = latest.current.overlay().draft;
    return cursor ? latest.current.view.to_screen(cursor) : null;
  };
  return <>
    <canvas ref={element} class="scene-canvas" tabIndex={0} role="application"
      aria-label={props.label} aria-describedby="scene-words" data-testid="scene"
      data-cursor={props.cursor} onPointerDown={down} onPointerMove={move} onPointerUp={up}
      onPointerCancel={() => gestures.cancel()} onPointerLeave={leave} onKeyDown={(e) => {
        if (e.key === "Escape") probe.forget();
        props.on_key?.(e);
        show_cards();
      }}
      onContextMenu={(e) => e.preventDefault() /* the right button pans */} />
    {cards && <Inspector scene={() => latest.current.scene()} probe={probe} box={() => element.current} eye={eye}
      shown={() => latest.current.overlay()} insets={() => latest.current.insets()}
      resting={() => element.current !== null && latest.current.cursor === "pan" && !gestures.busy}
      selection={() => latest.current.overlay().selection}
      crosshair={crosshair} />}
  </>;
}

/** [px] Of a pointer from the corner of the canvas. */
function place_of(e: { clientX: number; clientY: number }, canvas: HTMLElement): Point {
  const box = canvas.getBoundingClientRect();
  return { x: e.clientX - box.left, y: e.clientY - box.top };
}

/** [px] of `scene`, from its right, that the open panel of layers covers; 0 if the panel lies elsewhere. */
export function panel_cover(scene: HTMLElement): number {
  const panel = scene.parentElement?.querySelector(".layers")?.getBoundingClientRect();
  const box = scene.getBoundingClientRect();
  const over = panel && panel.left < box.right && panel.top < box.bottom && panel.bottom > box.top;
  return over ? box.right - panel.left : 0;
}

/** The scale bar stands at the lower right of `view`, above a card that reaches there. */
export function scale_insets(view: HTMLElement): Insets {
  const insets = { left: 0, top: 0, right: panel_cover(view), bottom: 22 };
  const box = view.getBoundingClientRect();
  for (const element of view.parentElement!.querySelectorAll(kCards)) {
    const card = element.getBoundingClientRect();
    const reaches = card.right > box.right - insets.right - kScaleRoom && card.left < box.right && card.top < box.bottom;
    if (reaches) insets.bottom = Math.max(insets.bottom, box.bottom - card.top + 14);
  }
  return insets;
}

/** Writes the view (centre x, y [m], scale [px/m]) and the drawn tick on the element, so that a script can point at a
 * place of the world. The view is empty while it moves, the tick before the first frame. */
function tell_view(canvas: HTMLCanvasElement, view: View, moving: boolean, tick: number | undefined): void {
  const now = moving ? "" : [view.x, view.y, view.scale].map((v) => v.toFixed(4)).join(" ");
  if (canvas.dataset.view !== now) canvas.dataset.view = now;
  const drawn = tick === undefined ? "" : String(tick);
  if (canvas.dataset.tick !== drawn) canvas.dataset.tick = drawn;
}
