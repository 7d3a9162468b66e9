// web/src/views/cards.tsx: the cards on the scene: the sentence that explains, the banner for
// states that need a person, and the age of an old picture.
import { ComponentChildren, JSX } from "preact";
import { use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { Words } from "../link/frame";
import { age_words, news_age, scan_age } from "../state/age";
import { SceneState } from "../state/scene";
import { use_pulse, use_store } from "../state/store";
import { Tone, frame_word, link_words, stopped_words } from "../words";

/** The sentences of the controller: the robot's action and its reason, with the numbers. */
export function Explain(): JSX.Element | null {
  const app = use_app();
  use_pulse(150);
  const { session } = use_ui("session");
  const words = explain_words(app.scene, session);
  return <Sentence id="scene-words" name="explain" {...words} />;
}

export function Sentence(props: Words & { tone: string; name: string; id?: string }): JSX.Element {
  return (
    <div class={`card explain tone-${props.tone}`} id={props.id} data-testid={props.name}>
      <b>{props.what}</b>
      {props.why && <span>{props.why}</span>}
    </div>
  );
}

function explain_words(scene: SceneState, session: SessionState | null): Words & { tone: string } {
  const { frame: f, words } = scene;
  if (!session) {
    return { what: "Waiting for the server", why: "The world appears as soon as it answers.", tone: "muted" };
  }
  if (!f) {
    const { paused } = session.pace;
    return { what: paused ? "Paused at the start" : "Nothing has been sensed yet",
      why: paused ? "Press play to begin." : "", tone: "muted" };
  }
  // The server sends new sentences only. A page that opens late shows the state until then.
  const said = words ?? { what: frame_word(f).word, why: "" };
  if (!session.robot.drives) return { what: "Replaying the log", why: said.why, tone: "accent" };
  const tone = f.hold !== "none" || f.mission === "held" ? "bad"
    : f.mission === "stuck" ? "warn" : f.mission === "arrived" ? "ok" : "accent";
  return { ...said, tone };
}

/** A strip across the top of the scene, with buttons. */
function Strip(props: { tone: Tone; words: string; children?: ComponentChildren }): JSX.Element {
  return (
    <div class={`banner ${props.tone}`} role="alert" data-testid="banner">
      <span>{props.words}</span>{props.children}
    </div>
  );
}

/** The state that a person must not miss. */
export function Banner(): JSX.Element | null {
  const app = use_app();
  const { link, session } = use_ui("link", "session");
  use_pulse(250);
  if (link.phase === "lost") {
    const alone = session?.source === "hardware"
      ? "A robot that nobody watches stops by itself, unless its server was started with --unattended." : "";
    return (
      <Strip tone="bad" words={`${link_words(link, performance.now())} ${alone}`}>
        <button class="text" onClick={() => app.link.retry_now()}>Try now</button>
      </Strip>
    );
  }
  if (session?.stop) {
    return (
      <Strip tone="bad" words={stopped_words(app.scene, session, link.phase === "open", performance.now())}>
        <button class="text" onClick={() => void app.release()}>Release</button>
      </Strip>
    );
  }
  const record = session?.record;
  if (record && (record.status === "failed" || record.status === "full")) {
    return <Strip tone="bad" words={record.sentence} />;
  }
  const outcome = session?.run?.outcome;
  if (outcome === "collided" || outcome === "end_of_log" || outcome === "failed") {
    const words = { collided: "The robot touched an obstacle.",
      end_of_log: "The log has ended.",
      failed: session?.problem ?? "The run failed." }[outcome];
    return (
      <Strip tone={outcome === "end_of_log" ? "info" : "bad"} words={words}>
        <button class="text" onClick={() => void app.reset()}>Start again</button>
        {session?.run && <button class="text" onClick={() => app.go("runs", session.run!.id)}>Open the run</button>}
      </Strip>
    );
  }
  return null;
}

/** The growing age of an old picture, which is drawn grey, or of an old scan. */
export function Staleness(): JSX.Element | null {
  const app = use_app();
  const open = use_store(app.ui, (u) => u.link.phase === "open");
  const { session } = use_ui("session");
  use_pulse(100);
  const news = news_age(app.scene, session, open, performance.now());
  const scan = scan_age(app.scene);
  if (news === null && scan === null) return null;
  const words = news !== null
    ? <>Old picture: the robot was last heard <b class="num">{age_words(news)}</b> ago</>
    : <>The scan is <b class="num">{age_words(scan!)}</b> old</>;
  return (
    <div class={`stale ${news !== null ? "all" : ""}`} role="status" data-testid="stale"><span>{words}</span></div>
  );
}
