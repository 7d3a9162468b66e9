// web/src/teleop/pad_setup.tsx: the dialog in which a person says what the axes and buttons of a gamepad do, while all
// of them are shown live.
import { JSX } from "preact";
import { useEffect, useMemo, useState } from "preact/hooks";
import { use_redraw } from "../state/store";
import { Dialog } from "../ui/controls";
import { fixed } from "../words";
import { Pad, PadEar, PadMap, Role, fits, keep_map, kRoles, map_of } from "./pads";
import { kSendEvery } from "./seat";

const kWords: Record<Role, { name: string; ask: string }> = {
  ahead: { name: "Ahead and back", ask: "Push the stick for the speed all the way ahead." },
  turn: { name: "Turn", ask: "Push the stick for the turn all the way to the left." },
  run: { name: "Hold to run", ask: "Press the button that you will hold while the robot drives." },
  stop: { name: "Stop", ask: "Press the button for Stop." },
};

/** `find`: the pad as it is now. Until it is closed the pad moves nothing. */
export function PadSetup(props: { find: () => Pad | null; on_close: () => void }): JSX.Element {
  const redraw = use_redraw();
  const [id] = useState(() => props.find()?.id ?? "");
  const ear = useMemo(() => {
    const ear = new PadEar();
    ear.map = { ...map_of(id) };
    const first = kRoles.find((role) => ear.map[role] === undefined);
    if (first) ear.begin(first);
    return ear;
  }, [id]);
  useEffect(() => {
    const beat = setInterval(() => {
      const now = props.find();
      if (now?.id === id) ear.hear(now);
      redraw();
    }, kSendEvery);
    return () => clearInterval(beat);
  }, [ear]);

  const now = props.find();
  const pad = now?.id === id ? now : null;
  const map = ear.complete;
  const close = (kept: PadMap | null | undefined) => {
    if (kept !== undefined) keep_map(id, kept);
    props.on_close();
  };
  return (
    <Dialog title="Set up this gamepad" name="pad-setup" on_close={() => close(undefined)}>
      <p class="quiet pad-name">{id}</p>
      <p class="pad-ask" role="status" data-testid="pad-ask">{question(ear, pad)}</p>
      <table class="pad-roles">
        <tbody>
          {kRoles.map((role) => (
            <tr key={role} class={ear.role === role ? "asked" : ""}>
              <th scope="row">{kWords[role].name}</th>
              <td class="num" data-testid={`pad-${role}`}>{answer(ear.map, role)}</td>
              <td><button class="ghost" data-testid={`assign-${role}`} aria-label={`${kWords[role].name}: assign`}
                onClick={() => ear.begin(role)}>Assign</button></td>
            </tr>
          ))}
        </tbody>
      </table>
      {pad && <PadState pad={pad} />}
      <div class="ways">
        <button class="small primary" disabled={!map || !pad || !fits(map, pad)} data-testid="pad-save"
          onClick={() => close(map)}>Use this gamepad</button>
        {map_of(id) && <button class="ghost" data-testid="pad-forget" onClick={() => close(null)}>Forget its setup</button>}
      </div>
    </Dialog>
  );
}

function question(ear: PadEar, pad: Pad | null): string {
  if (!pad) return "The gamepad is gone. Plug it in and press one of its buttons.";
  if (ear.remark) return ear.remark;
  if (ear.waits) return "Let go of all sticks and buttons.";
  return ear.role ? kWords[ear.role].ask : "Everything is assigned. Hold-to-run must be held while the robot drives.";
}

function answer(map: Partial<PadMap>, role: Role): string {
  const value = map[role];
  if (value === undefined) return "–";
  if (typeof value === "number") return `Button ${value}`;
  return `Axis ${value.axis}${value.sign < 0 ? ", reversed" : ""}`;
}

/** Every axis as a bar from its middle, every button as a lamp. */
function PadState(props: { pad: Pad }): JSX.Element {
  const { axes, buttons } = props.pad;
  return (
    <div class="pad-state" aria-hidden="true">
      {axes.map((value, i) => (
        <div class="pad-axis" key={i}>
          <span>Axis {i}</span>
          <svg viewBox="-1 0 2 1" preserveAspectRatio="none">
            <rect x={Math.min(0, value)} width={Math.min(1, Math.abs(value))} height="1" /><path d="M0 0V1" />
          </svg>
          <span class="num">{fixed(value, 2)}</span>
        </div>
      ))}
      <div class="pad-buttons">{buttons.map((b, i) => <i key={i} class={b.pressed ? "on" : ""}>{i}</i>)}</div>
    </div>
  );
}
