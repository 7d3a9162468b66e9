// web/src/draw/view.ts: the one place where metres become pixels: a window onto the world.
import { Bounds, Point } from "../geometry";

export interface Insets { left: number; top: number; right: number; bottom: number }

const kMinScale = 6;    // [px/m]
const kMaxScale = 1200; // [px/m]

export class View {
  width = 1;    // [px]
  height = 1;   // [px]
  scale = 80;   // [px/m]
  x = 0;        // [m] world point in the middle of the window
  y = 0;        // [m]
  /** While true the view keeps the world fitted; panning or zooming by hand ends that. */
  fitted = true;

  to_screen(p: Point): Point {
    return { x: this.sx(p.x), y: this.sy(p.y) };
  }
  sx(x: number): number {
    return this.width / 2 + (x - this.x) * this.scale;
  }
  sy(y: number): number {
    return this.height / 2 - (y - this.y) * this.scale;
  }
  to_world(px: number, py: number): Point {
    return {
      x: this.x + (px - this.width / 2) / this.scale,
      y: this.y - (py - this.height / 2) / this.scale,
    };
  }

  /** The transform that shows `bounds` inside the window less `insets`. */
  fit_target(bounds: Bounds, insets: Insets): { x: number; y: number; scale: number } {
    const free_w = Math.max(60, this.width - insets.left - insets.right);
    const free_h = Math.max(60, this.height - insets.top - insets.bottom);
    const w = Math.max(0.5, bounds.max_x - bounds.min_x);
    const h = Math.max(0.5, bounds.max_y - bounds.min_y);
    const scale = Math.min(kMaxScale, 240, Math.max(kMinScale, Math.min(free_w / w, free_h / h)));
    const middle_x = insets.left + free_w / 2 - this.width / 2;
    const middle_y = insets.top + free_h / 2 - this.height / 2;
    return {
      x: (bounds.min_x + bounds.max_x) / 2 - middle_x / scale,
      y: (bounds.min_y + bounds.max_y) / 2 + middle_y / scale,
      scale,
    };
  }

  /** Goes a `share` (0..1) of the way to `target`; returns whether it still has to move. */
  approach(target: { x: number; y: number; scale: number }, share: number): boolean {
    const near = Math.abs(target.scale / this.scale - 1) < 0.002 &&
      Math.abs(target.x - this.x) * this.scale < 0.5 &&
      Math.abs(target.y - this.y) * this.scale < 0.5;
    const k = near ? 1 : share;
    this.scale *= Math.pow(target.scale / this.scale, k);
    this.x += (target.x - this.x) * k;
    this.y += (target.y - this.y) * k;
    return !near;
  }

  pan(dx: number, dy: number): void {
    this.fitted = false;
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /** Zooms so that the world point under (px, py) stays there. */
  zoom_at(px: number, py: number, factor: number): void {
    this.fitted = false;
    const before = this.to_world(px, py);
    this.scale = Math.min(kMaxScale, Math.max(kMinScale, this.scale * factor));
    const after = this.to_world(px, py);
    this.x += before.x - after.x;
    this.y += before.y - after.y;
  }
}
