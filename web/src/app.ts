// web/src/app.ts: the state of the page and its actions: one link, one scene, the controls.
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import { Accepted, Catalog, Page, RequestJson, RobotItem, ScenarioItem, SessionState } from "./contract";
import { Selection } from "./draw/scene";
import { View } from "./draw/view";
import { Pose } from "./geometry";
import { Edit, EditHistory } from "./edit/history";
import { Tool } from "./edit/gestures";
import {
  add_edit, add_goal_edit, goal_json, goal_request, move_edit, move_request, set_goal_edit,
} from "./edit/edits";
import { Goal } from "./link/frame";
import { LinkStatus, LiveLink } from "./link/live";
import * as rest from "./link/rest";
import { Past } from "./link/past";
import { Obstacle } from "./obstacle";
import { open_session, session_id, session_path, socket_url } from "./link/session";
import { SceneState, begin_run, fold_frame, fold_session, new_scene } from "./state/scene";
import { stored_hidden, store_open, stored_open, toggled } from "./state/layers";
import { browser, give_signs_of_life, stop_in_reach } from "./sign_of_life";
import { Store, keep, kept, use_store } from "./state/store";
import { StopState, Stopper, sound_alarm } from "./stopper";
import { sentence_of, titled } from "./words";

export type ViewName = "drive" | "runs" | "system";
type Theme = "dark" | "light";
export interface Toast { id: number; tone: "info" | "warn" | "bad"; text: string }

/** A goal for real hardware that is not sent yet; drawn dashed. */
export interface Preview {
  goal: Goal;
  further: boolean;        // appended to the goals that the robot has
  trouble: string | null;  // why the robot may not reach it
}

export interface UiState {
  link: LinkStatus;
  locked: boolean;     // the server asks for its token
  gone: string | null; // why there is no session to show
  session: SessionState | null;
  catalog: Catalog | null;
  scenarios: ScenarioItem[];
  robots: RobotItem[];
  toasts: Toast[];
  spoken: string;     // the sentence that a screen reader reads next
  view: ViewName;
  run: number | null; // opened in the Runs view
  theme: Theme;
  tool: Tool;
  selection: Selection;
  three: boolean;
  follow: boolean;
  force_scale: number;
  hidden: ReadonlySet<string>; // names of the layers that are switched off
  layers: boolean;             // the layer panel is open
  shortcuts: boolean;
  sheet: boolean;
  loading: string | null;
  stop: StopState;
  preview: Preview | null;
  goal_learnt: boolean; // a goal was set by hand, so the hint is not needed any more
  undo: string | null;
  redo: string | null;
}

const kPathRows = 40_000;
const kToastTime = { info: 4000, warn: 7000, bad: 9000 };
const kFrameWait = 600;   // [ms] within which a run that is not paused sends a frame
const kHeardLimit = 1000; // [ms] of silence after which the page no longer shows the robot as it is
const kMoveMs = 90;       // [ms] between two requests of one drag
const kTheme = "tautline.theme";

/** The parts of a session that a load changes. */
interface LoadChange {
  scenario?: string; controller?: string; filter?: string; physics?: string; robot?: string;
}

export class App {
  readonly scene: SceneState = new_scene(kPathRows);
  readonly view = new View();
  readonly ui: Store<UiState>;
  readonly link: LiveLink;
  readonly history: EditHistory;
  /** Asks the canvas to draw again. */
  redraw: () => void = () => undefined;
  private readonly stopper_: Stopper;
  private readonly past_ = new Past(this.scene, kPathRows, () => this.redraw());
  private next_toast_ = 1;
  private drag_: { busy: boolean; sent: number } | null = null;

  constructor() {
    this.ui = new Store<UiState>({
      link: { phase: "connecting", retry_at: 0, rate: 0, latency: null },
      locked: false, gone: null, session: null, catalog: null, scenarios: [], robots: [], toasts: [], spoken: "",
      view: "drive", run: null, theme: initial_theme(), tool: "pan", selection: null, three: false, follow: false,
      force_scale: 1, hidden: stored_hidden(), layers: stored_open(), shortcuts: false, sheet: false, loading: null,
      stop: { phase: "none", since: 0 }, preview: null, goal_learnt: false, undo: null, redo: null,
    });
    this.link = new LiveLink(socket_url, {
      frame: (frame) => {
        fold_frame(this.scene, frame);
        this.scene.heard_at = performance.now();
        this.past_.look_back();
        this.redraw();
      },
      filtered: (sweep) => {
        this.scene.filtered.take(sweep);
        this.redraw();
      },
      state: (session) => this.take_session(session),
      status: (status) => this.take_status(status),
      notice: (level, message) => {
        if (level > 0) this.toast(level > 1 ? "bad" : "warn", message);
      },
      log: (message) => this.say(message),
      new_session: () => {
        begin_run(this.scene);
        this.past_.forget();
        this.history.clear();
        void this.fetch_lists();
      },
      gone: (why) => void this.session_gone(why),
    });
    this.stopper_ = new Stopper([
      () => this.link.call("/request", { type: "stop", engaged: true }),
      () => rest.post(session_path("/control"), { action: "stop" }),
    ], (stop) => this.take_stop(stop));
    this.history = new EditHistory((r) => this.link.call("/request", r), () => {
      this.ui.set({ undo: this.history.can_undo, redo: this.history.can_redo });
    });
  }

