// web/src/app.ts: the state of the page and its actions: one link, one scene, the controls.
import { createContext } from "preact";
import { useContext } from "preact/hooks";
import { Accepted, Catalog, MapDocument, Page, RequestJson, RobotItem, ScenarioItem, SessionState } from "./contract";
import type { ArmDesk } from "./arm/desk";
import { View } from "./draw/view";
import { Editor } from "./edit/editor";
import { Tool } from "./edit/gestures";
import { Entry } from "./entry";
import { LinkStatus, LiveLink } from "./link/live";
import * as rest from "./link/rest";
import { Past } from "./link/past";
import { Rewind } from "./link/rewind";
import { ViewName, kMostCompared, parse_route, print_route } from "./link/route";
import { People } from "./people";
import { session_path, socket_url } from "./link/session";
import { stored_frames } from "./link/stored";
import { Obstacle } from "./obstacle";
import { SceneState, begin_run, fold_frame, fold_session, new_scene } from "./state/scene";
import { forces_shown, store_open, toggled } from "./state/layers";
import { Theme, cameras, store_theme, store_three, store_tool } from "./state/remembered";
import { browser, give_signs_of_life, stop_in_reach } from "./sign_of_life";
import { keep_step } from "./state/first_steps";
import { Store, use_store } from "./state/store";
import { Toast, with_toast } from "./state/toasts";
import { UiState, first_ui } from "./state/ui";
import { StopState, Stopper, sound_alarm } from "./stopper";
import { sentence_of, titled } from "./words";

const kPathRows = 40_000;
const kToastTime = { info: 4000, warn: 7000, bad: 9000 };
const kUndoTime = 15_000;
const kFrameWait = 600;   // [ms] within which a run that is not paused sends a frame
const kHeardLimit = 1000; // [ms] of silence after which the page no longer shows the robot as it is

export class App {
  readonly scene: SceneState = new_scene(kPathRows);
  readonly view = new View();
  readonly ui: Store<UiState>;
  readonly link: LiveLink;
  readonly entry: Entry;
  readonly editor: Editor;
  readonly people = new People();
  /** For a robot with an arm, once its part of the page is there. */
  desk: ArmDesk | null = null;
  /** Asks the canvas to draw again. */
  redraw: () => void = () => undefined;
  /** Fits the world into the 3D view, if that is shown. */
  fit_three: () => void = () => undefined;
  private readonly stopper_: Stopper;
  private readonly past_ = new Past(this.scene, kPathRows, () => this.is_recorded, () => {
    this.rewind.show_world();
    this.redraw();
  });
  readonly rewind = new Rewind(this.scene, this.past_.edits, () => this.ui.value.session, {
    frames: (run) => stored_frames(run, "frames"),
    filtered: (run) => stored_frames(run, "filtered"),
    row: (run) => rest.get(`/runs/${run}`),
  }, {
    changed: () => this.rewound(),
    problem: (sentence) => this.toast("warn", sentence),
  });
  private route_ = parse_route("");
  private hidden_before_: ReadonlySet<string> | null = null; // the hidden layers before the forces were revealed
  private next_toast_ = 1;

  constructor() {
    this.ui = new Store(first_ui());
    this.link = new LiveLink(socket_url, {
      frame: (frame) => {
        if (!this.scene.frame) this.view.target = null; // the first one says where the robot is
        fold_frame(this.scene, frame);
        this.scene.heard_at = performance.now();
        this.past_.see(frame);
        this.rewind.follow();
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
        this.rewind.forget();
        this.editor.history.clear();
        void this.fetch_lists();
      },
      gone: (why) => void this.entry.session_gone(why),
    });
    this.stopper_ = new Stopper([
      () => this.link.call("/request", { type: "stop", engaged: true }),
      () => rest.post(session_path("/control"), { action: "stop" }),
    ], (stop) => this.take_stop(stop));
    this.entry = new Entry(this.ui, this.link);
    this.editor = new Editor(this);
  }

