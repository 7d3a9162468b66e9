// web/src/plots/canvas.tsx: one plot, or the time axis below the plots, on the screen. It follows its
// size and passes pointers on.
import { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { use_ui } from "../app";
import { Palette, read_palette } from "../draw/palette";
import { use_latest } from "../state/store";
import { Chart, Look, draw_chart, draw_time_axis, field_of } from "./chart";
import { PlotActions, PlotGestures } from "./gestures";

interface CanvasProps extends Omit<PlotActions, "time_at"> {
  /** The plot with as many points as fit its width [px]; null: the time axis. */
  chart: ((width: number) => Chart) | null;
  look: Omit<Look, "palette">;
  height: number; // [px]
  name: string;
}

export function PlotCanvas(props: CanvasProps): JSX.Element {
  const { theme } = use_ui("theme");
  const element = useRef<HTMLCanvasElement>(null);
  const palette = useRef<Palette | null>(null);
  const latest = use_latest(props);
  const draw = useRef<() => void>(() => undefined);

  useEffect(() => {
    const canvas = element.current!;
    const g = canvas.getContext("2d")!;
    draw.current = () => {
      const { chart, look, height } = latest.current;
      canvas.style.height = `${height}px`;
      const width = canvas.clientWidth;
      if (width < 2) return;
      const ratio = Math.min(3, devicePixelRatio || 1);
      const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
      if (canvas.width !== w) canvas.width = w;
      if (canvas.height !== h) canvas.height = h;
      palette.current ??= read_palette();
      g.setTransform(ratio, 0, 0, ratio, 0, 0);
      g.clearRect(0, 0, width, height);
      const box = { x: 0, y: 0, width, height };
      const whole_look = { ...look, palette: palette.current };
      if (chart) draw_chart(g, box, chart(width), whole_look);
      else draw_time_axis(g, box, whole_look);
      const field = field_of(box);
      // Where a script finds an instant: pixels of the field, and its times.
      canvas.dataset.field = [field.x, field.width, look.span.from, look.span.to].map((v) => v.toFixed(4)).join(" ");
    };
    const time_at = (px: number) => {
      const { look, height } = latest.current;
      const field = field_of({ x: 0, y: 0, width: canvas.clientWidth, height });
      const t = look.span.from + ((px - field.x) / field.width) * (look.span.to - look.span.from);
      return Math.max(look.span.from, Math.min(look.span.to, t));
    };
    const gestures = new PlotGestures({
      time_at, hover: (t) => latest.current.hover(t), band: (b) => latest.current.band(b),
      seek: (t) => latest.current.seek(t), show: (s) => latest.current.show(s),
      zoom: (at, factor) => latest.current.zoom(at, factor), pan: (by) => latest.current.pan(by),
    });
    const px = (e: MouseEvent) => e.clientX - canvas.getBoundingClientRect().left;
    const on = <K extends keyof HTMLElementEventMap>(type: K, act: (e: HTMLElementEventMap[K]) => void) =>
      canvas.addEventListener(type, act, { passive: false });
    on("pointerdown", (e) => {
      if (e.button !== 0) return;
      canvas.setPointerCapture(e.pointerId);
      gestures.down(e.pointerId, px(e), e.pointerType === "touch");
    });
    on("pointermove", (e) => gestures.move(e.pointerId, px(e)));
    on("pointerup", (e) => gestures.up(e.pointerId, px(e)));
    on("pointercancel", (e) => gestures.cancel(e.pointerId));
    on("pointerleave", () => gestures.leave());
    on("wheel", (e) => {
      e.preventDefault();
      const unit = e.deltaMode === 1 ? 30 : 1;
      gestures.wheel(px(e), (e.shiftKey ? e.deltaY : e.deltaX) * unit, (e.shiftKey ? 0 : e.deltaY) * unit);
    });
    const observer = new ResizeObserver(() => draw.current());
    observer.observe(canvas);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    palette.current = null; // the theme's colours are read again
  }, [theme]);
  useEffect(() => draw.current());
  return <canvas ref={element} class="plot-canvas" data-testid={`plot-${props.name}`} />;
}
