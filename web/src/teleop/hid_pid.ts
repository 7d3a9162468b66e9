// web/src/teleop/hid_pid.ts: a joystick that pushes back, by the USB class of force feedback (PID 1.0) over WebHID: one
// constant force, whose size and direction follow the robot. It ends by itself: a page that freezes pushes nobody.
// Source: USB Device Class Definition for Physical Interface Devices 1.0, sections 2 and 5.
import { ForceDevice } from "./force";
import { Hid, HidDevice, Layout, find_report } from "./hid_report";

const kPage = 0x0f;
const pid = (usage: number) => (kPage << 16) | usage;
// Collections, one for each report.
const kSetEffect = pid(0x21), kSetConstant = pid(0x73), kOperation = pid(0x77), kDeviceGain = pid(0x7d);
const kBlockLoad = pid(0x89), kBlockFree = pid(0x90), kCreate = pid(0xab);
const kControl = [pid(0x95), pid(0x96)];
// Fields.
const kIndex = pid(0x22), kConstant = pid(0x26), kDuration = pid(0x50), kGain = pid(0x52), kTrigger = pid(0x53);
const kByDirection = pid(0x56), kMagnitude = pid(0x70), kStart = pid(0x79), kStop = pid(0x7b), kLoops = pid(0x7c);
const kGainField = pid(0x7e), kLoaded = pid(0x8c), kFull = pid(0x8d), kEnable = pid(0x97), kReset = pid(0x9a);
const kFirstAxis = (0x0a << 16) | 1; // of the direction: ordinal 1; a polar angle lies there

const kLasts = 0.5;       // [s] a force that is not renewed
const kRenewEvery = 5;    // calls of set_force
const kFirstBlock = 1;  // of a device that does not tell which one it took
const kTries = 20;      // until the device has made room for the effect
const kTryAgain = 10;   // [ms]

type Values = [number, number][];

/** What WebHID offers here; null where it is missing, as without https and in browsers that have none. */
export function hid_of(from: object = navigator): Hid | null {
  return "hid" in from ? ((from as { hid?: Hid }).hid ?? null) : null;
}

/** Browsers compare with the whole device, not with its parts: mostly a joystick, gamepad or wheel with PID inside. */
const kFilters = [{ usagePage: kPage }, { usagePage: 1, usage: 4 }, { usagePage: 1, usage: 5 }, { usagePage: 2 }];

/** Lets a person choose a device; null: none was chosen. Must be called by a press. */
export async function choose_device(hid: Hid): Promise<HidDevice | null> {
  const chosen = await hid.requestDevice({ filters: kFilters });
  return chosen.find((d) => find_report(d.collections, kSetConstant)) ?? chosen[0] ?? null;
}

export class PidStick implements ForceDevice {
  readonly name: string;
  private wanted_ = { forward: 0, left: 0 };
  private angle_ = NaN;    // [turns] that the device has
  private calls_ = 0;      // of set_force, since the force began
  private sending_ = false;
  private closed_ = false;

  private constructor(private readonly device_: HidDevice, private readonly block_: number,
    private readonly effect_: Layout, private readonly force_: Layout, private readonly operation_: Layout,
    private readonly free_: Layout | null, private readonly lost_: (why: string) => void) {
    this.name = device_.productName || "force-feedback stick";
  }

  /** Opens `device` and starts a constant force of 0. `lost` is called once, if the device goes or refuses. Throws a
   * sentence if the device cannot do it. */
  static async open(device: HidDevice, lost: (why: string) => void): Promise<PidStick> {
    const named = device.productName || "This device";
    const need = (...usages: number[]) => {
      const found = find_report(device.collections, ...usages);
      if (!found) throw new Error(`${named} offers no constant force by the USB class of force feedback.`);
      return found;
    };
    const effect = need(kSetEffect), force = need(kSetConstant), operation = need(kOperation);
    if (!force.field(kMagnitude)) throw new Error(`${named} names no magnitude of a constant force.`);
    try {
      if (!device.opened) await device.open();
    } catch (error) {
      throw new Error(`${named} could not be opened. On Linux the browser needs leave to write to it (a udev rule). ${error}`);
    }
    try {
      const block = await ready(device, named);
      const free = find_report(device.collections, kBlockFree);
      const stick = new PidStick(device, block, effect, force, operation, free, lost);
      await stick.turn(0);
      await stick.push(0);
      return stick;
    } catch (error) {
      await device.close().catch(() => undefined);
      throw error;
    }
  }

  set_force(forward: number, left: number): void {
    const before = this.wanted_;
    if (forward === 0 && left === 0 && before.forward === 0 && before.left === 0) return;
    this.wanted_ = { forward, left };
    if (!this.sending_ && !this.closed_) void this.follow();
  }

