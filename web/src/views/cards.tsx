// web/src/views/cards.tsx: the cards on the scene: the sentence that explains, the banner for
// states that need a person, and the age of an old picture.
import { ComponentChildren, JSX } from "preact";
import { use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { Words } from "../link/frame";
import { may } from "../people";
import { age_words, ago_words, news_age, scan_age } from "../state/age";
import { SceneState } from "../state/scene";
import { use_pulse, use_store } from "../state/store";
import { use_me } from "../ui/guard";
import { StoppedBy } from "./watching";
import { Tone, kQuestions, frame_word, link_words, stopped_words } from "../words";

/** The sentences of the controller: the robot's action and its reason, with the numbers. */
export function Explain(): JSX.Element | null {
  const app = use_app();
  use_pulse(150);
  const { session } = use_ui("session");
  const words = explain_words(app.shown, session);
  const age = app.rewind.age;
  if (age !== null) return <Sentence id="scene-words" name="explain" {...words} tone="elastic" age={age} />;
  const trouble = trouble_word(app.scene, session);
  return (
    <Sentence id="scene-words" name="explain" {...words}>
      {trouble && <Why trouble={trouble} on_press={() => void app.show_trouble()} />}
    </Sentence>
  );
}

/** `next`: what a person may do now; `age` [s]: of an earlier instant. */
export function Sentence(props: Words & {
  tone: string; name: string; id?: string; next?: string; age?: number; children?: ComponentChildren;
}): JSX.Element {
  return (
    <section class={`card explain tone-${props.tone}`} id={props.id} aria-label="What the robot does and why" data-testid={props.name}>
      <b>{props.what}{props.age !== undefined && <em class="ago">{ago_words(props.age)}</em>}</b>
      {props.why && <span>{props.why}</span>}
      {props.next && <span class="next" data-testid="next"> {props.next}</span>}
      {props.children}
    </section>
  );
}

/** Opens the instant of a trouble, with the forces of that instant. */
export function Why(props: { trouble: string; on_press: () => void }): JSX.Element {
  return (
    <button class="text why" data-testid="why" title="Shows that instant with the forces on the robot"
      onClick={props.on_press}>{props.trouble}</button>
  );
}

/** The question to which the last trouble of the run is the answer; null while there is none. */
function trouble_word(scene: SceneState, session: SessionState | null): string | null {
  const f = scene.frame;
  if (!f || !session?.robot.drives) return null;
  const outcome = session.run?.outcome ?? "";
  const ended = outcome in kEnds ? kQuestions[outcome] : undefined;
  const question = ended ?? kQuestions[f.truth?.collided ? "collided" : f.mission];
  if (question) return question;
  return f.mission === "held" && f.hold !== "stopped" ? "Why is it held?" : null;
}

function explain_words(scene: SceneState, session: SessionState | null): Words & { tone: string; next?: string } {
  const { frame: f, words } = scene;
  if (!session) {
    return { what: "Waiting for the server", why: "The world appears as soon as it answers.", tone: "muted" };
  }
  const { paused } = session.pace;
  const before_start = paused && (!f || (f.hold !== "none" && f.hold !== "stopped" && scene.sweeps.length === 0));
  if (before_start) return { what: "Paused at the start", why: "Press play to begin.", tone: "info" };
  if (!f) return { what: "Nothing has been sensed yet", why: "", tone: "muted" };
  // The server sends new sentences only. A page that opens late shows the state until then.
  const said = words ?? { what: frame_word(f).word, why: "" };
  if (!session.robot.drives) return { what: "Replaying the log", why: said.why, tone: "accent" };
  const held = f.hold !== "none" || f.mission === "held";
  const tone = held ? (paused && !session.stop ? "info" : "bad")
    : f.mission === "stuck" ? "warn" : f.mission === "arrived" ? "ok" : "accent";
  const next = f.mission === "arrived" && f.hold === "none" ? "Set another goal, or Reset to drive it again." : undefined;
  return { ...said, tone, next };
}

/** A note beside the sentence, with buttons. */
function Strip(props: { tone: Tone; words: string; children?: ComponentChildren }): JSX.Element {
  return (
    <div class={`banner ${props.tone}`} role="alert" data-testid="banner">
      <span>{props.words}</span>{props.children}
    </div>
  );
}

const kEnds: Record<string, string> = {
  collided: "The robot touched an obstacle.", overturned: "The robot has turned over.", fallen: "The robot has driven off an edge.",
  end_of_log: "The log has ended.", failed: "The run failed.",
};

/** The state that a person must not miss. */
export function Banner(): JSX.Element | null {
  const app = use_app();
  const { link, session } = use_ui("link", "session");
  const may_drive = may(use_me(), "operator");
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
        <StoppedBy label={session.by?.stop ?? null} />
        {may_drive && <button class="text twice" onClick={() => void app.release()}>Release</button>}
      </Strip>
    );
  }
  const record = session?.record;
  if (record && (record.status === "failed" || record.status === "full")) {
    return <Strip tone="bad" words={record.sentence} />;
  }
  const outcome = session?.run?.outcome ?? "";
  if (outcome in kEnds) {
    const words = (outcome === "failed" && session?.problem) || kEnds[outcome];
    return (
      <Strip tone={outcome === "end_of_log" ? "info" : "bad"} words={words}>
        {may_drive && <button class="text" onClick={() => void app.editor.reset()}>Start again</button>}
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
  const { session, catalog } = use_ui("session", "catalog");
  use_pulse(100);
  const outside = open && catalog?.controllers.find((c) => c.name === session?.controller)?.outside;
  const news = news_age(app.scene, session, open, performance.now());
  const scan = scan_age(app.shown);
  if (news === null && scan === null) return null;
  const age = <b class="num">{age_words(news ?? scan!)}</b>;
  const words = news === null ? <>The scan is {age} old</>
    : outside ? <>Has waited {age} for {session?.controller}</>
    : <>Old picture: the robot was last heard {age} ago</>;
  return (
    <div class={`stale ${news !== null ? "all" : ""}`} role="status" data-testid="stale"><span>{words}</span></div>
  );
}
