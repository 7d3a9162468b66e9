// tests/web/layout.mjs: at five sizes and in every state robot, goal, Stop and the sentence are seen and can be
// pressed; the picture rests; what a first visit shows. Run like e2e.mjs.
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { after, before, test } from "node:test";
import { arm, devices } from "./devices.mjs";
import { launch, open, usual_theme } from "./page.mjs";
import { json, near, repository, scratch, serve, until } from "./program.mjs";

const kSizes = {
  desktop: { width: 1440, height: 900 }, zoomed: { width: 720, height: 450 }, upright: { width: 390, height: 844 },
  sideways: { width: 844, height: 390 }, small: { width: 320, height: 640 },
};
const kNotebooks = { notebook: { width: 1280, height: 800 }, narrow: { width: 1000, height: 700 } };
const kTouch = ["upright", "sideways", "small"];
const kPhones = ["upright", "small"]; // with tabs below, and a sheet

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const control = (base, body) => json(base, "/session/control", { method: "POST", body: JSON.stringify(body) });

/** A page of each size on one server; `act` gets it with the size's name. */
async function at_each_size(options, act, names = Object.keys(kSizes), sizes = kSizes) {
  const place = scratch();
  const server = await serve({ database: place.database, ...options });
  try {
    for (const name of names) {
      const p = await open(browser, server.base, { size: sizes[name], touch: kTouch.includes(name), theme: options.theme });
      await act(p, name, server);
      await p.close();
    }
  } finally {
    await server.stop().catch(() => undefined);
    place.remove();
  }
}

/** [px] Of robot and goal in the scene; null for what is not there. */
async function places(p, { pose, goal }) {
  const at = async (place) => (place ? p.pixels(place.x, place.y) : null);
  return { robot: await at(pose), goal: await at(goal) };
}

/** Sentences about what is covered, cut off or outside the window. */
async function faults_of(p, base, marks = undefined) {
  const { robot, goal } = marks ?? await places(p, await json(base, "/session"));
  return p.page.evaluate(({ robot, goal }) => {
    const faults = [];
    const name = (e) => (e ? e.dataset?.testid ?? e.className ?? e.tagName : "nothing");
    const shown = (e) => e !== null && e.getClientRects().length > 0;
    const [w, h] = [innerWidth, innerHeight];
    const hit = (what, x, y, inside) => {
      const top = document.elementFromPoint(x, y);
      if (!top || !inside(top)) faults.push(`${what} at ${x.toFixed(0)}, ${y.toFixed(0)} is under ${name(top)}`);
    };
    const whole = (selector, what) => {
      const e = document.querySelector(selector);
      if (!shown(e)) return void faults.push(`${what} is not shown`);
      const b = e.getBoundingClientRect();
      for (const [x, y] of [[0.5, 0.5], [0.08, 0.2], [0.92, 0.2], [0.08, 0.8], [0.92, 0.8]]) {
        hit(what, b.left + x * b.width, b.top + y * b.height, (top) => e.contains(top));
      }
      if (b.left < 0 || b.top < 0 || b.right > w + 0.5 || b.bottom > h + 0.5) faults.push(`${what} leaves the window`);
    };
    const mark = (e) => (e.dataset.note = String([...e.parentElement.children].indexOf(e)));
    const scene = document.querySelector(".scene-canvas");
    for (const [what, place] of Object.entries({ robot, goal })) if (place) hit(what, place.x, place.y, (top) => top === scene);
    whole("button.stop", "Stop");
    whole(".explain", "the sentence");
    if (!document.querySelector(".sheet, .preview, .toast, .layers, .values:not(.unasked)")) {
      whole('[data-testid="reset"]', "Reset");
      whole('[data-testid="play"]', "Play");
    }
    const sentence = document.querySelector(".explain");
    if (sentence.scrollHeight > sentence.clientHeight + 1) faults.push(`the sentence is cut off: ${sentence.textContent}`);
    const bar = document.querySelector(".hardware-bar");
    if (bar) {
      whole(".hardware-bar b", "REAL HARDWARE");
      whole(".arm", "Arm");
      if (shown(document.querySelector(".go"))) whole(".preview .acts", "Go and Discard");
    } else if (document.querySelector(".badge")) {
      const badge = document.querySelector(".badge");
      badge.style.pointerEvents = "auto";
      whole(".badge", "the badge");
      badge.style.pointerEvents = "";
    }
    const notes = document.querySelector(".notes");
    if (!document.querySelector(".sheet, .preview, .toast, .values") && notes && notes.scrollHeight <= notes.clientHeight + 1) {
      for (const note of notes.children) if (shown(note)) whole(`[data-note="${mark(note)}"]`, `the note "${note.textContent.slice(0, 30)}"`);
    }
    if (document.documentElement.scrollWidth > w || document.documentElement.scrollHeight > h) faults.push("the page scrolls");
    for (const e of document.querySelectorAll(".shell > *, .shell button, .shell select, .shell a, .toast")) {
      if (!shown(e)) continue;
      const b = e.getBoundingClientRect();
      const scroller = e.parentElement.closest(".tools, .panel, .sheet, .layer-groups, .rail, .values, .notes, .preview, .toasts");
      const box = scroller?.getBoundingClientRect() ?? { left: 0, top: 0, right: w, bottom: h };
      const along = scroller && getComputedStyle(scroller);
      const x_free = along && /auto|scroll/.test(along.overflowX);
      const y_free = along && /auto|scroll/.test(along.overflowY);
      if (b.width === 0 || b.height === 0) continue;
      if (!x_free && (b.left < box.left - 0.5 || b.right > box.right + 0.5)) faults.push(`${name(e)} leaves its room sideways: ${e.textContent.slice(0, 30)}`);
      if (!y_free && (b.top < box.top - 0.5 || b.bottom > box.bottom + 0.5)) faults.push(`${name(e)} leaves its room: ${e.textContent.slice(0, 30)}`);
    }
    return faults;
  }, { robot, goal });
}

