// web/src/views/run_actions.tsx: what can be done with the selected runs: compare, tag, cancel,
// delete with undo.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { App, use_app } from "../app";
import { ManyRuns, RunItem } from "../contract";
import * as rest from "../link/rest";
import { Dialog, Problem, use_problem } from "../ui/controls";
import { kMostCompared } from "../link/route";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";

/** Most runs that are drawn over each other. */
const kMostTogether = kMostCompared + 1; // with the open run

/** Lines of the list by their key: single runs, or batches that stand for all their runs. */
export type Selection = ReadonlyMap<string, RunItem>;

export function key_of(run: RunItem): string {
  return run.group ? `batch-${run.group.first}` : `run-${run.id}`;
}

interface Named { ids: number[]; batches: number[] }

function named(selection: Selection): Named {
  const runs = [...selection.values()];
  return {
    ids: runs.filter((r) => !r.group).map((r) => r.id),
    batches: runs.flatMap((r) => (r.group && r.batch !== null ? [r.batch] : [])),
  };
}

/** "1 run", "12 runs". */
export function runs_words(count: number): string {
  return count === 1 ? "1 run" : `${count.toLocaleString("en")} runs`;
}

export function count_of(selection: Selection): number {
  return [...selection.values()].reduce((sum, r) => sum + (r.group?.runs ?? 1), 0);
}

/** Says how many runs were changed, and why others were not. */
function tell(app: App, answer: ManyRuns, done: string, undo?: () => void): void {
  const { runs, refused } = answer;
  if (runs.length > 0) app.toast("info", `${runs_words(runs.length)} ${done}.`, undo);
  if (refused.length > 0) {
    app.toast("warn", `${runs_words(refused.length)} not ${done}: ${refused[0].why}`);
  }
}

/** Deletes the runs, and offers to bring them back. */
export async function delete_runs(app: App, runs: Named, changed: () => void): Promise<void> {
  const answer = await app.attempt(rest.post<ManyRuns>("/runs/delete", runs));
  if (!answer) return;
  tell(app, answer, "deleted", () => {
    void app.attempt(rest.post<ManyRuns>("/runs/restore", { ids: answer.runs })).then((back) => {
      if (back) tell(app, back, "restored");
      changed();
    });
  });
  changed();
}

async function cancel_runs(app: App, runs: Named, changed: () => void): Promise<void> {
  const answer = await app.attempt(rest.post<ManyRuns>("/runs/cancel", runs));
  if (answer) tell(app, answer, "cancelled");
  changed();
}

export function SelectionBar(props: {
  selection: Selection; on_clear: () => void; on_changed: () => void; on_compare: (ids: number[]) => void;
}): JSX.Element {
  const app = use_app();
  const [tagging, set_tagging] = useState(false);
  const { selection } = props;
  const runs = named(selection);
  const comparable = runs.batches.length === 0 && runs.ids.length >= 2 && runs.ids.length <= kMostTogether;
  const under_way = [...selection.values()].some((r) => r.kind === "background" &&
    (["queued", "recording"].includes(r.status) || (r.group && (r.group.results.queued || r.group.results.recording))));
  const done = () => {
    props.on_changed();
    props.on_clear();
  };
  return (
    <div class="selection-bar" role="toolbar" aria-label="Selected runs" data-testid="selection-bar">
      <b data-testid="selection-count">{runs_words(count_of(selection))}</b>
      <button class="ghost" data-testid="selection-compare" disabled={!comparable}
        title={comparable ? "Draw them over each other" : `Select two to ${kMostTogether} single runs to compare them`}
        onClick={() => props.on_compare(runs.ids)}>{icons.compare}Compare</button>
      <Guard need="operator">
        <button class="ghost" data-testid="selection-tag" onClick={() => set_tagging(true)}>Tag</button>
        <button class="ghost" data-testid="selection-cancel" disabled={!under_way}
          title={under_way ? "End the queued and running ones" : "None of them is queued or running"}
          onClick={() => void cancel_runs(app, runs, done)}>Cancel</button>
      </Guard>
      <Guard need="admin">
        <button class="ghost" data-testid="selection-delete"
          onClick={() => void delete_runs(app, runs, done)}>{icons.trash}Delete</button>
      </Guard>
      <button class="icon" aria-label="Select none" title="Select none (Esc)" data-testid="selection-clear"
        onClick={props.on_clear}>{icons.close}</button>
      {tagging && <TagDialog runs={runs} on_close={() => set_tagging(false)} on_changed={done} />}
    </div>
  );
}

/** The tags in a text with commas. */
export function tags_in(text: string): string[] {
  return [...new Set(text.split(",").map((tag) => tag.trim()).filter((tag) => tag !== ""))];
}

function TagDialog(props: { runs: Named; on_close: () => void; on_changed: () => void }): JSX.Element {
  const app = use_app();
  const [text, set_text] = useState("");
  const [problem, attempt] = use_problem();
  const change = (what: "add" | "remove") => void attempt(async () => {
    const tags = tags_in(text);
    if (tags.length === 0) throw new Error("Type a tag first.");
    const answer = await rest.post<ManyRuns>("/runs/tag", { ...props.runs, [what]: tags });
    tell(app, answer, what === "add" ? "tagged" : "untagged");
    props.on_close();
    props.on_changed();
  });
  return (
    <Dialog title="Tag the selected runs" name="tag-dialog" on_close={props.on_close}>
      <form class="form" onSubmit={(e) => {
        e.preventDefault();
        change("add");
      }}>
        <label class="stack"><span>Tags, with commas between</span>
          <input value={text} data-testid="tag-text" onInput={(e) => set_text(e.currentTarget.value)} /></label>
        <Problem text={problem} />
        <div class="facts-acts">
          <button type="submit" class="small primary" data-testid="tag-add">Add</button>
          <button type="button" class="ghost" data-testid="tag-remove" onClick={() => change("remove")}>Remove</button>
        </div>
      </form>
    </Dialog>
  );
}
