// web/src/plots/span.ts: the piece of time that plots show, and how zooming and panning change it.

/** [s] of run clock. */
export interface Span { from: number; to: number }

/**
 * What a person has chosen to see: a piece of time, or the last seconds, which go on with a live run.
 * Null: as much as is usual.
 */
export type Zoom = Span | { last: number } | null;

const kShortest = 0.05; // [s]

/** The shown piece of `whole`; `usual` [s] of its end when nothing is chosen. */
export function shown_span(zoom: Zoom, whole: Span, usual: number): Span {
  const last = zoom === null ? usual : "last" in zoom ? zoom.last : null;
  if (last === null) return zoom as Span;
  const from = Math.max(whole.from, whole.to - last);
  // A run that has just begun fills the plot from the left.
  return { from, to: Number.isFinite(last) ? Math.max(whole.to, from + last) : Math.max(whole.to, from + kShortest) };
}

/** `span` made `factor` times as long about `at`, within `whole`. */
export function zoomed(span: Span, at: number, factor: number, whole: Span): Span {
  const room = Math.max(kShortest, whole.to - whole.from);
  const length = Math.min(room, Math.max(kShortest, (span.to - span.from) * factor));
  const share = (at - span.from) / (span.to - span.from);
  return within(at - share * length, length, whole);
}

/** `span` moved by `by` [s], within `whole`. */
export function panned(span: Span, by: number, whole: Span): Span {
  return within(span.from + by, span.to - span.from, whole);
}

function within(from: number, length: number, whole: Span): Span {
  const start = Math.max(whole.from, Math.min(from, whole.to - length));
  return { from: start, to: start + length };
}

/** `span` as a choice: a live run is followed from a piece that ends at its newest instant. */
export function choice_of(span: Span, whole: Span, live: boolean): Zoom {
  const all = span.from <= whole.from && span.to >= whole.to;
  if (live && span.to >= whole.to - kShortest) return { last: all ? Infinity : span.to - span.from };
  return all ? null : span;
}
