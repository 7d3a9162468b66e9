// web/src/app.ts: what the page knows and can do: one link, one scene, one set of controls' state.
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import { Accepted, Catalog, Page, RequestJson, RobotItem, ScenarioItem, SessionState } from "./contract";
import { Selection } from "./draw/scene";
import { View } from "./draw/view";
import { Pose } from "./geometry";
import { Edit, EditHistory } from "./edit/history";
import { Tool } from "./edit/gestures";
import { add_goal_edit, goal_request, move_edit, move_request, set_goal_edit } from "./edit/edits";
import { Goal } from "./link/frame";
import { LinkStatus, LiveLink } from "./link/live";
import * as rest from "./link/rest";
import { Past } from "./link/past";
import { open_session, session_id, session_path, socket_url } from "./link/session";
import { SceneState, begin_run, fold_frame, fold_session, new_scene } from "./state/scene";
import { stored_hidden, store_open, stored_open, toggled } from "./state/layers";
import { SignOfLife, browser, stop_in_reach } from "./sign_of_life";
import { Store } from "./state/store";
import { StopState, Stopper, sound_alarm } from "./stopper";
import { sentence_of, titled } from "./words";

export type ViewName = "drive" | "runs" | "system";
export interface Toast { id: number; tone: "info" | "warn" | "bad"; text: string }

/** A goal for real hardware that nobody has sent off yet: the page's own, drawn dashed. */
export interface Preview {
  goal: Goal;
  further: boolean;        // for when those before it are reached
  trouble: string | null;  // what is known to be wrong with it
}

export interface UiState {
  link: LinkStatus;
  /** The server answers, and wants its token first. */
  locked: boolean;
  gone: string | null; // why there is no session to show
  session: SessionState | null;
  catalog: Catalog | null;
  scenarios: ScenarioItem[];
  robots: RobotItem[];
  toasts: Toast[];
  /** The sentence a screen reader hears next. */
  spoken: string;
  view: ViewName;
  run: number | null; // opened in the Runs view
  theme: "dark" | "light";
  tool: Tool;
  selection: Selection;
  three: boolean;
  follow: boolean;
  force_scale: number;
  hidden: ReadonlySet<string>; // layers that are switched off, by name
  layers: boolean;             // their panel is open
  shortcuts: boolean;
  sheet: boolean;
  loading: string | null;
  stop: StopState;
  preview: Preview | null;
  /** A goal was set by hand: the hint how to has done its work. */
  goal_learnt: boolean;
  undo: string | null;
  redo: string | null;
}

const kPathRows = 40_000;
const kToastTime = { info: 4000, warn: 7000, bad: 9000 };
const kFrameWait = 600; // [ms] a run that goes on has sent a frame by then
const kHeardLimit = 1000; // [ms] who hears nothing for so long sees nothing of the robot either
const kMoveMs = 90; // between two requests of one drag

/** What is to be another. */
export interface LoadChange {
  scenario?: string; controller?: string; filter?: string; physics?: string; robot?: string;
}

export class App {
  readonly scene: SceneState = new_scene(kPathRows);
  readonly view = new View();
  readonly ui: Store<UiState>;
  readonly link: LiveLink;
  readonly history: EditHistory;
  /** Asks the canvas to draw once more. */
  redraw: () => void = () => undefined;
  private readonly sign_: SignOfLife;
  private readonly stopper_: Stopper;
  private readonly past_ = new Past(this.scene, kPathRows, () => this.redraw());
  private next_toast_ = 1;
  private drag_: { busy: boolean; sent: number; failed: boolean } | null = null;

