// tests/dev/runs_load.mjs: how fast a server with 20,000 stored runs lists, searches and sorts them, and
// the heap of a page that does so. Run by hand:
//   TAUTLINE_FILL=/tmp/many.db build/release/tests/test_db --gtest_filter='RunListLoadTest.*'
//   node tests/dev/runs_load.mjs /tmp/many.db [TIMES=100]
import { copyFileSync } from "node:fs";
import { launch, open } from "../web/page.mjs";
import { scratch, serve, until } from "../web/program.mjs";

const kTimes = Number(process.argv[3] ?? 100);
const kPath = "/api/v1/runs?limit=50";
const kAsked = {
  "list": "", "list in batches": "&group=batch", "search": "&q=floor+39", "search in batches": "&q=case+modi&group=batch",
  "sort by time": "&sort=time&order=asc", "sort by clearance, stuck": "&sort=min_clearance&result=stuck",
  "sort in batches": "&sort=path_length&group=batch", "a tag": "&tag=wet",
};
const kMegabyte = 2 ** 20;

const place = scratch();
copyFileSync(process.argv[2], place.database);
const server = await serve({ database: place.database, scenario: "demo" });
const browser = await launch(["--js-flags=--expose-gc"]);
try {
  for (const [name, query] of Object.entries(kAsked)) {
    const ms = [];
    for (let i = 0; i < kTimes; ++i) {
      const from = performance.now();
      const answer = await fetch(server.base + kPath + query);
      await answer.text();
      if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
      ms.push(performance.now() - from);
    }
    ms.sort((a, b) => a - b);
    const at = (share) => ms[Math.ceil(kTimes * share) - 1].toFixed(1).padStart(7);
    console.log(`${name.padEnd(28)} p50 ${at(0.5)} ms   p99 ${at(0.99)} ms`);
  }
  const p = await open(browser, server.base, { hash: "#/runs" });
  const cdp = await p.context.newCDPSession(p.page);
  const heap = async (when) => {
    await cdp.send("HeapProfiler.collectGarbage");
    const { usedSize } = await cdp.send("Runtime.getHeapUsage");
    console.log(`heap ${when.padEnd(23)} ${(usedSize / kMegabyte).toFixed(1)} MB`);
  };
  await p.page.locator("a.run-link").first().waitFor();
  await heap("of the list");
  for (const word of ["case1", "wet", "39", "modified", ""]) {
    await p.get("runs-filter").fill(word);
    await p.page.waitForTimeout(500);
  }
  for (const sort of ["time", "min_clearance", "scenario", "id"]) await p.get(`sort-${sort}`).click();
  await heap("after searches");
  for (let i = 0; i < 40; ++i) {
    const before = await p.get("page-words").textContent();
    await p.get("page-on").click();
    await until("the next page", 10, () => p.get("page-words").textContent(), (w) => w !== before);
  }
  await heap("after 40 pages");
  await p.close();
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
