// web/src/draw/known_map.ts: the map that the robot knows, and the ellipse of its pose on it.
import type { MapDocument } from "../contract";
import { Bounds } from "../geometry";
import { Context, stroke } from "./marks";
import { Palette } from "./palette";
import { draw_on_map } from "./scene";
import { SceneState } from "../state/scene";
import { View } from "./view";

const kShare95 = 2.448; // deviations of a pose in the plane that 95 of 100 lie within
const kLeastAxis = 3;   // [px]
export const kOpacity = 0.7;

/** Walls and free cells as two pictures, each to be filled with a colour of the theme. */
interface Shown { bounds: Bounds; picture: HTMLCanvasElement; wall: string; free: string; map: MapDocument }
let shown: Shown | null = null;

/** Draws `map` from now on; null: none. @return its bounds */
export function show_map(map: MapDocument | null): Bounds | null {
  const bounds = map && { min_x: map.x, min_y: map.y, max_x: map.x + map.columns * map.cell, max_y: map.y + map.rows * map.cell };
  shown = map && { bounds: bounds!, picture: document.createElement("canvas"), wall: "", free: "", map };
  return bounds;
}

/** Cells by rows from the top, as a picture has them; unknown ones are clear. */
function paint(s: Shown): void {
  const { columns, rows, cells } = s.map;
  s.picture.width = columns;
  s.picture.height = rows;
  const g = s.picture.getContext("2d")!;
  g.clearRect(0, 0, columns, rows);
  let at = 0;
  for (let k = 0; k + 1 < cells.length; k += 2) {
    const kind = cells[k];
    g.fillStyle = kind === 2 ? s.wall : s.free;
    for (let left = cells[k + 1]; left > 0;) {
      const column = at % columns;
      const run = Math.min(left, columns - column);
      if (kind > 0) g.fillRect(column, rows - 1 - Math.floor(at / columns), run, 1);
      at += run;
      left -= run;
    }
  }
}

/** The map in the colours of `palette`; null: none. */
export function map_picture(palette: Palette): Readonly<Shown> | null {
  if (shown && (shown.wall !== palette.muted || shown.free !== palette.panel)) {
    shown.wall = palette.muted;
    shown.free = palette.panel;
    paint(shown);
  }
  return shown;
}

export function draw_map(g: Context, view: View, palette: Palette): void {
  const known = map_picture(palette);
  if (!known) return;
  const { min_x, max_y, max_x, min_y } = known.bounds;
  g.save();
  g.imageSmoothingEnabled = view.scale * known.map.cell < 1; // else each cell is a square
  g.globalAlpha = kOpacity;
  g.drawImage(known.picture, view.sx(min_x), view.sy(max_y), (max_x - min_x) * view.scale, (max_y - min_y) * view.scale);
  g.restore();
}

/** The ellipse in which the robot is, 95 times of 100. Dashed while it is not located. */
export function draw_sure(g: Context, view: View, palette: Palette, scene: SceneState): void {
  const f = scene.frame;
  const m = f?.map_pose;
  if (!f || !m || m.places === 0) return;
  const middle = (m.xx + m.yy) / 2;
  const half = Math.hypot((m.xx - m.yy) / 2, m.xy);
  const axis = (variance: number) => Math.max(kLeastAxis, kShare95 * Math.sqrt(Math.max(0, variance)) * view.scale);
  const turn = Math.atan2(2 * m.xy, m.xx - m.yy) / 2;
  g.beginPath();
  g.ellipse(view.sx(f.pose.x), view.sy(f.pose.y), axis(middle + half), axis(middle - half), -turn, 0, 2 * Math.PI);
  stroke(g, m.fix === "located" ? palette.path : palette.bad, 2, m.fix === "located" ? [] : [4, 4]);
}

draw_on_map({ draw_map, draw_sure });
