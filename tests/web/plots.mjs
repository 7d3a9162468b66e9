// tests/web/plots.mjs: the plots of live and stored runs in Chromium: signals are chosen, time is zoomed,
// the cursor shows the record's numbers, pictures and tables are saved. Run like e2e.mjs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

let browser;
let place;
let server;
let runs;
before(async () => {
  browser = await launch();
  place = scratch();
  server = await serve({ database: place.database, scenario: "case1" });
  const batch = { scenario: "case1", physics: "kinematic", repeats: 2 };
  ({ runs } = await json(server.base, "/runs", { method: "POST", body: JSON.stringify(batch) }));
  for (const id of runs) await until("the run is stored", 60, () => json(server.base, `/runs/${id}`), (r) => r.status === "finished");
});
after(async () => {
  await browser?.close();
  await server?.stop();
  place?.remove();
});

async function opened(run, options = {}) {
  const p = await open(browser, server.base, { ...options, hash: `#/runs/${run}` });
  await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
  await p.get("plot-v").waitFor();
  return p;
}

/** The lines' left edge and width [px of the window], and the shown piece of time [s]. */
async function field(p, plot = "v") {
  const canvas = p.get(`plot-${plot}`);
  await canvas.scrollIntoViewIfNeeded();
  const [left, width, from, to] = (await canvas.getAttribute("data-field")).split(" ").map(Number);
  const box = await canvas.boundingBox();
  return { left: box.x + left, width, from, to, y: box.y + box.height / 2, x: (t) => box.x + left + ((t - from) / (to - from)) * width };
}

const number = (text) => Number(/^[−\d.]+/.exec(text)?.[0].replace("−", "-"));
const tick_of = (text) => Number(/tick (\d+)/.exec(text)[1]);

async function choose(p, names, on = true) {
  await p.get("pick-signals").click();
  for (const name of names) {
    await p.get("picker-find").fill(name);
    const row = p.get(`signal-${name}`);
    if ((await row.getAttribute("aria-checked") === "true") !== on) await row.click();
  }
  await p.get("pick-signals").click();
}

test("the cursor shows the record's numbers, and the scene its instant", { timeout: 120_000 }, async () => {
  const [run] = runs;
  const { items } = await json(server.base, `/runs/${run}/ticks?limit=10000`);
  const p = await opened(run);
  const columns = ["clearance", "v", "omega", "x", "y", "heading"];
  await choose(p, columns);
  const at = await field(p);
  const sentences = new Set();
  for (const share of [0.06, 0.31, 0.47, 0.63, 0.92]) {
    await p.page.mouse.move(at.left + share * at.width, at.y);
    const said = await until("the cursor follows", 5, () => p.get("plot-time").textContent(),
      (text) => near(number(text), at.from + share * (at.to - at.from), 0.1));
    const row = items[tick_of(said)];
    assert.ok(near(number(said), row.t, 0.0051), said);
    for (const name of columns) {
      const shown = number(await p.get(`value-${name}`).textContent());
      assert.ok(near(shown, row[name], 0.0051), `tick ${row.tick}: ${name} is ${row[name]}, shown is ${shown}`);
    }
    assert.match(await p.get("run-time").textContent(), new RegExp(`^${String(Math.floor(row.t / 60)).padStart(2, "0")}:`));
    assert.ok(near(Number(await p.get("timeline").inputValue()), row.t, 0.03), "the scene's clock is the cursor's");
    sentences.add(await p.get("run-explain").textContent());
  }
  assert.ok(sentences.size >= 3, "the sentence is that of the instant");
  await p.page.mouse.move(at.left + 0.5 * at.width, 100); // the pointer leaves
  assert.ok(near(number(await p.get("plot-time").textContent()), at.from + 0.92 * (at.to - at.from), 0.1), "the instant stays");
  await p.close();
});

