// tests/dev/sessions_bench.mjs [WORLDS=200] [SECONDS=30]: many sessions in one process, each with a
// world in real time, a record and a viewer; then Stop beside ten sessions at full speed and a batch of
// experiments. Prints the lateness of ticks, the memory of a session, and the time of a Stop.
// Run with TAUTLINE_BIN=build/release/server/tautline on an otherwise idle machine.
import { readFileSync } from "node:fs";
import { json, require, scratch, serve } from "../web/program.mjs";

const WebSocket = require("ws");
const worlds = Number(process.argv[2] ?? 200);
const seconds = Number(process.argv[3] ?? 30);
const kFast = 10;
const kStops = 200;

const sleep = (s) => new Promise((resolve) => setTimeout(resolve, 1000 * s));
const post = (base, path, body) => json(base, path, { method: "POST", body: JSON.stringify(body) });

/** [MB] that the process holds in memory. */
const memory = (pid) => Number(readFileSync(`/proc/${pid}/status`, "utf8").match(/VmRSS:\s+(\d+)/)[1]) / 1024;

/** [s] of processor time used so far. */
function processor(pid) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

/** Looks at the frames and the state of a session, as the page does. */
function watch(base, id, seen) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(`${base.replace("http", "ws")}/ws?session=${id}`, ["foxglove.websocket.v1"]);
    socket.on("message", (data, binary) => {
      if (binary) {
        if (data[0] === 1) ++seen.frames;
        return;
      }
      const message = JSON.parse(data);
      if (message.op !== "advertise") return;
      const channels = message.channels.filter((c) => ["/telemetry", "/state", "/log"].includes(c.topic));
      socket.send(JSON.stringify({
        op: "subscribe", subscriptions: channels.map((c) => ({ id: c.id, channelId: c.id })),
      }));
      resolve(socket);
    });
    socket.on("error", reject);
  });
}

/** Ticks of all sessions but main, by how late they were. */
async function lateness(base) {
  const counts = new Map();
  let worst = 0;
  for (const item of (await json(base, "/sessions")).items) {
    if (item.id === "main") continue;
    for (const { below, ticks } of item.lateness.buckets) counts.set(below, (counts.get(below) ?? 0) + ticks);
    worst = Math.max(worst, item.lateness.worst);
  }
  return { counts, worst };
}

/** Upper end [ms] of the bucket in which that share of the ticks since `before` lies. */
function quantile(before, now, share) {
  const rows = [...now.counts].map(([below, n]) => [below, n - (before.counts.get(below) ?? 0)]);
  const all = rows.reduce((sum, [, n]) => sum + n, 0);
  let so_far = 0;
  for (const [below, n] of rows) {
    so_far += n;
    if (so_far >= share * all) return below === null ? "more" : `< ${1000 * below} ms`;
  }
  return "none";
}

const place = scratch();
const server = await serve({ database: place.database, scenario: "demo", more: ["--sessions", String(worlds + kFast)] });
const { base, pid } = server;
try {
  await post(base, "/session/control", { action: "pause" });
  const seen = { frames: 0 };
  const first = memory(pid);
  const sockets = [];
  const ids = [];
  for (let i = 0; i < worlds; ++i) {
    const { id } = await post(base, "/sessions", { scenario: "demo", controller: "modified", vehicle: "bullet", seed: i + 1 });
    ids.push(id);
    sockets.push(await watch(base, id, seen));
  }
  await sleep(3);
  const period = (await json(base, `/sessions/${ids[0]}`)).robot.period;
  const before = await lateness(base);
  const frames = seen.frames;
  const used = processor(pid);
  await sleep(seconds);
  const now = await lateness(base);
  const ticks = [...now.counts.values()].reduce((a, b) => a + b, 0) - [...before.counts.values()].reduce((a, b) => a + b, 0);
  console.log(`${worlds} worlds in real time, recorded and watched, for ${seconds} s; half a tick is ${(500 * period).toFixed(1)} ms`);
  console.log(`  ticks ${ticks} of ${Math.round(worlds * seconds / period)}, frames seen ${seen.frames - frames}`);
  console.log(`  lateness p50 ${quantile(before, now, 0.5)}, p99 ${quantile(before, now, 0.99)}, worst ever ${(1000 * now.worst).toFixed(1)} ms`);
  console.log(`  processor ${((processor(pid) - used) / seconds).toFixed(2)} of one, memory ${((memory(pid) - first) / worlds).toFixed(2)} MB a session`);

  for (const id of ids) await json(base, `/sessions/${id}`, { method: "DELETE" });
  for (const socket of sockets) socket.close();
  for (let i = 0; i < kFast; ++i) {
    const { id } = await post(base, "/sessions", { scenario: "demo", controller: "modified", vehicle: "bullet" });
    await post(base, `/sessions/${id}/control`, { action: "speed", speed: 0 });
  }
  await post(base, "/runs", { scenario: "demo", repeats: 1000 });
  await post(base, "/session/control", { action: "play" });
  const took = [];
  for (let i = 0; i < kStops; ++i) {
    const began = performance.now();
    await post(base, "/session/control", { action: "stop" });
    took.push(performance.now() - began);
    await post(base, "/session/control", { action: "release" });
    await sleep(0.02);
  }
  took.sort((a, b) => a - b);
  console.log(`Stop beside ${kFast} sessions as fast as they go and a batch: p50 ${took[kStops / 2].toFixed(1)} ms, ` +
    `p99 ${took[Math.floor(0.99 * kStops)].toFixed(1)} ms, worst ${took.at(-1).toFixed(1)} ms`);
} finally {
  await server.stop();
  place.remove();
}
