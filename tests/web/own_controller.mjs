// tests/web/own_controller.mjs: a controller outside the program drives a live session, thinks for long,
// fails; other sessions go on.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { desktop, launch, open } from "./page.mjs";
import { json, repository, scratch, serve, until } from "./program.mjs";

const kScript = `
import os, sys, time
sys.path.insert(0, ${JSON.stringify(join(repository, "docs/examples"))})
import tautline
ticks = 0
def update(seen):
    global ticks
    ticks += 1
    if ticks == 60:
        time.sleep(5)
    if ticks == 200:
        raise ValueError("no idea what to do now")
    return tautline.Answer(0.1, 0.0, what="Counting ticks", why="This is tick %d of mine." % ticks)
tautline.drive(update)
`;

test("a controller of one's own: its words, its silence, its end", { timeout: 120_000 }, async () => {
  const place = scratch();
  const script = join(place.folder, "mine.py");
  writeFileSync(script, kScript);
  const server = await serve({ database: place.database, scenario: "case1", more: ["--controller", `mine=python3 ${script}`] });
  const browser = await launch();
  try {
    const p = await open(browser, server.base, { size: desktop });
    await p.get("controller").selectOption("mine");
    await p.page.getByText("Counting ticks").first().waitFor();
    const { id } = await json(server.base, "/sessions", { method: "POST", body: '{"scenario":"case1"}' });
    const other = async () => (await json(server.base, `/sessions/${id}`)).tick;
    await p.page.getByText(/Has waited .* for mine/).waitFor({ timeout: 30_000 });
    const before = await other();
    await until("the other session goes on", 3, other, (tick) => tick > before + 20);
    await p.page.getByText(/Has waited .* for mine/).waitFor(); // still
    await p.page.getByText("no idea what to do now").first().waitFor({ timeout: 60_000 });
    const { problem } = await json(server.base, "/session");
    assert.match(problem, /The controller 'mine' failed at tick \d+\. It ended with status 1\. Its last lines:/);
    await p.close();
  } finally {
    await browser.close();
    await server.stop().catch(() => undefined);
    place.remove();
  }
});
