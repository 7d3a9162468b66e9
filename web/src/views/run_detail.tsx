// web/src/views/run_detail.tsx: one stored run: scene, time, lanes, metrics, and a second run drawn
// over it.
import { JSX } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Metrics, RunItem } from "../contract";
import { Ghost } from "../draw/scene";
import { Insets, View } from "../draw/view";
import { Gestures } from "../edit/gestures";
import { Bounds, Pose, include } from "../geometry";
import { Player } from "../link/player";
import * as rest from "../link/rest";
import { StoredRun, stored_frames } from "../link/stored";
import { scene_bounds } from "../state/scene";
import { use_redraw } from "../state/store";
import { SceneCanvas, scale_insets } from "../ui/canvas";
import { Dialog, Pick } from "../ui/controls";
import { icons } from "../ui/icons";
import { Timeline } from "../ui/timeline";
import { clock, driver_word, fixed, frame_word, run_word, sentence_of, speed_word, titled } from "../words";
import { Sentence } from "./cards";
import { Lanes } from "./lanes";
import { LayerButton, LayerPanel, panel_cover, use_filtered } from "./layers";
import { use_keys } from "./keys";

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
  id: number; compare: number | null; on_gone: () => void; on_uncompare: () => void;
}): JSX.Element {
  const app = use_app();
  const redraw_controls = use_redraw();
  const first = use_stored(props.id, redraw_controls);
  const second = use_stored(props.compare, redraw_controls);
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
  return <Opened run={first.run} other={second.run} on_gone={props.on_gone}
    on_uncompare={props.on_uncompare} />;
}

function Opened(props: {
  run: StoredRun; other: StoredRun | null; on_gone: () => void; on_uncompare: () => void;
}): JSX.Element {
  const { run, other } = props;
  const { hidden, force_scale } = use_ui("hidden", "force_scale");
  const [layers, set_layers] = useState(false);
  const redraw_controls = use_redraw();
  const redraw = useRef<() => void>(() => undefined);
  const frame = useRef<HTMLElement>(null);
  const view = useMemo(() => new View(), [run]);
  const player = useMemo(() => new Player(run, () => {
    redraw_controls();
    redraw.current();
  }), [run]);
  const gestures = useMemo(() => looking(view, run, () => redraw.current()), [view, run]);

  // The first frame is shown as soon as it is there.
  if (run.rows > 0 && run.scene.frame === null) player.seek(0);
  if (other && other.rows > 0) {
    const row = other.columns.row_at(player.time);
    if (other.scene.rows !== row + 1) other.seek(row);
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
      view.fitted = true;
      redraw.current();
    },
  });

  const ghost = (): Ghost | null => other && {
    columns: other.columns, rows: other.columns.row_at(player.time) + 1,
    pose: other.rows > 0 ? pose_at(other, player.time) : null, radius: other.scene.radius,
    hull: other.scene.hull,
  };
  const bounds = (): Bounds => {
    const b = scene_bounds(run.scene);
    for (const r of other ? [run, other] : [run]) widen(b, r);
    return b;
  };
  return (
    <>
      <Facts run={run} other={other} on_gone={props.on_gone} on_uncompare={props.on_uncompare} />
      <section class="view" ref={frame} aria-busy={!run.done && !run.error} aria-label={`Run ${run.item.id}`} data-testid="run-view">
        <SceneCanvas scene={run.scene} view={view} gestures={gestures} cursor="pan"
          label={`Run ${run.item.id} from above`} bounds={bounds}
          insets={() => free_insets(frame.current!)}
          on_ready={(request) => (redraw.current = request)}
          overlay={() => ({
            selection: null, hovered: null, draft: {}, force_scale,
            hidden, ghost: ghost(), future: true, insets: scale_insets(frame.current!),
            path: other ? "accent" : undefined,
          })} />
        <LayerButton class="icon layers-tool" open={layers} on_press={set_layers} />
        <Instant run={run} />
      </section>
      {layers && <LayerPanel scene={run.scene} on_close={() => set_layers(false)} />}
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
          <Timeline time={player.time} end={run.duration} loaded={run.progress} events={run.events.list}
            on_seek={(t) => player.seek(t)} />
          <Pick label="Speed" name="run-speed" value={String(player.speed)}
            choices={[0.25, 0.5, 1, 2, 4, 8, 16].map((s) => ({ name: String(s), label: speed_word(s) }))}
            on_pick={(v) => {
              player.speed = Number(v);
              redraw_controls();
            }} />
        </div>
        {run.error && <p class="problem" role="alert">The rest of this run could not be fetched: {run.error}</p>}
        <Lanes run={run} other={other} time={player.time} on_pick={(t) => player.seek(t)} />
      </section>
    </>
  );
}

