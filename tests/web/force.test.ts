// tests/web/force.test.ts: forces on the driver's hand: rumble, and a HID-PID joystick whose reports are packed by its
// own descriptor.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Rumble } from "../../web/src/teleop/force";
import { PidStick, bearing_of, choose_device, hid_of } from "../../web/src/teleop/hid_pid";
import { Hid, HidDevice, HidItem, Layout, find_report } from "../../web/src/teleop/hid_report";
// @ts-expect-error: plain JavaScript, as a browser test sends it into the page
import { force_stick } from "./force_stick.mjs";

type Fake = HidDevice & {
  sent: [number, number[]][]; waits: number; gone: boolean; force: { size: number; angle: number }; block: number;
  effect: string | null; enabled: boolean; runs: boolean;
};
const fake = (): Fake => force_stick();
const settled = () => new Promise((done) => setTimeout(done, 5));
const unlost = (why: string) => assert.fail(why);
const of_id = (device: Fake, id: number) => device.sent.filter(([sent]) => sent === id).map(([, bytes]) => bytes);

const value = (usage: number, reportSize: number, more: HidItem = {}): HidItem =>
  ({ usages: [usage], reportSize, reportCount: 1, logicalMinimum: 0, logicalMaximum: 2 ** reportSize - 1, ...more });

test("values are packed bit by bit, least first, past constants", () => {
  const layout = new Layout(1, false, [value(1, 3), { isConstant: true, reportSize: 2, reportCount: 1 }, value(2, 12), value(3, 7)]);
  assert.equal(layout.bytes, 3);
  // 5 | 0xabc << 5 | 0x41 << 17 = 0x835785
  assert.deepEqual([...layout.pack(new Map([[1, 5], [2, 0xabc], [3, 0x41], [9, 1]]))], [0x85, 0x57, 0x83]);
  const data = new DataView(layout.pack(new Map([[1, 5], [2, 0xabc], [3, 0x41]])).buffer);
  assert.deepEqual([1, 2, 3, 9].map((usage) => layout.read(data, usage)), [5, 0xabc, 0x41, null]);
});

test("values are held within the field's range, also negative ones and unsigned maxima that were read as signed", () => {
  const layout = new Layout(0, false, [value(1, 8, { logicalMinimum: -100, logicalMaximum: 100 }), value(2, 16, { logicalMaximum: -1 })]);
  const packed = (one: number, two: number) => [...layout.pack(new Map([[1, one], [2, two]]))];
  assert.deepEqual(packed(-1, 0xfffe), [0xff, 0xfe, 0xff]);
  assert.deepEqual(packed(-500, 1e9), [156, 0xff, 0xff]);
  assert.deepEqual(packed(500, -3), [100, 0, 0]);
  assert.equal(layout.read(new DataView(new Uint8Array([156, 0, 0]).buffer), 1), -100);
});

test("no value has all bits set where that is outside of the range", () => {
  const layout = new Layout(0, false, [value(1, 8, { logicalMinimum: 1, logicalMaximum: 8 }), value(2, 8)]);
  assert.deepEqual([...layout.pack(new Map([[1, NaN], [2, NaN]]))], [0xff, 0]);
});

test("an array names a usage; several values share an item; a range counts up", () => {
  const layout = new Layout(0, false, [
    { isArray: true, usages: [70, 71, 72], reportSize: 8, reportCount: 1, logicalMinimum: 1, logicalMaximum: 3 },
    { usages: [5, 6], reportSize: 4, reportCount: 4, logicalMaximum: 15 },
    { isRange: true, usageMinimum: 20, usageMaximum: 21, reportSize: 8, reportCount: 2, logicalMaximum: 255 },
  ]);
  assert.deepEqual([...layout.pack(new Map([[72, 1], [70, 0], [5, 3], [6, 9], [21, 4]]))], [3, 0x93, 0, 0, 4]);
  assert.equal(layout.read(new DataView(new Uint8Array([2, 0, 0, 0, 0]).buffer), 71), 1);
  assert.equal(layout.read(new DataView(new Uint8Array([2, 0, 0, 0, 0]).buffer), 72), 0);
});

test("a received report may begin with its number; a short one has no value", () => {
  const layout = new Layout(6, true, [value(1, 8), value(2, 8)]);
  const read = (...bytes: number[]) => layout.read(new DataView(new Uint8Array(bytes).buffer), 2);
  assert.equal(read(6, 10, 20), 20);
  assert.equal(read(10, 20), 20);
  assert.equal(read(10), null);
});

test("a report is found by its collection, and taken whole from the root", () => {
  const part = value(0xf0070, 8), whole = [value(1, 8), part];
  const roots = [{ usagePage: 1, usage: 4, outputReports: [{ reportId: 3, items: whole }], children: [
    { usagePage: 0x0f, usage: 0x73, outputReports: [{ reportId: 3, items: [part] }] }] }];
  assert.equal(find_report(roots, 0xf0073)!.field(0xf0070)!.bit, 8);
  assert.equal(find_report(roots, 0xf0021), null);
});

test("a force comes from an angle, clockwise from ahead", () => {
  assert.equal(bearing_of(-1, 0), 0);    // pushes back: from ahead
  assert.equal(bearing_of(0, 1), 0.25);  // pushes left: from the right
  assert.equal(bearing_of(1, 0), 0.5);
  assert.equal(bearing_of(0, -1), 0.75);
});

