// tests/web/rewind.mjs: looking back in the live run and the place that an address holds, in a real
// browser against the real program.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const post = (base, path, body = {}) => json(base, path, { method: "POST", body: JSON.stringify(body) });
const control = (base, action, more = {}) => post(base, "/session/control", { action, ...more });
const cylinder = (x, y, radius = 0.2) => ({ type: "cylinder", x, y, radius });

async function with_page(options, act) {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: options.scenario ?? "case1" });
  try {
    await act(await open(browser, server.base, options), server);
  } finally {
    await server.stop();
    place.remove();
  }
}

/** Runs the paused run on by `ticks`, until they are recorded; the run clock [s] then. */
async function run_on(base, ticks) {
  for (let left = ticks; left > 0; left -= 20) {
    const { tick } = await json(base, "/session");
    await control(base, "step", { ticks: 20 });
    await until("it stands", 30, () => json(base, "/session"), (s) => s.tick >= tick + 20);
  }
  const { tick, stamp, run } = await json(base, "/session");
  await until("the record has it", 20, () => json(base, `/runs/${run.id}`), (r) => r.ticks > tick);
  return stamp;
}

const seconds = (clock) => {
  const [minutes, rest] = clock.split(":").map(Number);
  return 60 * minutes + rest;
};
const time_of = async (p) => seconds(await p.get("time").textContent());
const kPeriod = 0.026; // [s] of a tick
/** The time of the tick next to `t`, which the page shows within half a tenth. */
const tick_time = (t) => Math.round(t / kPeriod) * kPeriod;
/** That time for the slider, which takes hundredths and goes to the tick at or before. */
const for_slider = (t) => String(Math.ceil(t * 100 - 1e-6) / 100);
const shows = (t) => (now) => near(now, t, 0.051);
const figure = async (p, name) => Number.parseFloat(await p.get(`figure-${name}`).textContent());
const looks_back = (p) => until("it looks back", 10, () => p.get("live").count(), (n) => n === 1);
const is_live = (p) => until("it is live", 10, () => p.get("live").count(), (n) => n === 0);
const marks = (p) => p.get("mark").evaluateAll((list) => list.map((e) => e.getAttribute("aria-label")));

test("the time of the live run is dragged back and says live again with one press", { timeout: 180_000 }, () =>
  with_page({ scenario: "demo" }, async (p, { base }) => {
    await until("it has driven", 60, () => json(base, "/session"), (s) => s.stamp > 6);
    const { run } = await json(base, "/session");

    // By mouse: the knob is where the time is.
    const box = await p.get("live-timeline").boundingBox();
    const y = box.y + box.height / 2;
    const end = Number(await p.get("live-timeline").getAttribute("max"));
    const x = (t) => box.x + 10 + (t / end) * (box.width - 20);
    await p.page.mouse.move(x(6), y);
    await p.page.mouse.down();
    await p.page.mouse.move(x(4), y, { steps: 5 });
    await p.page.mouse.move(x(3), y, { steps: 5 });
    await p.page.mouse.up();
    await looks_back(p);
    await until("the instant", 5, () => time_of(p), (t) => near(t, 3, 0.5));
    await p.page.waitForTimeout(300);
    const at = await time_of(p);
    await p.shot("rewind");

    // Figures, sentence and age are those of that instant; the robot goes on.
    const tick = await until("its tick", 5, async () => {
      const t = Number(await p.get("live-timeline").inputValue());
      return (await json(base, `/runs/${run.id}/ticks?from=${Math.round(t / kPeriod) - 2}&limit=5`)).items
        .find((r) => near(r.t, t, 0.014));
    });
    assert.ok(near(await figure(p, "speed"), Math.abs(tick.v), 0.006), `speed ${await figure(p, "speed")}, recorded ${tick.v}`);
    assert.match(await p.get("explain").textContent(), /\d s ago/);
    const ago = async () => Number.parseFloat(await p.get("ago").textContent());
    const before = await ago();
    await until("the robot goes on", 5, ago, (a) => a > before + 0.5);
    assert.ok(near(await time_of(p), at, 0.11), "the instant stays");
    assert.deepEqual(await p.accessibility(), []);

    // By keyboard: tick by tick, by a second, played on; then live.
    await p.get("live-timeline").focus();
    await p.page.keyboard.press("ArrowLeft");
    await until("a second before", 5, () => time_of(p), (t) => near(t, at - 1, 0.15));
    const value = () => p.get("live-timeline").inputValue().then(Number);
    const from = await value();
    await p.page.keyboard.press(",");
    await until("one tick back", 5, value, (v) => near(v, from - kPeriod, 0.014));
    await p.page.keyboard.press(".");
    await until("and on", 5, value, (v) => near(v, from, 0.014));
    await p.page.keyboard.press("p");
    await until("it plays on", 5, value, (v) => v > from + 0.5);
    assert.equal((await json(base, "/session")).pace.paused, false);
    await p.page.keyboard.press("p");
    await p.page.keyboard.press("l");
    await is_live(p);
    await p.page.keyboard.press(",");
    await looks_back(p);
    await p.page.keyboard.press("End");
    await is_live(p);
    await p.get("live-timeline").focus();
    await p.page.keyboard.press("Home");
    await looks_back(p);
    await p.get("live").press("Enter");
    await is_live(p);
    assert.equal((await json(base, "/session")).run.id, run.id, "nothing of it touched the run");

    // Stop works as ever.
    await p.page.keyboard.press("PageDown"); // the focus is on the time again
    await looks_back(p);
    await p.page.keyboard.press("Space");
    await until("stopped", 10, () => json(base, "/session"), (s) => s.stop);
    await p.close();
  }));

