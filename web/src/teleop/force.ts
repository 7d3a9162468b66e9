// web/src/teleop/force.ts: a device that pushes the driver's hand, behind one small interface; and rumble, which tells
// how strong a force is but not where to.

export interface ForceDevice {
  /** For people. */
  readonly name: string;
  /** A force on the hand, of full force: ahead and to the left are positive, each in [-1, 1]. Called every kSendEvery,
   * and at once with (0, 0) when the force ends. */
  set_force(forward: number, left: number): void;
  /** Ends the force and lets the device go. */
  close(): void;
}

const kWeakest = 0.1;  // of full force, that a hand feels in a pad
const kRumbleFor = 100; // [ms]; the next force comes before, and a lost page ends it

/** `pad`: the one in the hand now. */
export class Rumble implements ForceDevice {
  readonly name = "rumble";
  constructor(private readonly pad_: () => Pick<Gamepad, "vibrationActuator"> | null) {}

  get there(): boolean {
    return !!this.pad_()?.vibrationActuator;
  }

  set_force(forward: number, left: number): void {
    const strength = Math.min(1, Math.hypot(forward, left));
    if (!(strength >= kWeakest)) return;
    void this.pad_()?.vibrationActuator?.playEffect("dual-rumble", {
      duration: kRumbleFor, strongMagnitude: strength, weakMagnitude: strength / 2,
    }).catch(() => undefined);
  }

  close(): void {
    // The last effect ends by itself.
  }
}