/** What the robot did and why at the shown instant. */
function Instant(props: { run: StoredRun }): JSX.Element | null {
  const f = props.run.scene.frame;
  if (!f) return null;
  const said = props.run.scene.words ?? { what: frame_word(f).word, why: "" };
  return <Sentence name="run-explain" what={props.run.scene.world ? said.what : "Replaying the log"} why={said.why}
    tone={f.hold !== "none" ? "bad" : "accent"} />;
}

/** The margins that the sentence, the button at the upper right and the layer panel cover. */
function free_insets(view: HTMLElement): Insets {
  const card = view.querySelector(".explain")?.getBoundingClientRect().height ?? 0;
  const button = view.querySelector(".layers-tool")?.getBoundingClientRect().height ?? 0;
  const high = view.clientHeight > view.clientWidth; // the button takes room above
  return {
    left: 20, top: 20 + (high ? button : 0), right: 20 + (panel_cover(view) || (high ? 0 : button)), bottom: card + 24,
  };
}

const kRows: { label: string; unit: string; digits: number; of: (m: Metrics) => number | null }[] = [
  { label: "Clearance", unit: "m", digits: 2, of: (m) => m.min_clearance },
  { label: "Intrusion", unit: "m", digits: 2, of: (m) => m.intrusion },
  { label: "Path", unit: "m", digits: 2, of: (m) => m.path_length },
  { label: "Turning", unit: "rad", digits: 2, of: (m) => m.turning },
  { label: "Via points", unit: "", digits: 0, of: (m) => m.via_points },
  { label: "Time", unit: "s", digits: 1, of: (m) => m.time },
];

function Facts(props: {
  run: StoredRun; other: StoredRun | null; on_gone: () => void; on_uncompare: () => void;
}): JSX.Element {
  const app = use_app();
  const [asking, set_asking] = useState(false);
  const { item } = props.run;
  const word = run_word(item.status, item.outcome);
  const runs = props.other ? [item, props.other.item] : [item];
  const has_metrics = runs.some((r) => r.metrics);
  const finished = !["recording", "queued"].includes(item.status);
  const erase = async () => {
    if (await app.attempt(rest.remove(`/runs/${item.id}`))) {
      app.toast("info", `Run ${item.id} was deleted.`);
      app.go("runs");
      props.on_gone();
    }
    set_asking(false);
  };
  return (
    <section class="facts" aria-label="Result of the run" data-testid="facts">
      <a class="icon narrow" href="#/runs" aria-label="Back to the list">{icons.back}</a>
      <b>Run {item.id}</b>
      <span class={`tag tone-${word.tone}`}><i />{word.word}</span>
      <span class="quiet">{titled(item.scenario)} · {driver_word(item)} · {item.filter} · seed {item.seed}</span>
      <span class="facts-acts">
        {props.other && <button class="ghost" onClick={props.on_uncompare}>One run</button>}
        <a class="ghost" href={`/api/v1/runs/${item.id}/csv`} download={`run-${item.id}.csv`}
          data-testid="csv">{icons.download}CSV</a>
        {finished && <button class="icon" aria-label={`Delete run ${item.id}`} title="Delete"
          onClick={() => set_asking(true)} data-testid="delete-run">{icons.trash}</button>}
      </span>
      {item.reason && <p class="reason">{item.reason}</p>}
      {has_metrics && <table class="measures">
        <thead><tr>
          {props.other && <td />}
          {kRows.map((row) => <th key={row.label} scope="col">{row.label}{row.unit && <u> {row.unit}</u>}</th>)}
        </tr></thead>
        <tbody>
          {runs.map((r, i) => (
            <tr key={r.id}>
              {props.other &&
                <th scope="row" class={i === 0 ? "tone-accent" : "tone-elastic"}>{r.id} {driver_word(r)}</th>}
              {kRows.map((row) => (
                <td key={row.label} class="num">{r.metrics ? fixed(row.of(r.metrics), row.digits) : "–"}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>}
      {asking && <Dialog title={`Delete run ${item.id}?`} name="delete-dialog" on_close={() => set_asking(false)}>
        <p>This deletes its record for good. Other runs stay.</p>
        <div class="facts-acts">
          <button class="small bad" data-testid="delete-yes" onClick={() => void erase()}>Delete it</button>
          <button class="ghost" onClick={() => set_asking(false)}>Keep it</button>
        </div>
      </Dialog>}
    </section>
  );
}

/** Gestures that move the view only: nothing changes a stored run. */
function looking(view: View, run: StoredRun, redraw: () => void): Gestures {
  const nothing = () => undefined;
  return new Gestures({
    scene: run.scene, view, tool: () => "pan", can_edit: () => false, set_goal: nothing, add_goal: nothing,
    add: nothing, move: nothing, select: nothing, draft: nothing, hover: nothing, changed: redraw,
  });
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
