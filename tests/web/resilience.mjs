// tests/web/resilience.mjs: a page left open while the server restarts and the network fails: its state is
// right again within 5 s each time, nothing is doubled, nothing leaks. By default two restarts and three
// failures; with TAUTLINE_LONG=1 five and ten over twenty minutes.
import assert from "node:assert/strict";
import { connect, createServer } from "node:net";
import { test } from "node:test";
import { launch, open } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

const kLong = Boolean(process.env.TAUTLINE_LONG);
const kRestarts = kLong ? 5 : 2;
const kFailures = kLong ? 10 : 3;
const kRest = (kLong ? 20 * 60_000 : 40_000) / (kRestarts + kFailures); // [ms] from one to the next
const kMost = 5000;          // [ms] until the state is right again
const kMostGrowth = 4 << 20; // [bytes] of heap after the first trouble, with all that a run may keep

const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
const post = (base, path, body) => json(base, path, { method: "POST", body: JSON.stringify(body) });

/** The network between page and server: it passes everything, cuts everything, or swallows everything. */
async function network(port) {
  const pairs = new Set();
  let state = "up";
  const server = createServer((page) => {
    if (state === "cut") {
      page.destroy();
      return;
    }
    const pair = [page, connect(port, "127.0.0.1")];
    pairs.add(pair);
    pair.forEach((from, i) => {
      const to = pair[1 - i];
      from.on("data", (bytes) => state === "up" && to.write(bytes));
      from.on("error", () => undefined);
      from.on("close", () => {
        to.destroy();
        pairs.delete(pair);
      });
    });
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const drop = () => pairs.forEach(([page, far]) => [page, far].forEach((socket) => socket.destroy()));
  return {
    base: `http://127.0.0.1:${server.address().port}`,
    /** "cut": connections end and none begins; "silent": they stay, and no byte arrives. */
    fail(how) {
      state = how;
      if (how === "cut") drop();
    },
    /** What was swallowed is lost, as with a router that begins anew. */
    heal() {
      if (state === "silent") drop();
      state = "up";
    },
    end() {
      drop();
      server.close();
    },
  };
}

/** The page's state by its own elements. */
const shown = (page) => page.evaluate(() => {
  const text = (id) => document.querySelector(`[data-testid="${id}"]`)?.textContent ?? "";
  const [minutes, seconds] = text("time").split(":").map(Number);
  return {
    open: document.querySelector('[data-testid="link"]').classList.contains("open"),
    old: document.querySelector('[data-testid="stale"]') !== null,
    time: 60 * minutes + seconds, state: text("state"), speed: Number.parseFloat(text("figure-speed")),
    scenario: document.querySelector('[data-testid="scenario-menu"]').dataset.scenario,
    stop: document.querySelector('[data-testid="stop"]').getAttribute("aria-pressed") === "true",
    marks: [...document.querySelectorAll('[data-testid="mark"]')].map((e) => e.getAttribute("aria-label")),
    toasts: [...document.querySelectorAll(".toast span")].map((e) => e.textContent),
  };
});

function differs(page, session) {
  if (!page.open || page.old) return "there is no link, or the picture is old";
  if (page.scenario !== session.scenario.name) return `scenario ${page.scenario}`;
  if (page.stop !== session.stop) return `stop ${page.stop}`;
  if (!near(page.time, session.stamp, 1.5)) return `time ${page.time} for ${session.stamp}`;
  return null;
}

/** The titles of the page's obstacles, found as a person does: by the key that selects the next one. */
async function obstacles_of(p) {
  await p.page.keyboard.press("Escape");
  const titles = [];
  for (let i = 0; i < 40; ++i) {
    await p.page.keyboard.press("n");
    // Fetched when needed. By a locator: a handle of an element would keep it, and count as a leak.
    if (i === 0) await p.page.locator('[data-testid$="-values"]').first().waitFor({ timeout: 5000 }).catch(() => null);
    const title = await p.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(
      document.querySelector('[data-testid="obstacle-values"] b')?.textContent ??
        (document.querySelector('[data-testid="goal-values"]') ? "Goal" : null))))));
    if (title === null) break;
    if (title !== "Goal") titles.push(title);
  }
  await p.page.keyboard.press("Escape");
  return titles;
}

async function heap(p, cdp) {
  await cdp.send("HeapProfiler.collectGarbage");
  const { metrics } = await cdp.send("Performance.getMetrics");
  const value = (name) => metrics.find((m) => m.name === name).value;
  return { bytes: value("JSHeapUsedSize"), nodes: value("Nodes"), listeners: value("JSEventListeners") };
}

