// web/src/views/runs.tsx: the Runs view: the list with its filters, and the open run.
import { JSX } from "preact";
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Page, RunItem } from "../contract";
import * as rest from "../link/rest";
import { use_store } from "../state/store";
import { icons } from "../ui/icons";
import { driver_word, fixed, matches, run_word, sentence_of, titled } from "../words";
import { RunDetail } from "./run_detail";
import { StartRun } from "./start_run";

const kPageSize = 50;
const kRefreshMs = 3000;
const kOutcomes = ["", "reached", "stuck", "collided", "out_of_time"];

export function Runs(): JSX.Element {
  const app = use_app();
  const { run: open } = use_ui("run");
  const connected = use_store(app.ui, (u) => u.link.phase === "open");
  const list = use_runs(connected);
  const [text, set_text] = useState("");
  const [compare, set_compare] = useState<number | null>(null);
  const [starting, set_starting] = useState(false);
  useEffect(() => {
    if (compare === open) set_compare(null);
  }, [open, compare]);

  const shown = list.items.filter((r) =>
    matches(`${r.id} ${r.scenario} ${r.controller} ${r.filter} ${r.physics} ${r.outcome} ${r.status}`, text));
  return (
    <main class={`runs ${open !== null ? "detail-open" : ""}`} aria-label="Runs">
      <div class="find" role="search">
        <input type="search" placeholder="Filter: scenario, controller, number" value={text}
          aria-label="Filter the runs" data-testid="runs-filter"
          onInput={(e) => set_text(e.currentTarget.value)} />
        <div class="chips" role="group" aria-label="Outcome">
          {kOutcomes.map((o) => (
            <button key={o} class={`chip ${list.outcome === o ? "on" : ""}`} aria-pressed={list.outcome === o}
              data-testid={`chip-${o || "all"}`} onClick={() => list.set_outcome(o)}>
              {o === "" ? `All${list.total === null || list.outcome !== "" ? "" : ` ${list.total}`}` : run_word("finished", o).word}
            </button>
          ))}
        </div>
        <span class="space" />
        <button class="ghost" data-testid="start-run" onClick={() => set_starting(true)}>Start a run</button>
      </div>
      <div class="list">
        <RunTable runs={shown} open={open} compare={compare} on_compare={set_compare} />
        {list.error && <p class="empty" role="alert">{list.error}</p>}
        {!list.error && !list.loading && shown.length === 0 &&
          <p class="empty">{list.items.length === 0
            ? "No runs yet. Drive the robot, or start a run in the background."
            : "No run matches. Clear the filter to see all runs."}</p>}
        {list.next !== null &&
          <button class="ghost more-runs" data-testid="more-runs" onClick={list.more}>Show earlier runs</button>}
      </div>
      {open !== null
        ? <RunDetail key={open} id={open} compare={compare} on_gone={list.refresh}
            on_uncompare={() => set_compare(null)} />
        : <section class="view none">
            <p class="empty">Open a run to play it, to search it, or to compare it with another.</p>
          </section>}
      {starting && <StartRun on_close={() => set_starting(false)} on_started={list.refresh} />}
    </main>
  );
}

interface RunList {
  items: RunItem[]; next: string | number | null; loading: boolean; error: string | null;
  total: number | null; outcome: string; set_outcome: (o: string) => void; more: () => void; refresh: () => void;
}

