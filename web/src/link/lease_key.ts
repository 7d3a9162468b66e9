// web/src/link/lease_key.ts: the key of the controls that this page holds. REST requests show it, so that they count as
// the driver's too.

let held = "";

export function lease_key(): string {
  return held;
}

export function keep_lease_key(key: string): void {
  held = key;
}
