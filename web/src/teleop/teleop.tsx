// web/src/teleop/teleop.tsx: the view of somebody who drives by hand: the world about the robot, the stick, its mode,
// and what limits the robot.
import { JSX } from "preact";
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { View } from "../draw/view";
import { Bounds } from "../geometry";
import { may } from "../people";
import { SceneState } from "../state/scene";
import { use_listener, use_pulse } from "../state/store";
import { SceneCanvas } from "../ui/canvas";
import { Segments, Slider } from "../ui/controls";
import { use_me } from "../ui/guard";
import { make_hand } from "../views/drive";
import { typing } from "../views/keys";
import { fixed, limit_words, sentence_of } from "../words";
import { DrawnStick } from "./drawn_stick";
import { OperatorLink } from "./operator_link";
import { Seat, kSendEvery, read_pad } from "./seat";
import { WhoDrives } from "./who_drives";

const kAround = 3;        // [m] shown about the robot
const kFarOff = 0.8;      // [m] from the middle, until the view follows
const kToldAgain = 3000;  // [ms] between two refusals that are told
const kRumble = 0.1;      // of full force
const kModes = [
  { name: "guarded", label: "Guarded", help: "As far as the robot can still stop before all that it sees" },
  { name: "wall", label: "Wall", help: "Slower where it is crowded; at full stick it follows a wall" },
  { name: "elastic", label: "Elastic", help: "The stick pulls the goal along; the robot finds the way" },
  { name: "raw", label: "Raw", help: "No guard: only Stop, the bumpers and the watchdog hold" },
];
type Mode = "guarded" | "wall" | "raw" | "elastic";

export function Teleop(): JSX.Element {
  const app = use_app();
  const { session, stop } = use_ui("session", "stop");
  const me = use_me();
  const seat = useMemo(() => new Seat(), []);
  const link = useMemo(() => new OperatorLink(app.link), [app]);
  const view = useMemo(() => new View(), []);
  const hand = useMemo(() => make_hand(app, { tool: () => "pan", edits: false }), [app]);
  const [mode, set_mode] = useState<Mode>("guarded");
  const [strange, set_strange] = useState(false);
  const told = useRef(-Infinity);
  const stopping = useRef(false);
  const latest_mode = useRef<Mode>(mode);
  latest_mode.current = mode;
  use_pulse(100);

  const drives = may(me, "operator") && (session?.robot.drives ?? false);
  const refused = (error: unknown) => {
    seat.drop();
    if (performance.now() - told.current < kToldAgain) return;
    told.current = performance.now();
    app.toast("warn", sentence_of(error));
  };
  useEffect(() => {
    if (!drives) return;
    const beat = setInterval(() => {
      const pad = navigator.getGamepads?.().find((p) => p !== null) ?? null;
      const wish = read_pad(pad);
      set_strange(wish.strange);
      seat.pad(wish.stick);
      if (wish.stop && !stopping.current) app.stop();
      stopping.current = wish.stop;
      rumble(pad, app.scene);
      if (!link.beat()) seat.drop();
      const next = seat.next();
      // Old commands that wait in the socket would reach the robot late: none is added to them.
      if (!next || !app.link.is_clear) return;
      app.link.call("/request", { type: "joystick", ...link.stamped(next), mode: latest_mode.current }).catch(refused);
    }, kSendEvery);
    return () => clearInterval(beat);
  }, [drives]);
  useEffect(() => seat.drop(), [stop.phase, session?.stop]); // by Stop or Release of any page
  use_listener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || typing(e.target) || document.querySelector("dialog[open]")) return;
    if (e.target instanceof HTMLInputElement && e.code.startsWith("Arrow")) return; // a slider or a choice keeps them
    if (seat.key(e.code, true, e.repeat)) e.preventDefault();
  });
  use_listener("keyup", (e) => void seat.key(e.code, false));
  use_listener("blur", () => seat.drop());
  use_listener("pagehide", () => seat.drop());
  useEffect(() => {
    const hide = () => document.hidden && seat.drop();
    document.addEventListener("visibilitychange", hide);
    return () => document.removeEventListener("visibilitychange", hide);
  }, []);
  const awake = use_awake();

  return (
    <>
      <main class="scene" aria-label="The world about the robot">
        <SceneCanvas scene={() => app.shown} view={view} gestures={hand.gestures}
          label="The robot and its surroundings from above" bounds={() => about(app.shown)}
          insets={() => ({ left: 12, top: 12, right: 12, bottom: 12 })} lost={() => strayed(view, app.shown)}
          on_ready={(redraw) => (app.redraw = redraw)}
          overlay={() => ({
            selection: null, hovered: null, draft: {}, handles: false, force_scale: app.ui.value.force_scale,
            hidden: app.ui.value.hidden, ghosts: [], future: false, insets: { left: 12, top: 12, right: 12, bottom: 12 },
            preview: null,
          })} />
      </main>
      <section class="deck" aria-label="Driving by hand">
        <DrawnStick seat={seat} disabled={!drives} force={force_of(app.scene)} />
        <div class="deck-words">
          <WhoDrives link={link} on_loss={() => seat.drop()} />
          <Reason scene={app.scene} seat={seat} drives={drives} strange={strange} />
          <Speeds scene={app.scene} seat={seat} full={full_speed(app.scene, session?.robot.max_v ?? 0)} />
        </div>
        <div class="deck-choices">
          <Segments label="Mode" name="stick-mode" choices={kModes} value={mode} disabled={!drives}
            on_pick={(name) => set_mode(name as Mode)} />
          <p class="quiet">{kModes.find((m) => m.name === mode)!.help}.</p>
          <SpeedCap disabled={!drives} />
          {!awake && <p class="quiet">This browser may let the screen go dark: it keeps it awake only over https.</p>}
        </div>
      </section>
    </>
  );
}