test("time is zoomed by a dragged span, the wheel, buttons and keys, and back", { timeout: 120_000 }, async () => {
  const p = await opened(runs[0]);
  const whole = await field(p);
  await p.drag({ x: whole.x(20), y: whole.y }, { x: whole.x(30), y: whole.y });
  const span = await until("the span", 5, () => field(p), (f) => f.to - f.from < 12);
  assert.ok(near(span.from, 20, 0.3) && near(span.to, 30, 0.3), `${span.from} to ${span.to}`);
  await p.page.mouse.move(span.x(24), span.y);
  await p.page.mouse.wheel(0, -400);
  const near_24 = await until("the wheel zooms in", 5, () => field(p), (f) => f.to - f.from < 7);
  assert.ok(near(near_24.x(24), span.x(24), 2), "what lies under the pointer stays there");
  await p.page.mouse.dblclick(near_24.x(24), near_24.y);
  const back = (f) => near(f.from, whole.from, 1e-3) && near(f.to, whole.to, 1e-3);
  await until("a double click shows the whole run", 5, () => field(p), back);
  await p.get("plot-in").click();
  await until("the button zooms in", 5, () => field(p), (f) => near(f.to - f.from, whole.to / 2, 0.1));
  await p.get("plot-out").click();
  await until("and out", 5, () => field(p), back);
  assert.ok(await p.get("plot-whole").isDisabled());

  await p.get("plot-cursor").focus();
  const tick = async () => tick_of(await p.get("plot-time").textContent());
  const before = await tick();
  await p.page.keyboard.press("ArrowRight");
  await until("one tick on", 5, tick, (n) => n === before + 1);
  await p.page.keyboard.press("Shift+ArrowLeft");
  await until("ten ticks back", 5, tick, (n) => n === before - 9);
  assert.match(await p.get("plot-cursor").getAttribute("aria-valuetext"), /Commanded speed [\d.]+ m\/s/);
  await p.page.keyboard.press("+");
  await until("+ zooms in", 5, () => field(p), (f) => near(f.to - f.from, whole.to / 2, 0.1));
  await p.page.keyboard.press("Home");
  await until("the cursor is kept in sight", 5, () => field(p), (f) => f.from === 0);
  assert.equal(await tick(), 0);
  await p.page.keyboard.press("Escape");
  await until("Escape goes back", 5, () => field(p), back);
  await p.close();
});

test("by touch: a finger moves the cursor, two zoom", { timeout: 120_000 }, async () => {
  const p = await opened(runs[0], { size: phone, touch: true });
  const at = await field(p);
  const client = await p.context.newCDPSession(p.page);
  const touch = (type, xs) => client.send("Input.dispatchTouchEvent", { type, touchPoints: xs.map((x, id) => ({ x, y: at.y, id })) });
  await touch("touchStart", [at.x(40)]);
  await touch("touchMove", [at.x(50)]);
  await until("the cursor follows the finger", 5, () => p.get("timeline").inputValue(), (t) => near(Number(t), 50, 1));
  await touch("touchEnd", []);
  await touch("touchStart", [at.x(40), at.x(50)]);
  await touch("touchMove", [at.x(20), at.x(60)]);
  await touch("touchEnd", []);
  const zoomed = await until("two fingers zoom", 5, () => field(p), (f) => f.to - f.from < 0.6 * (at.to - at.from));
  assert.ok(zoomed.from < 45 && zoomed.to > 45);
  const whole = await p.get("plot-whole").boundingBox();
  assert.ok(whole.width >= 44 && whole.height >= 44, "a finger finds the buttons");
  await p.get("plot-whole").tap();
  await until("and back", 5, () => field(p), (f) => near(f.to, at.to, 1e-3));
  await p.get("plots-fold").tap();
  assert.equal(await p.get("plot-v").count(), 0, "the scene can have the room");
  await p.close();
});

