// web/src/views/signals.tsx: the plots of the live run: its last seconds, or any piece of it.
import { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { file_name } from "../plots/save";
import { PlotStack } from "../plots/stack";
import { Columns } from "../state/columns";
import { use_redraw } from "../state/store";
import { titled } from "../words";

const kWindow = 20;   // [s] of run clock
const kPeriod = 100;  // [ms] within which nobody sees a newer value

/** Renders again when `columns` has new rows, but not more often than anyone sees. */
function use_rows(columns: Columns): void {
  const redraw = use_redraw();
  useEffect(() => {
    const state = () => `${columns.length} ${columns.at("t", columns.length - 1)}`;
    let seen = state();
    const timer = setInterval(() => {
      if (state() === seen) return;
      seen = state();
      redraw();
    }, kPeriod);
    return () => clearInterval(timer);
  }, [columns]);
}

/** `time` is the instant that the scene looks back to, null while it shows the newest; `seek` looks back. */
export function Signals(props: { time?: number | null; seek?: (t: number) => void }): JSX.Element {
  const app = use_app();
  const { session, hidden, force_scale } = use_ui("session", "hidden", "force_scale");
  const { scene } = app;
  use_rows(scene.columns);
  const run = scene.run;
  const scenario = session?.scenario.name ?? "";
  const file = file_name(run, scenario);
  return (
    <section class="signals" aria-label="Plots">
      <PlotStack runs={[{ label: run === null ? "Live" : `Run ${run}`, columns: scene.columns }]} live usual={kWindow}
        time={props.time ?? null} seek={props.seek} follows={false} folds={false} height={72}
        save={{
          title: `${run === null ? "Live run" : `Run ${run}`}: ${titled(scenario)}, ${titled(scene.controller)}`,
          file, csv: run !== null && run > 0 ? [{ run, name: file }] : [],
          scene: () => ({
            scene: app.shown, view: app.view,
            overlay: {
              selection: null, hovered: null, draft: {}, force_scale, hidden, ghosts: [], future: false,
              insets: { left: 0, top: 0, right: 0, bottom: 22 },
            },
          }),
        }} />
    </section>
  );
}
