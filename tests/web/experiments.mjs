// tests/web/experiments.mjs: an experiment from its template to its table, its runs and its end.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

let browser;
let server;
let store;

before(async () => {
  store = scratch();
  server = await serve({ database: store.database, scenario: "case1" });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  store?.remove();
});

/** 1 m to the goal: some hundredths of a second a run. */
function short(name, repeats, more = {}) {
  return {
    name, physics: "kinematic", repeats,
    scenarios: [{ name: "near", goal: { x: 1, y: 0.2 } }, { name: "far", goal: { x: 1.5, y: 0.2 } }],
    controllers: ["original", "go_to_goal"], comparisons: { baseline: "original" }, ...more,
  };
}
const post = (document) => json(server.base, "/experiments", { method: "POST", body: JSON.stringify(document) });
const info = (id) => json(server.base, `/experiments/${id}`);
const act = (id, name) => json(server.base, `/experiments/${id}/${name}`, { method: "POST", body: "{}" });
const finished = (id) => until("it is finished", 60, () => info(id), (e) => e.state === "finished");

/** Takes the text of a document into the dialog. */
async function write(p, text) {
  await p.get("experiment-document").fill(typeof text === "string" ? text : JSON.stringify(text));
}

test("from a template to the table, with Check before Start", { timeout: 120_000 }, async () => {
  const p = await open(browser, server.base, { size: desktop });
  await p.get("nav-experiments").click();
  await p.page.getByText("No experiments yet").waitFor();
  await p.get("new-experiment").click();
  await p.get("experiment-check").click();
  await p.get("experiment-estimate").waitFor();
  assert.match(await p.get("experiment-estimate").textContent(), /^81 runs: *9 scenarios × 3 controllers × 1 setting × 3 seeds/);
  // What is wrong is said beside the document, which stays.
  await write(p, "{\"name\": ");
  await p.get("experiment-start").click();
  await p.page.getByText("This is not JSON yet").waitFor();
  await write(p, { ...short("wrong", 2), controllers: ["originel"] });
  await p.get("experiment-start").click();
  await p.page.getByText("controllers/0").waitFor();
  assert.match(await p.get("experiment-problem").textContent(), /originel/);
  await write(p, short("two worlds", 20));
  await p.get("experiment-start").click();
  await p.page.getByText("name: ").waitFor(); // a blank is not allowed in a name
  await write(p, short("two-worlds", 20));
  await p.get("experiment-start").click();
  await p.get("experiment").waitFor();
  const [{ id, runs }] = (await json(server.base, "/experiments")).items;
  assert.equal(runs, 80);
  await finished(id);
  await until("nothing is missing", 10, () => p.get("experiment-progress").count(), (n) => n === 0);
  const results = await json(server.base, `/experiments/${id}/results`);
  await until("the table is whole", 10, () => p.get("experiment-results").textContent(), (text) => !text.includes("missing"));
  const table = await p.get("experiment-results").textContent();
  for (const arm of results.arms) {
    assert.ok(table.includes(arm.label));
    assert.ok(table.includes(arm.figures.time_s.median.toFixed(1)), `${arm.label}: ${table}`);
    assert.ok(table.includes(`${Math.round(100 * arm.rates.reached.rate)} %`));
  }
  await p.get("experiment-scenario").selectOption("far");
  const far = (await json(server.base, `/experiments/${id}/results?scenario=far`)).scenarios;
  await until("the table of one world", 10, () => p.get("experiment-results").textContent(),
    (text) => far.every((arm) => text.includes(arm.figures.time_s.median.toFixed(1))));
  assert.deepEqual(await p.accessibility(), []);
  await p.shot("experiments-desktop");
  for (const [file, begins] of [["runs.csv", "run,"], ["report.md", "# two-worlds"], ["report.tex", "\\documentclass"], ["results.json", "{"]]) {
    const href = await p.get(`file-${file}`).getAttribute("href");
    const text = await (await fetch(new URL(href, server.base))).text();
    assert.ok(text.startsWith(begins), `${file}: ${text.slice(0, 40)}`);
  }
  await p.close(/422/); // two documents were wrong on purpose
});

