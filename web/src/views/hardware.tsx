// web/src/views/hardware.tsx: real hardware: the bar that every view shows, its devices, and how
// well the loop keeps its period.
import { JSX } from "preact";
import css from "../style/hardware.css?text";
import { use_app, use_ui } from "../app";
import { DeviceInfo, HardwareInfo } from "../contract";
import { Facts } from "../ui/controls";
import { Guard } from "../ui/guard";
import { adopt } from "../ui/sheet";
import { titled, watchers_words } from "../words";
import { disarmed_words } from "./hardware_words";

adopt(css);

/** A bar under the top bar: why the wheels stand still or may turn, and the Arm button. */
export function HardwareBar(): JSX.Element | null {
  const { session } = use_ui("session");
  const hardware = session?.hardware;
  if (session?.source !== "hardware") return null;
  const armed = hardware?.armed ?? false;
  const words = hardware?.trouble || (armed ? "Armed: the robot may move." : "Not armed.");
  const disarmed = hardware?.disarmed ?? null;
  const next = armed ? "It moves when a goal is sent off with Go." : "Arming moves nothing by itself.";
  return (
    <div class={`hardware-bar ${armed ? "armed" : ""}`} role="status" data-testid="hardware-bar">
      <p><b>{session.emulated ? "EMULATED DEVICES" : "REAL HARDWARE"}</b>
        <span data-testid="hardware-words">{words}</span>
        {disarmed && <span data-testid="disarmed">{disarmed_words(disarmed, words)}</span>}
        <span class="wide-only">{next}</span><span data-testid="watchers">{watchers_words(session)}</span></p>
      {hardware && <Guard need="operator"><ArmButton armed={armed} /></Guard>}
    </div>
  );
}

/** The robot cannot move before someone has pressed it. */
function ArmButton({ armed }: { armed: boolean }): JSX.Element {
  const app = use_app();
  return (
    <button class={`arm ${armed ? "armed" : ""}`} data-testid="arm" aria-pressed={armed}
      title={armed ? "Switches the motors off and clears the goals"
        : "Switches the motors on. The robot stands still until a goal is sent off"}
      onClick={() => void app.arm(!armed)}>{armed ? "Disarm" : "Arm motors"}</button>
  );
}

/** A card of the System view. */
export function Devices(props: { hardware: HardwareInfo }): JSX.Element {
  const h = props.hardware;
  return (
    <section class="card block" data-testid="devices">
      <h2>Devices</h2>
      {h.devices.map((d) => <Device key={d.name} device={d} />)}
      {h.warnings.map((w) => <p key={w} class="tone-warn device-words">{w}</p>)}
      <h2>Timing</h2>
      <dl class="facts-list">
        <div><dt>Real-time priority</dt><dd>{h.real_time ? "yes" : "not permitted: see tautline doctor"}</dd></div>
        <div><dt>Memory kept in place</dt><dd>{h.memory_locked ? "yes" : "not permitted"}</dd></div>
        <div><dt>Missed periods</dt><dd class="num">{h.missed_periods}</dd></div>
        <div><dt>Latest tick</dt><dd class="num">{milliseconds(h.lateness.worst)} ms late</dd></div>
        {h.lateness.buckets.filter((b) => b.ticks > 0).map((b) => (
          <div key={String(b.below)}>
            <dt>{b.below === null ? "later" : `less than ${milliseconds(b.below)} ms late`}</dt>
            <dd class="num">{b.ticks}</dd>
          </div>
        ))}
      </dl>
    </section>
  );
}

function Device(props: { device: DeviceInfo }): JSX.Element {
  const d = props.device;
  return (
    <div class="device" data-testid={`device-${d.name.replace(/ /g, "-")}`}>
      <p class={`device-words ${d.well ? "tone-ok" : "tone-bad"}`}>
        <b>{titled(d.name)}</b> {d.port}<br />{d.sentence}
      </p>
      {d.remarks.map((r) => <p key={r} class="device-words tone-warn">{r}</p>)}
      <Facts rows={Object.entries(d.facts).map(([name, value]) => [titled(name), value])} />
    </div>
  );
}

const milliseconds = (seconds: number): string => {
  const ms = seconds * 1000;
  return ms < 10 ? String(Number(ms.toFixed(1))) : ms.toFixed(0);
};
