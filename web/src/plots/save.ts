// web/src/plots/save.ts: a drawing as an SVG or PNG file of the browser's downloads.
import { Context } from "../draw/marks";
import { Palette, read_palette } from "../draw/palette";
import { download } from "../ui/download";
import { SvgContext } from "./svg";

/** A picture of its own size [px]; `draw` fills it. */
export interface Picture { title: string; width: number; height: number; draw: (g: Context, palette: Palette) => void }

const kDense = 2; // pixels of a PNG in one pixel of the picture

/** The palette of a theme, whichever is shown. */
function palette_of(theme: string): Palette {
  const probe = document.createElement("div");
  probe.dataset.theme = theme;
  document.body.append(probe);
  const palette = read_palette(probe);
  probe.remove();
  return palette;
}

/** Saves `picture` as `name`.svg or `name`.png, in the colours of `theme`. */
export async function save_picture(picture: Picture, name: string, kind: "svg" | "png", theme: string): Promise<void> {
  const palette = palette_of(theme);
  const canvas = document.createElement("canvas");
  const g = canvas.getContext("2d")!;
  if (kind === "svg") {
    const width_of = (text: string, font: string) => {
      g.font = font;
      return g.measureText(text).width;
    };
    const svg = new SvgContext(picture.width, picture.height, width_of);
    picture.draw(svg as unknown as Context, palette);
    download(new Blob([svg.file(picture.title)], { type: "image/svg+xml" }), `${name}.svg`);
    return;
  }
  canvas.width = Math.round(picture.width * kDense);
  canvas.height = Math.round(picture.height * kDense);
  g.scale(kDense, kDense);
  picture.draw(g, palette);
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, "image/png"));
  if (!blob) throw new Error("The browser could not make a picture of this size.");
  download(blob, `${name}.png`);
}

/** "run-12-case1": letters that a file system may refuse become dashes. */
export function file_name(run: number | null, scenario: string): string {
  const name = `${run === null ? "session" : `run-${run}`}-${scenario}`;
  return name.replace(/[^A-Za-z0-9._-]+/g, "-");
}
