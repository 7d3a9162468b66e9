// web/src/draw/driven.ts: what a driver sees about the robot from above: the sectors that the laws read, the followed
// wall with its numbers, and where the stick and the robot's motion lead.
import { ring_sectors, sector_arc, wall_of, wall_words, ways_ahead } from "../state/driven";
import type { SceneState } from "../state/scene";
import { kRing, kWall } from "../state/stick";
import { Context, fill, polyline, trace, write_over } from "./marks";
import { Palette } from "./palette";
import { View } from "./view";

const kWordsAt = 14;    // [px] from an arc, from a wall
const kWordsWide = 124; // [px] of the wall's

function write_words(g: Context, palette: Palette, text: string, x: number, y: number, colour: string, align: CanvasTextAlign = "center"): void {
  g.save();
  write_over(g, text, x, y, colour, `600 12px ${palette.font}`, palette.bg, 4, align);
  g.restore();
}

/** Wedges to the nearest thing of each sector. One without an echo ends in dots at its reach; one that slows the robot
 * is orange. */
export function draw_sectors(g: Context, view: View, palette: Palette, scene: SceneState, hidden: ReadonlySet<string>): void {
  const pose = scene.frame?.pose;
  if (!pose || hidden.has(kRing)) return;
  const sectors = ring_sectors(scene).sort((a, b) => Number(a.limits) - Number(b.limits));
  for (const s of sectors) {
    const colour = s.limits ? palette.external : palette.filtered;
    const arc = sector_arc(pose, s);
    g.globalAlpha = s.limits ? 0.3 : s.echo ? 0.1 : 0.04;
    g.beginPath();
    trace(g, view, [pose, ...arc]);
    g.closePath();
    fill(g, colour);
    g.globalAlpha = 1;
    polyline(g, view, arc, s.echo ? colour : palette.muted, s.limits ? 4 : s.echo ? 2.2 : 1.2, s.echo ? [] : [2, 5]);
  }
  for (const s of sectors) {
    if (!s.echo) continue;
    const r = s.range * view.scale - kWordsAt;
    if (r < 3 * kWordsAt) continue; // on the robot
    write_words(g, palette, s.range.toFixed(2), view.sx(pose.x) + r * Math.cos(s.bearing), view.sy(pose.y) - r * Math.sin(s.bearing),
      s.limits ? palette.external : palette.filtered);
  }
}

/** The numbers of the followed wall, beyond it. */
export function draw_wall_words(g: Context, view: View, palette: Palette, scene: SceneState, hidden: ReadonlySet<string>): void {
  const wall = wall_of(scene), pose = scene.frame?.pose;
  if (!wall || !pose || hidden.has(kWall)) return;
  const bearing = pose.heading + wall.theta;
  const right = Math.cos(bearing) >= 0;
  const x = view.sx(wall.words.x) + kWordsAt * Math.cos(bearing);
  const inside = Math.max(right ? 0 : kWordsWide, Math.min(view.width - (right ? kWordsWide : 0), x));
  write_words(g, palette, wall_words(wall), inside, view.sy(wall.words.y) - kWordsAt * Math.sin(bearing), palette.internal,
    right ? "left" : "right");
}

/** Where the stick and the robot's present motion lead to. */
export function draw_ways_ahead(g: Context, view: View, palette: Palette, scene: SceneState, hidden: ReadonlySet<string>): void {
  g.save();
  g.lineCap = "round";
  for (const { key, line } of ways_ahead(scene, hidden)) {
    polyline(g, view, line, palette[key.token], 3, key.style === "dashed" ? [8, 6] : []);
  }
  g.restore();
}