async function assert_clear(p, base, what, marks = undefined) {
  assert.deepEqual(await faults_of(p, base, marks), [], what);
}

const shot = (p, size, state, theme = usual_theme) => p.shot(`layout-${size}-${state}-${theme}`);

for (const theme of ["dark", "light"]) {
  test(`running, with each panel, toasts and Stop, ${theme}`, { timeout: 240_000 }, () =>
    at_each_size({ scenario: "demo", theme }, async (p, size, { base }) => {
      await control(base, { action: "reset" });
      await control(base, { action: "play" });
      const check = async (state) => {
        await assert_clear(p, base, `${size}, ${state}`);
        await shot(p, size, state, theme);
      };
      const layers = await p.page.locator('[data-testid="layer-panel"]').count();
      await check("running");
      await p.get("layers").click();
      await check(layers ? "no-layers" : "layers");
      if (kPhones.includes(size)) { // where the panel covers its button
        await p.page.getByRole("region", { name: "Layers" }).getByRole("button", { name: "Close" }).click();
        await p.get("tune").click();
        await p.get("tab-signals").last().click();
        await check("sheet");
        await p.get("tune").click();
      } else {
        await p.get("layers").click();
      }
      await p.page.keyboard.press("n");
      await p.get("goal-values").waitFor();
      await check("goal-values");
      // Three warnings that differ in numbers only are one toast: goals inside a cylinder.
      const set_goal = async (x, y) => {
        await p.get("goal-x").fill(String(x));
        await p.get("goal-y").fill(String(y));
        await p.get("goal-y").press("Enter");
      };
      const toasts = p.page.locator(".toast");
      for (const [x, pattern] of [[5.2, /goal/i], [5.21, /×2/], [5.22, /×3/]]) {
        await set_goal(x, 0.6);
        await until(`${size}: a toast with ${pattern}`, 10, () => toasts.allTextContents(), (all) => all.length === 1 && pattern.test(all[0]));
      }
      await check("toasts");
      await set_goal(7.5, 3.6);
      await p.page.keyboard.press("Escape");
      await p.page.evaluate(() => document.activeElement.blur());
      const obstacle = p.page.getByTestId("obstacle-values");
      for (let i = 0; i < 5 && await obstacle.count() === 0; ++i) {
        await p.page.keyboard.press("n");
        await p.page.waitForTimeout(200);
      }
      await obstacle.waitFor();
      await check("obstacle-values");
      assert.equal(await p.get("steps").isVisible(), size === "desktop", `${size}: where room is short the steps make way for the numbers`);
      await p.page.keyboard.press("Escape");

      await p.get("stop").click();
      await p.get("release").waitFor();
      await check("stopped");
      await p.get("release").click();
      await p.get("release").waitFor({ state: "detached" });
    }));
}

