// tests/web/past.test.ts: what a page missed of a run is fetched from the record.
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Past } from "../../web/src/link/past";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import { hand_wound } from "./timers";
import { FrameSpec, add_cylinder, frame_bytes, framed } from "./wire";

const settled = () => new Promise((resolve) => setImmediate(resolve));

/** A page on a run of which obstacle 7 was added at tick 15 and obstacle 8 at tick 130. */
function watching() {
  const timers = hand_wound();
  const kept = globalThis.fetch;
  const server = { asked: [] as string[], down: false, tick: 20, recorded_to: Infinity, run: 1 };
  const spec = (tick: number): FrameSpec => ({ tick, pose: [tick / 100, 0, 0],
    requests: tick === 15 ? [add_cylinder(7, 1, 1, 0.2)] : tick === 130 ? [add_cylinder(8, 2, 1, 0.2)] : [] });
  globalThis.fetch = (async (path: string) => {
    server.asked.push(path.replace("/api/v1/runs/1/", ""));
    if (server.down) throw new Error("down");
    if (path.endsWith("/session")) return new Response(JSON.stringify({ run: { id: server.run }, tick: server.tick }));
    const [from, limit] = [...path.matchAll(/=(\d+)/g)].map((m) => Number(m[1]));
    if (path.includes("/ticks")) {
      const items = Array.from({ length: 5 }, (_, i) => ({ t: (from + i) * 0.026, tick: from + i, x: (from + i) / 100, y: 0 }));
      return new Response(JSON.stringify({ items, next: null }));
    }
    const found = [from, 15, 130].filter((t) => t <= server.recorded_to).filter((t, i) => t >= from && t < from + limit && (i === 0 || t !== from));
    return new Response(framed(found.map((t) => frame_bytes(spec(t)))) as BodyInit);
  }) as typeof fetch;
  const scene = new_scene();
  scene.run = 1;
  let recorded = true;
  const past = new Past(scene, 1000, () => recorded, () => undefined);
  return {
    scene, past, server,
    see(from: number, to = from) {
      for (let tick = from; tick <= to; ++tick) {
        const f = decode_frame(frame_bytes(spec(tick)), new Legends());
        fold_frame(scene, f);
        past.see(f);
      }
    },
    async later(ms = 2500) {
      timers.tick(ms);
      for (let i = 0; i < 5; ++i) await settled();
    },
    record: (on: boolean) => (recorded = on),
    marks: () => scene.events.list.map((e) => `${e.label} ${Math.round(e.t / 0.026)}`),
    end() {
      timers.restore();
      globalThis.fetch = kept;
    },
  };
}

test("events of ticks that were passed over are fetched once they are recorded, each once", async () => {
  const w = watching();
  w.see(0, 9);
  await w.later();
  assert.deepEqual(w.server.asked, [], "nothing was missed");
  w.see(20);
  w.see(22);
  await w.later(2400);
  assert.deepEqual(w.server.asked, []);
  await w.later(100);
  assert.deepEqual(w.server.asked, ["events?from=10&limit=12"]);
  assert.deepEqual(w.marks(), ["Obstacle added 15"]);
  const now = [{ id: 7, kind: "cylinder" as const, pose: { x: 1, y: 1, heading: 0 }, radius: 0.2, length: 0, width: 0, points: [], height: 1, extra: {} }];
  assert.deepEqual([w.past.edits.obstacles_at(14, now).length, w.past.edits.obstacles_at(15, now).length], [0, 1]);
  await w.later();
  assert.deepEqual(w.server.asked.slice(1), ["events?from=21&limit=1"], "the end, which may not have been recorded then");
  assert.deepEqual(w.marks(), ["Obstacle added 15"]);
  w.end();
});

test("after a loss of the connection the path and the events of the time between come back", async () => {
  const w = watching();
  w.see(0, 20);
  w.past.cut();
  w.see(140);
  assert.deepEqual(w.marks(), ["Obstacle added 15"]);
  await w.later();
  assert.deepEqual(w.server.asked, ["ticks?from=21&limit=5000", "events?from=21&limit=119"]);
  assert.deepEqual(w.marks(), ["Obstacle added 15", "Obstacle added 130"]);
  assert.deepEqual([...w.scene.columns.get("tick")].slice(-6), [21, 22, 23, 24, 25, 140].slice(0, 6));
  w.end();
});

test("without a record, or a server, it waits for the next missed tick", async () => {
  const w = watching();
  w.record(false);
  w.see(0, 9);
  w.see(20);
  await w.later();
  assert.deepEqual(w.server.asked, []);
  w.record(true);
  w.server.down = true;
  w.see(22);
  await w.later();
  assert.deepEqual(w.marks(), []);
  w.server.down = false;
  w.see(24);
  await w.later();
  assert.deepEqual(w.marks(), ["Obstacle added 15"]);
  w.past.forget();
  const asked = w.server.asked.length;
  await w.later(10_000);
  assert.equal(w.server.asked.length, asked, "another run asks for nothing of this one");
  w.end();
});

test("a paused run whose record comes late is shown once the record holds it", async () => {
  const w = watching();
  Object.assign(globalThis, { location: { search: "" } });
  w.server.recorded_to = -1;
  void w.past.fetch_newest();
  await w.later(0);
  assert.equal(w.scene.frame, null);
  await w.later(600);
  assert.equal(w.scene.frame, null);
  w.server.recorded_to = 20;
  await w.later(600);
  assert.equal(w.scene.frame?.tick, 15, "the newest that the record holds");
  const asked = w.server.asked.length;
  await w.later(600);
  assert.equal(w.server.asked.length, asked, "asks no more");
  Reflect.deleteProperty(globalThis, "location");
  w.end();
});

test("a run that the session has left is not asked for: the record may not hold it", async () => {
  const w = watching();
  Object.assign(globalThis, { location: { search: "" } });
  w.server.run = 2;
  void w.past.fetch_newest();
  await w.later(600);
  assert.deepEqual(w.server.asked, ["/api/v1/session"]);
  Reflect.deleteProperty(globalThis, "location");
  w.end();
});
