// tests/web/stored.test.ts: a stored run, fetched by pages, sought anywhere and played.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RunDocument, RunItem } from "../../web/src/contract";
import { decode_frame, decode_frames } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Player } from "../../web/src/link/player";
import { StoredRun, kPageFrames, split_frames } from "../../web/src/link/stored";
import { SceneState, fold_frame, new_scene } from "../../web/src/state/scene";
import { FrameSpec, add_cylinder, frame_bytes, framed, goal, grid, line, move, push_stick, remove, scan_bytes, set_parameter } from "./wire";

test("frames of an answer are split by their lengths; a truncated answer is an error", () => {
  const parts = [frame_bytes({ tick: 0 }), frame_bytes({ tick: 1, ranges: [1, 2, 3] })];
  const whole = framed(parts);
  assert.deepEqual(decode_frames(split_frames(whole)).map((f) => f.tick), [0, 1]);
  assert.throws(() => split_frames(whole.slice(0, whole.length - 1)), /runs past the end/);
  assert.throws(() => split_frames(whole.slice(0, parts[0].length + 4 + 2)), /stray bytes/);
});

const item: RunItem = {
  id: 3, status: "finished", outcome: "reached", scenario: "case1", controller: "modified", filter: "none",
  physics: "bullet", seed: 1, parameters: { safety_distance: 1 }, ticks: 1000, time: 26, metrics: null,
  document: { robot: { radius: 0.3, half_length: 0.25, half_width: 0.21, half_track: 0.2 } as RunDocument["robot"], scenario: { name: "case1", start: { x: 0, y: 0, heading: 0 }, obstacles: [{ type: "cylinder", x: 1, y: 1, radius: 0.3 }] } },
};

const none = () => Promise.reject(new Error("nothing filtered"));

/** A server that holds `count` frames; obstacle 2 is added at tick 100, moved at 200, gone at 300. */
function stored(count: number) {
  const asked: number[] = [];
  const at = (tick: number) => frame_bytes({
    tick, pose: [tick / 100, 0, 0], ranges: tick % 2 === 0 ? [1000, 2000, 3000] : undefined,
    requests: tick === 100 ? [add_cylinder(2, 5, 5, 0.2)] : tick === 200 ? [move(2, 6, 5)] : tick === 300 ? [remove(2)]
      : tick === 150 ? [set_parameter("safety_distance", 3)] : [],
  });
  const run = new StoredRun(item, async (from, limit) => {
    asked.push(from);
    const end = Math.min(count, from + limit);
    const frames = [];
    for (let t = from; t < end; ++t) frames.push(at(t));
    return { bytes: framed(frames), next: end < count ? end : null };
  }, none);
  return { run, asked };
}

test("a stored run is fetched page by page and can be sought anywhere", async () => {
  const { run, asked } = stored(1000);
  let calls = 0;
  await run.load(() => ++calls);
  assert.deepEqual(asked, [0, kPageFrames, 2 * kPageFrames]);
  assert.equal(run.rows, 1000);
  assert.equal(run.done, true);
  assert.ok(calls >= 3);
  assert.ok(run.seek(999));
  assert.equal(run.scene.frame?.tick, 999);
  assert.equal(run.scene.rows, 1000);
  assert.equal(run.scene.sweeps.length, 1, "an odd tick shows the sweep of the even one before");
});

test("obstacles and parameters match the shown instant, forward and back", async () => {
  const { run } = stored(400);
  await run.load(() => undefined);
  const at = (row: number) => {
    run.seek(row);
    return run.scene.obstacles.map((o) => [o.id, o.pose.x]);
  };
  assert.deepEqual([run.scene.radius, run.scene.hull], [0.3, { half_length: 0.25, half_width: 0.21 }], "the robot is the one of that run");
  assert.deepEqual(at(399), [[1, 1]]);
  assert.deepEqual(at(250), [[1, 1], [2, 6]]);
  assert.deepEqual(at(100), [[1, 1], [2, 5]]);
  assert.deepEqual(at(99), [[1, 1]]);
  assert.equal(run.scene.safety_distance, 1);
  run.seek(150);
  assert.equal(run.scene.safety_distance, 3);
});

test("a run still being recorded is shown up to its end when opened", async () => {
  let there = 500;
  const run = new StoredRun({ ...item, status: "recording", ticks: there }, async (from, limit) => {
    there += 1000; // grows faster than it is fetched
    const frames = Array.from({ length: Math.min(limit, there - from) }, (_, i) => frame_bytes({ tick: from + i }));
    return { bytes: framed(frames), next: from + limit };
  }, none);
  await run.load(() => undefined);
  assert.equal(run.done, true);
  assert.ok(run.rows >= 500 && run.rows <= 500 + kPageFrames, `${run.rows} rows`);
});

test("a failed fetch of a run gives a reason and keeps the fetched part", async () => {
  let pages = 0;
  const run = new StoredRun(item, async () => {
    if (++pages > 1) throw new Error("The server cannot be reached.");
    return { bytes: framed([frame_bytes({ tick: 0 })]), next: 1 };
  }, none);
  await run.load(() => undefined);
  assert.equal(run.rows, 1);
  assert.equal(run.done, false);
  assert.match(run.error ?? "", /cannot be reached/);
});

