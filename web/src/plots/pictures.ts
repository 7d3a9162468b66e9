// web/src/plots/pictures.ts: what is saved: the scene with axes and legend, and the plots on one sheet.
import { Context, fill, stroke, write } from "../draw/marks";
import { Palette } from "../draw/palette";
import { Overlay, draw_scene } from "../draw/scene";
import { View } from "../draw/view";
import { layer_groups } from "../state/layer_groups";
import { LayerKey, kOwn } from "../state/layers";
import { SceneState, scene_bounds } from "../state/scene";
import { fixed } from "../words";
import { Chart, draw_chart, draw_time_axis, kAxis, kGutter, ticks } from "./chart";
import { Picture } from "./save";
import { Span } from "./span";

const kMargin = 16;
const kTitle = 40; // [px] for the title
const kRow = 20;   // [px] of a line of the legend

interface Entry { label: string; colour: string; dash: number[]; points?: boolean }

function write_title(g: Context, palette: Palette, title: string, width: number, height: number): void {
  g.fillStyle = palette.bg;
  g.fillRect(0, 0, width, height);
  write(g, title, kMargin, kTitle / 2, palette.text, `600 15px ${palette.font}`, "left");
}

/** The places of labels in rows `width` [px] wide. No font writes 12 px letters wider than 8 px on average. */
export function legend_rows(labels: string[], width: number): { x: number; row: number }[] {
  let x = 0;
  let row = 0;
  return labels.map((label) => {
    const wide = 50 + label.length * 7.4;
    if (x > 0 && x + wide > width) {
      x = 0;
      ++row;
    }
    const place = { x, row };
    x += wide;
    return place;
  });
}
const rows_of = (labels: string[], width: number) => (legend_rows(labels, width).at(-1)?.row ?? -1) + 1;

function draw_legend(g: Context, palette: Palette, entries: Entry[], x: number, y: number, width: number): void {
  const places = legend_rows(entries.map((e) => e.label), width);
  entries.forEach(({ label, colour, dash, points }, i) => {
    const left = x + places[i].x;
    const middle = y + places[i].row * kRow + kRow / 2;
    g.beginPath();
    if (points) {
      for (const at of [3, 11, 19]) {
        g.moveTo(left + at + 2.5, middle);
        g.arc(left + at, middle, 2.5, 0, 2 * Math.PI);
      }
      fill(g, colour);
    } else {
      g.moveTo(left, middle);
      g.lineTo(left + 22, middle);
      stroke(g, colour, 2.5, dash);
    }
    write(g, label, left + 30, middle, palette.text, `12px ${palette.font}`, "left");
  });
}

/** A plot of the sheet: its name with unit, and its lines. */
export interface Sheet { title: string; span: Span; cursor: number | null; plots: { title: string; chart: Chart }[] }

const kSheetWidth = 900;
const kPlotHeight = 150;
const kCaption = 22;

/** All plots below each other, each with its caption and legend. */
export function sheet_picture(sheet: Sheet): Picture {
  const wide = kSheetWidth - 2 * kMargin;
  let foot = kTitle;
  const places = sheet.plots.map(({ title, chart }) => {
    const top = foot;
    const field = top + kCaption + rows_of(chart.lines.map((l) => l.label), wide - kGutter) * kRow;
    foot = field + kPlotHeight + kCaption / 2;
    return { title, chart, top, field };
  });
  const height = foot + kAxis + kMargin;
  return {
    title: sheet.title, width: kSheetWidth, height,
    draw: (g, palette) => {
      write_title(g, palette, sheet.title, kSheetWidth, height);
      const look = { palette, span: sheet.span, cursor: sheet.cursor, band: null };
      for (const { title, chart, top, field } of places) {
        write(g, title, kMargin, top + kCaption / 2, palette.text, `600 12px ${palette.font}`, "left");
        const entries = chart.lines.map((l) => ({ label: l.label, colour: palette[l.colour], dash: l.dash }));
        draw_legend(g, palette, entries, kMargin + kGutter, top + kCaption, wide - kGutter);
        draw_chart(g, { x: kMargin, y: field, width: wide, height: kPlotHeight }, chart, look);
      }
      draw_time_axis(g, { x: kMargin, y: foot - kCaption / 2, width: wide, height: kAxis }, look);
    },
  };
}

/** A scene as a view of the page shows it. */
export interface ScenePart { scene: SceneState; view: View; overlay: Overlay }

const kUsualSize = { width: 1000, height: 700 };

/** The layers that are drawn now, for the legend. */
function drawn_layers(part: ScenePart): LayerKey[] {
  const { scene, overlay } = part;
  const own = new Set(Object.values(kOwn).map((key) => key.name));
  return layer_groups(scene, overlay.path === "accent").flatMap((group) => group.keys)
    .filter((key) => !overlay.hidden.has(key.name) && (own.has(key.name) || scene.layers.has(key.name)));
}

/** The scene with metres along its edges; the title says the instant. */
export function scene_picture(part: ScenePart, of: string): Picture {
  const stamp = part.scene.frame?.stamp;
  const title = stamp === undefined ? of : `${of}, at ${fixed(stamp, 2)} s`;
  const view = Object.assign(new View(), part.view);
  if (view.width < 2 || view.height < 2) {
    const insets = { left: 20, top: 20, right: 20, bottom: 20 };
    Object.assign(view, kUsualSize, Object.assign(new View(), kUsualSize).fit_target(scene_bounds(part.scene), insets));
  }
  const keys = drawn_layers(part);
  const left = kMargin + kGutter;
  const width = left + view.width + kMargin;
  const foot = kTitle + view.height;
  const height = foot + kAxis + kMargin + rows_of(keys.map((k) => k.label), view.width) * kRow + kMargin;
  return {
    title, width, height,
    draw: (g, palette) => {
      write_title(g, palette, title, width, height);
      g.save();
      g.beginPath();
      g.rect(left, kTitle, view.width, view.height);
      g.clip();
      g.translate(left, kTitle);
      draw_scene(g, view, palette, part.scene, { ...part.overlay, selection: null, hovered: null, draft: {} });
      g.restore();
      draw_metres(g, view, palette, left, foot);
      const entries = keys.map((k) => ({
        label: k.label, colour: palette[k.token], dash: k.style === "dashed" ? [5, 3] : [], points: k.kind === "points",
      }));
      draw_legend(g, palette, entries, left, foot + kAxis + kMargin, view.width);
    },
  };
}

/** The frame about the scene and its axes, "x, m" and "y, m". */
function draw_metres(g: Context, view: View, palette: Palette, left: number, foot: number): void {
  g.beginPath();
  g.rect(left, kTitle, view.width, view.height);
  stroke(g, palette.line, 1);
  const font = `11px ${palette.font}`;
  const low = view.to_world(0, view.height);
  const high = view.to_world(view.width, 0);
  const xs = ticks(low.x, high.x, view.width / 80);
  const ys = ticks(low.y, high.y, view.height / 60);
  for (const x of xs.values) {
    if (view.sx(x) < view.width - 40) write(g, fixed(x, xs.digits), left + view.sx(x), foot + 12, palette.muted, font);
  }
  for (const y of ys.values) {
    if (view.sy(y) > 24) write(g, fixed(y, ys.digits), left - 8, kTitle + view.sy(y), palette.muted, font, "right");
  }
  write(g, "x, m", left + view.width, foot + 12, palette.muted, font, "right");
  write(g, "y, m", left - 8, kTitle + 8, palette.muted, font, "right");
}
