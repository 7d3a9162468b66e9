// tests/web/runs.mjs: the Runs view: search, chips, order, batches, what people write, selection,
// deletion with undo, comparison of four; by mouse, by touch and by keyboard alone.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

const kSizes = [
  { width: 1440, height: 900 }, { width: 720, height: 450 }, phone, { width: 844, height: 390 }, { width: 320, height: 640 },
];
let browser, place, server, batch, alone;
const post = (path, body) => json(server.base, path, { method: "POST", body: JSON.stringify(body) });
const list = (query = "") => json(server.base, `/runs?${query}`);

before(async () => {
  browser = await launch();
  place = scratch();
  server = await serve({ database: place.database, scenario: "case3" });
  const one = { scenario: "case1", physics: "kinematic" };
  batch = (await post("/runs", { ...one, repeats: 3, seed: 5 })).runs;
  alone = [];
  for (const [i, controller] of ["original", "strip", "dwa", "modified"].entries()) {
    alone.push((await post("/runs", { ...one, controller, seed: 71 + i })).runs[0]);
  }
  await until("the runs", 120, () => list("kind=background"), (l) => l.items.every((r) => r.status === "finished"));
});
after(async () => {
  await browser?.close();
  await server?.stop();
  place?.remove();
});

async function with_page(options, act) {
  const p = await open(browser, server.base, { hash: "#/runs", ...options });
  await p.get(`run-${alone[3]}`).waitFor();
  await act(p);
  await p.close();
}
const rows = (p) => p.page.locator(".run-table tbody tr").evaluateAll((all) => all.map((row) => row.dataset.testid));
const shows = (p, what, expected) => until(what, 10, () => rows(p), (now) => JSON.stringify(now) === JSON.stringify(expected));

test("a list in a new order has no next page before its first page has come", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    const refused = [];
    p.page.on("response", (r) => r.ok() || refused.push(r.url()));
    let answer_sorted;
    const sorted_waits = new Promise((go) => (answer_sorted = go));
    await p.page.route("**/api/v1/runs?*", async (route) => {
      const url = route.request().url();
      if (url.includes("sort=time")) await sorted_waits;
      await route.continue({ url: url.replace("limit=50", "limit=2") });
    });
    await p.get("page-on").click();
    await until("the second page", 10, () => p.get("page-words").textContent(), (w) => w.startsWith("3"));
    await p.get("page-back").click();
    await until("the first page", 10, () => p.get("page-words").textContent(), (w) => w.startsWith("1"));
    const asked = p.page.waitForRequest((r) => r.url().includes("sort=time"));
    await p.get("sort-time").click();
    await asked;
    assert.ok(await p.get("page-on").isDisabled());
    answer_sorted();
    await until("the next page", 10, () => p.get("page-on").isEnabled(), (on) => on);
    await p.get("page-on").click();
    await until("the second page", 10, () => p.get("page-words").textContent(), (w) => w.startsWith("3"));
    assert.deepEqual(refused, []);
  }));

test("the search asks the server, and the chips say what they find", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    const chip = (name) => p.get(`chip-${name}`).textContent();
    const { results } = await list();
    await until("all", 5, () => chip("all"), (w) => w === `All${Object.values(results).reduce((a, b) => a + b)}`);
    assert.equal(await chip("reached"), `Reached${results.reached ?? 0}`);
    assert.equal(await chip("collided"), `Collided${results.collided ?? 0}`);
    await p.get("runs-filter").fill("CASE1 orig");
    await shows(p, "one run", [`run-${alone[0]}`]);
    await until("the chips follow", 5, () => chip("all"), (w) => w === "All1");
    await p.get("runs-filter").fill(`case1 ${alone[2]}`);
    await until("by number", 5, () => rows(p), (now) => now.includes(`run-${alone[2]}`) && now.length < 5);
    await p.get("runs-filter").fill("nowhere");
    await p.get("show-all").click();
    await until("all again", 5, () => rows(p), (now) => now.length === 6);
    // A chip finds as many as it says.
    await p.get("chip-background").click();
    await p.get("chip-reached").click();
    const found = (await list("kind=background&result=reached&group=batch")).items.map((r) => (r.group ? `batch-${r.group.first}` : `run-${r.id}`));
    await shows(p, "the reached ones", found);
    await p.get("chip-background").click();
    await p.get("chip-all").click();
  }));

test("the heads sort; unknown figures come last; live and background runs are told apart", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    const head = p.page.locator("th", { has: p.get("sort-time") });
    for (const [order, direction] of [["desc", "descending"], ["asc", "ascending"]]) {
      await p.get("sort-time").click();
      await until(direction, 5, () => head.getAttribute("aria-sort"), (v) => v === direction);
      const { items } = await list(`kind=background&sort=time&order=${order}&group=batch`);
      await p.get("chip-background").click();
      await shows(p, `by time, ${direction}`, items.map((r) => (r.group ? `batch-${r.group.first}` : `run-${r.id}`)));
      await p.get("chip-background").click();
    }
    const live = (await json(server.base, "/session")).run.id;
    assert.equal(await p.get(`kind-${live}`).textContent(), "Live");
    assert.equal(await p.get(`kind-${alone[0]}`).textContent(), "Background");
    assert.equal(await p.get(`kind-${live}`).getAttribute("title"), "Driven live in a session");
    const seeds = await p.page.locator('[data-testid="run-table"] tbody tr:not(.batch) td:nth-child(6)').allTextContents();
    assert.ok(["71", "72", "73", "74"].every((seed) => seeds.includes(seed)), seeds.join(" "));
  }));

