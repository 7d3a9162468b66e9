// web/src/plots/gestures.ts: pointers on a plot: hover, a dragged span, a click, two fingers, the wheel.
import { Span } from "./span";

export interface PlotActions {
  /** [s] At a pixel of the plot. */
  time_at: (px: number) => number;
  hover: (t: number | null) => void;
  band: (span: Span | null) => void;
  seek: (t: number) => void;
  show: (span: Span) => void;
  zoom: (at: number, factor: number) => void;
  pan: (by: number) => void;
}

const kDrag = 6; // [px] from which a press is a drag

export class PlotGestures {
  private fingers_ = new Map<number, number>(); // pointer -> px
  private start_: number | null = null;         // px where the mouse was pressed
  private dragged_ = false;
  private pinched_ = false;

  constructor(private readonly act_: PlotActions) {}

  down(id: number, px: number, touch: boolean): void {
    if (touch) {
      this.fingers_.set(id, px);
      this.pinched_ = this.fingers_.size > 1;
      if (!this.pinched_) this.act_.hover(this.act_.time_at(px));
      return;
    }
    this.start_ = px;
    this.dragged_ = false;
  }

  move(id: number, px: number): void {
    const before = this.fingers_.get(id);
    if (before !== undefined && this.fingers_.size === 2) {
      this.pinch(id, before, px);
      return;
    }
    if (before !== undefined) this.fingers_.set(id, px);
    this.act_.hover(this.act_.time_at(px));
    if (this.start_ === null) return;
    this.dragged_ ||= Math.abs(px - this.start_) >= kDrag;
    if (this.dragged_) this.act_.band(this.span_to(px));
  }

  up(id: number, px: number): void {
    const { act_: act } = this;
    if (this.fingers_.delete(id)) {
      if (!this.pinched_) act.seek(act.time_at(px));
      return;
    }
    if (this.start_ === null) return;
    const span = this.span_to(px);
    this.start_ = null;
    act.band(null);
    if (this.dragged_) act.show(span);
    else act.seek(act.time_at(px));
  }

  cancel(id: number): void {
    this.fingers_.delete(id);
    this.start_ = null;
    this.act_.band(null);
  }

  leave(): void {
    if (this.start_ === null && this.fingers_.size === 0) this.act_.hover(null);
  }

  /** `across` and `down` [px]: sideways moves the piece of time, up and down changes its length. */
  wheel(px: number, across: number, down: number): void {
    const second = this.act_.time_at(1) - this.act_.time_at(0);
    if (Math.abs(across) > Math.abs(down)) this.act_.pan(across * second);
    else this.act_.zoom(this.act_.time_at(px), Math.exp(down * 0.0016));
  }

  /** The instants below both fingers stay below them. */
  private pinch(id: number, before: number, px: number): void {
    const [other] = [...this.fingers_].filter(([k]) => k !== id).map(([, at]) => at);
    this.fingers_.set(id, px);
    if (Math.abs(px - other) < kDrag || Math.abs(before - other) < kDrag) return;
    this.act_.zoom(this.act_.time_at(other), Math.abs((before - other) / (px - other)));
  }

  private span_to(px: number): Span {
    const [a, b] = [this.act_.time_at(this.start_!), this.act_.time_at(px)];
    return { from: Math.min(a, b), to: Math.max(a, b) };
  }
}
