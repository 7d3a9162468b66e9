// tests/dev/soak.mjs: hours of driving with a page and a client that never reads; by hand:
//   node tests/dev/soak.mjs [HOURS=2] [SPEED=8]
// Prints memory and ticks. Fails when ticks are lost, the page falls silent, or memory keeps growing.
import assert from "node:assert/strict";
import { randomBytes } from "node:crypto";
import { readFileSync } from "node:fs";
import { connect } from "node:net";
import { setTimeout as pause } from "node:timers/promises";
import { launch, open } from "../web/page.mjs";
import { json, scratch, serve } from "../web/program.mjs";

const hours = Number(process.argv[2] ?? 2);
const speed = Number(process.argv[3] ?? 8);
const post = (base, path, body, method = "POST") =>
  json(base, path, { method, headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });

/** Text in a masked WebSocket frame, up to 125 bytes. */
function frame(text) {
  const mask = randomBytes(4);
  const body = Buffer.from(text).map((byte, i) => byte ^ mask[i % 4]);
  return Buffer.concat([Buffer.from([0x81, 0x80 | body.length]), mask, body]);
}

/** Subscribes to telemetry and then never reads again. */
async function slow_client(port, channel) {
  const socket = connect(port, "127.0.0.1");
  await new Promise((resolve) => socket.once("connect", resolve));
  socket.write(`GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
    `Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.websocket.v1\r\n` +
    `Sec-WebSocket-Key: ${randomBytes(16).toString("base64")}\r\n\r\n`);
  await new Promise((resolve) => socket.once("data", resolve));
  socket.pause();
  socket.on("error", () => {});
  socket.write(frame(JSON.stringify({ op: "subscribe", subscriptions: [{ id: 1, channelId: channel }] })));
  return socket;
}

function memory(pid) {
  const status = readFileSync(`/proc/${pid}/status`, "utf8");
  return Number(status.match(/VmRSS:\s+(\d+)/)[1]) / 1024; // [MiB]
}

const median = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];

const place = scratch();
const server = await serve({ database: place.database, scenario: "demo" });
const browser = await launch();
try {
  const page = await open(browser, server.base, {});
  const stalled = [];
  for (const channel of [1, 2]) stalled.push(await slow_client(server.port, channel));
  await post(server.base, "/session/control", { action: "speed", speed });
  const home = (await json(server.base, "/session")).pose;
  const away = (await json(server.base, "/session")).goal ?? { x: 3, y: 3 };
  const samples = [];
  const start = Date.now();
  let told = -1;
  for (let leg = 0; Date.now() - start < hours * 3_600_000;) {
    await pause(2000);
    const s = await json(server.base, "/session");
    assert.equal(s.problem, null);
    assert.equal(s.lost_ticks, 0, "ticks were lost");
    if (s.mission !== "driving") {
      const goal = ++leg % 2 ? home : away;
      await post(server.base, "/session/goal", { x: goal.x, y: goal.y }, "PUT");
    }
    samples.push({ t: (Date.now() - start) / 60_000, rss: memory(server.pid), ticks: s.tick });
    const minutes = Math.floor(samples.at(-1).t);
    if (minutes % 5 === 0 && minutes !== told) {
      told = minutes;
      console.log(`${minutes} min: ${samples.at(-1).rss.toFixed(1)} MiB, tick ${s.tick}, ${leg} legs, ` +
        `page at ${await page.get("time").textContent().catch(() => "?")}`);
    }
  }
  // The first fifth is warm-up: pools, the database's cache, the drawn path.
  const settled = samples.filter((s) => s.t > hours * 12);
  const half = settled.length >> 1;
  const early = median(settled.slice(0, half).map((s) => s.rss));
  const late = median(settled.slice(half).map((s) => s.rss));
  const s = await json(server.base, "/session");
  await post(server.base, "/session/control", { action: "reset" });
  await pause(2000);
  const run = await json(server.base, `/runs/${s.run.id}`);
  console.log(`memory: ${early.toFixed(1)} MiB in the earlier half, ${late.toFixed(1)} MiB in the later`);
  console.log(`ticks: ${run.ticks} recorded, ${run.lost_ticks} lost, ${(run.bytes / 1e6).toFixed(0)} MB`);
  assert.ok(late < early * 1.05 + 2, "memory keeps growing");
  assert.equal(run.lost_ticks, 0);
  assert.ok(run.ticks >= samples.at(-1).ticks);
  await page.close();
  for (const socket of stalled) socket.destroy();
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
