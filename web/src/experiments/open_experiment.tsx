// web/src/experiments/open_experiment.tsx: one experiment: its progress, table, figures and runs.
import { JSX } from "preact";
import { useMemo, useState } from "preact/hooks";
import { use_app } from "../app";
import * as rest from "../link/rest";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { Pick } from "../ui/controls";
import { fixed, titled } from "../words";
import { ExperimentDetail, ExperimentInfo, Results } from "./contract";
import { Bars, Boxes } from "./figures";
import { ResultsTable } from "./results_table";
import { Paths } from "./paths";
import { RunsOf, open_again } from "./runs_of";
import { use_calm, use_detail, use_progress, use_results } from "./watch";
import { counted, incomplete_words, span_words, state_of } from "./words";

export function OpenExperiment(props: { id: string; on_gone: () => void; on_again: (document: unknown) => void }): JSX.Element {
  const { id } = props;
  const detail = use_detail(id);
  const progress = use_progress(id);
  const info = progress ?? detail.value;
  const [scenario, set_scenario] = useState("");
  const [picked, set_picked] = useState<string | null>(null);
  const done = use_calm(info?.done ?? null, info?.state === "running");
  const results = use_results(id, scenario, done);
  // Progress comes four times a second; the table, the figures and the runs change more seldom.
  const body = useMemo(() => detail.value && <Body id={id} detail={detail.value} results={results.value} scenario={scenario}
    on_scenario={set_scenario} picked={picked} on_pick={set_picked} done={done} />,
  [detail.value, results.value, scenario, picked, done]);
  if (!info || !detail.value) {
    return <section class="experiment none"><p class="empty" role={detail.problem ? "alert" : undefined}>{detail.problem ?? "Loading"}</p></section>;
  }
  return (
    <section class="experiment" aria-label={info.name} data-testid="experiment">
      <Head info={info} detail={detail.value} {...props} />
      <Progress info={info} />
      {results.problem && <p class="problem" role="alert">{results.problem}</p>}
      {body}
    </section>
  );
}

function Body(props: {
  id: string; detail: ExperimentDetail; results: Results | null; scenario: string; on_scenario: (name: string) => void;
  picked: string | null; on_pick: (label: string) => void; done: number | null;
}): JSX.Element {
  const { detail, results, scenario } = props;
  const app = use_app();
  const arms = results && arms_of(results, scenario);
  const baseline = results?.comparisons[0]?.baseline ?? null;
  const picked = props.picked ?? arms?.find((arm) => arm.label !== baseline)?.label ?? null;
  return <>
    {arms && <>
      <div class="experiment-pick">
        <Pick label="Scenario" name="experiment-scenario" value={scenario} on_pick={props.on_scenario}
          choices={[{ name: "", label: `All ${detail.scenarios.length} scenarios` },
            ...detail.scenarios.map((name) => ({ name, label: titled(name) }))]} />
      </div>
      <ResultsTable arms={arms} comparisons={scenario === "" ? results!.comparisons : []} baseline={baseline}
        picked={picked} on_pick={props.on_pick} />
      <div class="experiment-figures">
        <Bars title="Reached the goal" arms={arms} baseline={baseline} picked={picked} />
        <Boxes title="Time to the goal" unit="s" figure="time_s" arms={arms} baseline={baseline} picked={picked} />
        <Boxes title="Least clearance" unit="m" figure="min_clearance_m" arms={arms} baseline={baseline} picked={picked} />
      </div>
    </>}
    <Paths id={props.id} scenario={scenario === "" ? detail.scenarios[0] : scenario} done={props.done}
      baseline={baseline} picked={picked} on_replay={(run) => open_again(app, props.id, run)} />
    <RunsOf id={props.id} detail={detail} done={props.done} scenario={scenario} />
  </>;
}

/** The arms over all scenarios, or in the one that is shown. */
function arms_of(results: Results, scenario: string): Results["arms"] {
  return scenario === "" ? results.arms : results.scenarios?.filter((group) => group.scenario === scenario) ?? [];
}

