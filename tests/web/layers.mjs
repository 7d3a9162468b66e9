// tests/web/layers.mjs: a live run and its record are drawn alike, layer by layer; the panel's
// switches work and are remembered. Run like e2e.mjs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { setTimeout as pause } from "node:timers/promises";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

const kScale = 70;    // [px/m] of both views
const kHalf = 140;    // [px] half size of the compared piece about the robot, but
const kBelow = 100;   // [px] below it: the scale bar stands there in a small view
const kAlike = 0.001; // share of its pixels that may differ

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const control = (base, body) => json(base, "/session/control", { method: "POST", body: JSON.stringify(body) });

/** Drives on for `ticks`, so slowly that the page gets nearly every frame; the tick and the pose at which the run rests. */
async function drive(p, base, ticks) {
  const session = () => json(base, "/session");
  const { tick: first } = await session();
  for (let done = 0; done < ticks; ++done) {
    await control(base, { action: "step", ticks: 1 });
    await pause(20);
  }
  const { tick, pose } = await until("the end of the way", 60, session, (s) => s.tick >= first + ticks);
  await p.draws(tick);
  return { tick, pose };
}

/** Moves the view by its own wheel, until `pose` is in the middle at kScale; exact to a fiftieth of a pixel. */
async function look_at(p, pose) {
  await p.pixels(pose.x, pose.y); // the view has settled
  await p.get("scene").evaluate(async (canvas, { pose, scale }) => {
    const box = canvas.getBoundingClientRect();
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    const view = () => canvas.dataset.view.split(" ").map(Number);
    // A wheel's place is a whole number of pixels of the window.
    const wheel = (x, y, factor) => canvas.dispatchEvent(new WheelEvent("wheel", {
      clientX: x, clientY: y, deltaY: -Math.log(factor) / 0.0016, cancelable: true,
    }));
    const drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    const [mx, my] = [Math.round(box.left + w / 2), Math.round(box.top + h / 2)];
    wheel(mx, my, scale / view()[2]);
    await drawn();
    // Zoomed in by `factor` about one place and out about another, the picture moves by a share of the way between.
    for (const factor of [2, 2, 1 + 1 / 63, 1 + 1 / 63, 1 + 1 / 63]) {
      const [x, y, s] = view();
      const share = 1 - 1 / factor;
      const way = { x: Math.floor(w / 2) - (w / 2 + (pose.x - x) * s), y: Math.floor(h / 2) - (h / 2 - (pose.y - y) * s) };
      wheel(mx, my, factor);
      wheel(mx + Math.round(way.x / share), my + Math.round(way.y / share), 1 / factor);
      await drawn();
    }
    wheel(mx, my, scale / view()[2]);
    await drawn();
  }, { pose, scale: kScale });
}

/** Keeps the piece about the robot under `name`; with `than`, the share of its pixels that differ from that one. */
function keep(p, name, than = null) {
  return p.get("scene").evaluate(async (canvas, { name, than, half, below }) => {
    // A switch is rendered, then acted on, then drawn.
    for (let i = 0; i < 6; ++i) await new Promise((done) => requestAnimationFrame(done));
    const corner = (size) => Math.floor(size / 2) - half;
    const { data } = canvas.getContext("2d").getImageData(corner(canvas.clientWidth), corner(canvas.clientHeight), 2 * half, half + below);
    const kept = (window.kept ??= {});
    kept[name] = data;
    if (than === null) return 0;
    let differ = 0;
    for (let i = 0; i < data.length; i += 4) {
      if ([0, 1, 2].some((c) => Math.abs(data[i + c] - kept[than][i + c]) > 48)) ++differ;
    }
    return differ / (data.length / 4);
  }, { name, than, half: kHalf, below: kBelow });
}

const switches = (p) => p.page.getByRole("switch").evaluateAll((all) => all.map((e) => e.dataset.testid));

async function set(p, id, on) {
  const layer = p.get(id);
  if ((await layer.getAttribute("aria-checked") === "true") !== on) await layer.click();
}

/** Draws one layer after the other, all else off. What a layer that is on is drawn of may still be under way. */
async function one_by_one(p, of, compare) {
  const ids = await switches(p);
  for (const id of ids) await set(p, id, false);
  await keep(p, `${of} bare`);
  for (const id of ids) {
    await set(p, id, true);
    await compare(id);
    await set(p, id, false);
  }
  return ids;
}

async function open_stored(p, base, run, tick) {
  await until("the record has it", 20, () => json(base, `/runs/${run}`), (r) => r.ticks > tick);
  await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), run);
  await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
  const fold = p.get("plots-fold"); // the scene gets their room
  if (await fold.getAttribute("aria-expanded") === "true") await fold.click();
  await p.get("timeline").focus();
  await p.page.keyboard.press("End");
  await p.get("run-step").click(); // the slider's hundredths may end before the last tick
  if (!(await p.page.locator('[data-testid="layer-panel"]').count())) await p.get("layers").click();
}

