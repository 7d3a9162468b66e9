// web/src/state/store.ts: a value with listeners, the hooks that let controls read it, and the
// values that the browser keeps from visit to visit.
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

/** A function that renders the component again. */
export function use_redraw(): () => void {
  return useReducer((n: number, _: void) => n + 1, 0)[1];
}

/** The newest `value`, for listeners that outlive a rendering. */
export function use_latest<T>(value: T): { readonly current: T } {
  const latest = useRef(value);
  latest.current = value;
  return latest;
}

/** Renders again when `pick` returns another value, by `same`. */
export function use_store<T extends object, S>(store: Store<T>, pick: (value: T) => S,
  same: (a: S, b: S) => boolean = Object.is): S {
  const redraw = use_redraw();
  const picked = pick(store.value);
  const last = use_latest({ pick, picked });
  useEffect(() => store.subscribe(() => {
    if (!same(last.current.pick(store.value), last.current.picked)) redraw();
  }), [store]);
  return picked;
}

/** Renders again every `period` ms: for figures that change faster than anyone reads. */
export function use_pulse(period: number): void {
  const redraw = use_redraw();
  useEffect(() => {
    const timer = setInterval(redraw, period);
    return () => clearInterval(timer);
  }, [period]);
}

/** Listens on the window while the component is shown. */
export function use_listener<K extends keyof WindowEventMap>(type: K,
  act: (event: WindowEventMap[K]) => void, capture = false): void {
  const latest = use_latest(act);
  useEffect(() => {
    const listen = (event: WindowEventMap[K]) => latest.current(event);
    addEventListener(type, listen, capture);
    return () => removeEventListener(type, listen, capture);
  }, []);
}

/** The value that the browser keeps under `key`, as `parse` reads it; else `usual`. */
export function kept<T>(key: string, usual: T, parse: (text: string) => T): T {
  try {
    const text = localStorage.getItem(key);
    return text === null ? usual : parse(text);
  } catch {
    return usual;
  }
}

/** Private windows may refuse; the choice then lasts as long as the page. */
export function keep(key: string, text: string): void {
  try {
    localStorage.setItem(key, text);
  } catch {
    // the page goes on with the choice in memory
  }
}
