// tests/web/figures.test.ts: each figure means one thing, and is a dash while it is unknown.
import assert from "node:assert/strict";
import { test } from "node:test";
import { figure_words, kLive, kMetrics, shown_clearance, system_meaning } from "../../web/src/figures";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Meter } from "../../web/src/state/meter";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import { FrameSpec, frame_bytes } from "./wire";

const frame = (spec: FrameSpec) => decode_frame(frame_bytes(spec), new Legends());

test("in simulation the clearance is the true one, on any side", () => {
  const scene = new_scene();
  const shown = () => shown_clearance(scene, true);
  assert.deepEqual([shown().value, shown().label], [null, "True clearance"], "unknown before the first frame");
  fold_frame(scene, frame({ tick: 0, ranges: [8000, 8000, 8000], truth: [0, 0, 0, 0.7, false] }));
  assert.ok(Math.abs(shown().value! - 0.2) < 1e-6, "of the hull, beside the beams");
  fold_frame(scene, frame({ tick: 1, truth: [0, 0, 0, Infinity, false] }));
  assert.equal(shown().value, null, "no obstacle in the world");
});

test("elsewhere the clearance is that of the scan ahead: unknown before a scan, beyond its range without a return", () => {
  const scene = new_scene();
  const shown = () => shown_clearance(scene, false);
  fold_frame(scene, frame({ tick: 0 }));
  assert.deepEqual([shown().value, shown().label], [null, "Clear ahead"], "a frame without a scan");
  fold_frame(scene, frame({ tick: 1, ranges: [2000, 3000, 4000], clearance: 1.65 }));
  assert.deepEqual([shown().value, shown().beyond], [Math.fround(1.65), false]);
  fold_frame(scene, frame({ tick: 2, ranges: [65535, 65535, 65535], clearance: 8.191 - 0.35 }));
  assert.equal(shown().beyond, true);
});

test("every figure has a meaning and says its unit", () => {
  for (const f of [...Object.values(kLive), ...kMetrics]) {
    assert.ok(f.meaning.endsWith("."), f.label);
    if (f.unit) assert.match(figure_words(f), new RegExp(`Unit: ${f.unit}\\.$`));
  }
  assert.ok(system_meaning("Lost ticks"));
  assert.equal(system_meaning("WebSocket"), null);
});

test("the meter tells the mean, the longest and the rate", () => {
  const meter = new Meter();
  assert.equal(meter.words(0), null);
  meter.take(1, 100);
  meter.take(3, 1200);
  assert.equal(meter.words(1300), "2.0 ms, longest 3.0 ms, 1 a second");
});
