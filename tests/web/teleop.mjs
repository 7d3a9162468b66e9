// tests/web/teleop.mjs: driving by hand from the page: the drawn stick by mouse and touch, keys, a gamepad; nothing
// that is stuck, and nothing that goes on by itself.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

let browser, server, place;
before(async () => {
  browser = await launch();
  place = scratch();
  server = await serve({ database: place.database, scenario: "demo" });
});
after(async () => {
  await browser?.close();
  await server?.stop();
  place?.remove();
});

const session = () => json(server.base, "/session");
const control = (action) => json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action }) });
const moves = (s) => Math.hypot(s.command.v, s.command.omega) > 0.005;
const rests = (s) => Math.hypot(s.command.v, s.command.omega) < 1e-9;

/** A page at the seat, with the robot at its start and without a goal. */
async function seat(options = {}) {
  await control("reset");
  await json(server.base, "/session/goal", { method: "DELETE" });
  const p = await open(browser, server.base, { hash: "#/teleop", ...options });
  await p.get("hand-stick").waitFor();
  return p;
}

async function knob(p, forward, turn) {
  const box = await p.get("hand-stick").boundingBox();
  const unit = Math.min(box.width, box.height) / 200 * 60;
  return { x: box.x + box.width / 2 - turn * unit, y: box.y + box.height / 2 - forward * unit };
}

test("by mouse: it drives while the stick is held, and stops when it is let go", { timeout: 120_000 }, async () => {
  const p = await seat();
  const middle = await knob(p, 0, 0), ahead = await knob(p, 0.6, 0);
  await p.page.mouse.move(middle.x, middle.y);
  await p.page.mouse.down();
  await p.page.mouse.move(ahead.x, ahead.y);
  const s = await until("on its way", 10, session, (s) => s.command.v > 0.1);
  assert.equal(s.behaviour, "manual");
  await until("a sentence", 10, () => p.get("teleop-reason").textContent(), (t) => /follows your stick/.test(t));
  await p.shot("teleop-desktop-driving");
  // Outside the drawing the pointer is still held.
  await p.page.mouse.move(ahead.x, 20);
  await until("still on its way", 10, session, moves);
  await p.page.mouse.up();
  await until("at rest", 10, session, rests);
  await p.pick_radio("stick-mode", "wall");
  await p.page.mouse.move(middle.x, middle.y);
  await p.page.mouse.down();
  await p.page.mouse.move(ahead.x, ahead.y);
  await until("what limits it", 20, () => p.get("teleop-reason").textContent(), (t) => /Slower|guard|wall/.test(t));
  await p.shot("teleop-desktop-wall");
  await p.page.mouse.up();
  await until("at rest again", 10, session, rests);
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

test("by keys: blur lets go, and a held key does not go on by itself", { timeout: 120_000 }, async () => {
  const p = await seat();
  await p.page.keyboard.down("w");
  await until("on its way", 10, session, (s) => s.command.v > 0.1);
  await p.page.evaluate(() => dispatchEvent(new Event("blur")));
  await until("at rest", 10, session, rests);
  await p.page.waitForTimeout(700);
  assert.ok(rests(await session()), "a key that is held through a blur moves nothing");
  await p.page.keyboard.up("w");
  await p.page.keyboard.down("ArrowLeft");
  await until("turning", 10, session, (s) => s.command.omega > 0.05);
  await p.page.keyboard.press(" ");
  await until("stopped by Space", 10, session, (s) => s.stop && rests(s));
  await p.page.keyboard.up("ArrowLeft");
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);
  await p.page.waitForTimeout(500);
  assert.ok(rests(await session()), "a release moves nothing");
  await p.close();
});

test("by a gamepad: only while a bumper is held, B stops, a strange one moves nothing", { timeout: 120_000 }, async () => {
  const p = await seat();
  await p.page.evaluate(() => {
    window.rumbled = 0;
    const buttons = Array.from({ length: 17 }, () => ({ pressed: false, value: 0 }));
    window.pad = { mapping: "standard", axes: [0, 0, 0, 0], buttons, vibrationActuator: { playEffect: async () => void ++window.rumbled } };
    navigator.getGamepads = () => [window.pad];
  });
  const set = (axes, pressed, mapping = "standard") => p.page.evaluate(([axes, pressed, mapping]) => {
    window.pad.axes = axes;
    window.pad.mapping = mapping;
    window.pad.buttons.forEach((b, i) => (b.pressed = pressed.includes(i)));
  }, [axes, pressed, mapping]);
  await set([0, -1, 0, 0], []);
  await p.page.waitForTimeout(600);
  assert.ok(rests(await session()), "no bumper is held");
  await set([0, -1, 0, 0], [4], "");
  await until("the words", 10, () => p.get("teleop-reason").textContent(), (t) => /moves nothing/.test(t));
  assert.ok(rests(await session()), "its axes are not known");
  await set([0, -1, 0, 0], [4]);
  await p.pick_radio("stick-mode", "wall");
  await until("on its way", 10, session, moves);
  await until("a rumble", 30, () => p.page.evaluate(() => window.rumbled));
  await set([0, -1, 0, 0], [4, 1]);
  await until("stopped by B", 10, session, (s) => s.stop && rests(s));
  await set([0, 0, 0, 0], []);
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);
  await p.close();
});

test("by touch on a phone, upright and sideways; a lost link is not resumed", { timeout: 180_000 }, async () => {
  for (const [name, size] of [["upright", phone], ["sideways", { width: 844, height: 390 }]]) {
    const p = await seat({ size, touch: true });
    const box = await p.get("hand-stick").boundingBox();
    assert.ok(box.width >= 150 && box.y + box.height <= size.height + 1 && box.x >= 0, `${name}: ${JSON.stringify(box)}`);
    const cdp = await p.context.newCDPSession(p.page);
    const touch = (type, at) => cdp.send("Input.dispatchTouchEvent", { type, touchPoints: at ? [at] : [] });
    await touch("touchStart", await knob(p, 0, 0));
    await touch("touchMove", await knob(p, 0.5, 0));
    await until("on its way", 10, session, (s) => s.command.v > 0.05);
    await p.shot(`teleop-phone-${name}`);
    await p.context.setOffline(true);
    await touch("touchEnd");
    await p.context.setOffline(false);
    await until("at rest", 10, session, rests);
    assert.deepEqual(await p.accessibility(), []);
    await p.context.close();
  }
});

test("a frozen tab and a closed one stop the robot within the watchdog's time", { timeout: 120_000 }, async () => {
  for (const end of [
    async (p) => {
      const cdp = await p.context.newCDPSession(p.page);
      await cdp.send("Debugger.enable");
      await cdp.send("Debugger.pause");
      p.page.evaluate("1 + 1").catch(() => undefined); // the page pauses here
    },
    (p) => p.page.close(),
  ]) {
    const p = await seat({ size: desktop });
    await p.page.keyboard.down("w");
    await until("on its way", 10, session, (s) => s.command.v > 0.1);
    await end(p);
    await until("at rest", 10, session, rests);
    await p.context.close();
  }
});
