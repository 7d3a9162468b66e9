// web/src/experiments/watch.ts: keeps the list, one experiment's progress and its results as new as
// the server's, without asking more often than people can read.
import { useEffect, useRef, useState } from "preact/hooks";
import { Fetched, use_fetched } from "../link/fetched";
import { ExperimentDetail, ExperimentInfo, PathsOf, Results, RunsPage } from "./contract";

const kListEvery = 3000;    // [ms]
const kResultsEvery = 3000; // [ms] while runs come in

export function use_list(): Fetched<{ items: ExperimentInfo[] }> {
  return use_fetched("/experiments", [], kListEvery);
}

/** Progress by server-sent events; the browser connects again by itself. */
export function use_progress(id: string): ExperimentInfo | null {
  const [info, set_info] = useState<ExperimentInfo | null>(null);
  useEffect(() => {
    set_info(null);
    const events = new EventSource(`/api/v1/experiments/${id}/events`);
    events.addEventListener("progress", (e) => set_info(JSON.parse((e as MessageEvent<string>).data) as ExperimentInfo));
    return () => events.close();
  }, [id]);
  return info?.id === id ? info : null;
}

export function use_detail(id: string): Fetched<ExperimentDetail> {
  return use_fetched(`/experiments/${id}`, []);
}

/** `done`, but at most once in a while; at once when runs stop coming in. */
export function use_calm(done: number | null, running: boolean): number | null {
  const [calm, set_calm] = useState(done);
  const at = useRef(0);
  useEffect(() => {
    if (done === null || done === calm) return;
    const wait = running && calm !== null ? Math.max(0, at.current + kResultsEvery - performance.now()) : 0;
    const timer = setTimeout(() => {
      at.current = performance.now();
      set_calm(done);
    }, wait);
    return () => clearTimeout(timer);
  }, [done, running, calm]);
  return calm;
}

/** Results of all scenarios, or of one. */
export function use_results(id: string, scenario: string, done: number | null): Fetched<Results> {
  const query = scenario === "" ? "" : `?scenario=${encodeURIComponent(scenario)}`;
  return use_fetched(done === null ? null : `/experiments/${id}/results${query}`, [done]);
}

export function use_paths(id: string, scenario: string, done: number | null): Fetched<PathsOf> {
  return use_fetched(done === null ? null : `/experiments/${id}/paths?scenario=${encodeURIComponent(scenario)}`, [done]);
}

export interface RunQuery { outcome: string; scenario: string; controller: string; sort: string }

export function use_runs(id: string, query: RunQuery, from: number, done: number | null): Fetched<RunsPage> {
  const given = new URLSearchParams({ from: String(from), limit: "50" });
  for (const [key, value] of Object.entries(query)) if (value !== "") given.set(key, value as string);
  return use_fetched(done === null ? null : `/experiments/${id}/runs?${given}`, [done]);
}
