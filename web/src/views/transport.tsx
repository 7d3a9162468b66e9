// web/src/views/transport.tsx: reset, play and pause, step, run clock, events, speed of the live run.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { RecordInfo } from "../contract";
import { use_pulse } from "../state/store";
import { Pick } from "../ui/controls";
import { icons } from "../ui/icons";
import { Timeline } from "../ui/timeline";
import { clock, speed_word } from "../words";

const kSpeeds = [0.25, 0.5, 1, 2, 4, 8, 0];

/** A note on the live run's record, after a comma; empty while all is well. */
function record_word(record: RecordInfo): string {
  const words: Record<string, string> = { paused: ", record rests", full: ", record full",
    failed: ", not recorded", off: ", not recorded" };
  return words[record.status] ?? "";
}

export function Transport(): JSX.Element {
  const app = use_app();
  const { session } = use_ui("session");
  use_pulse(100);
  const time = app.scene.frame?.stamp ?? 0;
  const paused = session?.pace.paused ?? false;
  const paceable = session?.robot.paceable ?? false;
  const speed = session?.pace.speed ?? 1;
  const speeds = kSpeeds.includes(speed) ? kSpeeds : [speed, ...kSpeeds];
  const record = session?.record;
  const off = !session || !paceable;
  const why_off = session && !paceable ? "A real robot keeps its own time" : undefined;
  return (
    <div class="transport" role="group" aria-label="Run">
      <button class="btn" aria-label="Reset: the same scenario from its start"
        title="Reset: the same scenario from its start" data-testid="reset" disabled={!session}
        onClick={() => void app.reset()}>{icons.reset}</button>
      <button class="btn primary" aria-label={paused ? "Play" : "Pause"} data-testid="play"
        title={why_off ?? (paused ? "Play (P)" : "Pause (P)")} disabled={off}
        onClick={() => void app.toggle_play()}>{paused ? icons.play : icons.pause}</button>
      <button class="btn" aria-label="Step: one tick" data-testid="step" disabled={off}
        title={why_off ?? "One tick (.)"} onClick={() => void app.step()}>{icons.step}</button>
      <span class="num time" data-testid="time">{clock(time)}</span>
      <Timeline time={time} end={Math.max(time, 20)} events={app.scene.events.list} />
      <span class={`live-words wide ${["full", "failed"].includes(record?.status ?? "") ? "tone-bad" : ""}`}
        title={record?.sentence} data-testid="record-word">
        {session?.source === "replay" ? "from the log" : "live"}{record && record_word(record)}</span>
      <Pick label="Speed" name="speed" value={String(speed)} disabled={off}
        choices={speeds.map((s) => ({ name: String(s), label: speed_word(s) }))}
        on_pick={(v) => void app.ask("/speed", { speed: Number(v) })} />
    </div>
  );
}
