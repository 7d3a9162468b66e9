// tests/web/newcomer.mjs: five tasks of somebody who opens the page for the first time, each in at most three
// interactions. Run like e2e.mjs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

const kMost = 3;

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

for (const [name, options] of [["by mouse", { size: desktop }], ["by touch", { size: phone, touch: true }]]) {
  test(`a case, a goal, an obstacle, a comparison, a download, ${name}`, { timeout: 180_000 }, async () => {
    const place = scratch();
    const server = await serve({ database: place.database, scenario: "demo" });
    const session = () => json(server.base, "/session");
    const p = await open(browser, server.base, options);
    /** Does `steps` of one interaction each. */
    const task = async (what, ...steps) => {
      assert.ok(steps.length <= kMost, `${what}: ${steps.length} interactions`);
      for (const step of steps) await step();
    };
    const press = (id) => () => p.get(id).first().click();
    const point = (x, y) => async () => {
      const at = await p.pixels(x, y);
      await p.page.mouse.click(at.x, at.y);
    };
    try {
      await task("load a case", press("scenario-menu"), press("scenario-case1"));
      await until("the case", 10, session, (s) => s.scenario.name === "case1");

      await task("set a goal", press("tool-goal"), point(2, 4));
      await until("the goal", 10, session, (s) => near(s.goal?.x, 2, 0.1) && near(s.goal?.y, 4, 0.1));

      await task("drop an obstacle", press("tool-cylinder"), point(3, 1));
      await until("the obstacle", 10, session, (s) => s.obstacles.length === 2);
      const { run } = await until("ticks", 10, session, (s) => s.stamp > 2);

      // Its run ends with the reset; both controllers then drive until they arrive.
      await json(server.base, "/session/control", { method: "POST", body: '{"action":"reset"}' });
      const driven = (await json(server.base, "/runs", { method: "POST", body: '{"scenario":"case3"}' })).runs[0];
      await until("a run", 60, () => json(server.base, `/runs/${driven}`), (r) => r.status === "finished");
      await task("compare two controllers", press("nav-runs"), press(`run-${driven}`),
        () => p.get("drive-again").selectOption("strip"));
      const other = await until("the other run", 60, async () => (await json(server.base, "/runs?limit=1")).items[0],
        (r) => r.id > driven && r.status === "finished");
      assert.equal(other.controller, "strip");
      const [a, b] = await Promise.all([driven, other.id].map((id) => json(server.base, `/runs/${id}`)));
      assert.deepEqual([b.seed, b.document.scenario.obstacles], [a.seed, a.document.scenario.obstacles], "the same world");
      await p.get(`measures-${other.id}`).waitFor({ state: "attached" });
      await p.shot(`newcomer-compare-${name.slice(3)}`);

      await p.page.evaluate(() => (location.hash = "#/drive"));
      const download = p.page.waitForEvent("download");
      await task("download the run", press("nav-runs"), press(`run-${run.id}`), press("csv"));
      const lines = readFileSync(await (await download).path(), "utf8").split("\n");
      assert.match(lines[0], /tick/);
      assert.ok(lines.length > 20, `${lines.length} lines`);
      await p.close();
    } finally {
      await server.stop();
      place.remove();
    }
  });
}
