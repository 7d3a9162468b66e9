// web/src/views/cards.tsx: what lies on the scene: the sentence that explains, the legend, and the
// banner for states that need a person.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { explain } from "../explain";
import { Frame } from "../link/frame";
import { age_words, news_age, scan_age } from "../state/age";
import { use_pulse, use_store } from "../state/store";
import { link_words, stopped_words } from "../words";

/** What the robot is doing, and why, with the numbers. */
export function Explain(): JSX.Element | null {
  const app = use_app();
  use_pulse(150);
  const session = use_store(app.ui, (u) => u.session);
  const words = explain_words(app.scene.frame, session?.robot.drives ?? true,
    session?.pace.paused ?? false, session !== null);
  return (
    <div class={`card explain tone-${words.tone}`} id="scene-words" data-testid="explain">
      <b>{words.what}</b>
      {words.why && <span>{words.why}</span>}
    </div>
  );
}

function explain_words(f: Frame | null, drives: boolean, paused: boolean, known: boolean):
  { what: string; why: string; tone: string } {
  if (!known) {
    return { what: "Waiting for the server", why: "The world appears as soon as it answers.", tone: "muted" };
  }
  if (!f) {
    return { what: paused ? "Paused at the start" : "Nothing has been sensed yet",
      why: paused ? "Press play to begin." : "", tone: "muted" };
  }
  const said = explain(f);
  if (!drives) return { what: "Replaying the log", why: said.why, tone: "accent" };
  const tone = f.hold !== "none" || f.mission === "held" ? "bad"
    : f.mission === "stuck" ? "warn" : f.mission === "arrived" ? "ok" : "accent";
  return { ...said, tone };
}

/** A strip across the top of the scene for what must not be missed. */
export function Banner(): JSX.Element | null {
  const app = use_app();
  const link = use_store(app.ui, (u) => u.link);
  const session = use_store(app.ui, (u) => u.session);
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
  const session = use_store(app.ui, (u) => u.session);
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

interface Key { colour: string; label: string; shape: string }
const kKey: Key[] = [
  { colour: "scan", label: "Raw scan", shape: "dots" },
  { colour: "filtered", label: "Filtered scan", shape: "dots" },
  { colour: "internal", label: "Internal force", shape: "arrow" },
  { colour: "external", label: "External force", shape: "arrow" },
  { colour: "elastic", label: "Elastic force", shape: "arrow" },
  { colour: "accent", label: "Strip", shape: "line" },
  { colour: "path", label: "Travelled path", shape: "line" },
  { colour: "safe", label: "Safety circle", shape: "dashed" },
];

/** What a log can show: it has a scan and a path, but no strip of its own. */
const kSeen = ["Raw scan", "Filtered scan", "Travelled path"];

/** What the strips of many nodes show besides. */
const kPlan: Key = { colour: "accent", label: "Plan", shape: "dashed" };
const kBesides: Record<string, Key[]> = {
  strip: [kPlan],
  strip_moving: [kPlan, { colour: "warn", label: "Seen moving, its next second", shape: "arrow" }],
};

/** What a controller without a strip shows instead of it and its forces. */
const kCells: Key = { colour: "external", label: "Occupied cells", shape: "line" };
const kInstead: Record<string, Key[]> = {
  go_to_goal: [],
  edge_detection: [],
  potential_field: [],
  certainty_grid: [kCells, kPlan],
  vff: [kCells],
  vfh: [{ ...kCells, label: "Occupied cells, blocked sectors" }],
  dwa: [
    { colour: "accent", label: "Motion chosen", shape: "line" },
    { colour: "scan", label: "Motions weighed", shape: "line" },
  ],
};

function keys_of(controller: string | undefined, drives: boolean): Key[] {
  const seen = kKey.filter((k) => kSeen.includes(k.label));
  if (!drives) return seen;
  const instead = kInstead[controller ?? ""];
  return instead ? [...seen, kKey.at(-1)!, ...instead] : [...kKey, ...(kBesides[controller ?? ""] ?? [])];
}

/** What the colours mean, and how much the forces are enlarged. */
export function Legend(): JSX.Element {
  const app = use_app();
  const [open, set_open] = useState<boolean | null>(null);
  const times = use_store(app.ui, (u) => u.force_scale);
  const next = { 1: 2, 2: 5, 5: 1 }[times] ?? 1;
  const drives = use_store(app.ui, (u) => u.session?.robot.drives ?? true);
  const controller = use_store(app.ui, (u) => u.session?.controller);
  const shown = keys_of(controller, drives);
  const forces = shown.some((k) => k.shape === "arrow");
  return (
    <div class={`card legend ${open === null ? "auto" : open ? "open" : "closed"}`}>
      <button class="text legend-button" aria-expanded={open ?? undefined}
        onClick={(e) => {
          const list = e.currentTarget.parentElement!.querySelector("ul")!;
          set_open(getComputedStyle(list).display === "none");
        }}>Legend</button>
      <ul>
        {shown.map((k) => (
          <li key={k.label}><i class={`swatch c-${k.colour} ${k.shape}`} />{k.label}</li>
        ))}
      </ul>
      {forces && <button class="text scale-button" data-testid="force-scale"
        title="A force is a displacement in metres; this enlarges its arrow"
        onClick={() => app.ui.set({ force_scale: next })}>Forces drawn ×{times}</button>}
    </div>
  );
}
