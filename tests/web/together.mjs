// tests/web/together.mjs: two pages edit one world at the same time, and neither loses or undoes the other's
// work. By default for a quarter of a minute; with TAUTLINE_LONG=1 for ten.
import assert from "node:assert/strict";
import { test } from "node:test";
import { launch, open } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

const kTime = process.env.TAUTLINE_LONG ? 600_000 : 15_000; // [ms]
const kMostOwn = 6; // obstacles of one page

/** A small generator, so that a failure can be repeated. */
function random_of(seed) {
  let state = seed;
  return () => (state = (state * 16807) % 2147483647) / 2147483647;
}

test("two pages add, move and undo in one world", { timeout: kTime + 120_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1" });
  const obstacles = async () => (await json(server.base, "/session/obstacles")).items;
  const scenario = { name: "free", start: { x: 0, y: 0, heading: 0 }, goal: { x: 0.5, y: 0 }, controller: "strip" };
  await json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action: "load", scenario }) });
  const browser = await launch();
  let steps = 0;

  /** One person, who makes obstacles of one kind in one half of the world. */
  const person = async (kind, x0, seed) => {
    const p = await open(browser, server.base);
    if (await p.get("layers").getAttribute("aria-expanded") === "true") await p.get("layers").click();
    const random = random_of(seed);
    const near = (a, b) => Math.hypot(a.x - b.x, a.y - b.y) < 0.3; // it snaps
    let own = [];          // places where this page's obstacles have to stand
    const back = [];       // what each undo has to bring back
    const is = async (what) => {
      const list = await until(`${kind}: ${what} ${JSON.stringify(own)}`, 10,
        async () => (await obstacles()).filter((o) => o.type === kind),
        (all) => all.length === own.length && own.every((at) => all.some((o) => near(o, at)))).catch(async (error) => {
        error.message += `; the page says ${JSON.stringify(await p.page.locator(".toast").allInnerTexts())}`;
        await p.shot(`together-${kind}`);
        throw error;
      });
      own = list.map(({ x, y }) => ({ x, y })); // as they snapped
      await p.page.waitForTimeout(250); // the page hears of it a little later than this test
    };
    const free = (at) => own.every((other) => Math.hypot(at.x - other.x, at.y - other.y) > 0.9);
    const somewhere = () => ({ x: x0 + 2.2 * random(), y: 1.2 + 2.5 * random() });
    const does = {
      async add() {
        const at = somewhere();
        if (own.length >= kMostOwn || !free(at)) return;
        await p.get(`tool-${kind}`).click();
        const px = await p.pixels(at.x, at.y);
        await p.page.mouse.click(px.x, px.y);
        back.push(own);
        own = [...own, at];
        await is("added");
      },
      async move() {
        const from = own[Math.floor(random() * own.length)];
        const to = somewhere();
        if (!from || !free(to)) return;
        await p.page.keyboard.press("v");
        const a = await p.pixels(from.x, from.y);
        await p.page.mouse.click(a.x, a.y);
        await p.get("obstacle-values").waitFor();
        await p.drag(await p.pixels(from.x, from.y), await p.pixels(to.x, to.y));
        back.push(own);
        own = own.map((at) => (at === from ? to : at));
        await is("moved");
      },
      async undo() {
        if (back.length === 0) return;
        await p.page.keyboard.press("Escape");
        await p.get("undo").click();
        own = back.pop();
        await is("undone");
      },
    };
    const end = Date.now() + kTime;
    while (Date.now() < end) {
      await does[["add", "add", "move", "move", "undo"][Math.floor(random() * 5)]]();
      ++steps;
    }
    return { p, is };
  };

  try {
    const people = await Promise.all([person("cylinder", 1.6, 7), person("box", -3, 11)]);
    const all = await obstacles();
    for (const { p, is } of people) {
      await is("at the end");
      await p.get("scene").focus();
      await p.page.keyboard.press("Escape");
      // What each page shows is what the server has, whoever made it.
      const shown = await p.page.evaluate(async () => {
        const titles = [];
        for (let i = 0; i < 40; ++i) {
          dispatchEvent(new KeyboardEvent("keydown", { key: "n" }));
          await new Promise((done) => setTimeout(done, 250));
          const title = document.querySelector('[data-testid="obstacle-values"] b')?.textContent;
          if (title) titles.push(title);
          else if (!document.querySelector('[data-testid="goal-values"]')) break;
        }
        return titles.length;
      });
      assert.equal(shown, all.length);
      await p.close();
    }
    console.log(`# ${steps} steps, ${all.length} obstacles at the end`);
    assert.ok(steps >= 20, `${steps} steps`);
  } finally {
    await browser.close();
    await server.stop();
    place.remove();
  }
});
