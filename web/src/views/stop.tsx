// web/src/views/stop.tsx: Stop and Release, and the alarm of a Stop that failed.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { age_words } from "../state/age";
import { use_pulse, use_store } from "../state/store";
import { may } from "../people";
import { use_me } from "../ui/guard";

export function StopButtons(): JSX.Element {
  const app = use_app();
  const stopped = use_store(app.ui, (u) => u.session?.stop ?? false);
  const may_release = may(use_me(), "operator");
  const phase = use_store(app.ui, (u) => u.stop.phase);
  const word = phase === "failed" ? "Stop again" : stopped ? "Stopped" : phase === "sent" ? "Stopping" : "Stop";
  return (
    <>
      {stopped && may_release &&
        <button class="release" data-testid="release" onClick={() => void app.release()}>Release</button>}
      <button class={`stop ${stopped ? "latched" : ""}`} data-testid="stop" aria-pressed={stopped}
        title="Brings the robot to rest and keeps it there (Space). It does not replace an emergency stop."
        onClick={() => app.stop()}>{word}</button>
    </>
  );
}

/** Covers everything but the Stop button, large enough to read from across the room. */
export function StopAlarm(): JSX.Element | null {
  const app = use_app();
  const { stop } = use_ui("stop");
  use_pulse(stop.phase === "failed" ? 100 : 5000);
  if (stop.phase !== "failed") return null;
  const since = (performance.now() - stop.since) / 1000;
  return (
    <div class="stop-alarm" role="alertdialog" aria-label="Stop did not reach the robot" data-testid="stop-alarm">
      <b>Stop did NOT reach the robot</b>
      <p>Nothing has answered for <span class="num">{age_words(since)}</span>. The robot may still be moving.
        Use the stop button on the robot itself.</p>
      <p>The page sends Stop again and again until the server answers.</p>
      <button class="ghost" data-testid="stop-alarm-hide"
        onClick={() => app.give_up_stop()}>Stop sending it</button>
    </div>
  );
}
