// web/src/link/name.ts: the name that a person gives, which the browser keeps and the server shows
// to others.
import { keep, kept } from "../state/store";

const kName = "tautline.name";
export const kLongestName = 32;

export function own_name(): string {
  return kept(kName, "", clean_name);
}

/** Without control characters, which the server refuses, and without half a letter at its end. */
export function clean_name(text: string): string {
  return text.slice(0, kLongestName).replace(/[\p{Cc}\p{Cs}]/gu, "").trim();
}

export function keep_name(name: string): void {
  keep(kName, clean_name(name));
}