  constructor() {
    this.ui = new Store<UiState>({
      link: { phase: "connecting", retry_at: 0, rate: 0, latency: null },
      locked: false, gone: null, session: null, catalog: null, scenarios: [], robots: [], toasts: [], spoken: "", view: "drive", run: null,
      theme: initial_theme(), tool: "pan", selection: null, three: false, follow: false,
      force_scale: 1, hidden: stored_hidden(), layers: stored_open(), shortcuts: false, sheet: false, loading: null, stop: { phase: "none", since: 0 }, preview: null, goal_learnt: false, undo: null, redo: null,
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
    this.sign_ = new SignOfLife(browser,
      () => this.link.is_open && this.link.silence < kHeardLimit && stop_in_reach(),
      () => this.link.tell("/watch"));
    this.history = new EditHistory((r) => this.link.call("/request", r), () => {
      this.ui.set({ undo: this.history.can_undo, redo: this.history.can_redo });
    });
  }

  start(): void {
    this.apply_theme();
    this.read_route();
    addEventListener("hashchange", () => this.read_route());
    this.link.start();
    this.sign_.start();
  }

  /** The catalog, the scenarios and the robots; asked again after each connection. */
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

  /** Whether filtered scans are looked at. A paused run sends none: its newest is in the record. */
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

  /** Calls a service; a refusal becomes a toast with the server's sentence. */
  async ask<T>(name: string, body: unknown = {}): Promise<T | null> {
    try {
      return await this.link.call<T>(name, body);
    } catch (error) {
      this.toast("warn", sentence_of(error));
      return null;
    }
  }

  request(request: RequestJson): Promise<unknown> {
    return this.ask("/request", request);
  }

  async edit(edit: Edit): Promise<Accepted | null> {
    try {
      const answer = await this.history.perform(edit);
      if (answer.warning) this.toast("warn", answer.warning);
      return answer;
    } catch (error) {
      this.toast("warn", sentence_of(error));
      return null;
    }
  }

  async undo(): Promise<void> {
    try {
      const label = await this.history.undo();
      if (label) this.say(`Undone: ${label}`);
    } catch (error) {
      this.toast("warn", sentence_of(error));
    }
  }
  async redo(): Promise<void> {
    try {
      const label = await this.history.redo();
      if (label) this.say(`Done again: ${label}`);
    } catch (error) {
      this.toast("warn", sentence_of(error));
    }
  }

  /** A drag: the newest place is sent at a steady pace, the last one always; one step of undo. */
  drag(id: number, pose: Pose, from: Pose, done: boolean): void {
    const drag = (this.drag_ ??= { busy: false, sent: 0, failed: false });
    if (done) {
      this.drag_ = null;
      void this.link.call("/request", move_request(id, pose)).then(
        () => this.history.record(move_edit(id, from, pose)),
        (error) => this.toast("warn", sentence_of(error)));
      return;
    }
    const now = performance.now();
    if (drag.busy || now - drag.sent < kMoveMs) return;
    drag.busy = true;
    drag.sent = now;
    // A place on the way that is refused is no matter: only where the drag ends is said.
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
    // The scenario of the session goes on as it is; one of the list is read anew: a robot that
    // comes back finds the sensors that the scenario gives it.
    const anew = item && (other || change.scenario !== undefined || change.robot !== undefined);
    const physics = change.physics ?? s.physics;
    const known = this.ui.value.catalog?.physics.some((v) => v.name === physics) ?? false;
    const body = {
      ...(anew ? { scenario } : {}),
      ...(change.robot === undefined ? {} : { robot: change.robot }),
      filter: change.filter ?? s.filter,
      // A log has no controller and no physics; a scenario brings its own gains.
      ...(log ? {} : { controller: change.controller ?? s.controller }),
      ...(log || !known ? {} : { physics }),
      ...(other ? {} : { seed: s.seed, parameters: s.parameters }),
    };
    this.ui.set({ loading: scenario, selection: null });
    await this.ask("/load", body);
    this.history.clear();
    this.view.fitted = true;
    this.ui.set({ loading: null });
    this.redraw();
  }

  /** Stop, by every way there is until the server has answered. */
  stop(): void {
    this.stopper_.press();
  }
  /** Of real hardware this starts nothing: Stop has cleared its goals. */
  async release(): Promise<void> {
    this.stopper_.forget();
    await this.request({ type: "stop", engaged: false });
  }
  /** Stops trying to send a Stop that does not get through. */
  give_up_stop(): void {
    this.stopper_.forget();
  }

  get on_hardware(): boolean {
    return this.ui.value.session?.source === "hardware";
  }

  /** The goal that hands work on: the preview before the one the robot has. */
  get shown_goal(): Goal | null {
    return this.ui.value.preview?.goal ?? this.scene.goal;
  }

  /** A simulated robot sets off at once; real hardware only with go(). */
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
    const { x, y, heading } = goal;
    const body = heading === null ? { x, y } : { x, y, heading };
    const answer = await this.ask<{ trouble: string | null }>("/check_goal", body);
    if (answer && this.ui.value.preview === preview) this.ui.set({ preview: { ...preview, trouble: answer.trouble } });
  }
  drop_preview(): void {
    this.ui.set({ preview: null });
    this.redraw();
  }
  /** Sends the robot off to the goal of the preview. No undo leads back: it would send it elsewhere. */
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

  set_theme(theme: "dark" | "light"): void {
    try {
      localStorage.setItem("tautline.theme", theme);
    } catch {
      // private windows may refuse; the theme then lasts as long as the page
    }
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
    if (before?.scenario.name !== session.scenario.name) this.view.fitted = true;
    if (before?.run?.id !== session.run?.id) {
      if (before) this.history.clear();
      setTimeout(() => void this.past_.fetch_newest(), kFrameWait);
    }
    if (session.problem && session.problem !== before?.problem) this.toast("bad", session.problem);
    const other_world = before?.scenario.name !== session.scenario.name;
    const other_run = before?.run?.id !== session.run?.id;
    if (other_world || (other_run && session.source === "hardware")) this.ui.set({ tool: "pan", preview: null });
    const selection = this.ui.value.selection;
    const gone = selection?.kind === "obstacle" &&
      !this.scene.obstacles.some((o) => o.id === selection.id);
    this.ui.set({ session, selection: gone ? null : selection });
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

  /** A socket does not say why it was refused; a request does. */
  private async look_for_lock(): Promise<void> {
    try {
      await rest.get("/version");
      this.ui.set({ locked: false });
    } catch (error) {
      this.ui.set({ locked: error instanceof rest.RestError && error.status === 401 });
    }
  }

  /** Trades the token for a cookie. Rejects with the server's sentence. */
  async login(token: string): Promise<void> {
    await rest.post("/login", { token });
    this.ui.set({ locked: false });
    this.link.retry_now();
  }

  /** Opens a session of this page's own and shows it. Rejects with the server's sentence. */
  async new_session(): Promise<void> {
    await open_session();
    this.ui.set({ gone: null });
    this.link.reconnect();
  }

  /** A page that asked for none in particular gets one; else the person decides. */
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

  /** Gives the cookie back. The server closes what was opened with it, and the page asks for the token. */
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

function initial_theme(): "dark" | "light" {
  try {
    const stored = localStorage.getItem("tautline.theme");
    if (stored === "dark" || stored === "light") return stored;
  } catch {
    // fall through to what the system prefers
  }
  return matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
}

export const AppContext = createContext<App | null>(null);
export function use_app(): App {
  return useContext(AppContext)!;
}
