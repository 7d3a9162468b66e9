// tests/dev/heap.mjs: the heap of a page left open on a live run, and its time of drawing; by hand:
//   node tests/dev/heap.mjs [MINUTES=20]
// Prints both at each minute. Fails when the heap, the nodes or the listeners keep growing. Typed arrays
// stand beside the heap: the run's own columns fill for a quarter of an hour, up to their bound.
import assert from "node:assert/strict";
import { setTimeout as pause } from "node:timers/promises";
import { launch, open } from "../web/page.mjs";
import { json, scratch, serve } from "../web/program.mjs";

const minutes = Number(process.argv[2] ?? 20);
const kLeg = 15;         // [s] between two goals
const kGrowth = 1.5;     // [MB] of heap, and
const kMoreNodes = 300;  // nodes and listeners, between the second minute and the last

const megabytes = (bytes) => (bytes / 1e6).toFixed(2);

const place = scratch();
const server = await serve({ database: place.database, scenario: "demo" });
const browser = await launch();
try {
  const { base } = server;
  const page = await open(browser, base);
  await json(base, "/session/control", { method: "POST", body: JSON.stringify({ action: "load", scenario: "demo", controller: "strip" }) });
  const home = (await json(base, "/session")).pose;
  const away = { x: 7.5, y: 3.6 };
  const tools = await page.context.newCDPSession(page.page);
  await page.page.mouse.move(500, 450); // cards open and close under it
  const samples = [];
  const first = (await json(base, "/session")).tick;
  const start = Date.now();
  for (let minute = 1; minute <= minutes; ++minute) {
    while (Date.now() - start < minute * 60_000) {
      const to = Math.floor((Date.now() - start) / (kLeg * 1000)) % 2 === 0 ? away : home;
      await json(base, "/session/goal", { method: "PUT", body: JSON.stringify({ x: to.x, y: to.y }) });
      await pause(Math.min(kLeg * 1000, minute * 60_000 - (Date.now() - start)) + 1);
    }
    await tools.send("HeapProfiler.collectGarbage");
    const { usedSize, backingStorageSize = 0 } = await tools.send("Runtime.getHeapUsage");
    const { nodes, jsEventListeners: listeners } = await tools.send("Memory.getDOMCounters");
    const drawn = await page.get("draw-time").innerText();
    const rate = await page.get("link").innerText();
    samples.push({ heap: usedSize, nodes, listeners });
    console.log(`minute ${minute}: heap ${megabytes(usedSize)} MB, typed arrays ${megabytes(backingStorageSize)} MB, ` +
      `${nodes} nodes, ${listeners} listeners. ${drawn} ${rate}`);
  }
  const { tick } = await json(base, "/session");
  console.log(`${((tick - first) / (minutes * 60)).toFixed(1)} ticks a second`);
  const [from, to] = [samples[Math.min(1, samples.length - 1)], samples.at(-1)];
  assert.ok(to.heap - from.heap < kGrowth * 1e6, `the heap grew by ${megabytes(to.heap - from.heap)} MB`);
  for (const what of ["nodes", "listeners"]) assert.ok(to[what] - from[what] < kMoreNodes, `${what} grew by ${to[what] - from[what]}`);
  await page.close();
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
