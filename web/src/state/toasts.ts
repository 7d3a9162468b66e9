// web/src/state/toasts.ts: the messages that disappear again: few, and equal ones are counted.
export interface Toast { id: number; tone: "info" | "warn" | "bad"; text: string; count: number; undo?: () => void }

const kMost = 2;

/** `toasts` with one more. One that differs from it in numbers only is replaced and counted. */
export function with_toast(toasts: Toast[], toast: Omit<Toast, "count">): Toast[] {
  const same = toasts.find((t) => without_numbers(t.text) === without_numbers(toast.text));
  const others = toasts.filter((t) => t !== same);
  return [...others, { ...toast, count: (same?.count ?? 0) + 1 }].slice(-kMost);
}

function without_numbers(text: string): string {
  return text.replace(/\d[\d.]*/g, "");
}