  start(): void {
    this.apply_theme();
    this.read_route();
    addEventListener("hashchange", () => this.read_route());
    this.link.start();
    give_signs_of_life(browser,
      () => this.link.is_open && this.link.silence < kHeardLimit && stop_in_reach(),
      () => this.link.tell("/watch"));
  }

  /** Fetches the catalog, the scenarios and the robots; called after each connection. */
  async fetch_lists(): Promise<void> {
    try {
      const [catalog, page, robots] = await Promise.all([
        rest.get<Catalog>("/catalog"), rest.get<Page<ScenarioItem>>("/scenarios?limit=200"),
        rest.get<Page<RobotItem>>("/robots").catch(() => ({ items: [] }))]);
      this.ui.set({ catalog, scenarios: page.items, robots: robots.items });
    } catch (error) {
      if (this.link.is_open) this.toast("bad", sentence_of(error));
    }
  }

  /** Switches filtered scans on or off. A paused run sends none: its newest is in the record. */
  want_filtered(wanted: boolean): void {
    this.past_.wants_filtered = wanted;
    this.link.want_filtered(wanted);
    if (wanted && this.ui.value.session?.pace.paused) void this.past_.fetch_filtered();
    if (!wanted) this.scene.filtered.shown = null;
  }
  toggle_layer(name: string): void {
    this.ui.set({ hidden: toggled(this.ui.value.hidden, name) });
    this.redraw();
  }
  show_layers(open: boolean): void {
    this.ui.set({ layers: open });
    store_open(open);
  }

  /** The answer, or null after a toast with the sentence of the failure. */
  async attempt<T>(answer: Promise<T>): Promise<T | null> {
    try {
      return await answer;
    } catch (error) {
      this.toast("warn", sentence_of(error));
      return null;
    }
  }

  ask<T>(service: string, body: unknown = {}): Promise<T | null> {
    return this.attempt(this.link.call<T>(service, body));
  }

  request(request: RequestJson): Promise<unknown> {
    return this.ask("/request", request);
  }

  async edit(edit: Edit): Promise<Accepted | null> {
    const answer = await this.attempt(this.history.perform(edit));
    if (answer?.warning) this.toast("warn", answer.warning);
    return answer;
  }

  /** Adds the obstacle and selects it. */
  async add(obstacle: Obstacle): Promise<boolean> {
    const answer = await this.edit(add_edit(obstacle));
    if (answer?.id !== undefined) this.ui.set({ selection: { kind: "obstacle", id: answer.id } });
    return answer !== null;
  }

  async undo(): Promise<void> {
    const label = await this.attempt(this.history.undo());
    if (label) this.say(`Undone: ${label}`);
  }
  async redo(): Promise<void> {
    const label = await this.attempt(this.history.redo());
    if (label) this.say(`Done again: ${label}`);
  }

  pick_tool(tool: Tool): void {
    this.ui.set({ tool, selection: null });
  }
  /** The picked tool; `pan` if the robot takes no goals, or its world no obstacles. */
  get usable_tool(): Tool {
    const { tool, session } = this.ui.value;
    const { drives = false, editable = false } = session?.robot ?? {};
    const usable = { pan: true, measure: true, goal: drives, cylinder: editable, box: editable };
    return usable[tool] ? tool : "pan";
  }
  fit_view(): void {
    this.view.fitted = true;
    this.redraw();
  }
  get selected_obstacle(): Obstacle | null {
    const s = this.ui.value.selection;
    return s?.kind === "obstacle" ? this.scene.obstacles.find((o) => o.id === s.id) ?? null : null;
  }

  /**
   * A drag of obstacle `id`. Poses are sent at a steady pace, and the last one always. The whole
   * drag is one step of undo.
   */
  drag(id: number, pose: Pose, from: Pose, done: boolean): void {
    const drag = (this.drag_ ??= { busy: false, sent: 0 });
    if (done) {
      this.drag_ = null;
      void this.request(move_request(id, pose)).then((moved) => {
        if (moved) this.history.record(move_edit(id, from, pose));
      });
      return;
    }
    const now = performance.now();
    if (drag.busy || now - drag.sent < kMoveMs) return;
    drag.busy = true;
    drag.sent = now;
    // A refusal on the way needs no toast: the end of the drag shows one.
    this.link.call("/request", move_request(id, pose)).catch(() => undefined)
      .finally(() => (drag.busy = false));
  }