/** Scene, controller, for how many ticks it drives, and the layers that must then be seen. */
const kCases = [
  ["demo", "modified", 300, ["scan", "filtered", "path", "safety", "scan.nearest", "strip", "strip.nodes", "strip.elastic"]],
  ["demo", "dwa", 240, ["scan", "filtered", "window.allowed", "window.chosen"]],
  ["demo", "vfh", 240, ["filtered", "histogram.grid", "histogram"]],
  ["demo", "certainty_grid", 300, ["filtered", "certainty.grid", "plan"]],
  ["people", "strip_moving", 150, ["filtered", "strip", "map"]],
  ["sensors", "strip", 300, ["filtered", "ranging", "strip"]],
];

test("the record is drawn like the live run, layer by layer", { timeout: 600_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "demo" });
  const { base } = server;
  const p = await open(browser, base, { size: desktop, reads: true });
  try {
    await control(base, { action: "pause" });
    for (const [scenario, controller, ticks, seen] of kCases) {
      const what = (id) => `${scenario}, ${controller}: ${id}`;
      await control(base, { action: "load", scenario, controller });
      await p.page.evaluate(() => (location.hash = "#/drive"));
      await until("the page follows", 20, () => p.get("controller").inputValue(), (v) => v === controller);
      if (!(await p.page.locator('[data-testid="layer-panel"]').count())) await p.get("layers").click();
      await set(p, "layer-filtered", true);
      const { tick, pose } = await drive(p, base, ticks);
      const { run } = await json(base, "/session");

      await look_at(p, pose);
      const of_live = await one_by_one(p, "live", async (id) => {
        await p.page.waitForTimeout(id === "layer-filtered" ? 800 : 0);
        const drawn = await keep(p, `live ${id}`, "live bare");
        if (seen.includes(id.slice("layer-".length))) assert.ok(drawn > 0, `${what(id)} is seen`);
      });
      for (const name of seen) assert.ok(of_live.includes(`layer-${name}`), what(`${name} is listed`));
      const words = await p.get("explain").textContent();

      await open_stored(p, base, run.id, tick);
      await p.draws(tick);
      await until("its last tick", 20, () => p.get("run-explain").textContent(), (w) => w === words);
      await look_at(p, pose);
      const of_stored = await one_by_one(p, "stored", async (id) => {
        let differ = 1;
        // The record also knows layers of ticks that the live page did not get; at this tick they are empty.
        const live = of_live.includes(id) ? `live ${id}` : "live bare";
        for (let i = 0; i < 20 && differ > kAlike; ++i) { // a filtered scan is fetched when first wanted
          differ = await keep(p, `stored ${id}`, live);
          if (differ > kAlike) await p.page.waitForTimeout(100);
        }
        assert.ok(differ <= kAlike, `${what(id)}: ${(100 * differ).toFixed(2)} % of the pixels differ`);
      });
      assert.deepEqual(of_live.filter((id) => !of_stored.includes(id)), [], what("the record knows every layer"));
      assert.equal(await keep(p, "bare again", "stored bare"), 0, what("what is off is off"));
      assert.ok(await keep(p, "bare again", "live bare") <= kAlike, what("the world itself"));
    }
  } finally {
    await p.close();
    await server.stop();
    place.remove();
  }
});

test("a switch works by keyboard and by touch and is remembered; Space there is Stop", { timeout: 120_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1" });
  const p = await open(browser, server.base, { size: desktop });
  const on = (page, id) => page.get(id).getAttribute("aria-checked");
  await p.get("layer-strip").waitFor();
  await p.get("layer-strip").focus();
  await p.page.keyboard.press("Enter");
  assert.equal(await on(p, "layer-strip"), "false");
  await p.page.keyboard.press("Space");
  await until("stopped", 10, () => json(server.base, "/session"), (s) => s.stop);
  assert.equal(await on(p, "layer-strip"), "false", "Space is never a toggle");
  await p.get("release").click();
  await p.page.reload();
  await p.get("layer-strip").waitFor();
  assert.deepEqual([await on(p, "layer-strip"), await on(p, "layer-path")], ["false", "true"]);
  await p.page.keyboard.press("l");
  await p.get("layer-panel").waitFor({ state: "detached" });
  await p.page.reload();
  await p.page.waitForSelector('[data-testid="link"].open');
  assert.equal(await p.page.locator('[data-testid="layer-panel"]').count(), 0, "closed as it was left");
  await p.close();

  const q = await open(browser, server.base, { size: phone, touch: true });
  assert.equal(await q.page.locator('[data-testid="layer-panel"]').count(), 0);
  await q.get("layers").tap();
  await q.get("layer-scan").tap();
  assert.equal(await on(q, "layer-scan"), "false");
  const { pose } = await json(server.base, "/session");
  const robot = await q.pixels(pose.x, pose.y);
  const panel = await q.get("layer-panel").boundingBox();
  const stop = await q.get("stop").boundingBox();
  assert.ok(robot.y < panel.y && stop.y + stop.height < panel.y, "robot and Stop stay in sight");
  const under = await q.page.evaluate(({ x, y }) => document.elementFromPoint(x, y)?.dataset.testid, robot);
  assert.equal(under, "scene");
  await q.shot("phone-layers");
  await q.close();
  await server.stop();
  place.remove();
});
