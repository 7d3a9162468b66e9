// tests/web/teleop.mjs: driving by hand from the page: the drawn stick by mouse and touch, keys, gamepads, a stick that
// pushes back; nothing that is stuck, and nothing that goes on by itself. Then the driven run, replayed.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { force_stick } from "./force_stick.mjs";
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

/** Holds a key until the robot moves. When it never moves, the error holds the page's own words on the reason. */
const hold_key = (p, key) => p.hold_key(key, session, moves, async () => ({
  reason: await p.get("teleop-reason").textContent(),
  driver: await p.get("who-drives").textContent(),
}));

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
  await hold_key(p, "w");
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

/** A gamepad that a test moves: the page's own, with the function that sets its axes and pressed buttons. */
async function with_pad(p, { mapping = "standard", axes = 4, buttons = 17 } = {}) {
  await p.page.evaluate(([mapping, axes, buttons]) => {
    window.rumbled = 0;
    window.pad = {
      id: "Strange stick (Vendor: 1234)", mapping, axes: Array(axes).fill(0),
      buttons: Array.from({ length: buttons }, () => ({ pressed: false, value: 0 })),
      vibrationActuator: { playEffect: async () => void ++window.rumbled },
    };
    navigator.getGamepads = () => [null, window.pad];
  }, [mapping, axes, buttons]);
  return (axes, pressed = []) => p.page.evaluate(([axes, pressed]) => {
    window.pad.axes = axes;
    window.pad.buttons.forEach((b, i) => (b.pressed = pressed.includes(i)));
  }, [axes, pressed]);
}

test("by a gamepad: only while a bumper is held, B stops", { timeout: 120_000 }, async () => {
  const p = await seat();
  const set = await with_pad(p);
  await set([0, -1, 0, 0]);
  await p.page.waitForTimeout(600);
  assert.ok(rests(await session()), "no bumper is held");
  await p.pick_radio("stick-mode", "wall");
  await set([0, -1, 0, 0], [4]);
  await until("on its way", 10, session, moves);
  await until("a rumble", 30, () => p.page.evaluate(() => window.rumbled));
  await set([0, -1, 0, 0], [4, 1]);
  await until("stopped by B", 10, session, (s) => s.stop && rests(s));
  await set([0, 0, 0, 0]);
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);
  await p.get("release").waitFor({ state: "detached" }); // the page knows; then the middle comes first
  await p.page.waitForTimeout(200);
  await set([0, -1, 0, 0], [4]);
  await until("on its way again", 10, session, moves);
  await p.page.evaluate(() => {
    navigator.getGamepads = () => [null, null];
    dispatchEvent(new Event("gamepaddisconnected"));
  });
  await until("at rest without it", 10, session, rests);
  await p.close();
});

test("a strange gamepad moves nothing until it is set up by moving it; the keyboard reaches all of it", { timeout: 180_000 }, async () => {
  const p = await seat();
  const options = { mapping: "", axes: 3, buttons: 4 };
  let set = await with_pad(p, options);
  const rest = [0, 0, -1]; // the last axis is a lever
  await set([0, 1, -1], [0, 1, 2, 3]);
  await until("the words", 10, () => p.get("teleop-reason").textContent(), (t) => /moves nothing/.test(t));
  await p.page.waitForTimeout(400);
  assert.ok(rests(await session()), "its axes are not known");
  await set(rest);

  await p.get("pad-open").focus();
  await p.page.keyboard.press("Enter");
  const asks = (what) => until(`asked for ${what}`, 10, () => p.get("pad-ask").textContent(), (t) => t.includes(what));
  await asks("ahead");
  await set([0, 0, 0.4]); // too little
  await set([0, 0.9, -1]);
  await asks("Let go");
  await p.shot("teleop-pad-setup");
  await set(rest);
  await asks("left");
  await set([0.2, 0, 1]);
  await asks("does not rest in the middle");
  await set(rest);
  await set([-1, 0, -1]);
  await asks("Let go");
  await set(rest);
  await asks("hold while the robot drives");
  await set(rest, [3]);
  await asks("Let go");
  await set(rest);
  await asks("button for Stop");
  await set(rest, [0]);
  await asks("Everything is assigned");
  await set(rest);
  const told = (role) => p.get(`pad-${role}`).textContent();
  assert.deepEqual([await told("ahead"), await told("turn"), await told("run"), await told("stop")],
    ["Axis 1", "Axis 0, reversed", "Button 3", "Button 0"]);
  assert.deepEqual(await p.accessibility(), []);
  // Another button for hold-to-run, by keys; while it is set up the gamepad moves nothing.
  await p.get("assign-run").focus();
  await p.page.keyboard.press("Enter");
  await asks("hold while the robot drives");
  await set([0, 1, -1], [2]);
  await asks("Everything is assigned");
  await p.page.waitForTimeout(300);
  assert.ok(rests(await session()));
  await set(rest);
  await p.get("pad-save").focus();
  await p.page.keyboard.press("Enter");
  await p.get("pad-setup").waitFor({ state: "detached" });

  await set([0, 1, -1]);
  await p.page.waitForTimeout(400);
  assert.ok(rests(await session()), "its button is not held");
  await set([0, 1, -1], [2]);
  await until("ahead", 10, session, (s) => s.command.v > 0.1);
  await set([-1, 0, -1], [2]);
  await until("to the left", 10, session, (s) => s.command.omega > 0.05);
  await set([-1, 0, -1], [2, 0]);
  await until("stopped by its button", 10, session, (s) => s.stop && rests(s));
  await set(rest);
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);

  await p.page.reload();
  await p.get("hand-stick").waitFor();
  set = await with_pad(p, options);
  await set(rest); // the stick's middle comes first
  await p.page.waitForTimeout(300);
  await set([0, 1, -1], [2]);
  await until("ahead, as it was set up before", 10, session, (s) => s.command.v > 0.1);
  await set(rest);
  await p.get("pad-open").click();
  await p.get("pad-forget").click();
  await set([0, 1, -1], [2]);
  await until("the words again", 10, () => p.get("teleop-reason").textContent(), (t) => /moves nothing/.test(t));
  await p.close();
});