test("stuck, arrived and paused before the start", { timeout: 240_000 }, () =>
  at_each_size({ scenario: "wall" }, async (p, size, { base }) => {
    await control(base, { action: "load", scenario: "wall", controller: "potential_field" });
    await control(base, { action: "speed", speed: 0 });
    await control(base, { action: "play" });
    await until("stuck", 60, () => p.get("state").textContent(), (w) => w === "Stuck");
    await assert_clear(p, base, `${size}, stuck`);
    await shot(p, size, "stuck");
    await control(base, { action: "load", scenario: "case1", controller: "modified" });
    await control(base, { action: "speed", speed: 0 });
    await until("arrived", 60, () => p.get("state").textContent(), (w) => w === "Arrived");
    assert.match(await p.get("next").textContent(), /another goal.*Reset/, "it says what to do next");
    await assert_clear(p, base, `${size}, arrived`);
    await shot(p, size, "arrived");
    await control(base, { action: "pause" });
    await p.get("reset").click();
    await until("said calmly", 10, () => p.get("explain").textContent(), (w) => /Paused at the start/.test(w));
    assert.match(await p.get("explain").getAttribute("class"), /tone-info/, "no warning");
    await assert_clear(p, base, `${size}, paused`);
    await shot(p, size, "paused");
    p.forgive(/404/); // a run that was left before its first tick was recorded
  }));

test("nothing loaded yet, and disconnected", { timeout: 180_000 }, async () => {
  for (const [size, window] of Object.entries(kSizes)) {
    const place = scratch();
    const server = await serve({ database: place.database, scenario: "case3" });
    const context = await browser.newContext({ viewport: window, colorScheme: "dark" });
    const page = await context.newPage();
    await page.addInitScript(() => { window.WebSocket = class { static OPEN = 1; send() {} close() {} }; });
    await page.goto(server.base);
    await page.getByTestId("explain").getByText("Waiting for the server").waitFor();
    assert.deepEqual(await faults_of({ page }, server.base, {}), [], `${size}, nothing loaded`);
    await context.close();

    const p = await open(browser, server.base, { size: window });
    await until("frames", 10, () => p.get("time").textContent(), (t) => t > "00:01");
    const last = await json(server.base, "/session");
    await server.stop("SIGKILL");
    await p.get("banner").waitFor();
    await p.get("stale").waitFor();
    await p.page.waitForTimeout(600);
    assert.deepEqual(await faults_of(p, server.base, await places(p, last)), [], `${size}, disconnected`);
    await shot(p, size, "disconnected");
    await p.close(/WebSocket connection|ERR_CONNECTION|Failed to load resource|Failed to fetch/);
    place.remove();
  }
});

const logs = `${process.env.TAUTLINE_SHARED_DATA ?? `${repository}/../shared/data`}/laser`;
test("a log is replayed", { timeout: 120_000, skip: existsSync(logs) ? false : `no ${logs}` }, () =>
  at_each_size({ scenario: "demo", more: ["--logs", logs] }, async (p, size, { base }) => {
    const { items } = await json(base, "/scenarios?limit=200");
    await control(base, { action: "load", scenario: items.find((s) => s.kind === "log").name });
    await control(base, { action: "play" });
    await until("the badge", 20, () => p.get("source").textContent(), (w) => w === "Replay");
    await until("scans go by", 20, () => p.get("figure-scans").textContent(), (n) => Number(n) > 30);
    await control(base, { action: "pause" });
    await assert_clear(p, base, `${size}, replaying`);
    await shot(p, size, "replaying");
  }));

