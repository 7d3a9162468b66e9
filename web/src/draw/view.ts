// web/src/draw/view.ts: the one place where metres become pixels: a window onto the world.
import { Bounds, Point } from "../geometry";

/** The middle of the view [m] and its scale [px/m]. */
export interface Camera { x: number; y: number; scale: number }
export interface Insets { left: number; top: number; right: number; bottom: number }

/** The middle of the window [m] and its scale [px/m]. */
export interface Place { x: number; y: number; scale: number }

const kMinScale = 6;    // [px/m]
const kMaxScale = 1200; // [px/m]

export class View {
  width = 1;    // [px]
  height = 1;   // [px]
  scale = 80;   // [px/m]
  x = 0;        // [m] world point in the middle of the window
  y = 0;        // [m]
  /** True until a hand pans or zooms: the view goes to `target`. */
  fitted = true;
  /** The fit that is kept, so that the picture rests; null: a new one is wanted. */
  target: Place | null = null;
  private given_ = false; // the camera was given, as by a link; no hand has moved it since

  /** Fits the world anew at the next drawing. */
  fit(): void {
    this.fitted = true;
    this.target = null;
    this.given_ = false;
  }

  /** Takes the size of the window, whose corner went (dx, dy) [px]: the picture stays on the screen. A given camera
   * keeps its middle. */
  resize(width: number, height: number, dx: number, dy: number): void {
    const right = (width - this.width) / 2 + dx;
    const down = (height - this.height) / 2 + dy;
    for (const place of this.given_ ? [] : this.target ? [this, this.target] : [this]) {
      place.x += right / place.scale;
      place.y -= down / place.scale;
    }
    this.width = width;
    this.height = height;
  }

  /** Whether all of `b` lies inside the window less `insets`. */
  shows(b: Bounds, insets: Insets): boolean {
    return this.sx(b.min_x) >= insets.left && this.sx(b.max_x) <= this.width - insets.right &&
      this.sy(b.max_y) >= insets.top && this.sy(b.min_y) <= this.height - insets.bottom;
  }

  /** Where a hand has put it; null while it is fitted. */
  get camera(): Camera | null {
    return this.fitted ? null : { x: this.x, y: this.y, scale: this.scale };
  }
  show(camera: Camera): void {
    this.fitted = false;
    this.given_ = true;
    this.x = camera.x;
    this.y = camera.y;
    this.scale = Math.min(kMaxScale, Math.max(kMinScale, camera.scale));
  }

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
  fit_target(bounds: Bounds, insets: Insets): Place {
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
  approach(target: Place, share: number): boolean {
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
    this.given_ = false;
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  /** Zooms so that the world point under (px, py) stays there. */
  zoom_at(px: number, py: number, factor: number): void {
    this.fitted = false;
    this.given_ = false;
    const before = this.to_world(px, py);
    this.scale = Math.min(kMaxScale, Math.max(kMinScale, this.scale * factor));
    const after = this.to_world(px, py);
    this.x += before.x - after.x;
    this.y += before.y - after.y;
  }
}
