// tests/web/rewind.test.ts: an earlier instant of a live run, from a record that still grows.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RunItem, SessionState } from "../../web/src/contract";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { FramePages } from "../../web/src/link/pages";
import { Rewind } from "../../web/src/link/rewind";
import { FetchFrames } from "../../web/src/link/stored";
import { interpolated } from "../../web/src/state/columns";
import { RunEdits } from "../../web/src/state/edits";
import { EventLog, RunEvent } from "../../web/src/state/events";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import { chief, group_words, grouped } from "../../web/src/ui/marks";
import { Mission } from "../../web/src/wire/telemetry_generated";
import { FrameSpec, add_cylinder, frame_bytes, framed, move, remove, scan_bytes, set_parameter } from "./wire";

const kPeriod = 0.026;
const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

/** Obstacle 2 is added at tick 100, moved at 200, gone at 300; a gain is set at 150. */
function spec(tick: number): FrameSpec {
  return {
    tick, pose: [tick / 100, 0, 0], scan_stamp: tick * kPeriod, goal: [9, 0, null],
    ranges: tick % 3 === 0 ? [1000 + tick, 2000, 3000] : undefined, words: tick % 19 === 0 ? [`Words of ${tick}`, ""] : undefined,
    requests: tick === 100 ? [add_cylinder(2, 5, 5, 0.2)] : tick === 200 ? [move(2, 6, 5)] : tick === 300 ? [remove(2)]
      : tick === 150 ? [set_parameter("safety_distance", 2)] : [],
  };
}

/** A record of the ticks that `holds` accepts, up to `committed`. */
function record(holds: (tick: number) => boolean = () => true) {
  const server = { committed: 1000, asked: [] as number[], down: false };
  const messages = (make: (tick: number) => Uint8Array): FetchFrames => async (from, limit) => {
    server.asked.push(from);
    if (server.down) throw new Error("The server cannot be reached.");
    const out: Uint8Array[] = [];
    let tick = from;
    for (; tick < server.committed && out.length < limit; ++tick) if (holds(tick)) out.push(make(tick));
    while (tick < server.committed && !holds(tick)) ++tick;
    return { bytes: framed(out), next: tick < server.committed ? tick : null };
  };
  return { server, frames: messages((tick) => frame_bytes(spec(tick))),
    filtered: messages((tick) => (tick % 3 === 0 ? scan_bytes({ ranges: [tick, 2, 3] }) : new Uint8Array(0))) };
}

const row = {
  id: 7, parameters: { safety_distance: 1 }, ticks: 900,
  document: { scenario: { name: "case1", obstacles: [{ id: 1, type: "cylinder", x: 1, y: 1, radius: 0.3 }] } },
} as unknown as RunItem;

/** A live run at tick 999, of which all frames came. */
function live({ gaps = [] as RunItem["gaps"], kept_from = 0, status = "recording", holds = undefined as ((t: number) => boolean) | undefined } = {}) {
  const scene = new_scene();
  const edits = new RunEdits();
  const legends = new Legends();
  for (let tick = 0; tick < 1000; ++tick) {
    const f = decode_frame(frame_bytes(spec(tick)), legends);
    fold_frame(scene, f);
    edits.take(f);
  }
  scene.run = 7;
  scene.safety_distance = 2;
  scene.obstacles = [{ id: 1, kind: "cylinder", pose: { x: 1, y: 1, heading: 0 }, radius: 0.3, length: 0, width: 0, points: [], height: 1, extra: {} }];
  const { server, frames, filtered } = record(holds);
  const seen = { changes: 0, problems: [] as string[] };
  const session = { parameters: { safety_distance: 2 }, record: { kept_from, status, sentence: "The record rests." } } as unknown as SessionState;
  const rewind = new Rewind(scene, edits, () => session,
    { frames: () => frames, filtered: () => filtered, row: async () => ({ ...row, gaps }) },
    { changed: () => ++seen.changes, problem: (sentence) => seen.problems.push(sentence) });
  return { scene, rewind, server, seen };
}