test("runs are filtered and sorted, and one is made again and opens", { timeout: 120_000 }, async () => {
  const { id } = await post(short("sorted", 5));
  await finished(id);
  const p = await open(browser, server.base, { size: desktop, hash: `#/experiments/${id}` });
  const rows = () => p.get("experiment-runs").locator("tbody tr").allTextContents();
  await until("all runs", 10, rows, (list) => list.length === 20);
  await p.get("runs-controller").selectOption("go_to_goal");
  await until("of one controller", 10, rows, (list) => list.length === 10 && list.every((row) => row.includes("go_to_goal")));
  await p.get("sort-time_s").click();
  const { items } = await json(server.base, `/experiments/${id}/runs?controller=go_to_goal&sort=-time_s&limit=2`);
  await until("the slowest first", 10, rows, ([row]) => row?.startsWith(String(items[0].run)));
  await p.get("outcome-collided").click();
  await p.page.getByText("No finished run of this kind").waitFor();
  await p.get("outcome-all").click();
  await p.get(`replay-${items[0].run}`).click();
  await p.page.waitForURL(/#\/runs\/\d+$/, { timeout: 30_000 });
  const run = await json(server.base, `/runs/${p.page.url().match(/\d+$/)[0]}`);
  assert.equal(run.seed, items[0].seed);
  assert.equal(run.outcome, items[0].outcome);
  assert.ok(Math.abs(run.metrics.time - items[0].figures.time_s) < 1e-6, JSON.stringify(run.metrics));

  // Who has left the experiment meanwhile stays there.
  await p.page.goBack();
  await p.get(`replay-${items[1].run}`).click();
  await p.get("nav-drive").click();
  await p.page.getByText(/^Run \d+ is made\. It stands in Runs\.$/).waitFor();
  assert.match(p.page.url(), /#\/drive$/);
  await p.close();
});

test("the paths of all controllers lie over their world, and a press replays one", { timeout: 120_000 }, async () => {
  const scenarios = [{ name: "post", goal: { x: 2, y: 0 }, obstacles: [{ type: "cylinder", x: 1, y: 0.8, radius: 0.15 }, { type: "box", x: 1, y: -0.9, length: 0.3, width: 0.2 }] },
    { name: "near", goal: { x: 1, y: 0.2 } }];
  const { id } = await post(short("paths", 2, { scenarios }));
  await finished(id);
  const p = await open(browser, server.base, { size: desktop, hash: `#/experiments/${id}` });
  await p.get("experiment-paths").waitFor();
  const told = await json(server.base, `/experiments/${id}/paths?scenario=post`);
  assert.deepEqual(told.paths.map((each) => each.controller), ["original", "go_to_goal"]);
  const ends = told.paths.map(({ points }) => points.at(-1));
  assert.ok(ends.every(([x, y]) => Math.hypot(x - 2, y) < 0.12), JSON.stringify(ends));
  assert.equal(await p.page.locator(".experiment-paths .obstacle").count(), 2);
  assert.equal(await p.page.locator(".experiment-paths g.path").count(), 2);
  await p.get("experiment-scenario").selectOption("near");
  await p.page.getByText("Paths in Near").waitFor();
  await p.get("experiment-scenario").selectOption("post");
  await p.page.getByText("Paths in Post").waitFor();
  assert.deepEqual(await p.accessibility(), []);
  await p.shot("experiments-paths");
  const { run } = told.paths[1];
  await p.get(`path-${run}`).click();
  await p.page.waitForURL(/#\/runs\/\d+$/, { timeout: 30_000 });
  assert.equal((await json(server.base, `/runs/${p.page.url().match(/\d+$/)[0]}`)).controller, "go_to_goal");
  await p.close();
});

test("pause, go on, cancel and delete; what another page does is shown", { timeout: 120_000 }, async () => {
  const { id } = await post(short("long", 4000));
  await act(id, "pause"); // a page that loads slowly would come after its end
  const p = await open(browser, server.base, { size: phone, touch: true, hash: `#/experiments/${id}` });
  await p.page.getByText("INCOMPLETE").waitFor();
  await p.get("experiment-resume").click();
  await until("running", 10, () => info(id), (e) => e.state === "running");
  await p.get("experiment-pause").click();
  await until("paused", 10, () => info(id), (e) => e.state === "paused");
  await act(id, "resume"); // somebody else
  await p.get("experiment-pause").waitFor();
  await act(id, "pause");
  await p.get("experiment-resume").waitFor();
  assert.deepEqual(await p.accessibility(), []);
  await p.shot("experiments-phone");
  await p.get("experiment-cancel").click();
  await until("cancelled", 10, () => info(id), (e) => e.state === "cancelled");
  await p.get("experiment-delete").click();
  await p.get("experiment-delete-sure").click();
  await until("deleted", 10, () => json(server.base, "/experiments"), ({ items }) => items.every((e) => e.id !== id));
  await p.page.waitForURL(/#\/experiments$/);
  await p.close();
});

test("3,000 runs come in while the page stays smooth", { timeout: 240_000 }, async () => {
  const scenarios = [4, 5].map((x) => ({ name: `at-${x}`, goal: { x, y: 0.2 } }));
  const { id } = await post(short("smooth", 750, { scenarios }));
  const p = await open(browser, server.base, { size: desktop, hash: `#/experiments/${id}` });
  await p.get("experiment-results").waitFor();
  const cdp = await p.page.context().newCDPSession(p.page);
  await cdp.send("Performance.enable", { timeDomain: "threadTicks" }); // the page's own CPU time, whatever else runs
  const spent = async () => (await cdp.send("Performance.getMetrics")).metrics.find((m) => m.name === "TaskDuration").value;
  await p.page.evaluate(() => {
    window.tasks = [];
    new PerformanceObserver((list) => window.tasks.push(...list.getEntries().map((e) => e.duration))).observe({ entryTypes: ["longtask"] });
  });
  const before = await spent();
  const began = Date.now();
  await until("it is finished", 200, () => info(id), (e) => e.state === "finished");
  const share = (await spent() - before) / ((Date.now() - began) / 1000);
  const tasks = await p.page.evaluate(() => window.tasks);
  console.log(`the page used ${(100 * share).toFixed(0)} % of a core; tasks over 50 ms, of a machine that may be busy: ${tasks.length}`);
  assert.ok(share < 0.4, `the page used ${share} of a core`);
  await until("all runs are found", 10, () => p.page.locator(".experiment-runs .pager").textContent(), (text) => text.includes("of 3,000"));
  await p.close();
});

test("an experiment that the server left is shown as interrupted, and goes on", { timeout: 120_000 }, async () => {
  const { id } = await post(short("left", 600));
  await until("some are done", 10, () => info(id), (e) => e.done > 5);
  server.kill();
  await server.stop().catch(() => undefined);
  server = await serve({ database: store.database, scenario: "case1" });
  const p = await open(browser, server.base, { size: desktop, hash: `#/experiments/${id}` });
  await p.get("experiment-resume").click();
  await finished(id);
  assert.equal((await info(id)).done, 2400);
  await p.close();
});
