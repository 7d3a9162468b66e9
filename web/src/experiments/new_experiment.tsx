// web/src/experiments/new_experiment.tsx: a document from a template or by hand, checked, then started.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import * as rest from "../link/rest";
import { Dialog, Problem, Segments, use_problem } from "../ui/controls";
import { Estimate, ExperimentInfo } from "./contract";
import { templates } from "./templates";
import { counted, span_words } from "./words";

export function NewExperiment(props: { document: unknown; on_close: () => void; on_started: (id: string) => void }): JSX.Element {
  const given = Object.keys(props.document as object).length > 0;
  const [template, set_template] = useState(given ? "" : templates[0].name);
  const [text, set_text] = useState(printed(given ? props.document : templates[0].document));
  const [estimate, set_estimate] = useState<Estimate | null>(null);
  const [problem, attempt] = use_problem();
  const [busy, set_busy] = useState("");
  const run = async (name: string, act: (document: unknown) => Promise<unknown>) => {
    set_busy(name);
    await attempt(async () => act(parsed(text)));
    set_busy("");
  };
  const check = () => run("check", async (document) => set_estimate(await rest.post<Estimate>("/experiments/estimate", document)));
  const start = () => run("start", async (document) => {
    const info = await rest.post<ExperimentInfo>("/experiments", document);
    props.on_started(info.id);
    props.on_close();
  });
  return (
    <Dialog title="New experiment" name="experiment-dialog" on_close={props.on_close}>
      <form class="form experiment-form" noValidate onSubmit={(e) => {
        e.preventDefault();
        void start();
      }}>
        <Segments label="Template" name="experiment-template" value={template} on_pick={(name) => {
          set_template(name);
          set_estimate(null);
          set_text(printed(templates.find((t) => t.name === name)!.document));
        }} choices={templates} />
        <p class="quiet">{templates.find((t) => t.name === template)?.help ?? "The document of the open experiment."}</p>
        <label class="document"><span class="hidden-words">Document, as JSON</span>
          <textarea class="num" spellcheck={false} rows={16} value={text} data-testid="experiment-document"
            onInput={(e) => {
              set_text(e.currentTarget.value);
              set_estimate(null);
            }} /></label>
        <Problem text={problem} name="experiment-problem" />
        {estimate && <p role="status" data-testid="experiment-estimate"><b class="num">{counted(estimate.runs, "run")}:</b> {" "}
          {counted(estimate.scenarios, "scenario")} × {counted(estimate.controllers, "controller")} × {counted(estimate.settings, "setting")} × {counted(estimate.seeds, "seed")};
          at most {span_words(estimate.cpu_time)} of one core{estimate.extrapolated && ", a guess: these runs are slow to measure"}.</p>}
        <div class="experiment-acts">
          <button type="button" class="ghost" disabled={busy !== ""} data-testid="experiment-check" onClick={() => void check()}>
            {busy === "check" ? "Checking" : "Check"}</button>
          <button type="submit" class="small primary" disabled={busy !== ""} data-testid="experiment-start">
            {busy === "start" ? "Starting" : "Start"}</button>
        </div>
      </form>
    </Dialog>
  );
}

function printed(document: unknown): string {
  return JSON.stringify(document, null, 2);
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch (error) {
    throw new Error(`This is not JSON yet: ${(error as Error).message}.`);
  }
}