/** The list in pages, newest first. The open view fetches the first page every few seconds. */
function use_runs(connected: boolean): RunList {
  const [items, set_items] = useState<RunItem[]>([]);
  const [next, set_next] = useState<string | number | null>(null);
  const [loading, set_loading] = useState(true);
  const [total, set_total] = useState<number | null>(null);
  const [error, set_error] = useState<string | null>(null);
  const [outcome, set_outcome] = useState("");
  const asked = useRef(0);

  const fetch_page = useCallback(async (cursor: string | number | null, append: boolean) => {
    const mine = ++asked.current;
    const query = new URLSearchParams({ limit: String(kPageSize) });
    if (outcome) query.set("outcome", outcome);
    if (cursor !== null) query.set("cursor", String(cursor));
    try {
      const page = await rest.get<Page<RunItem>>(`/runs?${query}`);
      if (mine !== asked.current) return;
      set_error(null);
      if (page.total !== undefined) set_total(page.total);
      if (append) {
        set_items((old) => [...old, ...page.items]);
        set_next(page.next);
      } else {
        // Older pages stay as they are; new and changed runs come with the first page.
        set_items((old) => merged(page.items, old, outcome));
        set_next((before) => (before === null ? page.next : before));
      }
    } catch (e) {
      if (mine === asked.current) set_error(sentence_of(e));
    }
    set_loading(false);
  }, [outcome]);

  const refresh = useCallback(() => {
    set_items([]);
    set_next(null);
    void fetch_page(null, false);
  }, [fetch_page]);
  useEffect(() => {
    refresh();
    const timer = setInterval(() => {
      if (connected && !document.hidden) void fetch_page(null, false);
    }, kRefreshMs);
    return () => clearInterval(timer);
  }, [refresh, connected]);
  return {
    items, next, loading, error, total, outcome, set_outcome, refresh,
    more: () => void fetch_page(next, true),
  };
}

/** The first page and the older runs behind it. */
function merged(fresh: RunItem[], old: RunItem[], outcome: string): RunItem[] {
  const oldest = fresh.at(-1)?.id ?? Infinity;
  return [...fresh, ...old.filter((r) => r.id < oldest && (outcome === "" || r.outcome === outcome))];
}

function RunTable(props: {
  runs: RunItem[]; open: number | null; compare: number | null;
  on_compare: (id: number | null) => void;
}): JSX.Element {
  const app = use_app();
  const move = (e: KeyboardEvent, at: number) => {
    const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
    if (by === undefined) return;
    e.preventDefault();
    const rows = (e.currentTarget as HTMLElement).closest("tbody")!.querySelectorAll<HTMLElement>("a.run-link");
    rows[at + by]?.focus();
  };
  return (
    <table class="run-table" data-testid="run-table">
      <thead>
        <tr>
          <th scope="col">Run</th><th scope="col">Scenario</th><th scope="col">Controller</th>
          <th scope="col">Outcome</th><th scope="col" class="r">Time <u>s</u></th>
          <th scope="col" class="r wide">Path <u>m</u></th><th scope="col" class="r wide">Clearance <u>m</u></th>
          <th scope="col" class="r wide">Intrusion <u>m</u></th>
          <th scope="col" class="wide"><span class="hidden-words">Compare</span></th>
        </tr>
      </thead>
      <tbody>
        {props.runs.map((r, i) => {
          const word = run_word(r.status, r.outcome);
          const m = r.metrics;
          const on = r.id === props.open;
          const second = r.id === props.compare;
          return (
            <tr key={r.id} class={on ? "on" : second ? "second" : ""} data-testid={`run-${r.id}`}
              onClick={() => app.go("runs", r.id)}>
              <td class="num"><a class="run-link" href={`#/runs/${r.id}`} aria-current={on ? "true" : undefined}
                onKeyDown={(e) => move(e, i)} onClick={(e) => e.stopPropagation()}>{r.id}</a></td>
              <td>{titled(r.scenario)}</td>
              <td title={app.controller_label(r.controller)}>{driver_word(r)}</td>
              <td><span class={`tag tone-${word.tone}`}><i />{word.word}</span></td>
              <td class="r num">{fixed(m?.time ?? r.time, 1)}</td>
              <td class="r num wide">{fixed(m?.path_length, 2)}</td>
              <td class="r num wide">{fixed(m?.min_clearance, 2)}</td>
              <td class="r num wide">{fixed(m?.intrusion, 2)}</td>
              <td class="wide compare-cell">
                {props.open !== null && !on &&
                  <button class="icon" aria-pressed={second} data-testid={`compare-${r.id}`}
                    aria-label={`Compare run ${r.id} with the open one`} title="Draw it over the open run"
                    onClick={(e) => {
                      e.stopPropagation();
                      props.on_compare(second ? null : r.id);
                    }}>{icons.compare}</button>}
              </td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}
