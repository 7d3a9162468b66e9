// web/src/link/fetched.ts: an answer of the server, kept as new as the one who looks needs it.
import { useEffect, useState } from "preact/hooks";
import { sentence_of } from "../words";
import * as rest from "./rest";

export interface Fetched<T> { value: T | null; problem: string | null; refresh: () => void }

/** The answer of `path`, asked again when `on` changes and every `every` ms; null asks nothing. */
export function use_fetched<T>(path: string | null, on: unknown[], every: number | null = null): Fetched<T> {
  const [state, set_state] = useState<{ path: string | null; value: T | null; problem: string | null }>({ path, value: null, problem: null });
  const [asked, set_asked] = useState(0);
  useEffect(() => {
    if (path === null) return;
    const stop = new AbortController();
    rest.get<T>(path, stop.signal)
      .then((value) => set_state({ path, value, problem: null }))
      .catch((error) => {
        if (!stop.signal.aborted) set_state((old) => ({ path, value: old.path === path ? old.value : null, problem: sentence_of(error) }));
      });
    return () => stop.abort();
  }, [path, asked, ...on]);
  useEffect(() => {
    if (every === null) return;
    const timer = setInterval(() => {
      if (!document.hidden) set_asked((n) => n + 1);
    }, every);
    return () => clearInterval(timer);
  }, [every]);
  return { value: state.path === path ? state.value : null, problem: state.problem, refresh: () => set_asked((n) => n + 1) };
}