test("a run is not started with numbers that cannot be", { timeout: 60_000 }, () =>
  with_page({ size: phone, touch: true }, async (p) => {
    const { total } = await list("kind=background");
    await p.get("start-run").tap();
    const refused = async (seed, repeats, words) => {
      await p.get("start-seed").fill(seed);
      await p.get("start-repeats").fill(repeats);
      await p.get("start-go").tap();
      await until("it says why", 5, () => p.get("start-dialog").locator(".problem").textContent().catch(() => ""), (w) => words.test(w));
    };
    await refused("-5", "1", /seed must be a whole number/);
    await refused("1", "1000000000", /repeats must be a whole number from 1 to 100/);
    await refused("1e300", "1", /seed must be/);
    await refused("1", "2.7", /repeats must be/);
    assert.equal((await list("kind=background")).total, total);
  }));

test("a batch is one line that opens; many are tagged at once", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    const line = p.get(`batch-${batch[0]}`);
    assert.match(await line.textContent(), /3 runs/);
    await p.get(`open-batch-${batch[0]}`).click();
    await p.get(`run-${batch[1]}`).waitFor();
    assert.equal(await p.page.locator("tr.member").count(), 3);
    await p.get(`open-batch-${batch[0]}`).click();
    await p.page.waitForFunction(() => !document.querySelector("tr.member"));
    await p.get(`select-batch-${batch[0]}`).click();
    await p.get(`select-${alone[1]}`).click();
    assert.equal(await p.get("selection-count").textContent(), "4 runs");
    await p.get("selection-tag").click();
    await p.get("tag-text").fill("wet floor, monday");
    await p.get("tag-add").click();
    await until("tagged", 10, () => list("tag=wet%20floor"), (l) => l.total === 4);
    await p.get("selection-bar").waitFor({ state: "detached" });
    await p.get("runs-filter").fill("monday");
    await shows(p, "the tagged ones", [`run-${alone[1]}`, `batch-${batch[0]}`]);
  }));

test("label, tags and note of a run are written, kept and found", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    await p.get(`run-${alone[0]}`).click();
    await p.get("edit-run").click();
    await p.get("remarks-label").fill("Slow start");
    await p.get("remarks-tags").fill("demo");
    await p.get("remarks-note").fill("The left wheel slips.");
    await p.get("remarks-save").click();
    await until("its name", 5, () => p.get("facts-name").textContent(), (w) => w === "Slow start");
    assert.match(await p.get("facts-note").textContent(), /demo.*left wheel/);
    assert.equal(await p.get("facts-kind").textContent(), "background");
    await p.get("runs-filter").fill("wheel slow");
    await shows(p, "found by its note", [`run-${alone[0]}`]);
  }));

test("four runs are compared, with their differences to the first", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    await p.get(`select-${alone[3]}`).click();
    await p.get(`select-${alone[0]}`).click({ modifiers: ["Shift"] });
    assert.equal(await p.get("selection-count").textContent(), "4 runs");
    await p.get("selection-compare").click();
    await p.get(`measures-${alone[0]}`).waitFor({ timeout: 20_000 });
    await until("four rows", 20, () => p.page.locator('[data-testid="measures"] tbody tr').count(), (n) => n === 4);
    const [first, second] = await Promise.all([alone[3], alone[2]].map((id) => json(server.base, `/runs/${id}`)));
    const words = await p.get(`measures-${alone[2]}`).textContent();
    const by = second.metrics.path_length - first.metrics.path_length;
    assert.ok(words.includes(second.metrics.path_length.toFixed(2)) && words.includes(Math.abs(by).toFixed(2)), words);
    await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
    await p.get("timeline").fill("20");
    await p.page.waitForTimeout(500);
    await p.shot("runs-compare");
    assert.deepEqual(await p.accessibility(), []);
    await p.get(`uncompare-${alone[2]}`).click();
    await until("three rows", 10, () => p.page.locator('[data-testid="measures"] tbody tr').count(), (n) => n === 3);
  }));