test("hardware: disarmed, with a goal that is not sent yet, armed and driving, held, stopped", { timeout: 300_000 }, async () => {
  const place = scratch();
  const robot = await devices(place.folder);
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", robot.file] });
  const { base } = server;
  const session = () => json(base, "/session");
  try {
    for (const [size, window] of Object.entries(kSizes)) {
      const p = await open(browser, base, { size: window, touch: kTouch.includes(size) });
      const check = async (state) => {
        await assert_clear(p, base, `${size}, ${state}`);
        await shot(p, size, `hardware-${state}`);
      };
      await until("devices that are well", 30, session, (s) => s.hardware.devices.every((d) => d.well));
      await check("disarmed");
      await p.get("tool-goal").click();
      const { pose } = await session();
      const at = await p.pixels(pose.x + 1.5, pose.y - 0.5);
      await p.page.mouse.click(at.x, at.y);
      await p.get("preview").waitFor();
      await check("preview");
      await arm(p, session);
      await p.get("go").click();
      await until("a goal", 10, session, (s) => s.goal);
      await check("armed");
      robot.tell("scanner silence 2");
      await until("held", 20, () => p.get("state").textContent(), (w) => w === "Held");
      await check("held");
      await p.page.waitForTimeout(2500); // the silence is over; before, the device may still count as well
      await until("a scanner that is back", 30, session, (s) => s.hardware.devices.every((d) => d.well));
      await p.get("stop").click();
      await p.get("release").waitFor();
      await check("stopped");
      await p.get("release").click();
      await until("released", 10, session, (s) => !s.stop);
      if ((await session()).hardware.armed) await p.get("arm").click();
      await until("disarmed", 20, session, (s) => !s.hardware.armed);
      await p.close();
    }
  } finally {
    await server.stop();
    robot.end();
    place.remove();
  }
});

test("the picture rests: after a goal, a longer sentence, a selection, Stop; Fit brings all into the free area", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size, { base }) => {
    await control(base, { action: "reset" });
    await control(base, { action: "play" });
    const mark = () => p.pixels(2, 2);
    const first = await mark();
    const rests = async (what) => {
      await p.page.waitForTimeout(700);
      const now = await mark();
      assert.ok(near(now.x, first.x, 0.5) && near(now.y, first.y, 0.5), `${size}: the picture went after ${what}: ${JSON.stringify([first, now])}`);
    };
    await p.get("tool-goal").click();
    const goal = await p.pixels(9, 5);
    await p.page.mouse.click(goal.x, goal.y);
    await until("the goal", 10, () => json(base, "/session"), (s) => near(s.goal.x, 9, 0.1));
    await rests("a goal");
    await p.page.evaluate(() => {
      const long = document.querySelector(".explain").appendChild(document.createElement("i"));
      long.textContent = "A sentence of some length, which says a great deal about what is near and why. ".repeat(2);
    });
    await rests("a longer sentence");
    await p.page.evaluate(() => document.querySelector(".explain i").remove());
    await p.get("tool-pan").click();
    await p.page.keyboard.press("n");
    await rests("a selection");
    await p.page.keyboard.press("Escape");
    await rests("no selection");
    await p.get("stop").click();
    await p.get("release").waitFor();
    await rests("Stop");
    await p.get("release").click();
    // Moved away by hand, then fitted.
    await p.page.keyboard.press("+");
    await p.page.keyboard.press("+");
    await p.page.keyboard.press("+");
    await p.get("fit").click();
    await p.page.waitForTimeout(300);
    await assert_clear(p, base, `${size}, fitted`);
  }));

test("twelve and more tools are each within reach, 44 px large", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size) => {
    await p.page.evaluate(() => {
      const tools = document.querySelector(".tools");
      for (let i = 0; i < 6; ++i) tools.insertBefore(tools.children[1].cloneNode(true), tools.children[1]);
    });
    const { width: w, height: h } = kSizes[size];
    for (const tool of await p.page.locator(".tools button:visible").all()) {
      // The bar snaps after a scroll, and again when the page around it changes; what counts is that a scroll reaches the tool.
      const { width, height } = await until(`${size}: a tool within the window`, 5, async () => {
        await tool.scrollIntoViewIfNeeded();
        return tool.boundingBox();
      }, (b) => b.x > -1 && b.y > -1 && b.x + b.width < w + 1 && b.y + b.height < h + 1);
      assert.ok(width >= 44 && height >= 44, `${size}: ${width} x ${height}`);
    }
    await shot(p, size, "many-tools");
  }));

