// tests/web/runs.test.ts: the query of a search, tags as typed, and how a run went on in words.
import assert from "node:assert/strict";
import { test } from "node:test";
import { RunItem } from "../../web/src/contract";
import { tags_in } from "../../web/src/views/run_actions";
import { kFirstSearch, query_of } from "../../web/src/views/run_list";
import { later_words } from "../../web/src/words";

test("a search becomes a query with only what it asks for", () => {
  assert.equal(query_of(kFirstSearch, 50), "/runs?limit=50&group=batch");
  assert.equal(query_of({ ...kFirstSearch, text: " wet floor ", result: "stuck", kind: "session" }, 50),
    "/runs?limit=50&q=wet+floor&result=stuck&kind=session&group=batch");
  // The runs of one batch are not grouped.
  assert.equal(query_of({ ...kFirstSearch, batch: 7, sort: "time", descending: false }, 20, "9:1.5"),
    "/runs?limit=20&batch=7&sort=time&order=asc&cursor=9%3A1.5");
});

test("tags are typed with commas, each once", () => {
  assert.deepEqual(tags_in(" wet floor, monday,, monday "), ["wet floor", "monday"]);
  assert.deepEqual(tags_in(" , "), []);
});

test("a run that went on says how", () => {
  const run = (outcome: string, later: RunItem["later"]) => ({ outcome, later }) as RunItem;
  assert.equal(later_words(run("reached", null)), "");
  const at = (outcome: string) => ({ outcome, reason: "", time: 8746 });
  assert.equal(later_words(run("reached", at("reached"))), "The run went on to 2:25:46.");
  assert.equal(later_words(run("reached", at("running"))), "The run went on to 2:25:46 and drives on.");
  assert.equal(later_words(run("stuck", at("reached"))), "The run went on to 2:25:46 and was last reached.");
});