test("an earlier instant has its own world, and an edit returns to the live run", { timeout: 180_000 }, () =>
  with_page({ scenario: "case1", reads: true }, async (p, { base }) => {
    await control(base, "pause");
    const pixel = async (x, y) => {
      const at = await p.pixels(x, y);
      const box = await p.get("scene").boundingBox();
      return p.page.evaluate(([px, py]) => {
        const canvas = document.querySelector("canvas.scene-canvas");
        const k = canvas.width / canvas.clientWidth;
        return [...canvas.getContext("2d").getImageData(px * k, py * k, 1, 1).data].join();
      }, [at.x - box.x, at.y - box.y]);
    };
    const added = await run_on(base, 100);
    await p.draws((await json(base, "/session")).tick);
    const bare = await pixel(3, 2); // before: a page that lags shows a removed obstacle for a while
    const { id } = await post(base, "/session/obstacles", cylinder(3, 2));
    const removed = await run_on(base, 100);
    await json(base, `/session/obstacles/${id}`, { method: "DELETE" });
    await run_on(base, 60);
    const seek = async (about) => {
      const t = tick_time(about);
      await p.get("live-timeline").fill(for_slider(t));
      await until(`the instant ${t}`, 5, () => time_of(p), shows(t));
      await p.page.waitForTimeout(400);
    };
    await seek((added + removed) / 2);
    // Edits of ticks that were passed over come with the record.
    await until("the obstacle stands at its time", 10, () => pixel(3, 2), (c) => c !== bare);
    await seek(added - 1);
    await until("before it was added there is none", 10, () => pixel(3, 2), (c) => c === bare);
    await p.shot("rewind-world");

    // Its marks: each is named, and opens its instant.
    await until("the marks", 10, () => marks(p),
      (m) => [/Obstacle added/, /Obstacle removed/].every((words) => m.some((each) => words.test(each))));
    await p.get("mark").filter({ hasText: "Obstacle added" }).first().focus();
    await p.page.keyboard.press("Enter");
    await until("its instant", 5, () => time_of(p), (t) => near(t, added, 0.2));
    await until("the obstacle", 5, () => pixel(3, 2), (c) => c !== bare);

    // A new obstacle and a new goal are of the live world, and return to it.
    await p.get("tool-cylinder").click();
    const way = await p.pixels(3, 3);
    await p.page.mouse.click(way.x, way.y);
    await is_live(p);
    await until("it stands", 10, () => json(base, "/session"), (s) => s.obstacles.some((o) => near(o.x, 3, 0.05) && near(o.y, 3, 0.05)));
    await p.page.keyboard.press("Escape");
    await seek(added);
    await p.get("tool-goal").click();
    const goal = await p.pixels(2.5, 4);
    await p.page.mouse.click(goal.x, goal.y);
    await is_live(p);
    await until("the goal", 10, () => json(base, "/session"), (s) => s.goal && near(s.goal.x, 2.5, 0.05));

    // Undo is of the live world too; a reset begins a run that is live.
    await seek(added);
    await p.page.keyboard.press("Control+z");
    await is_live(p);
    await seek(added);
    await p.get("reset").click();
    await is_live(p);
    await p.close();
  }));

