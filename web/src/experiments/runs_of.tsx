// web/src/experiments/runs_of.tsx: the runs of an experiment: filtered, sorted, and made again to be
// watched.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { App, use_app } from "../app";
import { RunItem } from "../contract";
import * as rest from "../link/rest";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { Pick } from "../ui/controls";
import { fixed, result_word } from "../words";
import { ExperimentDetail, ExperimentRun } from "./contract";
import { RunQuery, use_runs } from "./watch";
import { count } from "./words";

const kOutcomes = ["reached", "stuck", "collided", "overturned", "fallen", "out_of_time", "failed"];
const kColumns: [string, string, string, number][] = [
  ["time_s", "Time", "s", 1], ["path_m", "Path", "m", 2], ["min_clearance_m", "Clearance", "m", 2], ["turning_rad", "Turning", "rad", 1],
];
const kLook = 300;     // [ms] between two looks at a run that is made again
const kPatience = 120; // [s]

export function RunsOf(props: { id: string; detail: ExperimentDetail; done: number | null; scenario: string }): JSX.Element {
  const [query, set_query] = useState<RunQuery>({ outcome: "", scenario: "", controller: "", sort: "" });
  const [from, set_from] = useState(0);
  useEffect(() => set_from(0), [query, props.scenario]);
  const page = use_runs(props.id, { ...query, scenario: props.scenario }, from, props.done);
  const set = (part: Partial<RunQuery>) => set_query({ ...query, ...part });
  return (
    <section class="experiment-runs" aria-label="Runs of the experiment">
      <header>
        <h3>Runs</h3>
        <div class="chips" role="group" aria-label="Outcome">
          {["", ...kOutcomes].map((outcome) => (
            <button key={outcome} class={`chip ${query.outcome === outcome ? "on" : ""}`} aria-pressed={query.outcome === outcome}
              data-testid={`outcome-${outcome || "all"}`} onClick={() => set({ outcome })}>{outcome === "" ? "All" : result_word(outcome).word}</button>
          ))}
        </div>
        <Pick label="Controller" name="runs-controller" value={query.controller} on_pick={(controller) => set({ controller })}
          choices={[{ name: "", label: "Every controller" }, ...props.detail.arms.map((name) => ({ name, label: name }))]} />
      </header>
      {page.problem && <p class="problem" role="alert">{page.problem}</p>}
      {page.value && (page.value.found === 0 ? <p class="empty">No finished run of this kind.</p> : <>
        <Table runs={page.value.items} id={props.id} sort={query.sort} on_sort={(sort) => set({ sort })} />
        <nav class="pager" aria-label="Pages of runs">
          <button class="ghost" disabled={from === 0} onClick={() => set_from(Math.max(0, from - 50))}>Back</button>
          <span class="num">{count(from + 1)}–{count(from + page.value.items.length)} of {count(page.value.found)}</span>
          <button class="ghost" disabled={page.value.next === null} onClick={() => set_from(from + 50)}>More</button>
        </nav>
      </>)}
    </section>
  );
}

function Table(props: { runs: ExperimentRun[]; id: string; sort: string; on_sort: (sort: string) => void }): JSX.Element {
  const { sort } = props;
  // First the largest, then the least, then by number.
  const next = (column: string) => (sort === `-${column}` ? column : sort === column ? "" : `-${column}`);
  const order = (column: string) => (sort === column ? "ascending" : sort === `-${column}` ? "descending" : undefined);
  return (
    <div class="results-box">
      <table class="run-table" data-testid="experiment-runs">
        <thead><tr>
          <th scope="col"><span class="plain">Run</span></th><th scope="col"><span class="plain">Outcome</span></th>
          {kColumns.map(([column, label, unit]) => (
            <th key={column} scope="col" class="r" aria-sort={order(column)}>
              <button class="sort" data-testid={`sort-${column}`} onClick={() => props.on_sort(next(column))}>{label} <u>{unit}</u>
                <i class={order(column) ? "on" : ""}>{order(column) === "ascending" ? icons.up : icons.down}</i></button>
            </th>
          ))}
          <th scope="col"><span class="hidden-words">What can be done</span></th>
        </tr></thead>
        <tbody>{props.runs.map((run) => <Line key={run.run} run={run} id={props.id} />)}</tbody>
      </table>
    </div>
  );
}

function Line(props: { run: ExperimentRun; id: string }): JSX.Element {
  const { run } = props;
  const app = use_app();
  const [busy, set_busy] = useState(false);
  const result = result_word(run.outcome);
  const replay = async () => {
    set_busy(true);
    await open_again(app, props.id, run.run);
    set_busy(false);
  };
  return (
    <tr>
      <td class="name-cell"><b>{count(run.run)}</b> {run.controller}<small>{run.scenario}, seed {run.seed}</small></td>
      <td><span class={`tag tone-${result.tone}`}><i />{result.word}</span>{run.reason && <small class="later">{run.reason}</small>}</td>
      {kColumns.map(([column, , , digits]) => <td key={column} class="r num">{fixed(run.figures[column] ?? null, digits)}</td>)}
      <td class="experiment-acts">
        <Guard need="operator"><button class="ghost small" disabled={busy} data-testid={`replay-${run.run}`}
          onClick={() => void replay()}>{busy ? "Making it again" : "Replay"}</button></Guard>
        <button class="ghost small" data-testid={`command-${run.run}`} title={run.command} onClick={() => void copy(app, run.command)}>Command</button>
      </td>
    </tr>
  );
}

async function copy(app: App, command: string): Promise<void> {
  try {
    await navigator.clipboard.writeText(command);
    app.toast("info", "The command is on the clipboard. Run it in the folder of the results.");
  } catch {
    app.toast("info", command); // no clipboard without https
  }
}

/** Makes the run again and opens it, unless the person has left the experiment meanwhile. */
export async function open_again(app: App, id: string, run: number): Promise<void> {
  const made = await app.attempt(make_again(id, run));
  if (made === null) return;
  const { view, experiment } = app.ui.value;
  if (view === "experiments" && experiment === id) app.open_run(made, []);
  else app.toast("info", `Run ${made} is made. It stands in Runs.`);
}

/** Makes the run again, with its record, and waits until it can be opened. */
async function make_again(id: string, run: number): Promise<number> {
  const { runs: [made] } = await rest.post<{ runs: number[] }>(`/experiments/${id}/runs/${run}/record`, {});
  for (let waited = 0; waited < kPatience * 1000; waited += kLook) {
    const { status } = await rest.get<RunItem>(`/runs/${made}`);
    if (status !== "queued" && status !== "recording") return made;
    await new Promise((resolve) => setTimeout(resolve, kLook));
  }
  throw new Error(`Run ${made} is still being made. It stands in Runs when it is done.`);
}
