// tests/web/filter.test.ts: the page's filters against the golden vectors the server is held to.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { apply_filter, samples_of } from "../../web/src/filter";

interface Golden {
  tolerance: number;
  vectors: { case: string; N: number; border: string; in: number[]; pmed: number[]; median?: number[] }[];
  invalid_aware: { N: number; in: number[]; valid: boolean[]; out: number[]; out_valid: boolean[] }[];
  scan360: { results: { N: number; changed: Record<string, number> }[]; spikes: Record<string, number> };
  lulu: { N: number; in: number[]; out: number[] }[];
}
const folder = process.env.TAUTLINE_GOLDEN_DIR ?? `${process.env.TAUTLINE_TESTS}/golden`;
const golden: Golden = JSON.parse(readFileSync(`${folder}/A_pseudomedian.json`, "utf8"));

function filtered(name: string, n: number, values: number[], valid?: boolean[]) {
  return apply_filter(name, n, {
    values: Float64Array.from(values),
    valid: Uint8Array.from(values, (_, i) => (valid && !valid[i] ? 0 : 1)),
  });
}
function close(actual: ArrayLike<number>, wanted: number[], label: string) {
  assert.equal(actual.length, wanted.length, label);
  wanted.forEach((w, i) => {
    const limit = golden.tolerance * Math.max(1, Math.abs(w));
    assert.ok(Math.abs(actual[i] - w) <= limit, `${label}: [${i}] is ${actual[i]}, not ${w}`);
  });
}

test("Golden A: pseudomedian and median with replicated borders", () => {
  let seen = 0;
  for (const v of golden.vectors) {
    if (v.border !== "replicate") continue;
    ++seen;
    close(filtered("pseudomedian", v.N, v.in).values, v.pmed, `${v.case} N=${v.N}`);
    if (v.median) close(filtered("median", v.N, v.in).values, v.median, `${v.case} median N=${v.N}`);
  }
  assert.ok(seen > 20, `only ${seen} vectors were there to check`);
});

test("Golden A: LULU", () => {
  assert.ok(golden.lulu.length > 0);
  for (const v of golden.lulu) close(filtered("lulu", v.N, v.in).values, v.out, `lulu N=${v.N}`);
});

test("Golden A: samples that must not be believed", () => {
  assert.ok(golden.invalid_aware.length > 0);
  for (const v of golden.invalid_aware) {
    const out = filtered("pseudomedian", v.N, v.in, v.valid);
    close(out.values, v.out, `invalid aware N=${v.N}`);
    assert.deepEqual([...out.valid].map(Boolean), v.out_valid);
  }
});

test("Golden A: the paper's spikes keep half their height", () => {
  for (const { N, changed } of golden.scan360.results) {
    // 3000 everywhere, 1500 at 150..210, then the spikes
    const base = Array.from({ length: 360 }, (_, i) => (i >= 150 && i <= 210 ? 1500 : 3000));
    const input = base.map((v, i) => golden.scan360.spikes[i] ?? v);
    close(filtered("pseudomedian", N, input).values, base.map((v, i) => changed[i] ?? v), `scan360 N=${N}`);
  }
});

test("a single wrong reading: halved by the pseudomedian, gone with median and LULU", () => {
  const scan = [2, 2, 2, 6, 2, 2, 2];
  assert.equal(filtered("pseudomedian", 1, scan).values[3], 4); // 2 + (6 - 2) / 2
  assert.equal(filtered("median", 1, scan).values[3], 2);
  assert.equal(filtered("lulu", 1, scan).values[3], 2);
  assert.equal(filtered("none", 1, scan).values[3], 6);
  assert.equal(filtered("pseudomedian", 0, scan).values[3], 6);
});

test("of an even number of readings the median is the upper of the middle two", () => {
  // The window about sample 1 holds 1, 5 and a code: two readings, N + 1 = 2 are enough.
  const out = filtered("median", 1, [1, 5, 0, 9, 9], [true, true, false, true, true]);
  assert.equal(out.values[1], 5);
  assert.equal(out.valid[2], 0);
});

test("a beam with too few believed neighbours is not believed", () => {
  // N = 2: the window about sample 2 holds one reading of five; 3 are needed.
  const out = filtered("pseudomedian", 2, [1, 1, 3, 1, 1], [false, false, true, false, false]);
  assert.deepEqual([...out.valid], [0, 0, 0, 0, 0]);
  assert.equal(out.values[2], 3);
});

test("wire values: millimetres, free beams, device codes", () => {
  const samples = samples_of({
    mount: { x: 0, y: 0, heading: 0 }, stamp: 0, angle_min: 0, angle_increment: 0.1, range_max: 8.191,
    ranges: Uint16Array.from([1500, 65535, 65520, 65534, 65519]),
  });
  assert.deepEqual([...samples.values], [1.5, 8.191, 8.191, 8.191, 65.519]);
  assert.deepEqual([...samples.valid], [1, 1, 0, 0, 1]);
});
