// tests/dev/pictures.mjs: remakes docs/pictures/controllers/: the page with each controller in the
// same scene at the same time of its run; by hand, with the release build:
//   node tests/dev/pictures.mjs [CONTROLLER ...]
// Look at what comes out: a picture is for people.
import assert from "node:assert/strict";
import { mkdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { launch, open } from "../web/page.mjs";
import { json, repository, scratch, serve, until } from "../web/program.mjs";

const kScene = "demo";
const kTime = 11; // [s] into the run: among the obstacles, for who gets so far
const kPeriod = 0.026; // [s]
const kShown = 25; // single steps at the end, slow enough that the page gets every frame of them
const kMost = 120_000; // bytes of a picture
const folder = join(repository, "docs/pictures/controllers");

const control = (base, body) => json(base, "/session/control", { method: "POST", body: JSON.stringify(body) });

/** The run is paused at tick `wanted`, or over before: the blind one collides. */
const at_tick = (base, wanted) =>
  until(`tick ${wanted}`, 120, () => json(base, "/session"), (s) => s.tick >= wanted || s.run.outcome !== "running");

async function take(p, base, controller) {
  await control(base, { action: "load", scenario: kScene, controller });
  const last = Math.round(kTime / kPeriod);
  await control(base, { action: "step", ticks: last - kShown });
  await at_tick(base, last - kShown - 1);
  for (let i = 0; i < kShown; ++i) {
    await control(base, { action: "step", ticks: 1 });
    await pause(40);
  }
  await until("the page follows", 60, () => p.get("controller").inputValue(), (v) => v === controller);
  await pause(1000);
  const file = join(folder, `${controller}.png`);
  await p.get("scene").screenshot({ path: file, timeout: 120_000 });
  const bytes = statSync(file).size;
  assert.ok(bytes < kMost, `${file}: ${bytes} bytes`);
  const { pose, what, why } = await json(base, "/session");
  console.log(`${controller}: ${bytes} bytes, at (${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}). ${what}. ${why}`);
}

mkdirSync(folder, { recursive: true });
const place = scratch();
const server = await serve({ database: place.database, scenario: kScene });
const browser = await launch();
try {
  await control(server.base, { action: "pause" }); // stays so over the loads
  const { controllers } = await json(server.base, "/catalog");
  const wanted = process.argv.length > 2 ? process.argv.slice(2) : controllers.map((c) => c.name);
  const p = await open(browser, server.base, { size: { width: 1180, height: 640 }, patience: 180_000 });
  for (const controller of wanted) await take(p, server.base, controller);
  await p.close();
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