test("opening makes one constant effect in the device's own block, without a force", async () => {
  const device = fake();
  await PidStick.open(device, unlost);
  assert.ok(device.opened && device.enabled);
  assert.equal(device.effect, "constant");
  assert.deepEqual(of_id(device, 22), [[4], [1]], "reset, then the actuators are on");
  assert.deepEqual(of_id(device, 23), [[250]], "full gain of the device");
  // Block 7; constant (2nd of its array); 500 ms; gain 200; no trigger; by direction; from ahead.
  assert.deepEqual(of_id(device, 11), [[7, 2, 0xf4, 1, 200, 0xff, 4, 0, 0, 0, 0]]);
  assert.equal(device.force.size, 0);
  assert.ok(!device.runs, "it starts with the first force");
});

test("the force has size and direction, is renewed, and ends at once", async () => {
  const device = fake();
  const stick = await PidStick.open(device, unlost);
  stick.set_force(-0.3, 0.4);
  await settled();
  assert.ok(Math.abs(device.force.size - 0.5) < 1e-3);
  assert.ok(Math.abs(device.force.angle - Math.atan2(0.4, 0.3) / (2 * Math.PI)) < 1e-3);
  assert.ok(device.runs);
  const starts = () => of_id(device, 20).length;
  assert.equal(starts(), 1);
  for (let i = 0; i < 10; ++i) {
    stick.set_force(-0.3, 0.4);
    await settled();
  }
  assert.equal(starts(), 3, "it lasts half a second, and is started anew twice in this half");
  assert.equal(of_id(device, 11).length, 2, "the direction is sent when it changes");
  stick.set_force(0, 0);
  await settled();
  assert.equal(device.force.size, 0);
  const sent = device.sent.length;
  stick.set_force(0, 0);
  await settled();
  assert.equal(device.sent.length, sent, "no force needs no reports");
});

test("forces that come while a report is on its way do not queue: the newest one counts", async () => {
  const device = fake();
  const stick = await PidStick.open(device, unlost);
  for (let i = 1; i <= 50; ++i) stick.set_force(-i / 100, 0);
  stick.set_force(0, 0);
  await settled();
  assert.equal(device.force.size, 0);
  assert.ok(of_id(device, 15).length <= 4, `${of_id(device, 15).length} reports`);
});

test("closing ends the force, frees the effect and lets the device go", async () => {
  const device = fake();
  const stick = await PidStick.open(device, unlost);
  stick.set_force(-1, 0);
  stick.close(); // while the force is on its way
  await settled();
  assert.equal(device.force.size, 0);
  assert.ok(!device.runs && !device.opened);
  assert.deepEqual(of_id(device, 25), [[7]]);
  stick.set_force(-1, 0);
  await settled();
  assert.equal(device.force.size, 0);
});

test("a device that is unplugged, or that refuses, is told once", async () => {
  for (const lose of [(stick: PidStick, device: Fake) => stick.unplugged(device), (stick: PidStick, device: Fake) => {
    device.gone = true;
    stick.set_force(-1, 0);
  }]) {
    const device = fake(), told: string[] = [];
    const stick = await PidStick.open(device, (why) => told.push(why));
    stick.unplugged(fake());
    assert.equal(told.length, 0, "another one");
    lose(stick, device);
    await settled();
    stick.unplugged(device);
    assert.equal(told.length, 1);
    assert.match(told[0], /Fake force stick (was unplugged|takes no more forces)/);
  }
});

test("what cannot push says so in a sentence", async () => {
  const reports: [string, Partial<Fake>][] = [
    ["offers no constant force", { collections: [{ usagePage: 1, usage: 5 }] }],
    ["could not be opened", { open: () => Promise.reject(new Error("NotAllowedError")) }],
    ["no room", { receiveFeatureReport: async () => new DataView(new Uint8Array([6, 0, 2, 0, 0]).buffer) }],
    ["did not take", { waits: 1000 }],
  ];
  for (const [why, broken] of reports) {
    const device = Object.assign(fake(), broken);
    await assert.rejects(PidStick.open(device, unlost), new RegExp(why));
    assert.ok(!device.opened, "it is not kept from others");
  }
});

test("of the chosen devices the one with a constant force is taken; none may be chosen", async () => {
  const usable = fake(), other = { ...fake(), collections: [] };
  const hid = (list: HidDevice[]) => ({ requestDevice: async (o: { filters: { usagePage: number; usage?: number }[] }) => {
    // As Chromium: only the outermost collections count.
    return list.filter((d) => o.filters.some((f) => d.collections.length === 0 ||
      d.collections.some((c) => c.usagePage === f.usagePage && (f.usage ?? c.usage) === c.usage)));
  } }) as unknown as Hid;
  assert.equal(await choose_device(hid([other, usable])), usable);
  assert.equal(await choose_device(hid([])), null);
  assert.equal(hid_of({}), null);
});

test("rumble has the size of the force, and is silent below what a hand feels", () => {
  const played: { strongMagnitude?: number }[] = [];
  const pad = { vibrationActuator: { playEffect: async (_: string, p: object) => void played.push(p) } };
  const rumble = new Rumble(() => pad as unknown as Gamepad);
  rumble.set_force(0.05, 0);
  rumble.set_force(NaN, 0);
  assert.equal(played.length, 0);
  rumble.set_force(-0.6, 0.8);
  rumble.set_force(-3, 0);
  assert.deepEqual(played.map((p) => p.strongMagnitude), [1, 1]);
  new Rumble(() => null).set_force(1, 0);
});
