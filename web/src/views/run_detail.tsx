// web/src/views/run_detail.tsx: one stored run: scene, time, lanes, and up to three further runs drawn
// over it.
import { JSX } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { RunItem } from "../contract";
import { Ghost, Overlay } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Gestures, only_looking } from "../edit/gestures";
import { Bounds, Point, Pose, include } from "../geometry";
import { Player } from "../link/player";
import * as rest from "../link/rest";
import { barred_by } from "../link/rewind";
import { StoredRun, stored_frames } from "../link/stored";
import { scene_bounds } from "../state/scene";
import { use_redraw } from "../state/store";
import { SceneCanvas, panel_cover, scale_insets } from "../ui/canvas";
import { Pick } from "../ui/controls";
import { icons } from "../ui/icons";
import { lazy } from "../ui/lazy";
import { Timeline } from "../ui/timeline";
import { clock, frame_word, kQuestions, sentence_of, speed_word } from "../words";
import { Sentence, Why } from "./cards";
import { Lanes } from "./lanes";
import { RunFacts, kLooks } from "./run_facts";
import { LayerButton, LayerPanel, use_filtered } from "./layers";
import { crosshair_step, use_keys } from "./keys";
import { use_place } from "./place";

const ReplayDeck = lazy(async () => (await import("../teleop/teleop")).ReplayDeck);

/** Fetches the row of a run and then its frames; calls `changed` for every page of them. */
function use_stored(id: number | null, changed: () => void): { run: StoredRun | null; problem: string | null } {
  const [run, set_run] = useState<StoredRun | null>(null);
  const [problem, set_problem] = useState<string | null>(null);
  useEffect(() => {
    set_run(null);
    set_problem(null);
    if (id === null) return;
    const stop = new AbortController();
    const begin = async () => {
      const item = await rest.get<RunItem>(`/runs/${id}`, stop.signal);
      const stored = new StoredRun(item, stored_frames(id, "frames"), stored_frames(id, "filtered"));
      set_run(stored);
      await stored.load(changed, stop.signal);
    };
    begin().catch((error) => {
      if (!stop.signal.aborted) set_problem(sentence_of(error));
    });
    return () => stop.abort();
  }, [id]);
  return { run, problem };
}

export function RunDetail(props: {
  id: number; compare: readonly number[]; on_changed: () => void; on_compare: (ids: number[]) => void;
}): JSX.Element {
  const app = use_app();
  const redraw_controls = use_redraw();
  const first = use_stored(props.id, redraw_controls);
  const others = [0, 1, 2].map((i) => use_stored(props.compare[i] ?? null, redraw_controls));
  useEffect(() => {
    const failed = others.findIndex((other) => other.problem);
    if (failed < 0) return;
    app.toast("warn", others[failed].problem!);
    props.on_compare(props.compare.filter((_, i) => i !== failed));
  });
  if (!first.run) {
    return (
      <section class="view none">
        <p class="empty" role={first.problem ? "alert" : "status"}>
          {first.problem ?? `Fetching run ${props.id}`}
        </p>
        {first.problem && <button class="ghost" onClick={() => app.go("runs")}>Back to the list</button>}
      </section>
    );
  }
  return <Opened {...props} run={first.run} others={others.flatMap(({ run }) => run ?? [])} />;
}