  /** Loads a scenario, or the same one with another controller, filter, physics or robot. */
  async load(change: LoadChange): Promise<void> {
    const s = this.ui.value.session;
    if (!s || this.ui.value.loading) return;
    const other = change.scenario !== undefined && change.scenario !== s.scenario.name;
    const scenario = change.scenario ?? s.scenario.name;
    const item = this.ui.value.scenarios.find((x) => x.name === scenario);
    const log = item?.kind === "log";
    // Without a name the server keeps the scenario of the session. A name reads the scenario again,
    // so that another robot gets the sensors that the scenario gives it.
    const anew = item && (other || change.scenario !== undefined || change.robot !== undefined);
    const physics = change.physics ?? s.physics;
    const known = this.ui.value.catalog?.physics.some((v) => v.name === physics) ?? false;
    const body = {
      ...(anew ? { scenario } : {}),
      ...(change.robot === undefined ? {} : { robot: change.robot }),
      filter: change.filter ?? s.filter,
      // A log has no controller and no physics; another scenario brings its own gains.
      ...(log ? {} : { controller: change.controller ?? s.controller }),
      ...(log || !known ? {} : { physics }),
      ...(other ? {} : { seed: s.seed, parameters: s.parameters }),
    };
    this.ui.set({ loading: scenario, selection: null });
    await this.ask("/load", body);
    this.history.clear();
    this.ui.set({ loading: null });
    this.fit_view();
  }

  /** Sends Stop over the socket, then also by REST, until the server has answered. */
  stop(): void {
    this.stopper_.press();
  }
  /** Real hardware stands still afterwards: Stop has cleared its goals. */
  async release(): Promise<void> {
    this.stopper_.forget();
    await this.request({ type: "stop", engaged: false });
  }
  /** No longer repeats a Stop that the server does not answer. */
  give_up_stop(): void {
    this.stopper_.forget();
  }

  get on_hardware(): boolean {
    return this.ui.value.session?.source === "hardware";
  }

  /** The goal that edits change: the preview, else the robot's own. */
  get shown_goal(): Goal | null {
    return this.ui.value.preview?.goal ?? this.scene.goal;
  }

  /** A simulated robot drives at once; real hardware only after go_there(). */
  want_goal(goal: Goal | null, further = false): void {
    if (!this.on_hardware) {
      if (goal) this.ui.set({ goal_learnt: true });
      void this.edit(goal && further ? add_goal_edit(goal) : set_goal_edit(this.scene.goal, goal));
    } else if (goal) {
      void this.preview(goal, further);
    } else {
      this.ui.set({ preview: null });
      if (this.scene.goal) void this.request(goal_request(null));
    }
  }
  private async preview(goal: Goal, further: boolean): Promise<void> {
    const preview = { goal, further, trouble: null };
    this.ui.set({ preview, selection: { kind: "goal" } });
    this.redraw();
    const answer = await this.ask<{ trouble: string | null }>("/check_goal", goal_json(goal));
    if (answer && this.ui.value.preview === preview) this.ui.set({ preview: { ...preview, trouble: answer.trouble } });
  }
  drop_preview(): void {
    this.ui.set({ preview: null });
    this.redraw();
  }
  /** Sends the goal of the preview. There is no undo: it would drive the robot somewhere else. */
  async go_there(): Promise<void> {
    const preview = this.ui.value.preview;
    if (!preview) return;
    const request = preview.further ? add_goal_edit(preview.goal).forward : goal_request(preview.goal);
    if (await this.request(request)) this.ui.set({ preview: null, selection: null });
    this.redraw();
  }
  /** Switches the motors of real hardware on or off; a refusal says why. */
  async arm(armed: boolean): Promise<void> {
    await this.ask("/arm", { armed });
  }
  async toggle_play(): Promise<void> {
    const s = this.ui.value.session;
    if (s?.robot.paceable) await this.ask(s.pace.paused ? "/play" : "/pause");
  }
  async step(): Promise<void> {
    const s = this.ui.value.session;
    if (!s?.robot.paceable) return;
    if (!s.pace.paused) await this.ask("/pause");
    await this.ask("/step", { ticks: 1 });
  }
  async reset(): Promise<void> {
    await this.ask("/reset");
    this.history.clear();
    this.ui.set({ selection: null });
  }

  go(view: ViewName, run: number | null = null): void {
    location.hash = run === null ? `#/${view}` : `#/${view}/${run}`;
  }

  set_theme(theme: Theme): void {
    keep(kTheme, theme);
    this.ui.set({ theme });
    this.apply_theme();
  }

  /** A controller's name for people. */
  controller_label(name: string): string {
    return this.ui.value.catalog?.controllers.find((c) => c.name === name)?.label ?? titled(name);
  }

