// tests/web/hardware.mjs: the page on a robot with emulated scanner and base: arming, fault sentences,
// Stop, and all controls usable on a phone.
import assert from "node:assert/strict";
import { test } from "node:test";
import { arm, devices } from "./devices.mjs";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

/** Every button of the header and the hardware bar lies within the window. */
async function within_reach(p, size) {
  for (const button of await p.page.locator(".topbar button:visible, .hardware-bar button").all()) {
    const box = await button.boundingBox();
    const words = await button.textContent();
    assert.ok(box.x >= 0 && box.x + box.width <= size.width, `${words}: ${box.x} to ${box.x + box.width}`);
  }
}

test("emulated hardware: arm, drive, a silent scanner, the stop button, Stop", { timeout: 180_000 }, async () => {
  const place = scratch();
  const robot = await devices(place.folder);
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", robot.file] });
  const browser = await launch();
  const session = () => json(server.base, "/session");
  /** [m] In half a second. */
  const way = async () => {
    const from = (await session()).pose;
    await new Promise((resolve) => setTimeout(resolve, 500));
    const to = (await session()).pose;
    return Math.hypot(to.x - from.x, to.y - from.y);
  };
  try {
    for (const [name, size] of [["desktop", desktop], ["phone", phone]]) {
      const p = await open(browser, server.base, { size });
      const words = (about, pattern) =>
        until(about, 20, () => p.get("hardware-words").textContent(), (text) => pattern.test(text));
      await until("devices that are well", 30, session, (s) => s.hardware.devices.every((d) => d.well));
      await p.shot(`hardware-${name}-disarmed`);
      await within_reach(p, size);

      await arm(p, session);
      await words("armed", /may move/);
      await p.get("tool-goal").click();
      const at = await p.pixels(3, -1);
      await p.page.mouse.click(at.x, at.y);
      await p.get("go").click();
      await until("wheels that turn", 20, way, (metres) => metres > 0.01);

      robot.tell("scanner silence 2");
      await words("a silent scanner", /front laser|scanner is silent/);
      await until("rest", 10, way, (metres) => metres < 1e-4);
      await p.shot(`hardware-${name}-silent`);
      await until("disarmed, as it stood for long", 10, session, (s) => !s.hardware.armed);
      await words("a scanner that is lost", /looked for again/);
      await until("a scanner that is back", 30, session, (s) => s.hardware.devices.every((d) => d.well));
      await arm(p, session);

      robot.tell("stop on");
      await words("the stop button", /stop button/i);
      robot.tell("stop off");
      await p.get("stop").click();
      await p.get("release").waitFor();
      await p.shot(`hardware-${name}-stopped`);
      await within_reach(p, size);
      await p.get("release").click();
      await until("disarmed by the stop button", 20, session, (s) => !s.hardware.armed);
      await p.close();
    }
  } finally {
    await browser.close();
    await server.stop();
    robot.end();
    place.remove();
  }
});