function Opened(props: {
  run: StoredRun; others: StoredRun[]; compare: readonly number[]; on_changed: () => void; on_compare: (ids: number[]) => void;
}): JSX.Element {
  const app = use_app();
  const { run, others } = props;
  const { hidden, force_scale } = use_ui("hidden", "force_scale");
  const [layers, set_layers] = useState(false);
  const redraw_controls = use_redraw();
  const redraw = useRef<() => void>(() => undefined);
  const frame = useRef<HTMLElement>(null);
  const view = useMemo(() => new View(), [run]);
  const crosshair = useRef<Point | null>(null);
  const player = useMemo(() => new Player(run, () => {
    redraw_controls();
    redraw.current();
  }), [run]);
  const gestures = useMemo(() => new Gestures(only_looking(run.scene, view, () => redraw.current())), [view, run]);

  // Shown as soon as it is there: the first scan, then the time that the address names.
  if (run.rows > 0 && run.scene.frame === null) player.seek(run.opening);
  use_place(run, player, view);
  for (const other of others) {
    const row = other.rows > 0 ? other.columns.row_at(player.time) : -1;
    if (row >= 0 && other.scene.rows !== row + 1) other.seek(row);
  }
  use_filtered((wanted) => {
    run.want_filtered(wanted);
    player.show_again();
  });
  useEffect(() => redraw.current());

  useEffect(() => {
    let frame = 0;
    let last = performance.now();
    let shown = 0;
    const tick = (now: number) => {
      const moved = player.advance(Math.min(0.25, (now - last) / 1000));
      last = now;
      if (moved) {
        redraw.current();
        if (now - shown > 66) { // figures and lanes need no more than 15 a second
          shown = now;
          redraw_controls();
        }
      }
      frame = requestAnimationFrame(tick);
    };
    frame = requestAnimationFrame(tick);
    return () => cancelAnimationFrame(frame);
  }, [player]);

  use_keys({
    p: () => player.toggle(), ".": () => player.step(1), ",": () => player.step(-1),
    f: () => {
      view.fit();
      redraw.current();
    },
  });

  const ghosts = (): Ghost[] => others.map((other, i) => ({
    columns: other.columns, rows: other.columns.row_at(player.time) + 1,
    pose: other.rows > 0 ? pose_at(other, player.time) : null, radius: other.scene.radius,
    hull: other.scene.hull, look: kLooks[i + 1],
  }));
  const overlay = (): Overlay => ({
    selection: null, hovered: null, draft: crosshair.current ? { cursor: crosshair.current } : {}, force_scale,
    hidden, ghosts: ghosts(), future: true, insets: scale_insets(frame.current!),
    path: others.length > 0 ? "accent" : undefined,
  });
  const bounds = (): Bounds => {
    const b = scene_bounds(run.scene);
    for (const r of [run, ...others]) widen(b, r);
    return b;
  };
  return (
    <>
      <RunFacts run={run.item} others={others.map((other) => other.item)} on_changed={props.on_changed}
        on_compare={props.on_compare} />
      <section class="view" ref={frame} aria-busy={!run.done && !run.error} aria-label={`Run ${run.item.id}`} data-testid="run-view">
        <SceneCanvas scene={() => run.scene} view={view} gestures={gestures} cursor="pan"
          label={`Run ${run.item.id} from above. Arrow keys move the crosshair, which tells what is there.`} bounds={bounds}
          on_key={(e) => {
            const at = crosshair_step(app, crosshair.current ?? view, e);
            if (!at && e.key !== "Escape") return;
            crosshair.current = at;
            e.preventDefault();
            redraw.current();
          }}
          insets={() => free_insets(frame.current!)} lost={() => !view.shows(bounds(), covered(frame.current!))}
          on_ready={(request) => (redraw.current = request)}
          overlay={overlay} />
        <LayerButton class="icon layers-tool" open={layers} on_press={set_layers} />
        <Instant run={run} on_seek={(t) => player.seek(t)} />
      </section>
      {layers && <LayerPanel scene={run.scene} compared={others.length > 0} on_close={() => set_layers(false)} />}
      <section class="lanes" aria-label="Time and signals">
        <div class="controls">
          <button class="btn" aria-label="One tick back" title="One tick back (,)"
            onClick={() => player.step(-1)}>{icons.back_step}</button>
          <button class="btn primary" aria-label={player.playing ? "Pause" : "Play"} data-testid="run-play"
            title={player.playing ? "Pause (P)" : "Play (P)"} onClick={() => player.toggle()}>
            {player.playing ? icons.pause : icons.play}
          </button>
          <button class="btn" aria-label="One tick on" title="One tick on (.)" data-testid="run-step"
            onClick={() => player.step(1)}>{icons.step}</button>
          <span class="num time" data-testid="run-time">{clock(player.time)}<span class="of"> / {clock(run.duration)}</span></span>
          <Timeline name="timeline" label="Time in the run" words={clock(player.time)} time={player.time}
            end={run.duration} loaded={run.progress} barred={barred_by(run.item.gaps ?? [], run.columns)}
            events={run.events.list} on_seek={(t) => player.seek(t)} />
          <Pick label="Speed" name="run-speed" value={String(player.speed)}
            choices={[0.25, 0.5, 1, 2, 4, 8, 16].map((s) => ({ name: String(s), label: speed_word(s) }))}
            on_pick={(v) => {
              player.speed = Number(v);
              redraw_controls();
            }} />
        </div>
        {run.driven && <ReplayDeck scene={run.scene} />}
        {run.error && <p class="problem" role="alert">The rest of this run could not be fetched: {run.error}</p>}
        <Lanes runs={[run, ...others]} time={player.time} playing={player.playing}
          on_pick={(t) => player.seek(t)} scene={() => ({ scene: run.scene, view, overlay: overlay() })} />
      </section>
    </>
  );
}

/** What the robot did and why at the shown instant. A run that went wrong offers the instant of that. */
function Instant(props: { run: StoredRun; on_seek: (t: number) => void }): JSX.Element | null {
  const app = use_app();
  useEffect(() => () => app.conceal_forces(), []);
  const { item, events, scene } = props.run;
  const f = scene.frame;
  if (!f) return null;
  const said = scene.words ?? { what: frame_word(f).word, why: "" };
  const trouble = kQuestions[item.outcome];
  const at = events.last_trouble?.t;
  return (
    <Sentence name="run-explain" what={scene.world ? said.what : "Replaying the log"} why={said.why}
      tone={f.hold !== "none" ? "bad" : "accent"}>
      {trouble && at !== undefined && at !== f.stamp && <Why trouble={trouble} on_press={() => {
        props.on_seek(at);
        app.reveal_forces(scene);
      }} />}
    </Sentence>
  );
}

const kMargin = 14; // [px] of the fitted world to the border and to cards

/** The margins that the sentence, the button at the upper right and the layer panel cover. */
function covered(view: HTMLElement): Insets {
  const card = view.querySelector(".explain")?.getBoundingClientRect();
  const button = view.querySelector(".layers-tool")?.getBoundingClientRect().height ?? 0;
  const high = view.clientHeight > view.clientWidth; // the button takes room above
  return { left: 0, top: high ? button : 0, right: panel_cover(view) || (high ? 0 : button),
    bottom: card ? view.getBoundingClientRect().bottom - card.top : 0 };
}

function free_insets(view: HTMLElement): Insets {
  const { left, top, right, bottom } = covered(view);
  return { left: left + kMargin, top: top + kMargin, right: right + kMargin, bottom: bottom + kMargin };
}

function pose_at(run: StoredRun, t: number): Pose {
  const row = run.columns.row_at(t);
  const at = (c: "x" | "y" | "heading") => run.columns.at(c, row);
  return { x: at("x"), y: at("y"), heading: at("heading") };
}

/** Includes the whole path, so that the view does not jump while the run plays. */
function widen(b: Bounds, run: StoredRun): void {
  const xs = run.columns.get("x");
  const ys = run.columns.get("y");
  const step = Math.max(1, Math.floor(run.rows / 500));
  for (let i = 0; i < run.rows; i += step) include(b, xs[i], ys[i], run.scene.radius + 0.1);
}