test("a force stick over WebHID is pushed, and let go by a blur, by Stop, by the hand, and unplugged", { timeout: 180_000 }, async () => {
  const p = await seat();
  await p.page.evaluate(`window.device = (${force_stick})()`);
  await p.page.evaluate(() => {
    const [{ usagePage, usage }] = window.device.collections; // browsers compare these only
    navigator.hid.requestDevice = async ({ filters }) =>
      (filters.some((f) => f.usagePage === usagePage && (f.usage ?? usage) === usage) ? [window.device] : []);
  });
  await p.get("force-open").click();
  await until("connected", 10, () => p.get("force-words").textContent(), (t) => /pushes Fake force stick/.test(t));
  const force = () => p.page.evaluate(() => ({ ...window.device.force, runs: window.device.runs, opened: window.device.opened }));
  const middle = await knob(p, 0, 0), ahead = await knob(p, 1, 0);
  const push = async () => {
    await p.page.mouse.move(middle.x, middle.y);
    await p.page.mouse.down();
    await p.page.mouse.move(ahead.x, ahead.y);
    return until("a force", 30, force, (f) => f.size > 0.1 && f.runs);
  };
  await p.pick_radio("stick-mode", "wall");
  const { angle } = await push();
  // Back and to a side: it comes from ahead.
  assert.ok(angle < 0.26 || angle > 0.74, String(angle));
  await until("its words", 10, () => p.get("push-words").textContent(), (t) => /Pushes/.test(t));
  await p.page.evaluate(() => dispatchEvent(new Event("blur")));
  await until("none after a blur", 10, force, (f) => f.size === 0);
  await p.page.mouse.up();
  await until("at rest", 10, session, rests);
  await push();
  await p.page.mouse.up();
  await until("none after letting go", 10, force, (f) => f.size === 0);
  await push();
  await p.page.keyboard.press(" ");
  await until("none after Stop", 10, force, (f) => f.size === 0);
  await p.page.mouse.up();
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);
  await p.get("force-close").click();
  await until("let go", 10, force, (f) => !f.opened && !f.runs);
  await p.get("force-open").click();
  await p.get("force-close").waitFor();
  await p.page.evaluate(() => navigator.hid.dispatchEvent(Object.assign(new Event("disconnect"), { device: window.device })));
  await p.get("force-open").waitFor();
  await p.page.getByText("Fake force stick was unplugged.").waitFor();
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

test("the world is seen from above, from behind the robot, and freely; the choice is kept", { timeout: 180_000 }, async () => {
  const p = await seat();
  await p.get("scene").waitFor();
  await p.pick_radio("eye", "follow");
  await p.get("scene-3d").locator("canvas").waitFor();
  assert.equal(await p.page.locator(".follow").count(), 0, "the camera rides behind the robot anyway");
  await hold_key(p, "w");
  await p.page.waitForTimeout(1500);
  await p.shot("teleop-desktop-follow");
  await p.page.keyboard.up("w");
  await p.pick_radio("eye", "free");
  await p.page.locator(".follow").waitFor();
  await p.page.reload();
  await p.get("scene-3d").locator("canvas").waitFor();
  // The small map shows the room, and becomes the large view.
  const colours = () => p.get("corner-map").locator("canvas").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
  await until("a small map", 10, colours, (count) => count > 20);
  await p.get("corner-map").click();
  await p.get("scene").waitFor();
  assert.equal(await p.get("corner-map").count(), 0);
  assert.deepEqual(await p.accessibility(), []);
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
    await until("it no longer says that the robot follows", 10, () => p.get("teleop-reason").textContent(), (w) => /^The robot is not heard/.test(w));
    await p.shot(`teleop-phone-${name}-lost`);
    await touch("touchEnd");
    await p.context.setOffline(false);
    await until("at rest", 10, session, rests);
    await until("it is heard again", 20, () => p.get("teleop-reason").textContent(), (w) => !/not heard/.test(w));
    assert.deepEqual(await p.accessibility(), []);
    await p.context.close();
  }
});

