// tests/web/e2e.mjs: the page in a real browser against the real program. Run with
// TAUTLINE_BIN=build/release/server/tautline node --test tests/web/e2e.mjs
import assert from "node:assert/strict";
import { existsSync, mkdirSync, writeFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { join } from "node:path";
import { main_job } from "./main_job.mjs";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, repository, scratch, serve, until } from "./program.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

/** A server and a page on it, both gone afterwards. */
async function with_page(options, act) {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: options.scenario, more: options.more });
  try {
    const p = await open(browser, server.base, options);
    await act(p, server, place);
    await p.close();
  } finally {
    await server.stop();
    place.remove();
  }
}

for (const physics of ["bullet", "kinematic"]) {
  test(`the main job with ${physics} physics`, { timeout: 240_000 }, () =>
    with_page({ scenario: "demo" }, (p, { base }) => main_job(p, base, physics)));
}

test("by keyboard alone: goal, obstacle, undo, gain, stop and release", { timeout: 120_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    const key = (k) => p.page.keyboard.press(k);
    const session = () => json(base, "/session");
    await key("p");
    await until("paused", 10, session, (s) => s.pace.paused);
    const tick = (await session()).tick;
    await key(".");
    await until("one tick on", 10, session, (s) => s.tick === tick + 1);

    // A goal typed into its box, reached by Tab from the tools.
    await key("g");
    await p.get("goal-x").focus();
    await p.page.keyboard.type("2.5");
    await key("Tab");
    await p.page.keyboard.press("Control+A");
    await p.page.keyboard.type("4");
    await key("Enter");
    await key("Escape");
    await p.page.evaluate(() => document.activeElement.blur());
    const typed = (s) => s.goal && near(s.goal.y, 4, 1e-9);
    await until("the typed goal", 10, session, typed);

    // An obstacle placed at the crosshair, then moved by 0.1 m, undone, done again, removed.
    const before_add = (await session()).obstacles.length;
    await key("c");
    await p.get("scene").focus();
    for (let i = 0; i < 12; ++i) await key("ArrowLeft");
    await key("Enter");
    const added = await until("the obstacle", 10, session, (s) => s.obstacles.length === before_add + 1);
    const made = added.obstacles.at(-1);
    await until("it is selected", 5, () => p.page.locator('[data-testid="obstacle-values"]').count(), (n) => n === 1);
    await key("ArrowLeft");
    await until("it moved", 10, session, (s) => near(s.obstacles.find((o) => o.id === made.id).x, made.x - 0.1, 1e-6));
    await key("Control+z");
    await until("moved back", 10, session, (s) => near(s.obstacles.find((o) => o.id === made.id).x, made.x, 1e-6));
    await key("Control+Shift+Z");
    await until("moved again", 10, session, (s) => near(s.obstacles.find((o) => o.id === made.id).x, made.x - 0.1, 1e-6));
    await key("Delete");
    await until("removed", 10, session, (s) => s.obstacles.length === before_add);
    await key("Control+z");
    await until("it is back", 10, session, (s) => s.obstacles.length === before_add + 1);

    // A gain by its slider's arrows; the server holds it.
    const gain = (await session()).parameters.safety_distance;
    await p.get("gain-safety_distance").focus();
    await key("ArrowRight");
    await until("the gain", 10, session, (s) => s.parameters.safety_distance > gain);

    // Space stops, from a button as well, and never releases.
    await p.get("play").focus();
    await key("Space");
    await until("stopped", 10, session, (s) => s.stop);
    await key("Space");
    await new Promise((resolve) => setTimeout(resolve, 300));
    assert.equal((await session()).stop, true);
    assert.equal((await session()).pace.paused, true, "Space did not press the button in focus");
    await p.get("release").focus();
    await key("Enter");
    await until("released", 10, session, (s) => !s.stop);

    await key("?");
    await p.page.waitForSelector('[data-testid="shortcuts"]');
    await key("Escape");
    await p.page.waitForSelector('[data-testid="shortcuts"]', { state: "detached" });
  }));

test("a refusal of the server is shown, and the value is restored", { timeout: 60_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    await p.page.keyboard.press("p");
    const { pose } = await until("a pose", 10, () => json(base, "/session"), (s) => s.pose && s.pace.paused);
    // An obstacle on the robot itself.
    await p.get("tool-cylinder").click();
    const robot = await p.pixels(pose.x, pose.y);
    await p.page.mouse.click(robot.x, robot.y);
    const words = await until("a sentence", 10, () => p.get("toasts").textContent());
    assert.match(words, /robot/i);
    assert.equal((await json(base, "/session")).obstacles.length, 1);
    // A gain with which the strip could be pushed into an obstacle: S >= K_r d_safe.
    const slider = p.get("gain-k_r");
    const held = await slider.inputValue();
    await slider.fill(await slider.getAttribute("min"));
    await until("it went back", 10, () => slider.inputValue(), (v) => v === held);
    assert.ok((await p.get("toasts").textContent()).length > words.length, "the server's sentence is shown");
  }));

