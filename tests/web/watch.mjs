// tests/web/watch.mjs: an armed, driving robot stops when its page is not visible or its Stop cannot be
// pressed; on emulated devices, in real time.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { arm, devices } from "./devices.mjs";
import { launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

const kMost = 3000; // [ms] from the last sign of life to wheels at zero and motors off
const kSign = 1400; // [ms] at most from one sign to the next, on a busy machine

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const put = (base, path, body, method = "PUT") => json(base, path, { method, body: JSON.stringify(body) });
const moves = (s) => Math.hypot(s.command.v, s.command.omega) > 0.005;

/** A page on an armed robot that is on its way, sent off as a person does it. */
async function with_driver(act, size) {
  const place = scratch();
  const robot = await devices(place.folder);
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", robot.file] });
  try {
    const p = await open(browser, server.base, size ? { size } : {});
    const session = () => json(server.base, "/session");
    await until("devices that are well", 30, session, (s) => s.hardware?.devices.every((d) => d.well) && s.hold === "halted");
    await act(p, server, session);
    await p.context.close();
  } finally {
    await server.stop();
    robot.end();
    place.remove();
  }
}

async function send_off(p, session) {
  await arm(p, session);
  await p.get("tool-goal").click();
  const at = await p.pixels(3, -1);
  await p.page.mouse.click(at.x, at.y);
  await p.get("go").click();
  await until("on its way", 20, session, moves);
  // Longer than the server's patience: the page keeps it going.
  await p.page.waitForTimeout(3500);
  assert.ok((await session()).hardware.armed, "a page that is looked at keeps the robot going");
}

const ends = {
  "a frozen tab": async (p) => {
    const cdp = await p.context.newCDPSession(p.page);
    await cdp.send("Debugger.enable");
    await cdp.send("Debugger.pause");
    p.page.evaluate("1 + 1").catch(() => undefined); // the page pauses here
  },
  "a tab whose scripts are off": async (p) => {
    const cdp = await p.context.newCDPSession(p.page);
    await cdp.send("Emulation.setScriptExecutionDisabled", { value: true });
  },
  "a hidden tab": async (p) => {
    // Headless Chromium reports every tab as visible; make the page see a hidden one.
    await p.page.evaluate(() => Object.defineProperty(document, "visibilityState", { get: () => "hidden" }));
  },
  "a closed tab": (p) => p.page.close(),
  "a page whose Stop is disabled": (p) =>
    p.page.evaluate(() => (document.querySelector("button.stop").disabled = true)),
  "a page whose Stop is covered": (p) => p.page.evaluate(() => {
    const cover = document.createElement("div");
    cover.style.cssText = "position:fixed;inset:0;z-index:999";
    document.body.append(cover);
  }),
};

for (const [name, end] of Object.entries(ends)) {
  test(`${name} stops and disarms the robot`, { timeout: 120_000 }, () =>
    with_driver(async (p, server, session) => {
      await send_off(p, session);
      assert.match(await p.get("watchers").textContent(), /watched by 1 page/);
      await end(p);
      const from = Date.now();
      const s = await until("disarmed and at rest", 20, session,
        (now) => !now.hardware.armed && !moves(now) && now.goal === null);
      const took = Date.now() - from;
      console.log(`# ${name}: wheels at zero and disarmed ${took} ms after`);
      assert.ok(took < kMost + kSign, `${took} ms`);
      assert.match(s.hardware.trouble, /Nobody has been watching/);
    }));
}

test("a stray tap, a pan, Arm with a goal waiting and Release move nothing", { timeout: 120_000 }, () =>
  with_driver(async (p, server, session) => {
    const rests = async (about) => {
      await p.page.waitForTimeout(700);
      const s = await session();
      assert.ok(!moves(s) && s.goal === null, about);
    };
    const at = await p.pixels(1.5, 0.5);
    await p.page.mouse.click(at.x, at.y);
    await p.drag(at, { x: at.x + 60, y: at.y + 40 });
    assert.equal(await p.get("preview").count(), 0, "at rest a press asks for nothing");
    await p.get("tool-goal").click();
    const goal = await p.pixels(3, -1);
    await p.page.mouse.click(goal.x, goal.y);
    assert.match(await p.get("preview-wait").textContent(), /Arm the motors first/);
    assert.ok(await p.get("go").isDisabled());
    await p.shot("hardware-phone-preview");
    await arm(p, session);
    await until("nothing holds it", 20, session, (s) => s.hold === "none");
    await rests("arming with a goal waiting");
    await p.get("stop").click();
    await until("stopped", 10, session, (s) => s.stop);
    await p.get("release").click();
    await until("released", 10, session, (s) => !s.stop);
    await rests("a release");
    await p.get("go").click();
    await until("on its way", 20, session, moves);
    await p.get("stop").click();
    await until("at rest, its goal cleared", 10, session, (s) => !moves(s) && s.goal === null);
    await p.get("release").click();
    await until("released", 10, session, (s) => !s.stop);
    await rests("a release after a goal");
    // A goal on a seen obstacle is reported before the robot drives.
    await p.get("tool-goal").click();
    await p.page.keyboard.press("f");
    const seen = await put(server.base, "/session/goal/check", { x: -20, y: 0 }, "POST");
    assert.match(seen.trouble, /nothing is known/);
  }, phone));
