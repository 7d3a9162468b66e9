// web/src/teleop/hand.ts: the driver's hand: 20 times a second it hears gamepad, keys and drawn stick, sends the stick,
// and pushes back on the devices that can.
import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { App, use_app, use_ui } from "../app";
import { force_of } from "../state/driven";
import { use_latest, use_listener } from "../state/store";
import { typing } from "../views/keys";
import { sentence_of } from "../words";
import { ForceDevice, Rumble } from "./force";
import { PidStick, choose_device, hid_of } from "./hid_pid";
import { OperatorLink } from "./operator_link";
import { find_pad, map_of, read_pad } from "./pads";
import { Seat, kSendEvery } from "./seat";

export type Mode = "guarded" | "wall" | "elastic" | "goal" | "raw";

const kToldAgain = 3000; // [ms] between two refusals that are told
const kOldForce = 500;   // [ms] of silence of the server, after which its force is none

export const gamepad = (): Gamepad | null => find_pad(() => navigator.getGamepads?.());

export interface Hand {
  seat: Seat;
  link: OperatorLink;
  strange: boolean;           // the gamepad has no order that is known
  pad: string | null;         // its id
  rumbles: boolean;
  stick: ForceDevice | null;  // that pushes back
  /** Lets a person choose such a stick; must be called by a press. */
  connect(): Promise<void>;
  disconnect(): void;
  /** While a gamepad is set up it moves nothing. */
  set_up(open: boolean): void;
  setting_up: boolean;
}

export function use_hand(drives: boolean, mode: Mode): Hand {
  const app = use_app();
  const { session, stop } = use_ui("session", "stop");
  const seat = useMemo(() => new Seat(), []);
  const link = useMemo(() => new OperatorLink(app.link), [app]);
  const rumble = useMemo(() => new Rumble(gamepad), []);
  const force = use_force_stick(app);
  const [heard, set_heard] = useState({ strange: false, pad: null as string | null, rumbles: false });
  const [setting_up, set_up] = useState(false);
  const told = useRef(-Infinity);
  const stopping = useRef(false);
  const latest = use_latest({ mode, setting_up });

  const let_go = () => {
    seat.drop();
    force.held.current?.set_force(0, 0);
  };
  const refused = (error: unknown) => {
    let_go();
    if (performance.now() - told.current < kToldAgain) return;
    told.current = performance.now();
    app.toast("warn", sentence_of(error));
  };
  /** A lost connection is told elsewhere. */
  const cut_off = () => {
    if (app.link.is_open && !seat.idle) refused(new Error("Your stick waits half a second before it leaves this computer. Take it again."));
    else let_go();
  };
  const hear = () => {
    const pad = gamepad();
    const wish = read_pad(pad, pad && map_of(pad.id));
    set_heard((before) => {
      const now = { strange: wish.strange, pad: pad?.id ?? null, rumbles: rumble.there };
      return same(before, now) ? before : now;
    });
    seat.pad(latest.current.setting_up ? null : wish.stick);
    if (wish.stop && !stopping.current) app.stop();
    stopping.current = wish.stop;
  };
  useEffect(() => {
    if (!drives) return;
    const beat = setInterval(() => {
      hear();
      if (!link.beat()) cut_off();
      const next = seat.next();
      const { forward, left } = felt(app, seat);
      for (const device of [rumble, force.held.current]) device?.set_force(forward, left);
      if (!next || !link.takes_sticks || latest.current.mode === "goal") return;
      app.link.call("/request", { type: "joystick", ...link.stamped(next), mode: latest.current.mode }).catch(refused);
    }, kSendEvery);
    return () => {
      clearInterval(beat);
      let_go();
    };
  }, [drives]);
  useEffect(let_go, [stop.phase, session?.stop]); // by Stop or Release of any page
  use_seat_keys(seat);
  use_losses(let_go);
  return {
    seat, link, ...heard, stick: force.stick, connect: force.connect, disconnect: force.disconnect, setting_up,
    set_up: (open) => {
      let_go();
      set_up(open);
    },
  };
}

/** Calls `let_go` when the hand may be gone: another window, a hidden or closed tab, a gamepad that was unplugged. */
function use_losses(let_go: () => void): void {
  use_listener("blur", let_go);
  use_listener("pagehide", let_go);
  use_listener("gamepaddisconnected", let_go);
  const latest = use_latest(let_go);
  useEffect(() => {
    const hide = () => document.hidden && latest.current();
    document.addEventListener("visibilitychange", hide);
    return () => document.removeEventListener("visibilitychange", hide);
  }, []);
}

interface ForceStick extends Pick<Hand, "stick" | "connect" | "disconnect"> { held: { current: PidStick | null } }

/** The stick that pushes back, from its choice until it is let go or unplugged. */
function use_force_stick(app: App): ForceStick {
  const held = useRef<PidStick | null>(null);
  const [stick, set_stick] = useState<PidStick | null>(null);
  const hold = (now: PidStick | null) => {
    held.current = now;
    set_stick(now);
  };
  const disconnect = () => {
    held.current?.close();
    hold(null);
  };
  const connect = async () => {
    const hid = hid_of();
    const device = hid && await choose_device(hid);
    if (!device) return;
    disconnect();
    hold(await PidStick.open(device, (why) => {
      hold(null);
      app.toast("warn", why);
    }));
  };
  useEffect(() => {
    const hid = hid_of();
    const unplugged = (e: Event) => held.current?.unplugged((e as Event & { device?: unknown }).device);
    hid?.addEventListener("disconnect", unplugged);
    return () => {
      hid?.removeEventListener("disconnect", unplugged);
      held.current?.close();
    };
  }, []);
  return { held, stick, disconnect, connect: async () => void await app.attempt(connect()) };
}

function same(a: object, b: object): boolean {
  return Object.entries(b).every(([key, value]) => (a as Record<string, unknown>)[key] === value);
}

/** The force on the hand: of the robot that this hand moves, while the server is heard. */
function felt(app: App, seat: Seat): { forward: number; left: number } {
  const live = seat.drives && app.link.is_open && app.link.silence < kOldForce && !app.ui.value.session?.stop;
  return live ? force_of(app.scene) : { forward: 0, left: 0 };
}

function use_seat_keys(seat: Seat): void {
  use_listener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || typing(e.target) || document.querySelector("dialog[open]")) return;
    if (e.target instanceof HTMLInputElement && e.code.startsWith("Arrow")) return; // a slider or a choice keeps them
    if (seat.key(e.code, true, e.repeat)) e.preventDefault();
  });
  use_listener("keyup", (e) => void seat.key(e.code, false));
}
