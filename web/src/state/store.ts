// web/src/state/store.ts: a value with listeners, and the hooks that let controls read it.
import { useEffect, useReducer, useRef } from "preact/hooks";

export class Store<T extends object> {
  private listeners_ = new Set<() => void>();

  constructor(private value_: T) {}

  get value(): T {
    return this.value_;
  }

  set(change: Partial<T>): void {
    this.value_ = { ...this.value_, ...change };
    for (const listener of [...this.listeners_]) listener();
  }

  subscribe(listener: () => void): () => void {
    this.listeners_.add(listener);
    return () => this.listeners_.delete(listener);
  }
}

/** Renders again when what `pick` returns is another value. */
export function use_store<T extends object, S>(store: Store<T>, pick: (value: T) => S): S {
  const [, redraw] = useReducer((n: number, _: void) => n + 1, 0);
  const picked = pick(store.value);
  const last = useRef({ pick, picked });
  last.current = { pick, picked };
  useEffect(() => store.subscribe(() => {
    if (!Object.is(last.current.pick(store.value), last.current.picked)) redraw();
  }), [store]);
  return picked;
}

/** Renders again every `period` ms: for figures that change faster than anyone reads. */
export function use_pulse(period: number): void {
  const [, redraw] = useReducer((n: number, _: void) => n + 1, 0);
  useEffect(() => {
    const timer = setInterval(redraw, period);
    return () => clearInterval(timer);
  }, [period]);
}
