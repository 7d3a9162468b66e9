// web/src/views/cards.tsx: what lies on the scene: the sentence that explains, and the banner for
// states that need a person.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { Words } from "../link/frame";
import { age_words, news_age, scan_age } from "../state/age";
import { SceneState } from "../state/scene";
import { use_pulse, use_store } from "../state/store";
import { frame_word, link_words, stopped_words } from "../words";

/** What the robot is doing, and why, with the numbers. */
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
  // The server says its words when they are new; who came late has the state until then.
  const said = words ?? { what: frame_word(f).word, why: "" };
  if (!session.robot.drives) return { what: "Replaying the log", why: said.why, tone: "accent" };
  const tone = f.hold !== "none" || f.mission === "held" ? "bad"
    : f.mission === "stuck" ? "warn" : f.mission === "arrived" ? "ok" : "accent";
  return { ...said, tone };
}

/** A strip across the top of the scene for what must not be missed. */
export function Banner(): JSX.Element | null {
  const app = use_app();
  const { link, session } = use_ui("link", "session");
  use_pulse(250);
  if (link.phase === "lost") {
    return (
      <div class="banner bad" role="alert" data-testid="banner">
        <span>{link_words(link, performance.now())} {session?.source === "hardware" &&
          "A robot that nobody watches stops by itself, unless its server was started with --unattended."}</span>
        <button class="text" onClick={() => app.link.retry_now()}>Try now</button>
      </div>
    );
  }
  if (session?.stop) {
    return (
      <div class="banner bad" role="alert" data-testid="banner">
        <span>{stopped_words(app.scene, session, link.phase === "open", performance.now())}</span>
        <button class="text" onClick={() => void app.release()}>Release</button>
      </div>
    );
  }
  const record = session?.record;
  if (record && (record.status === "failed" || record.status === "full")) {
    return <div class="banner bad" role="alert" data-testid="banner"><span>{record.sentence}</span></div>;
  }
  const outcome = session?.run?.outcome;
  if (outcome === "collided" || outcome === "end_of_log" || outcome === "failed") {
    const words = { collided: "The robot touched an obstacle.",
      end_of_log: "The log has come to its end.",
      failed: session?.problem ?? "This run broke off." }[outcome];
    return (
      <div class={`banner ${outcome === "end_of_log" ? "info" : "bad"}`} role="alert" data-testid="banner">
        <span>{words}</span>
        <button class="text" onClick={() => void app.reset()}>Start again</button>
        {session?.run && <button class="text" onClick={() => app.go("runs", session.run!.id)}>Open the run</button>}
      </div>
    );
  }
  return null;
}

/** How old what is drawn is, growing, while it is too old to go by. The scene is grey meanwhile. */
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
