// web/src/views/runs.tsx: the Runs view: search, chips, the list, the selection, and the open run.
import "../ui/run_sheet"; // before the styles of the parts below
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { use_store } from "../state/store";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { kind_words, result_word } from "../words";
import { Selection, SelectionBar } from "./run_actions";
import { RunDetail } from "./run_detail";
import { RunList, kFirstSearch, use_run_list } from "./run_list";
import { RunTable } from "./run_table";
import { StartRun } from "./start_run";
import { use_keys } from "./keys";

/** In the order of the chips; one that finds nothing is left out, except the first three. */
const kResults = ["reached", "stuck", "collided", "overturned", "fallen", "out_of_time", "end_of_log", "stopped", "failed", "interrupted",
  "cancelled", "queued", "recording"];
const kAlways = kResults.slice(0, 3);
const kNone: Selection = new Map();

export function Runs(): JSX.Element {
  const app = use_app();
  const { run: open, compare } = use_ui("run", "compare"); // drawn over the open run
  const connected = use_store(app.ui, (u) => u.link.phase === "open");
  const list = use_run_list(connected);
  const [selection, set_selection] = useState<Selection>(kNone);
  const [starting, set_starting] = useState(false);
  use_keys({ escape: () => set_selection(kNone) });
  const compare_all = (ids: number[]) => {
    const first = open !== null && ids.includes(open) ? open : ids[0];
    app.open_run(first, ids.filter((id) => id !== first));
  };
  return (
    <main class={`runs ${open !== null ? "detail-open" : ""}`} aria-label="Runs">
      <Find list={list} on_start={() => set_starting(true)} />
      <div class="list">
        <div class="rows">
          <RunTable list={list} open={open} compare={compare} selection={selection} on_select={set_selection} />
          {list.error && <p class="empty" role="alert">{list.error}</p>}
          {!list.error && !list.loading && list.items.length === 0 && <Nothing list={list} />}
          <Pager list={list} />
        </div>
        {selection.size > 0 && <SelectionBar selection={selection} on_clear={() => set_selection(kNone)}
          on_changed={list.refresh} on_compare={compare_all} />}
      </div>
      {open !== null
        ? <RunDetail key={open} id={open} compare={compare} on_changed={list.refresh} on_compare={(ids) => app.compare_with(ids)} />
        : <section class="view none">
            <p class="empty">Open a run to play it. Select two to four to compare them.</p>
          </section>}
      {starting && <StartRun on_close={() => set_starting(false)} on_started={list.refresh} />}
    </main>
  );
}

function Find(props: { list: RunList; on_start: () => void }): JSX.Element {
  const { search, results, set_search } = props.list;
  const all = results && Object.values(results).reduce((sum, n) => sum + n, 0);
  const shown = kResults.filter((r) => kAlways.includes(r) || (results?.[r] ?? 0) > 0 || search.result === r);
  const chip = (result: string, word: string, count: number | null) => (
    <button key={result} class={`chip ${search.result === result ? "on" : ""}`} aria-pressed={search.result === result}
      data-testid={`chip-${result || "all"}`} onClick={() => set_search({ result })}>
      {word}{count !== null && <b class="num">{count.toLocaleString("en")}</b>}
    </button>
  );
  return (
    <div class="find" role="search">
      <input type="search" placeholder="Search all runs" value={search.text}
        aria-label="Search all runs" title="Words in scenario, controller, label, note, tags or number" data-testid="runs-filter"
        onInput={(e) => set_search({ text: e.currentTarget.value })} />
      <div class="chips" role="group" aria-label="Outcome">
        {search.batch !== null && <button class="chip on" data-testid="chip-batch" title="Show all runs again"
          onClick={() => set_search({ batch: null })}>Batch {search.batch}{icons.close}</button>}
        {chip("", "All", all)}
        {shown.map((r) => chip(r, result_word(r).word, results && (results[r] ?? 0)))}
        {(["session", "background"] as const).map((kind) => (
          <button key={kind} class={`chip ${search.kind === kind ? "on" : ""}`} aria-pressed={search.kind === kind}
            title={kind_words[kind].help} data-testid={`chip-${kind}`}
            onClick={() => set_search({ kind: search.kind === kind ? "" : kind })}>
            {kind === "session" ? icons.live : icons.background}{kind_words[kind].word}
          </button>
        ))}
      </div>
      <Guard need="operator"><button class="ghost start" data-testid="start-run" onClick={props.on_start}>Start a run</button></Guard>
    </div>
  );
}

function Nothing(props: { list: RunList }): JSX.Element {
  const { search, set_search } = props.list;
  const searching = search.text !== "" || search.result !== "" || search.kind !== "" || search.batch !== null;
  if (!searching) return <p class="empty">No runs yet. Drive the robot, or start a run in the background.</p>;
  return (
    <p class="empty">No run matches. <button class="text" data-testid="show-all"
      onClick={() => set_search({ ...kFirstSearch, sort: search.sort, descending: search.descending })}>Show all runs</button></p>
  );
}

/** Which lines are shown, and the way to the others. */
function Pager(props: { list: RunList }): JSX.Element | null {
  const { at, items, total, paged, older, newer } = props.list;
  if (!paged) return null;
  return (
    <nav class="pager" aria-label="Pages of the list">
      <button class="ghost" data-testid="page-back" disabled={!newer} onClick={() => newer?.()}>Back</button>
      <span class="num" data-testid="page-words">{(at + 1).toLocaleString("en")}–{(at + items.length).toLocaleString("en")}
        {total !== null && ` of ${total.toLocaleString("en")}`}</span>
      <button class="ghost" data-testid="page-on" disabled={!older} onClick={() => older?.()}>More</button>
    </nav>
  );
}
