// web/src/views/run_list.ts: the list of runs as the server finds, sorts and counts them, one page at
// a time. The page never holds more than one page of runs, however many are stored.
import { useCallback, useEffect, useRef, useState } from "preact/hooks";
import { RunItem, RunPage } from "../contract";
import * as rest from "../link/rest";
import { sentence_of } from "../words";

export const kPageSize = 50;
const kRefreshMs = 3000;
const kTypingMs = 200;

export interface RunSearch {
  text: string;
  result: string;       // "": all
  kind: string;         // "": both
  batch: number | null; // only the runs of this batch
  grouped: boolean;     // each batch is one line
  sort: string;
  descending: boolean;
}
export const kFirstSearch: RunSearch = {
  text: "", result: "", kind: "", batch: null, grouped: true, sort: "id", descending: true,
};

/** The query of GET /runs. */
export function query_of(search: RunSearch, limit: number, cursor?: string): string {
  const query = new URLSearchParams({ limit: String(limit) });
  const add = (name: string, value: string) => value !== "" && query.set(name, value);
  add("q", search.text.trim());
  add("result", search.result);
  add("kind", search.kind);
  add("batch", search.batch === null ? "" : String(search.batch));
  if (search.sort !== "id" || !search.descending) {
    query.set("sort", search.sort);
    query.set("order", search.descending ? "desc" : "asc");
  }
  if (search.grouped && search.batch === null) query.set("group", "batch");
  add("cursor", cursor ?? "");
  return `/runs?${query}`;
}

export interface RunList {
  search: RunSearch;
  set_search: (change: Partial<RunSearch>) => void;
  items: RunItem[];
  /** Runs by result, under the search; null before the first answer. */
  results: Record<string, number> | null;
  total: number | null; // lines on all pages
  at: number;           // lines before this page
  loading: boolean;
  error: string | null;
  paged: boolean;       // there are more pages than this one
  older: (() => void) | null;
  newer: (() => void) | null;
  refresh: () => void;
}

export function use_run_list(connected: boolean): RunList {
  const [search, change] = useState(kFirstSearch);
  const [sent, set_sent] = useState(kFirstSearch); // the search without what is still being typed
  const [cursors, set_cursors] = useState<string[]>([]); // where this page and the earlier pages begin
  const [page, set_page] = useState<RunPage>({ items: [], next: null });
  const [answered, set_answered] = useState(""); // the query whose answer the page is
  const [counts, set_counts] = useState<{ results: RunList["results"]; total: number | null }>({ results: null, total: null });
  const [starts, set_starts] = useState<number[]>([]); // lines before each of those pages
  const [loading, set_loading] = useState(true);
  const [error, set_error] = useState<string | null>(null);
  const asked = useRef(0);

  useEffect(() => {
    const timer = setTimeout(() => {
      set_sent(search);
      set_cursors([]);
      set_starts([]);
    }, search.text === sent.text ? 0 : kTypingMs);
    return () => clearTimeout(timer);
  }, [search]);

  const query = query_of(sent, kPageSize, cursors.at(-1));
  const refresh = useCallback(async () => {
    const mine = ++asked.current;
    try {
      const answer = await rest.get<RunPage>(query);
      if (mine !== asked.current) return;
      set_error(null);
      set_page(answer);
      set_answered(query);
      if (answer.results) set_counts({ results: answer.results, total: answer.total ?? null });
    } catch (e) {
      if (mine !== asked.current) return;
      set_error(sentence_of(e));
    }
    set_loading(false);
  }, [query]);

  useEffect(() => {
    void refresh();
    const timer = setInterval(() => {
      if (connected && !document.hidden) void refresh();
    }, kRefreshMs);
    return () => clearInterval(timer);
  }, [refresh, connected]);

  const at = starts.at(-1) ?? 0;
  // The next page of an earlier answer does not follow this page.
  const next = answered === query ? page.next : null;
  return {
    search, ...counts, items: page.items, at, loading, error,
    paged: page.next !== null || cursors.length > 0,
    set_search: (part) => change((before) => ({ ...before, ...part })),
    older: next === null ? null : () => {
      set_cursors([...cursors, String(next)]);
      set_starts([...starts, at + page.items.length]);
    },
    newer: cursors.length === 0 ? null : () => {
      set_cursors(cursors.slice(0, -1));
      set_starts(starts.slice(0, -1));
    },
    refresh: () => void refresh(),
  };
}
