// tests/web/explain.test.ts: the page says what the server says (tests/server/serve/words_test.cpp wrote
// the frames and their sentences).
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { explain } from "../../web/src/explain";
import { decode_frame } from "../../web/src/link/frame";

test("page and server form the same sentences", () => {
  const cases = JSON.parse(readFileSync(`${process.env.TAUTLINE_TESTS}/golden/words.json`, "utf8")) as
    { frame: string; what: string; why: string }[];
  assert.ok(cases.length > 15);
  for (const { frame, what, why } of cases) {
    assert.deepEqual(explain(decode_frame(Buffer.from(frame, "hex"))), { what, why });
  }
});
