// web/src/teleop/devices.tsx: the devices in the driver's hand, in words, and the buttons that set them up.
import { JSX } from "preact";
import { Hand, gamepad } from "./hand";
import { hid_of } from "./hid_pid";
import { PadSetup } from "./pad_setup";
import { map_of } from "./pads";

export function Devices(props: { hand: Hand; disabled: boolean }): JSX.Element {
  const { hand, disabled } = props;
  const mapped = hand.pad !== null && map_of(hand.pad) !== null;
  const force = hand.stick ? `The force pushes ${hand.stick.name}.`
    : hand.rumbles ? "Rumble and the arrow show the force." : "The arrow on the stick shows the force.";
  return (
    <div class="devices">
      {hand.pad !== null && (hand.strange || mapped) && (
        <button class={`ghost ${hand.strange ? "asks" : ""}`} data-testid="pad-open" disabled={disabled}
          onClick={() => hand.set_up(true)}>{mapped ? "Set up the gamepad again" : "Set up this gamepad"}</button>
      )}
      {hid_of() !== null && (hand.stick
        ? <button class="ghost" data-testid="force-close" onClick={hand.disconnect}>Let the force stick go</button>
        : <button class="ghost" data-testid="force-open" disabled={disabled}
            title="A joystick that pushes back, by the USB class of force feedback"
            onClick={() => void hand.connect()}>Connect a force stick</button>)}
      <p class="quiet" data-testid="force-words">{force}{hid_of() === null && " A stick that pushes back needs a browser with WebHID, over https or on this machine."}</p>
      {hand.setting_up && <PadSetup find={gamepad} on_close={() => hand.set_up(false)} />}
    </div>
  );
}
