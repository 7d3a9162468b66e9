// web/src/views/drive_again.tsx: drives the world of a run again with another controller, to compare both.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { RunItem } from "../contract";
import * as rest from "../link/rest";
import { use_latest } from "../state/store";
import { Pick } from "../ui/controls";
import { Guard } from "../ui/guard";

const kPollMs = 300;

/** `on_driven` gets the new run once it has ended. */
export function DriveAgain(props: { run: RunItem; on_changed: () => void; on_driven: (id: number) => void }): JSX.Element | null {
  const app = use_app();
  const { catalog } = use_ui("catalog");
  const [under_way, set_under_way] = useState<number | null>(null);
  const latest = use_latest(props);
  useEffect(() => {
    if (under_way === null) return;
    const look = async () => {
      const run = await app.attempt(rest.get<RunItem>(`/runs/${under_way}`));
      if (run && ["queued", "recording"].includes(run.status)) return;
      set_under_way(null);
      latest.current.on_changed();
      if (run) latest.current.on_driven(run.id);
    };
    const timer = setInterval(() => void look(), kPollMs);
    return () => clearInterval(timer);
  }, [under_way]);

  const { run } = props;
  if (run.document?.source !== "simulation") return null;
  const others = (catalog?.controllers ?? []).filter((c) => c.name !== run.controller);
  const drive = async (controller: string) => {
    const { seed, physics, filter, parameters, document } = run;
    const answer = await app.attempt(rest.post<{ runs: number[] }>("/runs",
      { scenario: document!.scenario, controller, seed, physics, filter, parameters }));
    if (!answer) return;
    set_under_way(answer.runs[0]);
    app.say(`Run ${answer.runs[0]} is under way`);
    props.on_changed();
  };
  const busy = under_way !== null;
  return (
    <Guard need="operator">
      <span title="Drives the same world, from the same seed, with another controller, and draws both">
        <Pick label="Compare with another controller" name="drive-again" value="" disabled={busy} on_pick={(name) => void drive(name)}
          choices={[{ name: "", label: busy ? `Driving run ${under_way}` : "Compare with", help: "" }, ...others]} />
      </span>
    </Guard>
  );
}