test("signals of a live run are chosen, remembered, and read at the pointer", { timeout: 120_000 }, async () => {
  const p = await open(browser, server.base, { size: desktop });
  await p.get("tab-signals").click();
  await p.get("plot-v").waitFor();
  assert.equal(await p.get("plot-truth.obstacle_distance").count(), 0);
  await choose(p, ["truth.obstacle_distance", "x", "period"]);
  await choose(p, ["omega", "odometry.omega"], false);
  await p.page.reload();
  await p.get("tab-signals").click();
  for (const chosen of ["plot-x", "value-truth.obstacle_distance", "plot-period"]) await p.get(chosen).waitFor();
  assert.equal(await p.get("plot-omega").count(), 0);
  await p.get("pick-signals").focus();
  await p.page.keyboard.press("Enter");
  await p.page.keyboard.type("turn rate commanded");
  await p.page.keyboard.press("Tab");
  await p.page.keyboard.press("Tab");
  await p.page.keyboard.press("Enter");
  await p.get("plot-omega").waitFor();
  await p.page.keyboard.press("Escape");
  assert.equal(await p.get("picker").count(), 0);
  assert.equal(await p.page.evaluate(() => document.activeElement.dataset.testid), "pick-signals");

  const newest = async () => (await field(p, "x")).to;
  const first = await newest();
  await until("the plot goes on", 20, newest, (t) => t > first);
  await until("some seconds are there", 20, newest, (t) => t > 6);
  const at = await field(p, "x");
  await p.page.mouse.move(at.left + 0.2 * at.width, at.y);
  const words = () => p.get("plot-time").textContent();
  const said = await until("the cursor looks back", 5, words, (text) => number(text) < at.to - 1);
  await p.page.waitForTimeout(600);
  assert.equal(await words(), said, "while the run goes on, the cursor stands");
  const { run } = await json(server.base, "/session");
  const tick = tick_of(said);
  const [row] = (await until("the record has it", 20, () => json(server.base, `/runs/${run.id}/ticks?from=${tick}&limit=1`),
    (page) => page.items.length === 1)).items;
  assert.equal(row.tick, tick);
  assert.ok(near(number(await p.get("value-x").textContent()), row.x, 0.0051));
  await p.get("plot-in").click();
  await until("zoomed, it still follows the run", 5, () => field(p, "x"), (f) => f.to - f.from < 11);
  await p.close();
});