  start(): void {
    this.apply_theme();
    addEventListener("hashchange", () => this.read_route());
    addEventListener("pagehide", () => this.store_view());
    addEventListener("online", () => this.link.retry_now());
    void this.let_in().then(() => this.link.start());
    give_signs_of_life(browser,
      () => this.people.may("operator") && this.link.is_open && this.link.silence < kHeardLimit && stop_in_reach(),
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
    this.rewind.want_filtered(wanted);
    if (wanted && this.ui.value.session?.pace.paused) void this.past_.fetch_filtered();
    if (!wanted) this.scene.filtered.shown = null;
  }
  toggle_layer(name: string): void {
    this.hidden_before_ = null; // a choice of one's own stays
    this.ui.set({ hidden: toggled(this.ui.value.hidden, name) });
    this.redraw();
  }
  show_layers(open: boolean): void {
    this.ui.set({ layers: open });
    store_open(open);
  }

  /** The instant that is shown: the newest one, or the earlier one that somebody looks back at. */
  get shown(): SceneState {
    return this.rewind.scene ?? this.scene;
  }
  go_live(): void {
    this.rewind.live();
  }
  /** Looks back at the instant of the last trouble, with the forces drawn. */
  async show_trouble(): Promise<void> {
    await this.past_.catch_up();
    const at = this.scene.events.last_trouble?.t ?? this.scene.frame?.stamp;
    if (at === undefined) return;
    this.rewind.seek(at);
    if (this.rewind.time === null) this.rewind.step(-1); // it is the newest tick
    if (this.rewind.time !== null) this.reveal_forces(this.scene);
  }
  /** Draws every force, until conceal_forces(). */
  reveal_forces(scene: SceneState): void {
    this.hidden_before_ ??= this.ui.value.hidden;
    this.ui.set({ hidden: forces_shown(this.ui.value.hidden, scene.known) });
  }
  conceal_forces(): void {
    if (this.hidden_before_) this.ui.set({ hidden: this.hidden_before_ });
    this.hidden_before_ = null;
  }
  private rewound(): void {
    const looking = this.rewind.time !== null;
    if (!looking) this.conceal_forces();
    if (looking !== this.ui.value.looking) {
      this.ui.set({ looking });
      this.say(looking ? "Looking back. The robot goes on." : "Live again");
    }
    this.redraw();
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

  request(request: RequestJson): Promise<Accepted | null> {
    return this.ask("/request", request);
  }

  pick_tool(tool: Tool): void {
    store_tool(tool);
    this.ui.set({ tool, selection: null });
  }
  /** The picked tool; `pan` if the robot takes no goals, or its world no obstacles. */
  get usable_tool(): Tool {
    const { tool, session } = this.ui.value;
    const may = this.people.may("operator");
    const drives = may && (session?.robot.drives ?? false);
    const editable = may && (session?.robot.editable ?? false);
    const looks = tool === "pan" || tool === "measure";
    const can = tool === "goal" ? drives : tool === "pose" ? may && !!session?.map : tool === "hand" ? drives && !!session?.robot.arm : editable;
    return looks || can ? tool : "pan";
  }
  show_three(three: boolean): void {
    store_three(three);
    this.ui.set({ three });
  }
  /** Keeps the camera for the next visit to this scenario. */
  private store_view(): void {
    const { session } = this.ui.value;
    if (session) cameras.set(session.scenario.name, this.view.camera);
  }
  fit_view(): void {
    this.view.fit();
    this.fit_three();
    this.redraw();
  }
  private get is_recorded(): boolean {
    return this.link.is_open && ["recording", "paused"].includes(this.ui.value.session?.record.status ?? "");
  }
  get selected_obstacle(): Obstacle | null {
    const s = this.ui.value.selection;
    return s?.kind === "obstacle" ? this.scene.obstacles.find((o) => o.id === s.id) ?? null : null;
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

  /** Switches the motors of real hardware on or off; a refusal says why. */
  async arm(armed: boolean): Promise<void> {
    await this.ask("/arm", { armed });
  }
  /** Plays or pauses the robot; while somebody looks back, the record. */
  async toggle_play(): Promise<void> {
    const s = this.ui.value.session;
    if (this.ui.value.looking) this.rewind.toggle();
    else if (s?.robot.paceable) await this.ask(s.pace.paused ? "/play" : "/pause");
  }
  async step(): Promise<void> {
    const s = this.ui.value.session;
    if (this.ui.value.looking) return this.rewind.step(1);
    if (!s?.robot.paceable) return;
    if (!s.pace.paused) await this.ask("/pause");
    await this.ask("/step", { ticks: 1 });
  }
  /** Goes on if `step` is the first step that is shown. */
  done_step(step: number): void {
    if (this.ui.value.step === step) this.to_step(step + 1);
  }
  to_step(step: number): void {
    this.ui.set({ step });
    keep_step(step);
  }

  go(view: ViewName, run: number | null = null): void {
    location.hash = print_route({ view, run });
  }
  /** Null closes the open one. */
  open_experiment(experiment: string | null): void {
    location.hash = print_route({ view: "experiments", experiment });
  }
  open_run(run: number, compare: readonly number[]): void {
    location.hash = print_route({ view: "runs", run, compare: compare.slice(0, kMostCompared) });
  }
  /** The runs that are compared with the open one. */
  compare_with(runs: readonly number[]): void {
    location.hash = print_route({ ...this.route_, compare: runs });
  }
  /** Keeps time and camera of the open run in the address. */
  note_place(place: UiState["place"]): void {
    this.route_ = { ...this.route_, ...place };
    history.replaceState(history.state, "", print_route(this.route_));
  }

  set_theme(theme: Theme): void {
    store_theme(theme);
    this.ui.set({ theme });
    this.apply_theme();
  }

  /** A controller's name for people. */
  controller_label(name: string): string {
    return this.ui.value.catalog?.controllers.find((c) => c.name === name)?.label ?? titled(name);
  }

  /** With `undo`, the message offers to take back what it says. */
  toast(tone: Toast["tone"], text: string, undo?: () => void): void {
    const id = this.next_toast_++;
    this.ui.set({ toasts: with_toast(this.ui.value.toasts, { id, tone, text, undo }) });
    setTimeout(() => this.dismiss(id), undo ? kUndoTime : kToastTime[tone]);
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
    if (session.robot.arm && !this.desk) void this.fetch_desk();
    if (session.map !== before?.map || (session.map && session.run?.id !== before?.run?.id)) void this.fetch_map(session.map);
    const other_world = before?.scenario.name !== session.scenario.name;
    const other_run = before?.run?.id !== session.run?.id;
    if (other_world) {
      this.store_view(); // of the world before
      const camera = cameras.get(session.scenario.name);
      if (camera) this.view.show(camera);
      else this.view.fit();
      const known = this.ui.value.scenarios.some((s) => s.name === session.scenario.name);
      if (before && !known) void this.fetch_lists(); // somebody else has just saved it
    }
    if (other_run) {
      this.rewind.forget();
      setTimeout(() => void this.past_.fetch_newest(), kFrameWait);
    }
    if (before && before.record.status !== session.record.status) this.rewind.record_changed();
    if (session.problem && session.problem !== before?.problem) this.toast("bad", session.problem);
    // A page that is opened again has its tool, but nothing sends a real robot off by a stray press.
    const other_tool = before ? other_world : session.source === "hardware";
    if (other_tool || (other_run && session.source === "hardware")) this.ui.set({ tool: "pan", preview: null });
    const gone = this.ui.value.selection?.kind === "obstacle" && !this.selected_obstacle;
    this.ui.set({ session, ...(gone ? { selection: null } : {}) });
    this.redraw();
  }

  private async fetch_map(name: string | null | undefined): Promise<void> {
    if (!name && !this.scene.map) return;
    const { show_map } = await import("./draw/known_map");
    const map = name ? await this.attempt(rest.get<MapDocument>(session_path("/map"))) : null;
    if (name !== this.ui.value.session?.map) return; // another world has been loaded meanwhile
    this.scene.map = show_map(map);
    if (this.view.fitted) this.view.fit();
    this.redraw();
  }

  private async fetch_desk(): Promise<void> {
    const { ArmDesk } = await import("./arm/part");
    this.desk ??= new ArmDesk(this);
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
      void this.people.fetch();
      void this.fetch_lists();
    } else if (status.phase === "lost" && before === "open") {
      this.say("Connection lost");
      this.past_.cut();
    }
    if (status.phase === "lost") void this.entry.look_for_lock();
  }

  private async let_in(): Promise<void> {
    const entering = this.entry.by_link();
    this.read_route(); // without the token, which is gone from the address by now
    await this.attempt(entering);
  }

  private read_route(): void {
    this.route_ = parse_route(location.hash);
    const { view, run, experiment, compare, time, camera } = this.route_;
    this.ui.set({ view, run, experiment, compare, place: { time, camera }, sheet: false, views: false });
    document.title = {
      drive: "Tautline", teleop: "Tautline: driving by hand", runs: "Tautline: runs", experiments: "Tautline: experiments", system: "Tautline: system", nowhere: "Tautline: unknown address",
    }[view];
  }

  private apply_theme(): void {
    document.documentElement.dataset.theme = this.ui.value.theme;
    this.redraw();
  }
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