function Head(props: {
  info: ExperimentInfo; detail: ExperimentDetail; on_gone: () => void; on_again: (document: unknown) => void;
}): JSX.Element {
  const { info, detail } = props;
  const app = use_app();
  const [sure, set_sure] = useState(false);
  const remove = async () => {
    if (await app.attempt(rest.remove(`/experiments/${info.id}`))) props.on_gone();
  };
  const began = new Date(info.created).toLocaleString("en", { dateStyle: "medium", timeStyle: "short" });
  return (
    <header class="experiment-head">
      <button class="icon back" aria-label="Back to the list" onClick={() => app.open_experiment(null)}>{icons.back}</button>
      <h2>{info.name}</h2>
      <span class="quiet">{counted(info.runs, "run")}{info.by && ` by ${info.by}`}, {began}</span>
      <span class="experiment-acts">
        <Guard need="operator"><button class="ghost small" data-testid="experiment-again"
          onClick={() => props.on_again(detail.document)}>Document</button></Guard>
        <Downloads id={info.id} />
        <Guard need="admin">{sure
          ? <button class="small danger" data-testid="experiment-delete-sure" onClick={() => void remove()}>Delete it and its runs</button>
          : <button class="icon" aria-label="Delete the experiment" title="Delete" data-testid="experiment-delete"
              onClick={() => set_sure(true)}>{icons.trash}</button>}</Guard>
      </span>
    </header>
  );
}

const kDownloads: [string, string][] = [
  ["runs.csv", "CSV"], ["results.json", "JSON"], ["report.md", "Markdown"], ["report.tex", "LaTeX"],
];

/** The files are made when they are asked for. */
function Downloads(props: { id: string }): JSX.Element {
  const path = (file: string) => `/api/v1/experiments/${props.id}/files/${file}`;
  return (
    <span class="downloads" role="group" aria-label="Results">
      {kDownloads.map(([file, label]) => (
        <a key={file} class="ghost small" href={path(file)} download data-testid={`file-${file}`}>{label}</a>
      ))}
      <a class="small primary" href={path("report.html")} target="_blank" data-testid="file-report.html">Report</a>
    </span>
  );
}

function Progress(props: { info: ExperimentInfo }): JSX.Element | null {
  const { info } = props;
  const app = use_app();
  const incomplete = incomplete_words(info);
  const act = (name: string) => void app.attempt(rest.post(`/experiments/${info.id}/${name}`, {}));
  if (incomplete === null) return null;
  const good = info.done - info.failed;
  const state = state_of(info);
  return (
    <div class="experiment-progress" data-testid="experiment-progress">
      <p role="status"><b>INCOMPLETE: {incomplete}.</b> {info.state === "running" ? "All figures below hold for these and still move."
        : `${state.word}.`} {info.problem}</p>
      <div class="meter" role="progressbar" aria-valuemin={0} aria-valuemax={info.runs} aria-valuenow={info.done} aria-label="Runs done">
        <i class="good" ref={(e) => e?.style.setProperty("width", `${(100 * good) / info.runs}%`)} />
        <i class="failed" ref={(e) => e?.style.setProperty("width", `${(100 * info.failed) / info.runs}%`)} />
      </div>
      <div class="experiment-rate num">
        <span><b>{Math.floor((100 * info.done) / info.runs)} %</b></span>
        {info.rate !== null && <span><b>{fixed(info.rate, info.rate < 10 ? 1 : 0)}</b> runs/s</span>}
        {info.time_left !== null && <span><b>{span_words(info.time_left)}</b> left</span>}
      </div>
      <Guard need="operator"><span class="experiment-acts">
        {info.state === "running"
          ? <button class="ghost" data-testid="experiment-pause" onClick={() => act("pause")}>{icons.pause}Pause</button>
          : <button class="small primary" data-testid="experiment-resume" onClick={() => act("resume")}>{icons.play}
              {info.done === info.runs ? "Make the failed runs again" : "Go on"}</button>}
        {(info.state === "running" || info.state === "paused") &&
          <button class="ghost" data-testid="experiment-cancel" onClick={() => act("cancel")}>{icons.close}Cancel</button>}
      </span></Guard>
    </div>
  );
}
