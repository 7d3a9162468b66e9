// tests/web/firstload.mjs: the bytes that the first view of Drive costs, as the browser counts them
// on the wire, and what a second visit fetches.
import assert from "node:assert/strict";
import { test } from "node:test";
import { desktop, launch, phone } from "./page.mjs";
import { scratch, serve } from "./program.mjs";

const kBudget = 100_000; // [bytes] over HTTP, with headers, without the record of the run so far

/** Opens the page in `context`, and all its requests, once none has come for a second. */
async function visit(context, base, accepts) {
  const page = await context.newPage();
  const client = await context.newCDPSession(page);
  await client.send("Network.enable");
  // To other hosts browsers offer brotli over HTTPS only.
  await client.send("Network.setExtraHTTPHeaders", { headers: { "Accept-Encoding": accepts } });
  const requests = new Map();
  let newest = Date.now();
  client.on("Network.requestWillBeSent", (e) => {
    newest = Date.now();
    requests.set(e.requestId, { path: new URL(e.request.url).pathname, bytes: 0, cached: false, coding: "" });
  });
  client.on("Network.responseReceived", (e) => {
    const request = requests.get(e.requestId);
    if (!request) return;
    request.cached = e.response.fromDiskCache || e.response.fromPrefetchCache;
    request.coding = e.response.headers["Content-Encoding"] ?? "";
    request.control = e.response.headers["Cache-Control"] ?? "";
  });
  client.on("Network.requestServedFromCache", (e) => requests.has(e.requestId) && (requests.get(e.requestId).cached = true));
  client.on("Network.loadingFinished", (e) => {
    newest = Date.now();
    if (requests.has(e.requestId)) requests.get(e.requestId).bytes = e.encodedDataLength;
  });
  await page.goto(`${base}/`);
  await page.waitForSelector('[data-testid="link"].open', { timeout: 20_000 });
  while (Date.now() - newest < 1000) await page.waitForTimeout(100);
  await page.close();
  return [...requests.values()].filter((r) => !r.path.startsWith("/api/v1/runs/"));
}

for (const [accepts, size] of [["gzip, br", desktop], ["gzip", phone]]) test(
  `by ${accepts} at ${size.width} px the first load of Drive is small, and the second fetches no part again`,
  { timeout: 90_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "demo" });
  const browser = await launch();
  try {
    const context = await browser.newContext({ viewport: size });
    const first = await visit(context, server.base, accepts);
    const bytes = first.reduce((sum, r) => sum + r.bytes, 0);
    const list = first.map((r) => `${String(r.bytes).padStart(7)} ${r.coding.padEnd(4)} ${r.path}`).join("\n");
    console.log(`${bytes} bytes over the wire:\n${list}`);
    assert.ok(bytes > 20_000, "something was counted");
    assert.ok(bytes <= kBudget, `${bytes} bytes, at most ${kBudget}:\n${list}`);
    const parts = first.filter((r) => /\.(js|css)$/.test(r.path));
    assert.ok(parts.length >= 2);
    for (const part of parts) {
      assert.match(part.coding, /gzip|br/, part.path);
      assert.match(part.control, /immutable/, part.path);
    }
    const second = await visit(context, server.base, accepts);
    const again = second.filter((r) => /\.(js|css)$/.test(r.path) && !r.cached && r.bytes > 0);
    assert.deepEqual(again.map((r) => r.path), []);
  } finally {
    await browser.close();
    await server.stop();
    place.remove();
  }
});