test("an earlier instant is shown as it was, and the newest one again", async () => {
  const { scene, rewind } = live();
  assert.equal(rewind.scene, null);
  for (const tick of [150, 99, 250, 251, 998, 320]) {
    rewind.seek(tick * kPeriod);
    await settled();
    const past = rewind.scene!;
    assert.equal(past.frame?.tick, tick);
    assert.equal(past.rows, tick + 1, "the path ends there");
    assert.equal(past.sweeps[0].sweep.ranges[0], 1000 + tick - (tick % 3), "the newest scan up to it");
    assert.equal(past.words?.what, `Words of ${tick - (tick % 19)}`);
    assert.deepEqual(past.obstacles.map((o) => [o.id, o.pose.x]),
      tick < 100 || tick >= 300 ? [[1, 1]] : [[1, 1], [2, tick < 200 ? 5 : 6]]);
    assert.equal(past.safety_distance, tick < 150 ? 1 : 2);
  }
  assert.ok(Math.abs(rewind.age! - (999 - 320) * kPeriod) < 1e-6);
  assert.equal(scene.frame?.tick, 999, "the live scene goes its own way");
  rewind.live();
  assert.deepEqual([rewind.scene, rewind.time, rewind.age], [null, null, null]);
  rewind.seek(999 * kPeriod);
  assert.equal(rewind.time, null, "the newest instant is live");
});

test("it steps and plays by ticks, and is live again at the newest one", async () => {
  const { rewind } = live();
  rewind.step(-1);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 998);
  rewind.step(-2);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 996);
  rewind.toggle();
  rewind.advance(kPeriod);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 997);
  rewind.advance(10);
  assert.deepEqual([rewind.time, rewind.playing], [null, false]);
  rewind.toggle();
  assert.equal(rewind.playing, false, "the live run is not played by it");
});

test("ticks that are not committed yet are shown as soon as they are", async () => {
  const { rewind, server } = live();
  server.committed = 980;
  rewind.seek(990 * kPeriod);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 979, "the newest one that is there");
  server.committed = 1000;
  await new Promise((resolve) => setTimeout(resolve, 450));
  assert.equal(rewind.scene?.frame?.tick, 990);
  rewind.live();
});

test("gaps and dropped ticks cannot be entered, and are jumped over in the direction of the move", async () => {
  const gap = { first_tick: 400, last_tick: 499, cause: "pause", sentence: "Nothing happened." };
  const { rewind } = live({ gaps: [gap], kept_from: 100 * kPeriod, holds: (t) => t >= 101 && (t < 400 || t > 499) });
  const tick = async () => {
    await settled();
    return rewind.scene?.frame?.tick;
  };
  rewind.seek(450 * kPeriod);
  await settled(); // the row with the gaps
  assert.equal(await tick(), 399);
  rewind.step(1);
  assert.equal(await tick(), 500);
  rewind.step(-1);
  assert.equal(await tick(), 399);
  rewind.seek(460 * kPeriod);
  assert.equal(await tick(), 500);
  rewind.seek(0);
  assert.equal(await tick(), 101);
  assert.deepEqual(rewind.barred.map((b) => [b.from, b.to].map((t) => Math.round(t / kPeriod))), [[0, 100], [400, 500]]);
  assert.match(rewind.barred[0].words, /00:02\.6/);
});

test("the time since the record rests cannot be entered either", async () => {
  const { rewind } = live({ status: "paused", holds: (t) => t < 900 });
  rewind.record_changed();
  await settled();
  assert.deepEqual(rewind.barred.map((b) => [Math.round(b.from / kPeriod), Math.round(b.to / kPeriod), b.words]), [[900, 999, "The record rests."]]);
  rewind.seek(950 * kPeriod);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 899);
  rewind.step(1);
  assert.equal(rewind.time, null, "after it comes the newest tick");
});

test("a drag fetches what it comes to, not all that it passes", async () => {
  const { rewind, server } = live();
  for (let tick = 900; tick > 100; --tick) rewind.seek(tick * kPeriod);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 101);
  assert.ok(server.asked.length <= 4, `${server.asked}`);
});

test("a failed fetch says so and shows the live run; a later one works", async () => {
  const { rewind, server, seen } = live();
  server.down = true;
  rewind.seek(5);
  await settled();
  assert.match(seen.problems[0], /cannot be reached/);
  assert.equal(rewind.time, null);
  server.down = false;
  rewind.seek(5);
  await settled();
  assert.equal(rewind.scene?.frame?.tick, 192);
});

test("the filtered scan of an earlier instant is fetched once one rests there", async () => {
  const { rewind } = live();
  rewind.want_filtered(true);
  rewind.seek(200 * kPeriod);
  await settled();
  assert.equal(rewind.scene?.filtered.shown, null);
  await new Promise((resolve) => setTimeout(resolve, 300));
  const { sweep, origin } = rewind.scene!.filtered.shown!;
  assert.deepEqual([sweep.ranges[0], origin.x], [198, 1.98]);
  rewind.want_filtered(false);
  assert.equal(rewind.scene?.filtered.shown, null);
});

