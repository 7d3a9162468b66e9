// web/src/views/start_run.tsx: the small form that starts runs in the background.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import * as rest from "../link/rest";
import { Dialog, NumberField, Pick, Problem, use_problem } from "../ui/controls";
import { titled } from "../words";

const kMostRepeats = 100;

const is_whole = (value: number | null, least: number, most: number): value is number =>
  Number.isInteger(value) && value! >= least && value! <= most;

export function StartRun(props: { on_close: () => void; on_started: () => void }): JSX.Element {
  const app = use_app();
  const { session, catalog, scenarios } = use_ui("session", "catalog", "scenarios");
  const known = scenarios.find((s) => s.name === session?.scenario.name) ?? scenarios[0]; // it may be saved nowhere
  const [scenario, set_scenario] = useState(known?.name ?? "");
  const [controller, set_controller] = useState(session?.controller ?? "modified");
  const [seed, set_seed] = useState<number | null>(1);
  const [repeats, set_repeats] = useState<number | null>(1);
  const [problem, attempt] = use_problem();
  const [busy, set_busy] = useState(false);
  const submit = async (e: Event) => {
    e.preventDefault();
    set_busy(true);
    await attempt(async () => {
      if (!is_whole(seed, 0, Number.MAX_SAFE_INTEGER)) throw new Error("The seed must be a whole number of at least 0.");
      if (!is_whole(repeats, 1, kMostRepeats)) throw new Error(`The repeats must be a whole number from 1 to ${kMostRepeats}.`);
      const answer = await rest.post<{ runs: number[] }>("/runs", {
        scenario, controller, seed, repeats,
      });
      app.toast("info", answer.runs.length === 1 ? `Run ${answer.runs[0]} is under way.`
        : `Runs ${answer.runs[0]} to ${answer.runs.at(-1)} are under way.`);
      props.on_started();
      props.on_close();
    });
    set_busy(false);
  };
  return (
    <Dialog title="Start a run" name="start-dialog" on_close={props.on_close}>
      <form class="form" noValidate onSubmit={(e) => void submit(e)}>
        <div class="line"><span>Scenario</span>
          <Pick label="Scenario" name="start-scenario" value={scenario} on_pick={set_scenario}
            choices={scenarios.map((s) => ({ name: s.name, label: titled(s.name) }))} /></div>
        <div class="line"><span>Controller</span>
          <Pick label="Controller" name="start-controller" value={controller} on_pick={set_controller}
            choices={catalog?.controllers ?? []} /></div>
        <div class="pair">
          <NumberField label="Seed" name="start-seed" value={seed} step={1} min={0} on_change={set_seed} />
          <NumberField label="Repeats" name="start-repeats" value={repeats} step={1} min={1}
            on_change={set_repeats} />
        </div>
        <p class="quiet">Runs in the background, as fast as possible. Each repeat takes the next seed.</p>
        <Problem text={problem} />
        <button type="submit" class="small primary" disabled={busy} data-testid="start-go">
          {busy ? "Starting" : "Start"}
        </button>
      </form>
    </Dialog>
  );
}