test("two thumbs on a phone held sideways: one holds the stick, the other picks a mode and presses Stop", { timeout: 120_000 }, async () => {
  const p = await seat({ size: { width: 844, height: 390 }, touch: true });
  const cdp = await p.context.newCDPSession(p.page);
  const touch = (type, ...touchPoints) => cdp.send("Input.dispatchTouchEvent", { type, touchPoints });
  const thumb = (id, at) => ({ ...at, id });
  const middle_of = async (what) => {
    const box = await what.boundingBox();
    return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  };
  const left = thumb(0, await knob(p, 0.5, 0));
  await touch("touchStart", thumb(0, await knob(p, 0, 0)));
  await touch("touchMove", left);
  await until("on its way", 10, session, (s) => s.command.v > 0.05);
  const tap = async (what) => {
    const right = thumb(1, await middle_of(what));
    assert.ok(right.x > 422, "at the right hand");
    await touch("touchStart", left, right);
    await touch("touchEnd", right);
  };
  await tap(p.get("stick-mode").locator('label:has(input[value="wall"])'));
  await until("the mode", 10, () => p.get("stick-mode").locator("input:checked").inputValue(), (v) => v === "wall");
  await until("still on its way", 10, session, moves);
  await p.shot("teleop-phone-two-thumbs");
  const stop = p.page.locator(".stop");
  assert.ok((await stop.boundingBox()).height >= 80, "found without a look");
  await tap(stop);
  await until("stopped", 10, session, (s) => s.stop && rests(s));
  await touch("touchEnd", left);
  await p.shot("teleop-phone-stopped");
  await p.get("release").click();
  await until("released", 10, session, (s) => !s.stop);
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

test("a driven run is replayed with its stick, its mode and its reasons, and nobody moves them", { timeout: 180_000 }, async () => {
  const p = await seat();
  await p.pick_radio("stick-mode", "wall");
  const middle = await knob(p, 0, 0), ahead = await knob(p, 0.9, 0.2);
  await p.page.mouse.move(middle.x, middle.y);
  await p.page.mouse.down();
  await p.page.mouse.move(ahead.x, ahead.y);
  await until("a limit", 30, () => p.get("speeds").textContent(), (t) => /Eq\. /.test(t));
  const { tick, robot, run } = await session();
  await p.page.waitForTimeout(500);
  await p.page.mouse.up();
  await until("at rest", 10, session, rests);
  await control("reset"); // ends the run
  await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), run.id);
  await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 60_000 });
  await p.get("deck").waitFor();
  assert.match(await p.get("driven-mode").textContent(), /Nobody/, "at its start");
  await p.get("timeline").fill(String(Number((tick * robot.period).toFixed(2))));
  await until("its mode", 10, () => p.get("driven-mode").textContent(), (t) => /mode Wall/.test(t));
  const label = () => p.get("hand-stick").getAttribute("aria-label");
  const before = await label();
  const found = before.match(/Stick: (\d+) % ahead, (\d+) %/);
  assert.ok(found && Math.abs(found[1] - 90) <= 2 && Math.abs(found[2] - 20) <= 2, before);
  const limited = async () => {
    const text = await p.get("speeds").textContent();
    if (!/Eq\. /.test(text)) await p.get("run-step").click();
    return text;
  };
  await until("a reason", 30, limited, (text) => /Eq\. /.test(text));
  await p.shot("run-driven");
  const box = await p.get("hand-stick").boundingBox();
  await p.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await p.page.mouse.down();
  await p.page.mouse.move(box.x + 10, box.y + 10);
  const after = (await label()).match(/Stick: (\d+) % ahead/);
  assert.ok(Math.abs(after[1] - 90) <= 2, "it is the record's");
  await p.page.mouse.up();
  assert.deepEqual(await p.accessibility(), []);
  await p.page.setViewportSize(phone);
  await p.page.waitForTimeout(400);
  await p.shot("run-driven-phone");
  await p.close();
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
    await hold_key(p, "w");
    await end(p);
    await until("at rest", 10, session, rests);
    await p.context.close();
  }
});