test("a page that is opened late knows the events and the world of before", { timeout: 120_000 }, () =>
  with_page({ scenario: "case1" }, async (first, { base }) => {
    await control(base, "pause");
    await run_on(base, 100);
    await post(base, "/session/obstacles", cylinder(3, 2));
    await run_on(base, 100);
    const p = await open(browser, base);
    await until("the mark", 15, () => marks(p), (m) => m.some((words) => /Obstacle added/.test(words)));
    assert.equal((await marks(p)).filter((m) => /Obstacle added/.test(m)).length, 1);
    const t = tick_time(1.5);
    await p.get("live-timeline").fill(for_slider(t));
    await looks_back(p);
    await until("the instant", 5, () => time_of(p), shows(t));
    await p.close();
    await first.close();
  }));

test("stuck: one press opens the instant, with every force drawn", { timeout: 240_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    // Walled in on the way to the goal.
    await control(base, "pause");
    for (let i = 0; i < 16; ++i) {
      const a = (i / 16) * 2 * Math.PI;
      const { pose } = await json(base, "/session");
      await post(base, "/session/obstacles", cylinder(pose.x + 1.1 * Math.cos(a), pose.y + 1.1 * Math.sin(a), 0.2)).catch(() => null);
    }
    await control(base, "speed", { speed: 0 });
    await control(base, "play");
    await until("stuck", 120, () => json(base, "/session"), (s) => s.mission === "stuck");
    await control(base, "speed", { speed: 1 });
    if (await p.get("layers").getAttribute("aria-expanded") !== "true") await p.get("layers").click();
    const forces = p.page.locator('.layer[role="switch"]:has(.is-arrows)');
    await forces.first().waitFor();
    const names = await forces.evaluateAll((list) => list.map((e) => e.dataset.testid));
    assert.ok(names.length > 0, "there are forces");
    for (const name of names) if (await p.get(name).getAttribute("aria-checked") === "true") await p.get(name).click();
    await p.get("why").click();
    await looks_back(p);
    // The words follow the picture at their own pace.
    const checked = (name) => p.get(name).getAttribute("aria-checked");
    for (const name of names) await until(`${name} is drawn`, 10, () => checked(name), (c) => c === "true");
    await until("the age", 10, () => p.get("explain").textContent(), (text) => /ago/.test(text));
    await until("the state", 10, () => p.get("state").textContent(), (text) => text === "Stuck");
    await p.page.waitForTimeout(400);
    await p.shot("rewind-stuck");
    await p.get("live").click();
    await is_live(p);
    for (const name of names) await until(`${name} as before`, 10, () => checked(name), (c) => c === "false");
    await p.close();
  }));

