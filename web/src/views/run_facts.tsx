// web/src/views/run_facts.tsx: what a run is and how it ended; its label, tags and note; and the
// figures of up to four runs beside each other.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { RunItem } from "../contract";
import { RunLook } from "../draw/scene";
import * as rest from "../link/rest";
import { kMostCompared } from "../link/route";
import { file_name } from "../plots/save";
import { figure_words, kMetrics } from "../figures";
import { Dialog, Problem, use_problem } from "../ui/controls";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { Named } from "../ui/tip";
import { clock, driver_word, fixed, kind_words, later_words, result_word, titled } from "../words";
import { DriveAgain } from "./drive_again";
import { delete_runs, tags_in } from "./run_actions";

const kLongNote = 300; // letters: above it the note may have to be scrolled

/** The colours of the open run and of those drawn over it. */
export const kLooks: RunLook[] = [
  { letter: "A", colour: "accent", dash: [] },
  { letter: "B", colour: "elastic", dash: [] },
  { letter: "C", colour: "third", dash: [9, 5] },
  { letter: "D", colour: "fourth", dash: [2, 5] },
];

export function RunFacts(props: {
  run: RunItem; others: RunItem[]; on_changed: () => void; on_compare: (ids: number[]) => void;
}): JSX.Element {
  const app = use_app();
  const [item, set_item] = useState(props.run);
  const [editing, set_editing] = useState(false);
  const word = result_word(item.result);
  const kind = kind_words[item.kind];
  const others = props.others.map((other) => other.id);
  const ended = !["recording", "queued"].includes(item.status);
  const erase = () => {
    // Once the view has closed: the open run may still be fetched.
    const then = () => setTimeout(() => void delete_runs(app, { ids: [item.id], batches: [] }, props.on_changed));
    addEventListener("hashchange", then, { once: true });
    app.go("runs");
  };
  return (
    <section class="facts" aria-label="Result of the run" data-testid="facts">
      <a class="icon narrow" href="#/runs" aria-label="Back to the list">{icons.back}</a>
      <b class="facts-name" data-testid="facts-name">{item.label || `Run ${item.id}`}</b>
      <span class={`tag tone-${word.tone}`}><i />{word.word}{item.metrics && <span class="num wide-only">{clock(item.time)}</span>}</span>
      <span class="quiet" title={kind.help}>{item.label && `Run ${item.id} · `}{titled(item.scenario)} · {driver_word(item)} · {item.filter} · seed {item.seed} · <span data-testid="facts-kind">{kind.word.toLowerCase()}</span></span>
      <span class="facts-acts">
        <DriveAgain run={item} on_changed={props.on_changed}
          on_driven={(id) => props.on_compare([...others.slice(0, kMostCompared - 1), id])} />
        <Guard need="operator"><button class="icon" aria-label="Edit label, tags and note" title="Label, tags and note"
          data-testid="edit-run" onClick={() => set_editing(true)}>{icons.edit}</button></Guard>
        <a class="ghost" href={`/api/v1/runs/${item.id}/csv?units=1`}
          download={`${file_name(item.id, item.scenario)}.csv`} data-testid="csv">{icons.download}CSV</a>
        {ended && <Guard need="admin"><button class="icon" aria-label={`Delete run ${item.id}`} title="Delete; it can be undone"
          onClick={erase} data-testid="delete-run">{icons.trash}</button></Guard>}
      </span>
      {(item.reason || item.later) && <p class="reason" data-testid="facts-reason">
        {[item.reason, later_words(item), item.later?.reason].filter(Boolean).join(" ")}</p>}
      {(item.tags.length > 0 || item.note) && <p class="reason" data-testid="facts-note" tabIndex={item.note.length > kLongNote ? 0 : undefined}>
        {item.tags.map((tag) => <em class="label" key={tag}>{tag}</em>)} {item.note}</p>}
      <Figures runs={[item, ...props.others]} on_uncompare={(id) => props.on_compare(others.filter((one) => one !== id))} />
      {editing && <Remarks run={item} on_close={() => set_editing(false)} on_saved={(saved) => {
        set_item(saved);
        props.on_changed();
      }} />}
    </section>
  );
}