test("two pages at once: the last writer wins and both see it", { timeout: 60_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    const q = await open(browser, base, { theme: "light" });
    const value = async (page, id) => Number(await page.get(id).inputValue());
    for (const page of [p, q]) await page.page.keyboard.press("g");
    for (const [writer, x] of [[p, 2], [q, 2.5]]) {
      await writer.get("goal-x").fill(String(x));
      await writer.get("goal-set").click();
      for (const page of [p, q]) await until(`goal at ${x}`, 10, () => value(page, "goal-x"), (v) => v === x);
    }
    await q.page.keyboard.press("Escape");
    await q.get("stop").click();
    await until("stopped on the other page", 10, () => p.get("stop").getAttribute("aria-pressed"), (v) => v === "true");
    await p.get("release").click();
    await until("released on the other page", 10, () => q.get("stop").getAttribute("aria-pressed"), (v) => v === "false");
    await q.close();
  }));

test("the page reconnects by itself after the server was down", { timeout: 90_000 }, async () => {
  const place = scratch();
  let server = await serve({ database: place.database });
  const p = await open(browser, server.base);
  await until("frames", 10, () => p.get("link").textContent(), (w) => /[1-9]\d* frames/.test(w));
  await server.stop("SIGKILL");
  const words = await until("it is said", 15, () => p.page.locator('[data-testid="banner"]').textContent().catch(() => ""));
  assert.match(words, /Connection lost\. Trying/);
  // The drawing is grey and shows its growing age; a Stop shows that it did not arrive.
  const age = async () => Number((await p.get("stale").textContent()).match(/([\d.]+) s/)[1]);
  const first = await age();
  await until("the age grows", 10, age, (seconds) => seconds > first + 1);
  await p.get("stop").click();
  assert.match(await p.get("stop-alarm").textContent({ timeout: 3000 }), /Stop did NOT reach the robot/);
  await p.shot("drive-disconnected");
  server = await serve({ database: place.database, port: server.port });
  await p.page.waitForSelector('[data-testid="link"].open', { timeout: 20_000 });
  // The failed Stop is sent until it arrives.
  await until("the Stop arrived", 15, () => json(server.base, "/session"), (s) => s.stop);
  await p.get("stop-alarm").waitFor({ state: "detached" });
  assert.equal(await p.page.locator('[data-testid="stale"]').count(), 0);
  await until("frames again", 15, () => p.get("link").textContent(), (w) => /[1-9]\d* frames/.test(w));
  // The interrupted run is marked.
  const runs = await json(server.base, "/runs");
  assert.ok(runs.items.some((r) => r.status === "interrupted"), JSON.stringify(runs.items.map((r) => r.status)));
  await p.close(/WebSocket connection|ERR_CONNECTION|Failed to load resource|Failed to fetch/);
  await server.stop();
  place.remove();
});

test("on a phone: tap a goal, tune in the sheet, pinch, look at a run", { timeout: 90_000 }, () =>
  with_page({ scenario: "case1", size: phone, touch: true }, async (p, { base }) => {
    const at = await p.pixels(1.0, 4.0);
    // At rest a tap sets no goal; the goal tool takes one press.
    const { goal } = await json(base, "/session");
    await p.page.touchscreen.tap(at.x, at.y);
    await p.page.waitForTimeout(400);
    assert.deepEqual((await json(base, "/session")).goal, goal);
    await p.get("steps-act").click();
    const there = await p.pixels(1.0, 4.0);
    await p.page.touchscreen.tap(there.x, there.y);
    await until("the goal", 10, () => json(base, "/session"), (s) => s.goal && near(s.goal.x, 1, 0.06) && near(s.goal.y, 4, 0.06));
    const wide = await p.page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= phone.width, `the page is ${wide} px wide`);
    await p.get("tune").click();
    await p.page.waitForSelector('[data-testid="sheet"] [data-testid="gain-k_r"]');
    await p.shot("phone-sheet");
    await p.get("tune").click();
    await p.get("nav-runs").click();
    const { run } = await json(base, "/session");
    await p.get(`run-${run.id}`).click();
    await p.page.waitForSelector('[data-testid="run-view"]');
    await p.page.getByRole("link", { name: "Back to the list" }).click();
    await p.page.waitForSelector('[data-testid="run-table"]');
  }));