test(`${kRestarts} restarts of the server and ${kFailures} failures of the network`, { timeout: kLong ? 1_800_000 : 240_000 }, async () => {
  const place = scratch();
  let server = await serve({ database: place.database, scenario: "demo" });
  const port = server.port;
  const net = await network(port);
  const browser = await launch();
  const p = await open(browser, net.base);
  const cdp = await p.context.newCDPSession(p.page);
  await cdp.send("Performance.enable");

  /** Within 5 s of `since` the page shows the server's state, and goes on to do so. */
  const right_again = async (what, since) => {
    const left = () => (kMost - (Date.now() - since)) / 1000;
    let why = "";
    await until(`${what}: the state is right again`, Math.max(0.5, left()), async () => {
      const [page, session] = await Promise.all([shown(p.page), json(server.base, "/session")]);
      return (why = differs(page, session)) === null;
    }).catch((error) => assert.fail(`${error.message} (${why})`));
    console.log(`# ${what}: right again after ${((Date.now() - since) / 1000).toFixed(1)} s`);
    const { obstacles } = await json(server.base, "/session");
    const titles = await obstacles_of(p);
    assert.equal(titles.length, obstacles.length, `${what}: obstacles ${titles}`);
    const { toasts } = await shown(p.page);
    assert.deepEqual(toasts, [...new Set(toasts)], `${what}: no toast is there twice`);
  };

  const restart = async (i) => {
    await post(server.base, "/session/obstacles", { type: "cylinder", x: 1 + i / 2, y: 4.2, radius: 0.1 }).catch(() => null);
    await server.stop(i % 2 === 0 ? "SIGTERM" : "SIGKILL").catch(() => null);
    await wait(2000);
    server = await serve({ database: place.database, scenario: "demo", port });
    const since = Date.now();
    await right_again(`restart ${i + 1}`, since);
    assert.ok(!(await shown(p.page)).marks.some((m) => /Obstacle/.test(m)), "no event of the run before");
  };

  const fail = async (i) => {
    net.fail(i % 2 === 0 ? "cut" : "silent");
    await wait(1500);
    // Meanwhile the robot is stopped, released, and its world is changed.
    const { id } = await post(server.base, "/session/obstacles", { type: "cylinder", x: 1, y: 4.2, radius: 0.1 });
    await post(server.base, "/session/control", { action: "stop" });
    await wait(i % 3 === 2 ? 9000 : 2500);
    net.heal();
    const since = Date.now();
    await right_again(`failure ${i + 1}`, since);
    assert.equal((await shown(p.page)).state, "Stopped");
    await post(server.base, "/session/control", { action: "release" });
    // What happened meanwhile is marked once, at its time.
    const all = await until("the marks of the failure", 8, async () => (await shown(p.page)).marks,
      (m) => m.some((words) => /Obstacle added/.test(words)));
    const told = all.join(", ").match(/Obstacle added/g).length;
    assert.equal(told, 1, all.join());
    await json(server.base, `/session/obstacles/${id}`, { method: "DELETE" });
    await post(server.base, "/session/control", { action: "reset" });
  };

  try {
    const steps = [];
    for (let i = 0; i < Math.max(kRestarts, kFailures); ++i) {
      if (i < kFailures) steps.push(() => fail(i));
      if (i < kRestarts) steps.push(() => restart(i));
    }
    let first = null;
    for (const step of steps) {
      const next = Date.now() + kRest;
      await step();
      await wait(Math.max(1000, next - Date.now()));
      const now = await heap(p, cdp);
      console.log(`# heap ${(now.bytes / 2 ** 20).toFixed(1)} MB, ${now.nodes} nodes, ${now.listeners} listeners`);
      first ??= now;
      assert.ok(now.bytes - first.bytes < kMostGrowth, `the heap grew from ${first.bytes} to ${now.bytes}`);
      assert.ok(now.listeners <= first.listeners + 20, `listeners: ${first.listeners}, then ${now.listeners}`);
      assert.ok(now.nodes <= first.nodes + 400, `nodes: ${first.nodes}, then ${now.nodes}`);
    }
    await p.close(/ERR_|WebSocket|Failed to load/); // brought about on purpose
  } finally {
    await browser.close();
    net.end();
    await server.stop().catch(() => undefined);
    place.remove();
  }
});