test("pages bring each tick once, and the last used ones are kept", async () => {
  const { server, frames } = record((tick) => tick < 500 || tick >= 900);
  server.committed = 5000;
  const pages = new FramePages(frames);
  await pages.fetch(390, 450);
  assert.deepEqual(pages.at_hand(390, 401)?.map((f) => f.tick), Array.from({ length: 12 }, (_, i) => 390 + i));
  assert.deepEqual(pages.at_hand(600, 700), [], "a gap holds nothing");
  server.committed = 5100;
  await pages.fetch(5050, 5200);
  assert.equal(pages.at_hand(5050, 5200), null, "not all of it is there yet");
  assert.equal(pages.known(5050, 5200).length, 50);
  server.committed = 5300;
  await pages.fetch(5050, 5200);
  assert.deepEqual(pages.at_hand(5098, 5101)?.map((f) => f.tick), [5098, 5099, 5100, 5101]);
  for (const tick of [1000, 1500, 2000, 2500]) await pages.fetch(tick, tick);
  assert.equal(pages.at_hand(390, 391), null, "the oldest page is gone");
});

test("an obstacle that no later edit touches stands where it is now, whatever was lost before", () => {
  const edits = new RunEdits();
  const f = (s: FrameSpec) => decode_frame(frame_bytes(s), new Legends());
  const at = (id: number, x: number) => ({ id, kind: "cylinder" as const, pose: { x, y: 0, heading: 0 }, radius: 0.2, length: 0, width: 0, points: [], height: 1, extra: {} });
  edits.take(f({ tick: 900, requests: [move(2, 8, 0)] }));
  edits.take(f({ tick: 700, requests: [move(2, 7, 0)] })); // found later in the record
  edits.take(f({ tick: 700, requests: [move(2, 70, 0)] }));
  const now = [at(1, 1), at(2, 8)];
  const xs = (tick: number) => edits.obstacles_at(tick, now).map((o) => o.pose.x);
  assert.deepEqual(xs(900), [1, 8]);
  edits.begin([at(1, 5), at(2, 2), at(3, 3)], {});
  assert.deepEqual(xs(800), [1, 7], "one that moved before the record begins, and one that was removed then");
  assert.deepEqual(xs(600), [1, 2]);
  assert.deepEqual(edits.parameters_at(600, { k_r: 1 }), { k_r: 1 });
});

test("events of the record join those that were seen, each once, in their order", () => {
  const log = new EventLog();
  const event = (t: number, label: string, kind: RunEvent["kind"] = "edit") => ({ t, label, kind });
  log.merge([event(3, "Goal set"), event(9, "Stuck", "bad")]);
  log.merge([event(3.4, "Goal set"), event(5, "Stop", "stop"), event(5.5, "Released", "stop"), event(6, "Stop", "stop")]);
  assert.deepEqual(log.list.map((e) => e.t), [3, 5, 5.5, 6, 9]);
  assert.equal(log.last_trouble?.t, 9);

  // A change that falls into a break has no known time: the record tells it.
  const f = (s: FrameSpec) => decode_frame(frame_bytes(s), new Legends());
  const broken = new EventLog();
  const whole = new EventLog(true);
  for (const each of [broken, whole]) {
    each.push(f({ tick: 1, mission: Mission.Driving }));
    each.push(f({ tick: 400, mission: Mission.Arrived, requests: [remove(1)] }));
  }
  assert.deepEqual(broken.list.map((e) => e.label), ["Obstacle removed"]);
  assert.deepEqual(whole.list.map((e) => e.label), ["Obstacle removed", "Arrived"]);
});

test("marks that would cover each other are one, with the icon of the gravest and the words of all", () => {
  const events: RunEvent[] = [
    { t: 1, kind: "goal", label: "Goal set" }, { t: 2, kind: "bad", label: "Stuck" }, { t: 60, kind: "edit", label: "Obstacle added" },
  ];
  const groups = grouped(events, 100, 400);
  assert.deepEqual(groups.map((g) => g.length), [2, 1]);
  assert.equal(chief(groups[0]).label, "Stuck");
  assert.equal(group_words(groups[0]), "00:01.0 Goal set, 00:02.0 Stuck");
  assert.equal(grouped(events, 100, 4000).length, 3, "in a wide one each has its own");
  assert.match(group_words(Array.from({ length: 7 }, () => events[0])), /and 3 more$/);
});

test("ticks and times between the known rows", () => {
  const { scene } = live();
  assert.equal(interpolated(scene.columns, "tick", "t", 500), 500 * kPeriod);
  assert.ok(Math.abs(interpolated(scene.columns, "tick", "t", 1010) - 1010 * kPeriod) < 1e-9, "beyond the last");
  assert.equal(interpolated(new_scene().columns, "tick", "t", 5), 0);
});