const logs = `${process.env.TAUTLINE_SHARED_DATA ?? `${repository}/../shared/data`}/laser`;
test("a recorded log plays through the page and is kept as a run", {
  timeout: 90_000, skip: existsSync(logs) ? false : `no ${logs}`,
}, () =>
  with_page({ scenario: "demo", more: ["--logs", logs] }, async (p, { base }) => {
    const { items } = await json(base, "/scenarios?limit=200");
    const log = items.find((s) => s.kind === "log");
    await p.load(log.name);
    await until("the badge", 10, () => p.get("source").textContent(), (w) => w === "Replay");
    await p.get("speed").selectOption("8");
    await until("scans go by", 20, () => p.get("figure-scans").textContent(), (n) => Number(n) > 30);
    assert.equal(await p.get("state").textContent(), "Replaying");
    assert.equal(await p.get("tool-goal").count(), 0, "a log takes no goals");
    await p.shot("drive-replay");
    const { run } = await json(base, "/session");
    await p.get("nav-runs").click();
    await p.get(`run-${run.id}`).click();
    await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
    await p.shot("runs-replay");
  }));

/** Keeps what comes over the WebSocket while `window.held` is a list; counts drawings of scenes. */
function hold_and_count() {
  const { set } = Object.getOwnPropertyDescriptor(WebSocket.prototype, "onmessage");
  Object.defineProperty(WebSocket.prototype, "onmessage", {
    set(act) {
      set.call(this, (event) => (window.held ? window.held.push(() => act(event)) : act(event)));
    },
  });
  window.draws = { seen: 0, left: 0 };
  const plain = CanvasRenderingContext2D.prototype.setTransform;
  CanvasRenderingContext2D.prototype.setTransform = function (...numbers) {
    if (this.canvas.classList.contains("scene-canvas")) ++window.draws[this.canvas.isConnected ? "seen" : "left"];
    return plain.apply(this, numbers);
  };
}

test("a scene that was left is no longer drawn; its view settles again on return", { timeout: 90_000 }, () =>
  with_page({ scenario: "demo" }, async (p, { base }) => {
    await p.page.addInitScript(hold_and_count);
    await p.page.reload();
    const control = (action) => json(base, "/session/control", { method: "POST", body: JSON.stringify({ action }) });
    await control("pause");
    await p.pixels(0, 0); // nothing is about to be drawn
    await p.page.evaluate(() => {
      const plain = window.cancelAnimationFrame;
      window.cancelAnimationFrame = () => undefined; // as on a quick machine, where its frame came before
      setTimeout(() => (window.cancelAnimationFrame = plain), 500);
      location.hash = "#/runs";
    });
    await p.get("scene").waitFor({ state: "detached" });
    await p.page.waitForTimeout(600);
    await control("play");
    await p.page.evaluate(() => {
      window.held = [];
      // Frames that come when the new canvas is there but not yet set up.
      new MutationObserver((_, watch) => {
        if (!document.querySelector(".scene-canvas")) return;
        watch.disconnect();
        requestAnimationFrame(() => {
          const { held } = window;
          window.held = null;
          for (const act of held) act();
        });
      }).observe(document.body, { childList: true, subtree: true });
    });
    await p.page.waitForFunction(() => window.held.length > 3);
    await p.page.evaluate(() => (location.hash = "#/drive"));
    await p.get("scene").waitFor();
    await p.page.waitForTimeout(500);
    await control("pause");
    await p.pixels(0, 0);
    const { seen, left } = await p.page.evaluate(() => window.draws);
    assert.ok(seen > 0);
    assert.equal(left, 0);
  }));

test("a user's robot is chosen in the page, and stays when the controller changes", { timeout: 90_000 }, async () => {
  const place = scratch();
  const robots = join(place.folder, "robots");
  mkdirSync(robots);
  writeFileSync(join(robots, "carrier.json"), JSON.stringify({
    name: "carrier", title: "Carrier", description: "Carries 200 kg.", hull: { length: 1.2, width: 0.7 }, mass: 200,
    track: 0.6, wheel_radius: 0.1, limits: { speed: 0.8, turn: 1.2 },
    lasers: [{ mount: { x: 0.55, y: 0, heading: 0 } }, { mount: { x: -0.55, y: 0, heading: 3.14159 } }],
  }));
  writeFileSync(join(robots, "broken.json"), '{"name": "broken", "hull": 3}');
  const server = await serve({ database: place.database, scenario: "case3", more: ["--robots", robots] });
  const p = await open(browser, server.base, {});
  const session = () => json(server.base, "/session");
  try {
    const pick = p.get("robot");
    assert.equal(await pick.inputValue(), "silvermate");
    assert.deepEqual(await pick.locator("option").evaluateAll((all) => all.map((o) => o.value)),
      ["jackal", "masuda", "robhaz", "robhaz_tall", "silvermate", "silvermate_arm", "carrier"]);
    await p.page.getByText("broken.json: limits: is missing").waitFor();
    await pick.selectOption("carrier");
    await until("the carrier drives", 20, session, (s) => s.robot.name === "carrier" && s.scenario.name === "case3");
    await p.page.getByText("Carries 200 kg.").waitFor();
    await p.get("controller").selectOption("strip");
    await until("the strip drives it", 20, session, (s) => s.controller === "strip" && s.robot.name === "carrier");
    await p.pick_radio("physics", "kinematic");
    await until("without dynamics", 20, session, (s) => s.physics === "kinematic" && s.robot.half_length === 0.6);
    await p.page.waitForTimeout(500);
    await p.shot("drive-carrier");
    await pick.selectOption("silvermate");
    await until("the first robot again", 20, session, (s) => s.robot.name === "silvermate" && s.controller === "strip");
  } finally {
    await p.close();
    await server.stop();
    place.remove();
  }
});