/** The bounds of what the driver needs to see. */
function about(scene: SceneState): Bounds {
  const at = scene.frame?.pose ?? { x: 0, y: 0 };
  return { min_x: at.x - kAround, max_x: at.x + kAround, min_y: at.y - kAround, max_y: at.y + kAround };
}

function strayed(view: View, scene: SceneState): boolean {
  const at = scene.frame?.pose;
  const { x, y } = view.target ?? view;
  return at !== undefined && Math.hypot(at.x - x, at.y - y) > kFarOff;
}

function measure(scene: SceneState, name: string): number | null {
  const value = scene.frame?.measures.find((m) => m.name === name)?.value;
  return value === undefined || !Number.isFinite(value) ? null : value;
}

function force_of(scene: SceneState): { forward: number; left: number } {
  return { forward: measure(scene, "teleop.force_forward") ?? 0, left: measure(scene, "teleop.force_left") ?? 0 };
}

function full_speed(scene: SceneState, max_v: number): number {
  return Math.min(max_v, scene.parameters["teleop.v_max"] ?? max_v);
}

function rumble(pad: Gamepad | null, scene: SceneState): void {
  const { forward, left } = force_of(scene);
  const strength = Math.min(1, Math.hypot(forward, left));
  if (strength < kRumble) return;
  void pad?.vibrationActuator?.playEffect("dual-rumble", {
    duration: 2 * kSendEvery, strongMagnitude: strength, weakMagnitude: strength / 2,
  }).catch(() => undefined);
}

/** The sentence of the view: why the robot does not do what the hand wants. */
function Reason(props: { scene: SceneState; seat: Seat; drives: boolean; strange: boolean }): JSX.Element {
  const { frame } = props.scene;
  const words = limit_words(frame?.limit ?? "");
  const wall = measure(props.scene, "teleop.wall_rho");
  const [what, why] = !props.drives ? ["You only watch", "This robot takes no stick, or your role may not drive."]
    : props.seat.barred ? ["Let go of the stick", "The robot goes on only after the stick has been in the middle."]
    : props.strange ? ["This gamepad moves nothing", "Its buttons have no standard order, so none is known to be Stop."]
    : frame && frame.behaviour === "manual" && words ? [words.what, words.why]
    : frame && frame.behaviour === "manual" ? ["The robot follows your stick", "Nothing limits it."]
    : ["Nobody drives by hand", "Drag the stick, hold W A S D or the arrows, or hold a bumper of a gamepad."];
  return (
    <p class="why" role="status" data-testid="teleop-reason">
      <b>{what}</b> <span>{why}{wall !== null && ` A wall is ${fixed(wall, 2)} m away.`}</span>
    </p>
  );
}

/** The size of wanted, commanded and executed speed, as bars. */
function Speeds(props: { scene: SceneState; seat: Seat; full: number }): JSX.Element {
  const { frame } = props.scene;
  const full = Math.max(props.full, 0.01);
  const rows: [string, number][] = [
    ["Stick", props.seat.wish.forward * full], ["Command", frame?.command.v ?? 0], ["Robot", frame?.twist.v ?? 0],
  ];
  return (
    <dl class="speeds">
      {rows.map(([name, v]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd><meter min={0} max={full} value={Math.min(full, Math.abs(v))} aria-label={`${name}, m/s`} />
            <span class="num">{fixed(v, 2)} <u>m/s</u></span></dd>
        </div>
      ))}
    </dl>
  );
}

function SpeedCap(props: { disabled: boolean }): JSX.Element | null {
  const app = use_app();
  const { catalog, session } = use_ui("catalog", "session");
  const info = catalog?.parameters.find((p) => p.name === "teleop.v_max");
  if (!info || !session) return null;
  const most = Math.min(info.max, session.robot.max_v);
  return (
    <fieldset class="bare" disabled={props.disabled}>
      <Slider info={{ ...info, max: most }} value={Math.min(most, app.scene.parameters[info.name] ?? most)} usual={most}
        on_set={(value) => app.attempt(app.link.set_parameter(info.name, value))} />
    </fieldset>
  );
}

/** Whether the screen is kept awake while the view is shown. */
function use_awake(): boolean {
  const [awake, set_awake] = useState(true);
  useEffect(() => {
    let lock: WakeLockSentinel | null = null;
    const ask = async () => {
      try {
        lock = document.hidden ? lock : await navigator.wakeLock.request("screen");
        set_awake(true);
      } catch {
        set_awake(false); // not offered here, or the battery is low
      }
    };
    void ask();
    document.addEventListener("visibilitychange", ask);
    return () => {
      document.removeEventListener("visibilitychange", ask);
      void lock?.release();
    };
  }, []);
  return awake;
}