/** The figures of the runs, with their differences to the first. */
function Figures(props: { runs: RunItem[]; on_uncompare: (id: number) => void }): JSX.Element | null {
  const { runs } = props;
  const many = runs.length > 1;
  if (!runs.some((r) => r.metrics)) return null;
  const rows = many ? kMetrics.slice(0, -1) : kMetrics; // the room is for the differences
  const first = runs[0].metrics;
  return (
    <div class={`measures-box ${many ? "many" : ""}`} tabIndex={many ? 0 : undefined}
      role={many ? "region" : undefined} aria-label={many ? "Figures of the compared runs" : undefined}>
      <table class="measures" data-testid="measures">
        <thead><tr>
          {many && <><th scope="col">Run</th><th scope="col">Outcome</th></>}
          {rows.map((row) => <th key={row.label} scope="col"><Named label={row.label} meaning={figure_words(row)} />{row.unit && <u> {row.unit}</u>}</th>)}
        </tr></thead>
        <tbody>
          {runs.map((r, i) => (
            <tr key={r.id} data-testid={`measures-${r.id}`}>
              {many && <RunNames run={r} look={kLooks[i]} on_close={i > 0 ? () => props.on_uncompare(r.id) : null} />}
              {rows.map((row) => {
                const value = r.metrics ? row.of(r.metrics) : null;
                return <td key={row.label} class="num">{fixed(value, row.digits)}
                  {i > 0 && <Difference value={value} first={first ? row.of(first) : null} digits={row.digits} />}</td>;
              })}
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function RunNames(props: { run: RunItem; look: RunLook; on_close: (() => void) | null }): JSX.Element {
  const { run, look, on_close } = props;
  const word = result_word(run.result);
  return (
    <>
      <th scope="row" class={`tone-${look.colour}`}>
        <svg class="swatch" viewBox="0 0 26 8" aria-hidden="true"><path d="M1 4h24" stroke="currentColor" stroke-width="3"
          stroke-dasharray={look.dash.join(" ")} /></svg>
        {look.letter} {run.label || `${run.id} ${driver_word(run)}`}
        {on_close && <button class="mini" aria-label={`Compare without run ${run.id}`} title="Compare without it"
          data-testid={`uncompare-${run.id}`} onClick={on_close}>{icons.close}</button>}
      </th>
      <td><span class={`tag tone-${word.tone}`}><i />{word.word}</span></td>
    </>
  );
}

function Difference(props: { value: number | null; first: number | null; digits: number }): JSX.Element | null {
  const { value, first, digits } = props;
  if (value === null || first === null) return null;
  const by = value - first;
  const text = fixed(by, digits);
  return <small title="Difference to the first run">{by > 0 && Number(text) !== 0 ? `+${text}` : Number(text) === 0 ? "±0" : text}</small>;
}

/** Label, tags and note, to be changed and saved. */
function Remarks(props: { run: RunItem; on_close: () => void; on_saved: (run: RunItem) => void }): JSX.Element {
  const { run } = props;
  const [label, set_label] = useState(run.label);
  const [tags, set_tags] = useState(run.tags.join(", "));
  const [note, set_note] = useState(run.note);
  const [problem, attempt] = use_problem();
  const save = () => attempt(async () => {
    props.on_saved(await rest.patch<RunItem>(`/runs/${run.id}`, { label: label.trim(), tags: tags_in(tags), note: note.trim() }));
    props.on_close();
  });
  return (
    <Dialog title={`Run ${run.id}`} name="remarks-dialog" on_close={props.on_close}>
      <form class="form" onSubmit={(e) => {
        e.preventDefault();
        void save();
      }}>
        <label class="stack"><span>Label</span>
          <input value={label} maxLength={120} data-testid="remarks-label" onInput={(e) => set_label(e.currentTarget.value)} /></label>
        <label class="stack"><span>Tags, with commas between</span>
          <input value={tags} data-testid="remarks-tags" onInput={(e) => set_tags(e.currentTarget.value)} /></label>
        <label class="stack"><span>Note</span>
          <textarea rows={4} maxLength={4000} value={note} data-testid="remarks-note" onInput={(e) => set_note(e.currentTarget.value)} /></label>
        <Problem text={problem} />
        <button type="submit" class="small primary" data-testid="remarks-save">Save</button>
      </form>
    </Dialog>
  );
}
