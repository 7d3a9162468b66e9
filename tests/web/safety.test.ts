// tests/web/safety.test.ts: signs of life, a Stop that fails, and the age of the drawing.
import assert from "node:assert/strict";
import { test } from "node:test";
import { SessionState } from "../../web/src/contract";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { SignEnvironment, give_signs_of_life } from "../../web/src/sign_of_life";
import { age_words, news_age, scan_age } from "../../web/src/state/age";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import { StopState, Stopper, kAnswerTime } from "../../web/src/stopper";
import { stopped_words, watchers_words } from "../../web/src/words";
import { hand_wound } from "./timers";
import { frame_bytes } from "./wire";

/** A browser of which only what the test calls happens. */
function tab() {
  const seen = { signs: 0, visible: true, stop: true };
  const frames: (() => void)[] = [];
  let look: () => void = () => undefined;
  const env: SignEnvironment = {
    visible: () => seen.visible, next_frame: (act) => void frames.push(act), every: (_, act) => (look = act),
  };
  give_signs_of_life(env, () => seen.stop, () => ++seen.signs);
  return { seen, look: () => look(), draw: () => frames.splice(0).forEach((act) => act()) };
}

test("only a drawn frame gives a sign of life", () => {
  const { seen, look, draw } = tab();
  look();
  assert.equal(seen.signs, 0);
  draw(); // this frame is begun, not yet visible
  assert.equal(seen.signs, 0);
  draw();
  assert.equal(seen.signs, 1);
  for (let i = 0; i < 10; ++i) look(); // a tab that no longer draws
  assert.equal(seen.signs, 1);
  draw();
  draw();
  assert.equal(seen.signs, 2, "one sign, however often it was due meanwhile");
});

test("a hidden page and a page with a failed Stop give no sign", () => {
  for (const off of ["visible", "stop"] as const) {
    const { seen, look, draw } = tab();
    seen[off] = false;
    look();
    draw();
    draw();
    assert.equal(seen.signs, 0, off);
    seen[off] = true;
    look();
    draw();
    seen[off] = false; // between the two frames
    draw();
    assert.equal(seen.signs, 0, off);
  }
});

/** Two ways for a Stop; each answers when told. */
function stop() {
  const calls: { way: number; resolve: () => void; reject: () => void }[] = [];
  const states: StopState[] = [];
  const way = (n: number) => () => new Promise<void>((resolve, reject) =>
    void calls.push({ way: n, resolve, reject: () => reject(new Error("no")) }));
  let now = 1000;
  const stopper = new Stopper([way(0), way(1)], (s) => states.push(s), () => now);
  return { calls, states, stopper, phases: () => states.map((s) => s.phase), at: (t: number) => (now = t) };
}
const settled = () => Promise.resolve().then(() => Promise.resolve()).then(() => Promise.resolve());

test("a Stop answered in time is sent one way only, without a message", async () => {
  const timers = hand_wound();
  const { calls, phases, stopper } = stop();
  stopper.press();
  calls[0].resolve();
  await settled();
  timers.tick(5 * kAnswerTime);
  timers.restore();
  assert.deepEqual(calls.map((c) => c.way), [0]);
  assert.deepEqual(phases(), ["sent", "none"]);
});

test("a Stop without an answer fails after half a second, and is sent every way until one answers", async () => {
  const timers = hand_wound();
  const { calls, phases, states, stopper, at } = stop();
  stopper.press();
  timers.tick(kAnswerTime - 1);
  assert.deepEqual(phases(), ["sent"]);
  timers.tick(1);
  assert.deepEqual(phases(), ["sent", "failed"]);
  timers.tick(kAnswerTime);
  assert.deepEqual(calls.map((c) => c.way), [0, 0, 1, 0, 1]);
  at(3000);
  stopper.press(); // no effect: the first has failed already
  assert.equal(states.at(-1)!.since, 1000);
  calls.at(-1)!.resolve();
  await settled();
  assert.equal(phases().at(-1), "none");
  const sent = calls.length;
  timers.tick(5 * kAnswerTime);
  timers.restore();
  assert.equal(calls.length, sent);
});

test("without a connection the other way is tried and failure is reported at once", async () => {
  const timers = hand_wound();
  const { calls, phases, stopper } = stop();
  stopper.press();
  calls[0].reject();
  await settled();
  assert.deepEqual(calls.map((c) => c.way), [0, 0, 1]);
  calls[1].reject();
  calls[2].reject();
  await settled();
  assert.deepEqual(phases(), ["sent", "failed"]);
  stopper.forget();
  timers.tick(5 * kAnswerTime);
  timers.restore();
  assert.equal(calls.length, 3);
});

const session = (change: object = {}): SessionState => ({ source: "hardware", stop: true, goal: null,
  run: { id: 1, status: "recording", outcome: "running" }, pace: { paused: false, speed: 1 }, ...change }) as SessionState;

test("old data show their age", () => {
  const scene = new_scene();
  assert.equal(news_age(scene, session(), false, 5000), null, "nothing was heard yet");
  scene.heard_at = 1000;
  assert.equal(news_age(scene, session(), true, 1500), null);
  assert.equal(news_age(scene, session(), true, 4500), 3.5);
  assert.equal(news_age(scene, session(), false, 1500), 0.5, "a lost link is old at once");
  assert.equal(news_age(scene, session({ pace: { paused: true, speed: 1 } }), true, 9000), null);
  assert.equal(age_words(3.46), "3.5 s");
  assert.equal(age_words(42.9), "42 s");
  assert.equal(age_words(125), "2 min 5 s");
});

test("the scan's age is counted from its own stamp", () => {
  const scene = new_scene();
  fold_frame(scene, decode_frame(frame_bytes({ tick: 0, stamp: 0.25, ranges: [1000, 2000] }), new Legends()));
  assert.equal(scan_age(scene), null);
  fold_frame(scene, decode_frame(frame_bytes({ tick: 1, stamp: scene.sweeps[0].sweep.stamp + 2.5 }), new Legends()));
  assert.ok(Math.abs(scan_age(scene)! - 2.5) < 1e-6);
});

test("a commanded Stop does not mean that the robot stands", () => {
  const scene = new_scene();
  scene.heard_at = 0;
  const frame = decode_frame(frame_bytes({ tick: 0 }), new Legends());
  scene.frame = { ...frame, twist: { v: 0.12, omega: 0 } };
  assert.equal(stopped_words(scene, session(), true, 100), "Stop is commanded. The wheels still turn: 0.12 m/s.");
  scene.frame = { ...frame, twist: { v: 0, omega: 0 } };
  assert.match(stopped_words(scene, session(), true, 100), /the robot stands.*Release moves nothing/);
  assert.match(stopped_words(scene, session({ source: "simulation", goal: { x: 1, y: 0 } }), true, 100), /drive on to its goal/);
  assert.match(stopped_words(scene, session(), false, 4000), /not known: it was last heard 4\.0 s ago/);
});

test("the watchers as text", () => {
  const words = (watchers: number, watched_by_script: boolean) => watchers_words(session({ watchers, watched_by_script }));
  assert.equal(words(1, false), "watched by 1 page");
  assert.equal(words(2, false), "watched by 2 pages");
  assert.equal(words(1, true), "watched by a script");
  assert.equal(words(3, true), "watched by 2 pages and a script");
  assert.equal(words(0, false), "watched by nobody");
});
