// tests/web/endings.mjs: signals, full files and closed pipes end no program silently and lose no run.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { openSync } from "node:fs";
import net from "node:net";
import { test } from "node:test";
import { binary, json, scratch, serve, until } from "./program.mjs";

const post = (base, path, body) => json(base, path, { method: "POST", body: JSON.stringify(body) });
const at_full_speed = (base) => post(base, "/session/control", { action: "speed", speed: 0 });
const state = (base) => json(base, "/session");

/** Status and words of `tautline ARGS`; `stdio` as for spawn. `meanwhile` runs before its output is read. */
async function tautline(args, stdout = "pipe", meanwhile = async () => {}) {
  const child = spawn(binary, args, { stdio: ["ignore", stdout, "pipe"] });
  const ended = new Promise((resolve) => child.once("close", resolve));
  let said = "";
  child.stderr.on("data", (bytes) => (said += bytes));
  await meanwhile();
  child.stdout?.resume();
  return { status: await ended, said };
}

test("SIGHUP ends the program in order, and its run is interrupted", async (t) => {
  const { database, remove } = scratch();
  t.after(remove);
  const first = await serve({ database });
  t.after(first.kill);
  await until("some ticks", 20, () => state(first.base), (session) => session.stamp > 1);
  assert.equal(await first.stop("SIGHUP"), 0);
  const second = await serve({ database, scenario: null });
  t.after(second.kill);
  const { items } = await json(second.base, "/runs?status=interrupted");
  assert.equal(items.length, 1);
  await second.stop();
});

test("a file that may not grow ends no run, and the page is told", async (t) => {
  const { database, remove } = scratch();
  t.after(remove);
  const server = await serve({ database, limit: "ulimit -f 400" });
  t.after(server.kill);
  await at_full_speed(server.base);
  const failed = await until("a record that fails", 30, () => state(server.base),
    (now) => now.record.status === "failed");
  assert.match(failed.record.sentence, /disk/);
  await until("ticks without a record", 20, () => state(server.base), (now) => now.stamp > failed.stamp);
  await until("a record that goes on", 30, () => state(server.base), (now) => now.record.status !== "failed");
  await server.stop();
});

test("the program's output is not read, and viewers leave in the middle of a message", async (t) => {
  const { database, remove } = scratch();
  t.after(remove);
  const server = await serve({ database });
  t.after(server.kill);
  server.hang_up();
  for (let i = 0; i < 20; ++i) {
    await new Promise((resolve) => {
      const socket = net.connect(server.port, "127.0.0.1", () => {
        socket.write("GET /api/v1/catalog HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
        setTimeout(() => { socket.resetAndDestroy(); resolve(); }, i);
      });
    });
  }
  assert.ok((await state(server.base)).run.id > 0);
  assert.equal(await server.stop(), 0);
});

test("a run deleted during its export leaves an incomplete table and a sentence", async (t) => {
  const { database, remove } = scratch();
  t.after(remove);
  assert.equal((await tautline(["run", "case1", "--vehicle", "kinematic", "--out", database])).status, 0);
  const server = await serve({ database, scenario: null });
  t.after(server.kill);
  const whole = await tautline(["export", "1", "--db", database]);
  assert.deepEqual(whole, { status: 0, said: "" });
  // Its pipe stays full until the run is deleted.
  const cut = await tautline(["export", "1", "--db", database], "pipe", async () => {
    await new Promise((resolve) => setTimeout(resolve, 500));
    assert.equal((await fetch(`${server.base}/api/v1/runs/1`, { method: "DELETE" })).status, 204);
  });
  assert.equal(cut.status, 4);
  assert.match(cut.said, /deleted/);
  await server.stop();
});

test("output that cannot be written is an error", async () => {
  const full = openSync("/dev/full", "w");
  for (const args of [["--version"], ["run", "case1", "--vehicle", "kinematic"]]) {
    const { status, said } = await tautline(args, full);
    assert.equal(status, 1, args.join(" "));
    assert.match(said, /could not be written/);
  }
});