test("3D draws the same world; without WebGL it shows a message", { timeout: 90_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    await p.get("three").click();
    await p.page.waitForSelector('[data-testid="scene-3d"] canvas');
    await p.page.waitForTimeout(1500);
    await p.shot("drive-3d");
    await p.get("three").click();
    await p.page.waitForSelector('[data-testid="scene"]');
    const plain = await launch(["--disable-3d-apis"]);
    const q = await open(plain, base);
    await q.get("three").click();
    assert.match(await q.get("no-webgl").textContent(), /WebGL/);
    await q.page.getByRole("button", { name: "Show it from above" }).click();
    await q.page.waitForSelector('[data-testid="scene"]');
    await q.close(/WebGL|3d/i);
    await plain.close();
  }));

test("every view is accessible, in both themes; screenshots are kept", { timeout: 150_000 }, () =>
  with_page({ scenario: "case3", hash: "#/system" }, async (first, { base }) => {
    const control = (body) => json(base, "/session/control", { method: "POST", body: JSON.stringify(body) });
    await json(base, "/runs", { method: "POST", body: JSON.stringify({ scenario: "case1", seed: 1 }) })
      .then(({ runs }) => until("a finished run", 60, () => json(base, `/runs/${runs[0]}`), (r) => r.status === "finished"));
    // Part of the way is driven, then the world is paused so that the view stays still.
    await control({ action: "speed", speed: 8 });
    await until("some way", 30, () => json(base, "/session"), (s) => s.stamp > 14);
    await control({ action: "pause" });
    const faults = [];
    for (const theme of ["dark", "light"]) {
      for (const [name, size] of [["desktop", desktop], ["phone", phone], ["tablet", { width: 1024, height: 768 }]]) {
        const p = await open(browser, base, { theme, size });
        // A page opened while the world is paused shows its present state, not its start.
        await until("the newest instant", 10, () => p.get("time").textContent(), (t) => t > "00:13");
        await p.page.waitForTimeout(500);
        for (const view of ["drive", "teleop", "runs", "system"]) {
          await p.get(`nav-${view}`).click();
          if (view === "runs") {
            await p.page.locator("a.run-link").nth(size === phone ? 0 : 1).waitFor();
            if (size !== phone) await p.page.locator("tbody tr").nth(0).click();
            await p.page.waitForTimeout(900);
          }
          if (view === "teleop") await p.get("hand-stick").waitFor(); // fetched when first shown
          if (view === "system") await p.page.locator("dt", { hasText: "Drawing a frame" }).waitFor(); // fetched when first shown
          await p.shot(`${view}-${name}-${theme}`);
          if (name !== "tablet") {
            for (const fault of await p.accessibility()) faults.push(`${view} ${name} ${theme}: ${fault}`);
          }
        }
        await p.close();
      }
    }
    assert.deepEqual(faults, []);
    assert.ok(first);
  }));

test("a server that wants its token asks for it", { timeout: 90_000 }, async () => {
  const place = scratch();
  const token = "a token of our own";
  const server = await serve({ database: place.database, scenario: "demo", more: ["--token", token] });
  const context = await browser.newContext({ viewport: desktop });
  try {
    const page = await context.newPage();
    await page.goto(server.base);
    await page.getByTestId("token").fill("not this one");
    await page.getByTestId("login-go").click();
    await page.getByTestId("login-problem").waitFor({ timeout: 20_000 });
    assert.match(await page.getByTestId("login-problem").textContent(), /token/);
    await page.screenshot({ path: join(repository, "build/screenshots/login.png") });
    await page.getByTestId("token").fill(token);
    await page.getByTestId("login-go").click();
    await page.waitForSelector('[data-testid="link"].open', { timeout: 20_000 });
    assert.equal(await page.getByTestId("token").count(), 0);
  } finally {
    await context.close();
    await server.stop();
    place.remove();
  }
});