test("a small notebook: no note lies on a tool, with the layers and without", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, name) => {
    await p.get("steps").waitFor();
    for (let k = 0; k < 2; ++k) {
      const covered = await p.page.locator(".tools button").evaluateAll((all) => all.filter((e) => {
        e.scrollIntoView({ block: "nearest" });
        const { x, y, width, height } = e.getBoundingClientRect();
        return !document.elementFromPoint(x + width / 2, y + height / 2)?.closest(".tools");
      }).map((e) => e.title));
      assert.deepEqual(covered, [], `${name}, ${await p.get("layers").getAttribute("aria-expanded")}`);
      await p.shot(`layout-${name}-steps-${k}`);
      await p.page.keyboard.press("l");
    }
  }, Object.keys(kNotebooks), kNotebooks));

test("what a finger presses is 44 px large", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size) => {
    const small = () => p.page.evaluate(() => [...document.querySelectorAll(
      ".shell :is(button:not(.mark-event), select, .segments label, input:not([type=radio])), .rail a")].filter((e) => { // the slider reaches the marks on it
      const b = e.getBoundingClientRect();
      return e.getClientRects().length > 0 && (b.height < 43.5 || (b.width < 43.5 && !e.matches(".segments label")));
    }).map((e) => `${e.dataset.testid ?? e.ariaLabel ?? e.className} ${e.getBoundingClientRect().width.toFixed(0)} x ${e.getBoundingClientRect().height.toFixed(0)}`));
    assert.deepEqual(await small(), [], size);
    if (kPhones.includes(size)) {
      await p.get("tune").click();
      assert.deepEqual(await small(), [], `${size}, sheet`);
      await p.get("tune").click();
    }
    await p.get("layers").click();
    assert.deepEqual(await small(), [], `${size}, layers`);
    await p.page.keyboard.press("l");
    await p.page.keyboard.press("n");
    await p.get("goal-values").waitFor();
    assert.deepEqual(await small(), [], `${size}, values`);
  }, kTouch));

test("on a phone: no word of help, tabs, System and the list of scenarios is cut off, and no number lies under a button", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size) => {
    const within = (selector) => p.page.evaluate((selector) => {
      const faults = [];
      if (document.documentElement.scrollWidth > innerWidth) faults.push("the page scrolls sideways");
      for (const e of document.querySelectorAll(selector)) {
        const b = e.getBoundingClientRect();
        if (b.left < -0.5 || b.right > innerWidth + 0.5) faults.push(`${e.textContent.slice(0, 20)} leaves the window`);
        if (e.scrollWidth > e.clientWidth + 1) faults.push(`${e.textContent.slice(0, 20)} is cut off`);
      }
      return faults;
    }, selector);
    const rail = await p.page.locator(".rail span").evaluateAll((all) => all.map((e) => e.getBoundingClientRect()).map(({ left, right }) => [left, right]));
    rail.slice(1).forEach(([left], i) => assert.ok(left > rail[i][1] + 2, `${size}: tab ${i + 1} touches the next one`));
    await p.get("scenario-menu").click();
    await p.page.locator(".menu-list").waitFor();
    assert.deepEqual(await within(".menu-list, .menu-list input"), [], `${size}, scenarios`);
    await p.page.keyboard.press("Escape");
    const keys = await p.page.locator(".tools button[title]").evaluateAll((all) =>
      all.flatMap((e) => e.title.match(/\((.*)\)$/)?.[1].split(", ") ?? []));
    await p.get("help").click();
    await p.get("shortcuts").waitFor();
    assert.deepEqual(await within('[data-testid="shortcuts"], [data-testid="shortcuts"] td'), [], `${size}, help`);
    const told = await p.page.locator('[data-testid="shortcuts"] tr:not(:has(td:text("Teleop"))) kbd').allTextContents();
    assert.ok(keys.length > 10 && keys.every((key) => told.includes(key)), `the help tells the keys of all tools: ${keys}; it tells ${told}`);
    await p.page.keyboard.press("Escape");
    await p.get("tune").click();
    await p.get("tab-robot").last().waitFor();
    await p.get("sheet").evaluate((e) => e.scrollTo(0, e.scrollHeight));
    assert.ok(await p.get("tab-robot").last().evaluate((e) => {
      const b = e.getBoundingClientRect();
      return e.contains(document.elementFromPoint(b.left + b.width / 2, b.top + b.height / 2));
    }), `${size}: the tabs stay where their button is`);
    await p.get("tune").click();
    await p.page.evaluate(() => (location.hash = "#/system"));
    await p.get("clients").waitFor();
    assert.deepEqual(await within(".topbar .menu-name, .keys-block td"), [], `${size}, system`);
    assert.ok(await p.page.locator(".clients th").first().evaluate((e) => e.clientHeight < 40), `${size}: a word of the table is broken`);
  }, kPhones));