test("two runs share the plots, each in its colour", { timeout: 120_000 }, async () => {
  const p = await opened(runs[0]);
  await p.page.evaluate((hash) => (location.hash = hash), `#/runs/${runs[0]}?with=${runs[1]}`);
  const values = () => p.page.locator('[data-testid="value-v"]').evaluateAll((all) => all.map((e) => e.dataset.run));
  await until("both are named", 20, values, (list) => list.length === 2);
  assert.deepEqual(await values(), runs.map(String));
  await p.shot("plots-compared");
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

/** What `act` downloads: its name and bytes. */
async function downloaded(p, act) {
  const [download] = await Promise.all([p.page.waitForEvent("download"), act()]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

/** Share of the pixels in which a browser shows the SVG otherwise than the PNG of the same drawing. */
async function difference(svg, png) {
  const page = await browser.newPage(); // without the policy of Tautline's page
  const share = await page.evaluate(async ([svg, png]) => {
    const load = (source) => new Promise((done, fail) => {
      const image = new Image();
      image.onload = () => done(image);
      image.onerror = () => fail(new Error("the picture cannot be read"));
      image.src = source;
    });
    const images = [await load(`data:image/svg+xml;base64,${svg}`), await load(`data:image/png;base64,${png}`)];
    const { width, height } = images[1];
    const [a, b] = images.map((image) => {
      const g = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d", { willReadFrequently: true });
      g.drawImage(image, 0, 0, width, height);
      return g.getImageData(0, 0, width, height).data;
    });
    let differ = 0;
    for (let i = 0; i < a.length; i += 4) if ([0, 1, 2].some((c) => Math.abs(a[i + c] - b[i + c]) > 96)) ++differ;
    return differ / (a.length / 4);
  }, [svg.toString("base64"), png.toString("base64")]);
  await page.close();
  return share;
}

test("scene and plots are saved as SVG and PNG, the ticks as CSV with units", { timeout: 120_000 }, async () => {
  const [run] = runs;
  for (const where of ["stored", "live"]) {
    const p = where === "stored" ? await opened(run) : await open(browser, server.base, { size: desktop });
    if (where === "live") await p.get("tab-signals").click();
    await p.get("plot-v").waitFor();
    if (where === "stored") await p.get("timeline").fill("30"); // a scene with scan, strip and forces
    const id = where === "stored" ? run : (await json(server.base, "/session")).run.id;
    await p.get("plot-save").click();
    assert.deepEqual(await p.accessibility(), []);
    assert.equal(await p.get("save-light").evaluate((e) => getComputedStyle(e).display), "grid", "a line with a switch, whatever was opened before");
    const title = `Run ${id}: Case 1, Modified`;
    for (const what of ["plots", "scene"]) {
      const svg = await downloaded(p, () => p.get(`save-${what}-svg`).click());
      assert.equal(svg.name, `run-${id}-case1-${what}.svg`);
      const text = svg.bytes.toString();
      const read = await p.page.evaluate((xml) => {
        const file = new DOMParser().parseFromString(xml, "image/svg+xml");
        const words = [...file.querySelectorAll("text")].map((e) => e.textContent);
        return { fault: file.querySelector("parsererror")?.textContent ?? null, words, paths: file.querySelectorAll("path").length };
      }, text);
      assert.equal(read.fault, null);
      assert.ok(read.words.some((w) => w.startsWith(title)), read.words.slice(0, 3).join());
      for (const word of what === "plots" ? ["Speed, m/s", "time, s", "Commanded speed"] : ["x, m", "y, m", "Travelled, by odometry"]) {
        assert.ok(read.words.includes(word), `${where} ${what}: ${word}`);
      }
      assert.ok(read.paths > 10);
      assert.doesNotMatch(text, /NaN|var\(/, "nothing of the page is needed to read it");
      const png = await downloaded(p, () => p.get(`save-${what}-png`).click());
      assert.equal(png.name, `run-${id}-case1-${what}.png`);
      assert.equal(png.bytes.subarray(1, 4).toString(), "PNG");
      assert.ok(png.bytes.readUInt32BE(16) > 600 && png.bytes.length > 10_000);
      if (where === "stored") { // it stands still
        const share = await difference(svg.bytes, png.bytes);
        assert.ok(share < 0.01, `${what}: ${(100 * share).toFixed(2)} % of the pixels differ`);
      }
    }
    const dark = async () => (await downloaded(p, () => p.get("save-plots-svg").click())).bytes.toString().match(/fill="(#\w+)"/)[1];
    assert.equal(await dark(), "#f5f6f8", "light at first");
    await p.get("save-light").click();
    assert.equal(await dark(), "#0e1116", "then in the colours of the page");
    if (where === "stored") {
      const csv = await downloaded(p, () => p.get(`save-csv-${id}`).click());
      assert.equal(csv.name, `run-${id}-case1.csv`);
      const [head, line] = csv.bytes.toString().split("\n");
      assert.match(head, /^tick,t \[s\],x \[m\],y \[m\],heading \[rad\],v \[m\/s\],/);
      for (const column of ["truth.clearance [m]", "mission", "strip.elastic [m]", "why"]) assert.ok(head.split(",").includes(column), column);
      assert.match(line, /^0,0,/);
    }
    await p.close();
  }
});

test("the plots fit every window", { timeout: 180_000 }, async () => {
  for (const [width, height] of [[1440, 900], [720, 450], [390, 844], [844, 390], [320, 640]]) {
    for (const theme of ["dark", "light"]) {
      const p = await open(browser, server.base, { size: { width, height }, theme, hash: `#/runs/${runs[0]}` });
      await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { state: "attached", timeout: 30_000 });
      await p.get("plot-save").waitFor();
      const wide = await p.page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= width, `${width} x ${height}: ${wide} px wide`);
      await p.shot(`plots-${width}x${height}-${theme}`);
      if (await p.get("pick-signals").isVisible()) { // they are folded where the height is small
        await p.page.locator(".lanes .plots").evaluate((e) => e.scrollTo(0, e.scrollHeight));
        await p.get("pick-signals").click();
        const hidden = await p.get("picker-find").evaluate((e) => {
          const b = e.getBoundingClientRect();
          return !e.contains(document.elementFromPoint(b.left + b.width / 2, b.top + b.height / 2));
        });
        assert.equal(hidden, false, `${width} x ${height}: the list of signals opens out of sight`);
      }
      assert.deepEqual(await p.accessibility(), [], `${width} x ${height}, ${theme}`);
      await p.close();
    }
  }
});