  close(): void {
    if (this.closed_) return;
    this.wanted_ = { forward: 0, left: 0 };
    this.closed_ = true;
    void this.end();
  }

  /** Tells that the device is gone. */
  unplugged(device: unknown): void {
    if (device === this.device_) this.lose(`${this.name} was unplugged.`);
  }

  /** Sends the newest wish; what was wished meanwhile comes next, so that nothing queues. */
  private async follow(): Promise<void> {
    this.sending_ = true;
    try {
      for (let sent: object | null = null; sent !== this.wanted_ && !this.closed_;) {
        sent = this.wanted_;
        const { forward, left } = this.wanted_;
        const strength = Math.min(1, Math.hypot(forward, left));
        const angle = strength > 0 ? bearing_of(forward, left) : this.angle_;
        if (angle !== this.angle_) await this.turn(angle);
        if (this.closed_) break; // close() has ended the force
        await this.push(strength);
        this.calls_ = strength > 0 ? this.calls_ + 1 : 0;
        if (this.calls_ % kRenewEvery === 1) await this.start();
      }
    } catch (error) {
      this.lose(`${this.name} takes no more forces: ${error instanceof Error ? error.message : error}`);
    }
    this.sending_ = false;
  }

  private start(): Promise<void> {
    return send(this.device_, this.operation_, [[kIndex, this.block_], [kStart, 1], [kLoops, 1]]);
  }

  /** [turns] The whole effect again, with another direction. */
  private async turn(angle: number): Promise<void> {
    this.angle_ = angle;
    const axis = this.effect_.field(kFirstAxis);
    const span = axis ? axis.max - axis.min : 0;
    const lasts = kLasts / (this.effect_.field(kDuration)?.unit ?? 1);
    await send(this.device_, this.effect_, [
      [kIndex, this.block_], [kConstant, 1], [kDuration, lasts], [kGain, this.effect_.field(kGain)?.max ?? 0],
      [kTrigger, NaN], [kByDirection, 1], [kFirstAxis, (axis?.min ?? 0) + angle * span],
    ]);
  }

  /** `strength` of full force, in the direction of turn(). */
  private async push(strength: number): Promise<void> {
    const most = this.force_.field(kMagnitude)!.max;
    await send(this.device_, this.force_, [[kIndex, this.block_], [kMagnitude, strength * most]]);
  }

  private async end(): Promise<void> {
    try {
      await this.push(0);
      await send(this.device_, this.operation_, [[kIndex, this.block_], [kStop, 1]]);
      if (this.free_) await send(this.device_, this.free_, [[kIndex, this.block_]]);
      await this.device_.close();
    } catch {
      // It is gone; so is its force.
    }
  }

  private lose(why: string): void {
    if (this.closed_) return;
    this.closed_ = true;
    void this.device_.close().catch(() => undefined);
    this.lost_(why);
  }
}

async function send(device: HidDevice, to: Layout, values: Values): Promise<void> {
  const data = to.pack(new Map(values));
  await (to.feature ? device.sendFeatureReport(to.id, data) : device.sendReport(to.id, data));
}

/** Switches the device on, at its full gain, and returns the number of a new effect. */
async function ready(device: HidDevice, named: string): Promise<number> {
  const control = find_report(device.collections, ...kControl);
  if (control) {
    await send(device, control, [[kReset, 1]]);
    await send(device, control, [[kEnable, 1]]);
  }
  const gain = find_report(device.collections, kDeviceGain);
  if (gain) await send(device, gain, [[kGainField, gain.field(kGainField)?.max ?? 0]]);
  return make_effect(device, named);
}

/** The number of a new constant effect. A device without reports for that has its effects ready. */
async function make_effect(device: HidDevice, named: string): Promise<number> {
  const create = find_report(device.collections, kCreate);
  if (!create) return kFirstBlock;
  await send(device, create, [[kConstant, 1]]);
  const load = find_report(device.collections, kBlockLoad);
  if (!load) return kFirstBlock;
  for (let i = 0; i < kTries; ++i) {
    const data = await device.receiveFeatureReport(load.id);
    if (load.read(data, kLoaded) === 1) return load.read(data, kIndex) ?? kFirstBlock;
    if (load.read(data, kFull) === 1) throw new Error(`${named} has no room for another force. Close the program that uses it.`);
    await new Promise((done) => setTimeout(done, kTryAgain));
  }
  throw new Error(`${named} did not take the force.`);
}

/** [turns] Where a force comes from, clockwise from ahead: PID's angle. One that pushes the hand back comes from ahead. */
export function bearing_of(forward: number, left: number): number {
  const turns = Math.atan2(left, -forward) / (2 * Math.PI);
  return turns < 0 ? turns + 1 : turns + 0;
}
