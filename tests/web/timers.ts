// tests/web/timers.ts: timers that a test advances.

/** Replaces the timers; put back by `restore`. */
export function hand_wound() {
  const kept = { setTimeout, clearTimeout, setInterval, clearInterval };
  const waiting = new Map<number, { at: number; act: () => void }>();
  let now = 0;
  let next = 1;
  Object.assign(globalThis, {
    setTimeout: (act: () => void, ms = 0) => (waiting.set(next, { at: now + ms, act }), next++),
    clearTimeout: (id: number) => waiting.delete(id),
    setInterval: () => 0, // the heartbeat is not wanted here
    clearInterval: () => undefined,
  });
  return {
    tick(ms: number) {
      now += ms;
      for (const [id, timer] of [...waiting]) {
        if (timer.at <= now && waiting.delete(id)) timer.act();
      }
    },
    restore: () => Object.assign(globalThis, kept),
  };
}
