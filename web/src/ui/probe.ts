// web/src/ui/probe.ts: the pointer on a scene, as the cards of things use it.
import type { Thing } from "../edit/inspect";
import { Point } from "../geometry";

const kSlack = { mouse: 9, crosshair: 14, finger: 22 }; // [px]
const kTap = 8; // [px] a longer way is a drag

/** A finger's tap holds on to its thing; a mouse has the thing under it. */
export class Probe {
  mouse: Point | null = null;
  private held_: Thing | null = null;
  private down_: Point | null = null;
  private tapped_: Point | null = null;

  moved(px: Point, by: string): void {
    if (by === "mouse") this.mouse = px;
  }
  pressed(px: Point): void {
    this.down_ = px;
  }
  released(px: Point, by: string): void {
    const tap = this.down_ && Math.hypot(px.x - this.down_.x, px.y - this.down_.y) < kTap;
    this.down_ = null;
    if (by !== "mouse" && tap) this.tapped_ = px;
  }
  left(): void {
    this.mouse = null;
  }
  forget(): void {
    this.held_ = null;
    this.tapped_ = null;
  }

  /** `find` gives the thing within a distance of a place. */
  thing(crosshair: Point | null, find: (px: Point, slack: number) => Thing | null): Thing | null {
    if (this.tapped_) this.held_ = find(this.tapped_, kSlack.finger);
    this.tapped_ = null;
    if (crosshair) return find(crosshair, kSlack.crosshair);
    return this.mouse ? find(this.mouse, kSlack.mouse) : this.held_;
  }
}
