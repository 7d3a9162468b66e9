// tests/web/sessions.mjs: each visitor a session of their own, in a real browser against the real
// program. Run with TAUTLINE_BIN=build/release/server/tautline node --test tests/web/sessions.mjs
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

async function with_server(more, act) {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1", more });
  try {
    await act(server.base);
  } finally {
    await server.stop();
    place.remove();
  }
}

const id_of = (p) => new URL(p.page.url()).searchParams.get("session");
const post = (base, path, body) => json(base, path, { method: "POST", body: JSON.stringify(body) });

test("two visitors have a world each, and an ended session is reported", { timeout: 120_000 }, () =>
  with_server(["--per-visitor"], async (base) => {
    const p = await open(browser, base);
    const q = await open(browser, base);
    assert.match(id_of(p), /^[0-9a-f]{32}$/);
    assert.notEqual(id_of(p), id_of(q));
    const session = (page) => () => json(base, `/sessions/${id_of(page)}`);

    // Changes by one visitor appear neither in the other's world nor on the other's page.
    await p.get("stop").click();
    await until("stopped", 10, session(p), (s) => s.stop);
    await post(base, `/sessions/${id_of(p)}/obstacles`, { type: "cylinder", x: 1, y: 4.5, radius: 0.1 });
    const mine = await session(p)();
    const theirs = await session(q)();
    assert.equal(theirs.stop, false);
    assert.equal(theirs.obstacles.length, mine.obstacles.length - 1);
    assert.equal(await q.get("stop").getAttribute("aria-pressed"), "false");
    assert.equal((await json(base, "/session")).stop, false);

    // The page may be opened again, and shows the same session.
    await p.page.reload();
    await p.page.waitForSelector('[data-testid="link"].open');
    await until("the same session", 10, () => p.get("stop").getAttribute("aria-pressed"), (v) => v === "true");

    const old = id_of(p);
    await json(base, `/sessions/${old}`, { method: "DELETE" });
    await p.get("session-gone").waitFor();
    assert.match(await p.get("session-gone").innerText(), /has ended/);
    assert.deepEqual(await p.accessibility(), []);
    await p.shot("session-gone");
    await p.get("session-new").click();
    await p.page.waitForSelector('[data-testid="link"].open');
    assert.notEqual(id_of(p), old);
    assert.equal(await p.get("session-gone").count(), 0);
    assert.equal((await session(p)()).stop, false);
    assert.equal((await session(q)()).stop, false);
    await p.close(/404/); // requests of the page while its session ended
    await q.close();
  }));

test("a full server shows a message, and a page shows the session of its address", { timeout: 120_000 }, () =>
  with_server(["--per-visitor", "--sessions", "1"], async (base) => {
    const { id } = await post(base, "/sessions", { scenario: "case2" });
    const p = await open(browser, base, { hash: `?session=${id}` });
    await until("its world", 10, () => p.get("scenario-menu").getAttribute("data-scenario"), (v) => v === "case2");
    await p.close();

    const context = await browser.newContext();
    const page = await context.newPage();
    await page.goto(`${base}/`);
    await page.getByTestId("session-gone").waitFor();
    assert.match(await page.getByTestId("session-gone").innerText(), /as many as this server has room for/);
    await context.close();
  }));
