// web/src/experiments/experiments.tsx: the Experiments view: the list, and the open experiment.
import "../ui/run_sheet"; // before the styles of the parts below
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import css from "../style/experiments.css?text";
import { Guard } from "../ui/guard";
import { adopt } from "../ui/sheet";
import { ExperimentInfo } from "./contract";
import { NewExperiment } from "./new_experiment";
import { OpenExperiment } from "./open_experiment";
import { use_list } from "./watch";
import { progress_words, state_of } from "./words";

adopt(css);

export function Experiments(): JSX.Element {
  const app = use_app();
  const { experiment: open } = use_ui("experiment");
  const list = use_list();
  const [writing, set_writing] = useState<unknown>(null);
  const items = list.value?.items ?? [];
  return (
    <main class={`experiments ${open !== null ? "detail-open" : ""}`} aria-label="Experiments">
      <section class="experiment-list" aria-label="All experiments">
        <Guard need="operator"><button class="small primary new" data-testid="new-experiment"
          onClick={() => set_writing({})}>New experiment</button></Guard>
        <ul>
          {items.map((info) => <Item key={info.id} info={info} open={info.id === open} />)}
        </ul>
        {list.problem && <p class="empty" role="alert">{list.problem}</p>}
        {list.value && items.length === 0 &&
          <p class="empty">No experiments yet. A new one runs controllers in many worlds, and ends with a table.</p>}
      </section>
      {open !== null
        ? <OpenExperiment key={open} id={open} on_gone={() => {
            app.open_experiment(null);
            list.refresh();
          }} on_again={set_writing} />
        : <section class="experiment none"><p class="empty">Open an experiment to see its table, its figures and its runs.</p></section>}
      {writing !== null && <NewExperiment document={writing} on_close={() => set_writing(null)} on_started={(id) => {
        list.refresh();
        app.open_experiment(id);
      }} />}
    </main>
  );
}

function Item(props: { info: ExperimentInfo; open: boolean }): JSX.Element {
  const { info } = props;
  const state = state_of(info);
  return (
    <li>
      <a href={`#/experiments/${info.id}`} class={props.open ? "on" : ""} aria-current={props.open ? "true" : undefined}
        data-testid={`experiment-${info.id}`}>
        <b>{info.name}</b>
        <span><span class={`tag tone-${state.tone}`}><i />{state.word}</span> <span class="quiet num">{progress_words(info)}</span></span>
        {info.state !== "finished" && <progress max={info.runs} value={info.done} aria-label={`${info.name}: runs done`} />}
      </a>
    </li>
  );
}
