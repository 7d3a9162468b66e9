// web/src/teleop/teleop.tsx: the view of somebody who drives by hand: the world about the robot, the stick, its mode,
// and what limits the robot.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { may } from "../people";
import { age_words, news_age } from "../state/age";
import { SceneState, senses_ground } from "../state/scene";
import { use_pulse } from "../state/store";
import { Segments, Slider } from "../ui/controls";
import { use_me } from "../ui/guard";
import { lazy } from "../ui/lazy";
import { Legend } from "./corner";
import { Deck } from "./deck";
import { Devices } from "./devices";
import { DriverView } from "./eye";
import { Hand, Mode, use_hand } from "./hand";
import { kTooSlow } from "./operator_link";
import { driven_words } from "./reasons";
import { use_second_thumb } from "./second_thumb";
import { WhoDrives } from "./who_drives";

const Terrain = lazy(async () => (await import("../views/terrain")).Terrain);

export { ReplayDeck } from "./deck"; // of one part of the page: more parts would cost the first load more

const kModes = [
  { name: "guarded", label: "Guarded", help: "As far as the robot can still stop before all that it sees" },
  { name: "wall", label: "Wall", help: "Slower where it is crowded; at full stick it follows a wall" },
  { name: "elastic", label: "Elastic", help: "The stick steers a course; the robot finds the way along it" },
  { name: "goal", label: "Goal", help: "The stick rests: press on the place to which the robot shall go" },
  { name: "raw", label: "Raw", help: "No guard: only Stop, the bumpers and the watchdog hold" },
];

export function Teleop(): JSX.Element {
  const app = use_app();
  const { session } = use_ui("session");
  const me = use_me();
  const [mode, set_mode] = useState<Mode>("guarded");
  const drives = may(me, "operator") && (session?.robot.drives ?? false);
  const hand = use_hand(drives, mode);
  const { seat } = hand;
  const awake = use_awake();
  use_second_thumb();
  use_pulse(100);
  return (
    <>
      <main class="scene" aria-label="The world about the robot">
        <DriverView sets_goal={mode === "goal" && drives} />
        <Legend />
        <Reason scene={app.scene} hand={hand} drives={drives} stopped={session?.stop ?? false} />
      </main>
      <Deck scene={app.scene} wish={seat.idle ? null : seat.wish} barred={seat.barred}
        hold={drives ? (stick) => seat.draw(stick) : null}>
        <div class="deck-mode">
          <Segments label="Mode" name="stick-mode" choices={kModes} value={mode} disabled={!drives}
            on_pick={(name) => set_mode(name as Mode)} />
          <p class="quiet">{kModes.find((m) => m.name === mode)!.help}.</p>
        </div>
        <div class="deck-more">
          <WhoDrives link={hand.link} on_loss={() => seat.drop()} />
          <SpeedCap disabled={!drives} />
          <Devices hand={hand} disabled={!drives} />
          {!awake && <p class="quiet">This browser may let the screen go dark: it keeps it awake only over https.</p>}
        </div>
        {senses_ground(app.scene) && <Terrain scene={app.scene} />}
      </Deck>
    </>
  );
}

/** The sentence of the view: why the robot does not do what the hand wants. */
function Reason(props: { scene: SceneState; hand: Hand; drives: boolean; stopped: boolean }): JSX.Element {
  const { link, session } = use_ui("link", "session");
  const { frame } = props.scene;
  const silence = news_age(props.scene, session, link.phase === "open", performance.now());
  const { what, why } = silence !== null
    ? { what: "The robot is not heard", why: `This picture is ${age_words(silence)} old. Your stick may not reach the robot, which then stops by itself.` }
    : !props.drives
    ? { what: "You only watch", why: "This robot takes no stick, or your role may not drive." }
    : props.stopped ? { what: "Stopped", why: "Release lets the robot drive again, once the stick has been in the middle." }
    : (props.hand.link.round_trip ?? 0) > kTooSlow ? { what: "The link is too slow to drive", why: "Your answer to what you see would come too late; Stop works." }
    : props.hand.seat.barred ? { what: "Let go of the stick", why: "The robot goes on only after the stick has been in the middle." }
    : frame?.behaviour === "manual" ? driven_words(props.scene)
    : props.hand.strange ? { what: "This gamepad moves nothing", why: "Its buttons have no standard order, so none is known to be Stop. Set it up below." }
    : { what: "Nobody drives by hand", why: "Drag the stick, hold W A S D or the arrows, or hold a bumper of a gamepad." };
  return <p class={`card say ${silence !== null ? "stale all" : ""}`} data-testid="teleop-reason"><b role="status">{what}</b> <span>{why}</span></p>;
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