  toast(tone: Toast["tone"], text: string): void {
    const same = this.ui.value.toasts.find((t) => t.text === text);
    const rest_of = this.ui.value.toasts.filter((t) => t !== same).slice(-3);
    const toast = { id: this.next_toast_++, tone, text };
    this.ui.set({ toasts: [...rest_of, toast] });
    setTimeout(() => this.dismiss(toast.id), kToastTime[tone]);
  }
  dismiss(id: number): void {
    this.ui.set({ toasts: this.ui.value.toasts.filter((t) => t.id !== id) });
  }
  say(spoken: string): void {
    if (spoken !== "") this.ui.set({ spoken });
  }

  private take_session(session: SessionState): void {
    const before = this.ui.value.session;
    fold_session(this.scene, session);
    const other_world = before?.scenario.name !== session.scenario.name;
    const other_run = before?.run?.id !== session.run?.id;
    if (other_world) this.view.fitted = true;
    if (other_run) {
      if (before) this.history.clear();
      setTimeout(() => void this.past_.fetch_newest(), kFrameWait);
    }
    if (session.problem && session.problem !== before?.problem) this.toast("bad", session.problem);
    if (other_world || (other_run && session.source === "hardware")) this.ui.set({ tool: "pan", preview: null });
    const gone = this.ui.value.selection?.kind === "obstacle" && !this.selected_obstacle;
    this.ui.set({ session, ...(gone ? { selection: null } : {}) });
    this.redraw();
  }

  private take_stop(stop: StopState): void {
    const before = this.ui.value.stop;
    this.ui.set({ stop });
    if (stop.phase === "failed" && before.phase !== "failed") {
      sound_alarm();
      this.say("Stop did not reach the robot");
    }
    if (before.phase === "failed" && stop.phase === "none" && this.ui.value.session?.stop) {
      this.toast("info", "Stop has reached the robot.");
    }
  }

  private take_status(status: LinkStatus): void {
    const before = this.ui.value.link.phase;
    this.ui.set({ link: status });
    if (before === status.phase) return;
    if (status.phase === "open") {
      this.ui.set({ locked: false });
      this.say("Connected");
      void this.fetch_lists();
    } else if (status.phase === "lost" && before === "open") {
      this.say("Connection lost");
    }
    if (status.phase === "lost") void this.look_for_lock();
  }

  /** A refused socket gives no reason, but a request does. */
  private async look_for_lock(): Promise<void> {
    try {
      await rest.get("/version");
      this.ui.set({ locked: false });
    } catch (error) {
      this.ui.set({ locked: error instanceof rest.RestError && error.status === 401 });
    }
  }

  /** Exchanges the token for a cookie. Rejects with the server's sentence. */
  async login(token: string): Promise<void> {
    await rest.post("/login", { token });
    this.ui.set({ locked: false });
    this.link.retry_now();
  }

  /** Opens a new session and shows it. Rejects with the server's sentence. */
  async new_session(): Promise<void> {
    await open_session();
    this.ui.set({ gone: null });
    this.link.reconnect();
  }

  /** Opens a new session unless the address names one: then the person decides. */
  private async session_gone(why: string): Promise<void> {
    if (session_id() !== null) {
      this.ui.set({ gone: why });
      return;
    }
    try {
      await this.new_session();
    } catch (error) {
      this.ui.set({ gone: sentence_of(error) });
    }
  }

  /** Returns the cookie: the server closes its connections, and the page asks for the token. */
  async logout(): Promise<void> {
    await rest.post("/logout", {});
    this.ui.set({ locked: true });
  }

  private read_route(): void {
    const [, name, id] = location.hash.split("/");
    const view: ViewName = name === "runs" || name === "system" ? name : "drive";
    const run = view === "runs" && id ? Number(id) : NaN;
    this.ui.set({ view, run: Number.isInteger(run) ? run : null, sheet: false });
    document.title = { drive: "Tautline", runs: "Tautline: runs", system: "Tautline: system" }[view];
  }

  private apply_theme(): void {
    document.documentElement.dataset.theme = this.ui.value.theme;
    this.redraw();
  }
}

function initial_theme(): Theme {
  const preferred = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
  return kept<Theme>(kTheme, preferred, (text) => (text === "dark" || text === "light" ? text : preferred));
}

export const AppContext = createContext<App | null>(null);
export function use_app(): App {
  return useContext(AppContext)!;
}

/** The parts `names` of the page's state; renders again when one of them changes. */
export function use_ui<K extends keyof UiState>(...names: K[]): Pick<UiState, K> {
  const { ui } = use_app();
  use_store(ui, (u) => names.map((name) => u[name]), (a, b) => a.every((v, i) => Object.is(v, b[i])));
  return ui.value;
}
