// web/src/draw/palette.ts: the colours of the current theme, read from the style sheet's tokens.

const kNames = ["bg", "panel", "text", "muted", "grid", "grid2", "line", "accent", "ok", "warn", "bad",
  "scan", "filtered", "internal", "external", "elastic", "path", "robot", "obst", "obstline",
  "safe", "third", "fourth", "high", "deep"] as const;
export type Palette = Record<(typeof kNames)[number], string> & { font: string };

export function read_palette(of: Element = document.documentElement): Palette {
  const style = getComputedStyle(of);
  const out = { font: style.getPropertyValue("--font").trim() || "sans-serif" } as Palette;
  for (const name of kNames) out[name] = style.getPropertyValue(`--${name}`).trim();
  return out;
}