test("a link holds run, time, comparison and view; tool, layers, camera and 3D survive a reload", { timeout: 300_000 }, () =>
  with_page({ scenario: "case1" }, async (p, { base }) => {
    const { runs } = await post(base, "/runs", { scenario: "case1", repeats: 2 });
    await until("the runs", 60, () => json(base, `/runs/${runs[1]}`), (r) => r.status === "finished");
    const ready = (page) => page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
    await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), runs[0]);
    await ready(p.page);

    // It opens at its first scan.
    const scan = (await json(base, `/runs/${runs[0]}/ticks?limit=60`)).items;
    const opened = Number(await p.get("timeline").inputValue());
    assert.ok(opened > 0 && opened < 1.5, `opened at ${opened} of ${scan.length} ticks`);

    await p.get("timeline").fill("4.5");
    await p.page.mouse.move(900, 300);
    await p.page.mouse.wheel(0, -300);
    await until("the address has the place", 5, () => p.page.url(), (url) => /t=4\.4|t=4\.5/.test(url) && /view=/.test(url));
    await p.page.evaluate((id) => (location.hash += `&with=${id}`), runs[1]);
    await until("the comparison", 10, () => p.get("facts").textContent(), (text) => text.includes(String(runs[1])));
    const url = p.page.url();
    const words = await p.get("run-explain").textContent();
    const view = await p.page.evaluate(() => document.querySelector("canvas.scene-canvas").dataset.view);

    const q = await open(browser, base, { hash: new URL(url).hash });
    await ready(q.page);
    await until("the time", 10, () => q.get("run-time").textContent(), (t) => /^00:04\.5/.test(t));
    assert.equal(await q.get("run-explain").textContent(), words);
    await until("the comparison", 10, () => q.get("facts").textContent(), (text) => text.includes(String(runs[1])));
    const [a, b] = [view, await until("a view", 5, () => q.page.evaluate(() => document.querySelector("canvas.scene-canvas").dataset.view))]
      .map((v) => v.split(" ").map(Number));
    a.forEach((v, i) => assert.ok(near(v, b[i], 0.1), `${a} and ${b}`));

    // The Drive view after a reload.
    await q.get("nav-drive").click();
    await q.get("tool-cylinder").click();
    const scene = await q.get("scene").boundingBox();
    await q.page.mouse.move(scene.x + 400, scene.y + 300);
    await q.page.mouse.wheel(0, -400);
    const seen = () => q.page.evaluate(() => document.querySelector("canvas.scene-canvas")?.dataset.view);
    const camera = await until("the view rests", 5, seen);
    const reload = async () => {
      await q.page.reload();
      await q.page.waitForSelector('[data-testid="link"].open');
    };
    await reload();
    await until("the camera", 5, seen, (v) => v === camera);
    assert.equal(await q.get("tool-cylinder").getAttribute("aria-pressed"), "true");
    await control(base, "pause");
    await q.get("three").click();
    await reload();
    await until("3D", 5, () => q.get("three").getAttribute("aria-pressed"), (v) => v === "true");
    // The eye of the 3D view too, until Fit.
    const picture = async () => {
      await q.page.mouse.move(5, 5); // no card of the robot
      await q.page.waitForTimeout(500);
      return (await q.page.screenshot({ clip: { x: scene.x + 200, y: scene.y + 150, width: 500, height: 350 } })).toString("base64");
    };
    /** The picture once four looks in a row are alike: a busy machine may draw the end of a drag a second later. */
    const resting = () => {
      let before = "", alike = 0;
      return until("a picture that rests", 30, picture, (now) => {
        alike = now === before ? alike + 1 : 0;
        before = now;
        return alike === 3;
      });
    };
    const looks = (what, wanted) => until(what, 30, picture, (now) => now === wanted);
    await q.get("scene-3d").locator("canvas").waitFor();
    const fitted = await resting();
    await q.drag({ x: scene.x + 400, y: scene.y + 300 }, { x: scene.x + 560, y: scene.y + 340 });
    const turned = await resting();
    assert.notEqual(turned, fitted);
    await reload();
    await looks("the eye is where it was", turned);
    await q.get("fit").click();
    await looks("Fit shows the whole world", fitted);
    await q.close(/WebGL/);
    await p.close();
  }));
