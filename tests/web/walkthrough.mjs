// tests/web/walkthrough.mjs: runs the commands of docs/experiments-api.md as they stand there.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { json, repository, scratch, serve } from "./program.mjs";

test("the API walk-through of the documentation", { timeout: 120_000 }, async () => {
  const [, commands] = readFileSync(join(repository, "docs/experiments-api.md"), "utf8").match(/```sh\n([^]*?)```/);
  const place = scratch();
  const server = await serve({ database: place.database });
  try {
    const script = commands.replace("http://localhost:8080", server.base);
    assert.notEqual(script, commands);
    const said = execFileSync("bash", ["-eu", "-o", "pipefail", "-c", script], { cwd: place.folder, encoding: "utf8", timeout: 100_000 });
    assert.match(said, /"runs":12/);             // the estimate
    assert.match(said, /event: progress\ndata: \{/);
    assert.match(said, /"complete":true/);       // the results
    assert.match(said, /^# two-strips$/m);       // the report
    assert.match(said, /\{"runs":\[\d+\]\}\s*$/);  // the record
    assert.equal(readFileSync(join(place.folder, "runs.csv"), "utf8").trim().split("\n").length, 13);
    assert.deepEqual((await json(server.base, "/experiments")).items, []);
  } finally {
    await server.stop().catch(() => undefined);
    place.remove();
  }
});