test("the player runs at its speed, stops at the end, starts over, and steps by frames", async () => {
  const { run } = stored(101); // 2.6 s
  await run.load(() => undefined);
  const player = new Player(run, () => undefined);
  player.toggle();
  player.speed = 2;
  player.advance(0.5);
  assert.ok(Math.abs(player.time - 1) < 1e-9);
  assert.equal(run.scene.frame?.tick, 38); // 1 s / 26 ms = 38.46
  player.advance(10);
  assert.equal(player.playing, false);
  assert.equal(run.scene.frame?.tick, 100);
  player.step(-1);
  assert.equal(run.scene.frame?.tick, 99);
  player.toggle();
  player.advance(10);
  player.toggle();
  assert.equal(player.time, 0);
  player.seek(1e9);
  assert.ok(Math.abs(player.time - 2.6) < 1e-9);
});

/** A run in which things come seldom and hold: words, grids, readings, people, scans, a goal that goes and returns. */
function varied(tick: number): FrameSpec {
  return {
    tick, pose: [tick / 100, 0, 0], scan_stamp: tick * 0.026, ranges: tick % 3 === 0 ? [1000 + tick, 2000, 3000] : undefined,
    goal: tick > 50 && tick < 60 ? undefined : goal, words: tick % 19 === 0 ? [`Words of ${tick}`, ""] : undefined,
    layers: [line, ...(tick % 23 === 0 ? [grid(tick)] : [])], moved: tick % 2 === 0 ? [[1, tick / 10, 1, 0]] : [],
    sonar: tick % 5 === 0 ? [[0, tick]] : tick % 5 === 2 && tick < 60 ? [[1, tick]] : [],
    requests: tick === 70 ? [add_cylinder(2, 5, 5, 0.2)] : [],
  };
}
const shown = (scene: SceneState) => ({
  words: scene.words, layers: [...scene.layers.values()].map((l) => [l.name, l.cells[0]]), goal: scene.goal,
  obstacles: scene.obstacles.map((o) => [o.id, o.pose.x]), sweeps: scene.sweeps.map((s) => [s.sweep.ranges[0], s.origin.x]),
  readings: [...scene.readings.values()].map((r) => `${r.kind} ${r.range} ${r.stamp}`).sort(),
});

test("a stored run of a driver has its stick at every row, also where a row brings none, and says that it was driven", async () => {
  const stick = (forward: number) => push_stick(forward, 0.5, 2);
  const bytes = Array.from({ length: 12 }, (_, tick) => frame_bytes({
    tick, behaviour: tick >= 3 && tick < 9 ? "manual" : "rest", requests: tick === 3 ? [stick(0.25), stick(0.5)] : tick === 6 ? [stick(1)] : [],
  }));
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), none);
  assert.ok(!run.driven);
  await run.load(() => undefined);
  assert.ok(run.driven);
  const forward = (row: number) => {
    run.seek(row);
    return run.scene.stick?.forward ?? null;
  };
  assert.deepEqual([2, 8, 5, 3, 6, 9, 11].map(forward), [null, 1, 0.5, 0.5, 1, null, null]);
  assert.equal(run.events.list.length, 0, "a stick is no mark of the timeline");
});

test("a stored run shows the live view at any tick, sought in any order", async () => {
  const bytes = Array.from({ length: 120 }, (_, tick) => frame_bytes(varied(tick)));
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), none);
  await run.load(() => undefined);
  const live = new_scene();
  live.obstacles = run.scene.obstacles;
  const legends = new Legends();
  const seen = bytes.map((b) => {
    fold_frame(live, decode_frame(b, legends));
    if (live.frame?.tick === 70) live.obstacles = [...live.obstacles, { ...live.obstacles[0], id: 2, pose: { x: 5, y: 5, heading: 0 } }];
    return shown(live);
  });
  for (const tick of [0, 119, 20, 21, 55, 60, 68, 69, 70, 71, 46, 118]) {
    run.seek(tick);
    assert.deepEqual(shown(run.scene), seen[tick], `tick ${tick}`);
  }
  assert.deepEqual([seen[69].layers.length, seen[69].readings.length, seen[119].readings.length], [2, 2, 1], "there is something to hold");
});

test("filtered scans of a stored run are fetched only while wanted, and belong to the newest scan", async () => {
  const bytes = Array.from({ length: 30 }, (_, tick) => frame_bytes(varied(tick)));
  const asked: number[] = [];
  const run = new StoredRun(item, async () => ({ bytes: framed(bytes), next: null }), async (from, limit) => {
    asked.push(from);
    const messages = bytes.map((_, tick) => (tick % 3 === 0 ? scan_bytes({ ranges: [tick, 2, 3] }) : new Uint8Array(0)));
    const end = Math.min(from + limit, from + 20); // an answer may be shorter than was asked for
    return { bytes: framed(messages.slice(from, end)), next: end < 30 ? end : null };
  });
  await run.load(() => undefined);
  run.seek(10);
  assert.deepEqual([asked, run.scene.filtered.shown], [[], null]);
  run.want_filtered(true);
  let late = 0;
  assert.equal(run.seek(10, () => ++late), true, "the rest of the instant does not wait for it");
  await new Promise((resolve) => setTimeout(resolve));
  assert.equal(late, 1);
  assert.deepEqual([run.scene.filtered.shown?.sweep.ranges[0], run.scene.filtered.shown?.origin.x], [9, 0.09]);
  run.seek(28);
  assert.deepEqual([run.scene.filtered.shown?.sweep.ranges[0], asked], [27, [0, 20]]);
  run.want_filtered(false);
  run.seek(12);
  assert.equal(run.scene.filtered.shown, null);
});
