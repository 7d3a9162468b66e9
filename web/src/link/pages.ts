// web/src/link/pages.ts: frames of a run that is still recorded, by tick: fetched in pages about the
// wanted ticks, of which the last used are kept.
import { Frame, decode_frames } from "./frame";
import { Legends } from "./legend";
import { FetchFrames, split_frames } from "./stored";

interface Page { frames: Frame[]; whole: boolean } // not whole: the record has not got to its end yet

const kTicks = 400; // of a page
const kMostPages = 4;

export class FramePages {
  private pages_ = new Map<number, Page>(); // by index; the last used one is the last
  private legends_ = new Legends();

  constructor(private readonly fetch_: FetchFrames) {}

  /** The frames of ticks `from` to `to`; null while some of them must be fetched. */
  at_hand(from: number, to: number): Frame[] | null {
    const pages = indices(from, to).map((index) => this.pages_.get(index));
    if (!pages.every((page) => page !== undefined)) return null;
    if (!pages.at(-1)!.whole && (pages.at(-1)!.frames.at(-1)?.tick ?? -1) < to) return null;
    return this.known(from, to);
  }

  /** Those of them that have been fetched. */
  known(from: number, to: number): Frame[] {
    const out: Frame[] = [];
    for (const index of indices(from, to)) {
      const page = this.pages_.get(index);
      if (!page) continue;
      this.pages_.delete(index);
      this.pages_.set(index, page);
      out.push(...page.frames.filter((f) => f.tick >= from && f.tick <= to));
    }
    return out;
  }

  /** Fetches the ticks `from` to `to` as far as they are recorded, the first ones first: their legend
   * holds in later ones. */
  async fetch(from: number, to: number): Promise<void> {
    for (const index of indices(from, to)) {
      const page = this.pages_.get(index) ?? { frames: [], whole: false };
      if (!page.whole) await this.fill(page, index);
      this.pages_.delete(index);
      this.pages_.set(index, page);
    }
    for (const [index] of this.pages_) if (this.pages_.size > kMostPages) this.pages_.delete(index);
  }

  private async fill(page: Page, index: number): Promise<void> {
    const end = (index + 1) * kTicks;
    const last = page.frames.at(-1)?.tick;
    for (let from = last === undefined ? index * kTicks : last + 1; from < end;) {
      const { bytes, next } = await this.fetch_(from, end - from);
      const frames = decode_frames(split_frames(bytes), this.legends_);
      page.frames.push(...frames.filter((f) => f.tick < end));
      if (next === null) return;
      from = next;
    }
    page.whole = true;
  }
}

function indices(from: number, to: number): number[] {
  const first = Math.floor(Math.max(0, from) / kTicks);
  const last = Math.floor(Math.max(0, to) / kTicks);
  return Array.from({ length: last - first + 1 }, (_, i) => first + i);
}
