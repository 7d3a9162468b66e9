// web/src/views/transport.tsx: reset, play and pause, step, time and speed of the live run; and its
// earlier instants, by a drag along the time.
import { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { age_words, ago_words } from "../state/age";
import { use_pulse } from "../state/store";
import { Pick } from "../ui/controls";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { Timeline } from "../ui/timeline";
import { clock, speed_word } from "../words";

const kSpeeds = [0.25, 0.5, 1, 2, 4, 8, 0];
const kLeastSpan = 20; // [s] of the timeline of a young run

/** Where the newest frames come from, with a note on the run's record; no note while all is well. */
function live_words({ source, record }: SessionState): string {
  const words: Record<string, string> = { paused: ", record rests", full: ", record full",
    failed: ", not recorded", off: ", not recorded" };
  return (source === "replay" ? "from the log" : "live") + (words[record.status] ?? "");
}

export function Transport(): JSX.Element {
  const app = use_app();
  const { session, looking } = use_ui("session", "looking");
  use_pulse(100);
  use_playback();
  const { rewind } = app;
  const newest = app.scene.frame?.stamp ?? 0;
  const time = rewind.time ?? newest;
  const age = rewind.age;
  const paused = looking ? !rewind.playing : session?.pace.paused ?? false;
  const paceable = session?.robot.paceable ?? false;
  const record = session?.record;
  const off = !session || (!paceable && !looking);
  const why_off = session && off ? "A real robot keeps its own time" : undefined;
  const play = looking ? (paused ? "Play on from here" : "Pause here") : paused ? "Play" : "Pause";
  return (
    <section class={`transport ${looking ? "looking" : ""}`} aria-label="Run">
      <Guard need="operator">
      <button class="btn" aria-label="Reset: the robot back to its start"
        title="Reset: the robot back to its start, in the world as it stands" data-testid="reset" disabled={!session}
        onClick={() => void app.editor.reset()}>{icons.reset}</button>
      <button class="btn primary" aria-label={play} data-testid="play" title={why_off ?? `${play} (P)`} disabled={off}
        onClick={() => void app.toggle_play()}>{paused ? icons.play : icons.pause}</button>
      </Guard>
      <button class="btn step-back" aria-label="One tick back" title="One tick back (,)" data-testid="step-back"
        disabled={record?.status === "off" || !app.scene.frame} onClick={() => rewind.step(-1)}>{icons.back_step}</button>
      <Guard need="operator"><button class="btn step" aria-label="Step: one tick" data-testid="step" disabled={off}
        title={why_off ?? "One tick (.)"} onClick={() => void app.step()}>{icons.step}</button></Guard>
      <Timeline name="live-timeline" label="Time of the live run" time={time} end={Math.max(newest, kLeastSpan)}
        words={age === null ? `${clock(time)}, live` : `${clock(time)}, ${age_words(age)} before live`}
        past={looking} barred={rewind.barred} events={app.scene.events.list}
        disabled={!app.scene.frame || record?.status === "off"} title={record?.status === "off" ? record.sentence : undefined}
        on_seek={(t) => rewind.seek(t)} />
      <span class="time-cell">
        <span class="num time" data-testid="time">{clock(time)}</span>
        {age !== null
          ? <em class="ago" data-testid="ago">{ago_words(age)}</em>
          : session && <span class={`live-words wide ${["full", "failed"].includes(session.record.status) ? "tone-bad" : ""}`}
            title={record?.sentence} data-testid="record-word">{live_words(session)}</span>}
      </span>
      <span class="time-end">
        {looking
          ? <button class="live-button" title="Live again (L, End)" data-testid="live" onClick={(e) => {
            const slider = e.currentTarget.closest(".transport")?.querySelector("input");
            if (e.detail === 0) slider?.focus(); // pressed by a key: the button goes
            app.go_live();
          }}><i />Live</button>
          : <Guard need="operator"><Speed speed={session?.pace.speed ?? 1} off={off} /></Guard>}
      </span>
    </section>
  );
}

function Speed(props: { speed: number; off: boolean }): JSX.Element {
  const app = use_app();
  const { speed } = props;
  const speeds = kSpeeds.includes(speed) ? kSpeeds : [speed, ...kSpeeds];
  return (
    <Pick label="Speed" name="speed" value={String(speed)} disabled={props.off}
      choices={speeds.map((s) => ({ name: String(s), label: speed_word(s) }))}
      on_pick={(v) => void app.ask("/speed", { speed: Number(v) })} />
  );
}

/** Plays the record on from the earlier instant, as fast as it was. */
function use_playback(): void {
  const app = use_app();
  const { looking } = use_ui("looking");
  useEffect(() => {
    if (!looking) return;
    let last = performance.now();
    let pending = requestAnimationFrame(function tick(now) {
      app.rewind.advance(Math.min(0.25, (now - last) / 1000));
      last = now;
      pending = requestAnimationFrame(tick);
    });
    return () => cancelAnimationFrame(pending);
  }, [looking]);
}
