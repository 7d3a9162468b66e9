// web/src/link/name.ts: the name that a person gives, which the browser keeps and the server shows
// to others.
import { keep, kept } from "../state/store";

const kName = "tautline.name";
export const kLongestName = 32;

export function own_name(): string {
  return kept(kName, "", (text) => text.slice(0, kLongestName));
}

export function keep_name(name: string): void {
  keep(kName, name.trim().slice(0, kLongestName));
}