test("deleted runs come back with Undo; a queued batch is cancelled", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    await p.get(`select-${alone[1]}`).click();
    await p.get(`select-batch-${batch[0]}`).click();
    await p.get("selection-delete").click();
    await p.get(`run-${alone[1]}`).waitFor({ state: "detached" });
    assert.equal((await fetch(`${server.base}/api/v1/runs/${batch[2]}`)).status, 404);
    assert.match(await p.get("toasts").textContent(), /4 runs deleted/);
    await p.get("toast-undo").click();
    await p.get(`run-${alone[1]}`).waitFor();
    await p.get(`batch-${batch[0]}`).waitFor();
    assert.equal((await json(server.base, `/runs/${batch[2]}`)).status, "finished");
    // The open run, by its own button.
    await p.get(`run-${alone[2]}`).click();
    await p.get("delete-run").click();
    await p.get(`run-${alone[2]}`).waitFor({ state: "detached" });
    await p.get("toast-undo").last().click();
    await p.get(`run-${alone[2]}`).waitFor();
    const { runs } = await post("/runs", { scenario: "case1", physics: "kinematic", repeats: 40, pace: 1 });
    await p.get(`select-batch-${runs[0]}`).click({ timeout: 10_000 });
    await p.get("selection-cancel").click();
    await until("cancelled", 20, () => list(`batch=${runs[0]}&result=cancelled`), (l) => l.total === 40);
    await post("/runs/delete", { ids: [], batches: [runs[0]] });
  }));

test("a live run keeps the time of its first outcome", { timeout: 90_000 }, () =>
  with_page({}, async (p) => {
    const control = (body) => post("/session/control", body);
    const put = (goal) => json(server.base, "/session/goal", { method: "PUT", body: JSON.stringify(goal) });
    const { run, pose } = await json(server.base, "/session");
    await control({ action: "speed", speed: 16 });
    await put({ x: pose.x + 0.3, y: pose.y });
    const row = () => json(server.base, `/runs/${run.id}`);
    const { outcome, time } = await until("an outcome", 40, row, (r) => r.outcome !== "running");
    await put({ x: pose.x, y: pose.y });
    await until("it drives on", 30, row, (r) => r.later && r.later.time > time + 8);
    await control({ action: "reset" });
    await until("it ended", 20, row, (r) => r.status === "finished");
    await control({ action: "speed", speed: 1 });
    await until("the row", 10, () => p.get(`run-${run.id}`).textContent(), (w) => w.includes(time.toFixed(1)));
    await p.get(`run-${run.id}`).click();
    await until("its facts", 10, () => p.get("facts").textContent(), (w) => /The run went on to/.test(w));
    assert.match(await p.get("facts-kind").textContent(), /live/);
    assert.equal((await row()).outcome, outcome);
    assert.equal((await row()).time, time);
  }));

test("by keyboard alone: select, delete, undo, sort", { timeout: 60_000 }, () =>
  with_page({}, async (p) => {
    const key = (k) => p.page.keyboard.press(k);
    await p.page.locator(`a.run-link[href="#/runs/${alone[3]}"]`).focus();
    await key("x");
    await key("ArrowDown");
    await key("Shift+ArrowDown");
    assert.equal(await p.get("selection-count").textContent(), "2 runs");
    await key("Escape");
    await until("none selected", 5, () => p.get("selection-bar").count(), (n) => n === 0);
    await p.get(`select-${alone[3]}`).focus();
    await key("Enter");
    await p.get("selection-delete").focus();
    await key("Enter");
    await p.get(`run-${alone[3]}`).waitFor({ state: "detached" });
    await p.get("toast-undo").focus();
    await key("Enter");
    await p.get(`run-${alone[3]}`).waitFor();
    await p.get("sort-scenario").focus();
    await key("Enter");
    await p.page.waitForSelector('th[aria-sort="ascending"]');
    assert.equal((await json(server.base, "/session")).stop, false);
  }));

for (const theme of ["dark", "light"]) {
  test(`at every size, ${theme}: nothing is cut off, and it is accessible`, { timeout: 120_000 }, async () => {
    for (const size of kSizes) {
      const name = `runs-${size.width}x${size.height}-${theme}`;
      await with_page({ size, theme, touch: size.width < 500 }, async (p) => {
        await p.get(`select-${alone[0]}`).click();
        await p.get(`select-${alone[1]}`).click();
        await p.page.waitForTimeout(300);
        await p.shot(`${name}-list`);
        // axe takes a line that is scrolled below the head for a covered one.
        await p.page.evaluate(() => document.querySelectorAll(".rows, .runs").forEach((e) => e.scrollTo(0, 0)));
        assert.deepEqual(await p.accessibility(), [], name);
        const [wide, high] = await p.page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
        assert.ok(wide <= size.width && high <= size.height, `${name} is ${wide} x ${high} px large: Stop can be scrolled away`);
        await p.get("selection-compare").click();
        await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
        await p.get(`measures-${alone[1]}`).waitFor();
        await p.page.waitForTimeout(300);
        await p.shot(`${name}-compare`);
        const cut = await p.page.evaluate(() => [...document.querySelectorAll(".facts > .quiet, .measures thead th")]
          .filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent));
        assert.deepEqual(cut, [], `${name} cuts off words`);
        const { width } = await p.get("timeline").boundingBox();
        assert.ok(width > 90, `${name}: the time is ${width} px wide`);
        assert.deepEqual(await p.accessibility(), [], `${name}, compared`);
      });
    }
  });
}