test("a first visit: three steps that lead on, are dismissed and remembered; help in the bar", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size, { base }) => {
    await control(base, { action: "load", scenario: "demo" });
    await control(base, { action: "play" });
    assert.match(await p.get("steps").textContent(), /^1\/3/);
    await p.get("steps-act").click();
    const goal = await p.pixels(4, 2);
    await p.page.mouse.click(goal.x, goal.y);
    await until("the second step", 10, () => p.get("steps").textContent(), (w) => /^2\/3/.test(w));
    await p.page.keyboard.press("Escape");
    await p.get("steps-act").click();
    const way = await p.pixels(7, 5);
    await p.page.mouse.click(way.x, way.y);
    await until("the third step", 10, () => p.get("steps").textContent(), (w) => /^3\/3/.test(w));
    await p.page.reload();
    await until("it is remembered", 20, () => p.get("steps").textContent(), (w) => /^3\/3/.test(w));
    await p.get("steps-close").click();
    await p.get("steps").waitFor({ state: "detached" });
    await p.page.reload();
    await p.page.waitForSelector('[data-testid="link"].open');
    assert.equal(await p.page.getByTestId("steps").count(), 0, "dismissed for good");
    await p.get("help").click();
    await p.get("shortcuts").waitFor();
    await p.get("steps-again").click();
    await until("they can be read again", 10, () => p.get("steps").textContent(), (w) => /^1\/3/.test(w));
  }));

test("a new experiment is checked and started without scrolling", { timeout: 120_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size) => {
    await p.page.evaluate(() => (location.hash = "#/experiments"));
    await p.get("new-experiment").click();
    for (const act of ["experiment-check", "experiment-start"]) {
      const hidden = await p.get(act).evaluate((e) => {
        const b = e.getBoundingClientRect();
        return ![0.1, 0.5, 0.9].every((share) => e.contains(document.elementFromPoint(b.left + b.width / 2, b.top + share * b.height)));
      });
      assert.equal(hidden, false, `${size}: ${act} is out of reach`);
    }
    await shot(p, size, "new-experiment");
  }));

test("an unknown address says so and offers the way back", { timeout: 60_000 }, () =>
  at_each_size({ scenario: "demo" }, async (p, size) => {
    for (const hash of ["#/nonsense", "#/runs/seven"]) {
      await p.page.evaluate((h) => (location.hash = h), hash);
      assert.match(await p.get("nowhere").textContent(), new RegExp(hash));
      await p.page.getByRole("link", { name: "To the robot" }).click();
      await p.get("scene").waitFor();
    }
    await p.page.evaluate(() => (location.hash = "#/runs/999"));
    await p.page.getByText("There is no run 999").waitFor();
    p.forgive(/Failed to load resource/);
    await shot(p, size, "no-run");
  }));

test("Drive, help and an unknown address pass the rules of axe", { timeout: 300_000 }, async () => {
  const faults = [];
  const look_round = (theme, sizes) => at_each_size({ scenario: "demo", theme }, async (p, size) => {
    const look = async (what) => {
      for (const fault of await p.accessibility()) faults.push(`${what}, ${size}, ${theme}: ${fault}`);
    };
    await p.page.keyboard.press("n");
    await look("drive");
    await p.get("help").click();
    await look("help");
    await p.page.keyboard.press("Escape");
    await p.page.evaluate(() => (location.hash = "#/nonsense"));
    await p.get("nowhere").waitFor();
    await look("nowhere");
  }, sizes);
  await look_round("dark", Object.keys(kSizes));
  await look_round("light", ["desktop", "small"]);
  assert.deepEqual(faults, []);
});
