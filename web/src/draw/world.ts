// web/src/draw/world.ts: the ground: grid, obstacles, scale bar.
import { Obstacle, outline } from "../obstacle";
import { Point } from "../geometry";
import { fixed } from "../words";
import { Context, circle, fill, stroke, trace, write } from "./marks";
import { Palette } from "./palette";
import { Insets, View } from "./view";

const kBeneath = 0.45; // of the colour of an obstacle with room below it

/** A line every metre, every fifth one stronger; wider steps when zoomed out. */
export function draw_grid(g: Context, view: View, palette: Palette): void {
  const step = view.scale >= 24 ? 1 : view.scale >= 9 ? 5 : 10;
  const a = view.to_world(0, view.height);
  const b = view.to_world(view.width, 0);
  for (const strong of [false, true]) {
    g.beginPath();
    for (let i = Math.floor(a.x / step); i <= Math.ceil(b.x / step); ++i) {
      if ((i % 5 === 0) !== strong) continue;
      const x = Math.round(view.sx(i * step)) + 0.5;
      g.moveTo(x, 0);
      g.lineTo(x, view.height);
    }
    for (let i = Math.floor(a.y / step); i <= Math.ceil(b.y / step); ++i) {
      if ((i % 5 === 0) !== strong) continue;
      const y = Math.round(view.sy(i * step)) + 0.5;
      g.moveTo(0, y);
      g.lineTo(view.width, y);
    }
    stroke(g, strong ? palette.grid2 : palette.grid, 1);
  }
}

export function trace_obstacle(g: Context, view: View, o: Obstacle): void {
  if (o.kind === "cylinder") {
    circle(g, view, o.pose, Math.max(1, o.radius * view.scale));
    return;
  }
  g.beginPath();
  trace(g, view, outline(o));
  g.closePath();
}

export function draw_obstacles(g: Context, view: View, palette: Palette, obstacles: Obstacle[],
  selected: number | null, hovered: number | null): void {
  for (const o of obstacles) {
    trace_obstacle(g, view, o);
    g.globalAlpha = o.bottom > 0 ? kBeneath : 1; // what is below it is seen
    fill(g, palette.obst);
    g.globalAlpha = 1;
    stroke(g, o.id === hovered ? palette.text : palette.obstline, 1.5, o.bottom > 0 ? [6, 3] : []);
    if (o.id === selected) stroke(g, palette.accent, 2.5);
  }
}

/** A bar of 0.1, 0.2, 0.5, 1, 2, 5 ... metres, as long as fits 60 to 150 pixels; above it the place of the pointer. */
export function draw_scale(g: Context, view: View, palette: Palette, insets: Insets, pointer: Point | null): void {
  let metres = 0.1;
  for (const next of [0.2, 0.5, 1, 2, 5, 10, 20]) if (metres * view.scale < 56) metres = next;
  const length = metres * view.scale;
  const x = view.width - insets.right - 20;
  const y = view.height - insets.bottom;
  g.beginPath();
  g.moveTo(x - length, y - 5);
  g.lineTo(x - length, y);
  g.lineTo(x, y);
  g.lineTo(x, y - 5);
  stroke(g, palette.muted, 1.5);
  write(g, `${metres} m`, x, y - 9, palette.muted, `12px ${palette.font}`, "right", "alphabetic");
  if (!pointer) return;
  const text = `x ${fixed(pointer.x, 2)} m, y ${fixed(pointer.y, 2)} m`;
  write(g, text, x, y - 26, palette.text, `12px ${palette.font}`, "right", "alphabetic");
}
