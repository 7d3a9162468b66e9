// tests/dev/pictures.mjs: remakes the screenshots of docs/pictures with the release build, by hand:
//   node tests/dev/pictures.mjs [NAME ...]
// NAME is a controller (docs/pictures/controllers/NAME.png) or a key of kFeatures (docs/pictures/NAME.png).
// `barn` needs a BARN world as a scenario file in TAUTLINE_BARN_WORLD (`tautline barn --scenarios DIR`).
// Look at each picture before committing it.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { setTimeout as pause } from "node:timers/promises";
import { devices } from "../web/devices.mjs";
import { launch, open } from "../web/page.mjs";
import { json, repository, scratch, serve, until } from "../web/program.mjs";

const kScene = "demo";
const kTime = 11; // [s] of the run: most controllers are among the obstacles then
const kShown = 25; // single steps before a picture, slow enough that the page gets each frame
const kMostController = 120_000; // bytes of a picture
const kMostFeature = 200_000; // bytes
const kSize = { width: 1180, height: 780 };
const kWide = { width: 1440, height: 820 }; // the table of runs has all its columns
const folder = join(repository, "docs/pictures");

const post = (base, path, body) => json(base, path, { method: "POST", body: JSON.stringify(body) });
const control = (base, body) => post(base, "/session/control", body);
const session = (base) => json(base, "/session");

/** Steps the paused run to `time` [s], or to its end. */
async function step_to(base, time) {
  const last = Math.round(time / (await session(base)).robot.period);
  const rest = async () => { // the tick at which the run stands
    let before = -1;
    return until("a run that rests", 120, async () => {
      const { tick, run } = await session(base);
      const rests = tick === before;
      before = tick;
      return { tick, rests, over: run.outcome !== "running" };
    }, (s) => s.rests);
  };
  for (let at = await rest(); at.tick < last - kShown && !at.over; at = await rest()) {
    await control(base, { action: "step", ticks: last - kShown - at.tick });
  }
  for (let i = 0; i < kShown; ++i) {
    await control(base, { action: "step", ticks: 1 });
    await pause(40);
  }
  await pause(1000);
}

/** Loads `what`, paused. */
async function load(p, base, what) {
  await control(base, { action: "load", ...what });
  await control(base, { action: "pause" });
  await p.get("fit").click();
}

async function shoot(what, name, most) {
  await (what.page?.() ?? what).evaluate(() => document.querySelector(".tools")?.scrollTo(0, 0));
  const file = join(folder, `${name}.png`);
  await what.screenshot({ path: file, timeout: 120_000 });
  const bytes = statSync(file).size;
  console.log(`${name}: ${bytes} bytes`);
  assert.ok(bytes < most, `${file}: ${bytes} bytes`);
}

async function controller(p, base, name) {
  await load(p, base, { scenario: kScene, controller: name });
  await step_to(base, kTime);
  await until("the page follows", 60, () => p.get("controller").inputValue(), (v) => v === name);
  await shoot(p.get("scene"), `controllers/${name}`, kMostController);
  const { pose, what, why } = await session(base);
  console.log(`  at (${pose.x.toFixed(2)}, ${pose.y.toFixed(2)}). ${what}. ${why}`);
}

const kCarrier = {
  name: "carrier", title: "Carrier", hull: { length: 1.2, width: 0.7, low: 0.05, high: 0.5 },
  mass: 200, track: 0.6, wheel_radius: 0.1,
  limits: { speed: 0.8, turn: 1.2, acceleration: 0.6, turn_acceleration: 2 },
  lasers: [{ resolution_deg: 0.5, mount: { x: 0.55, y: 0, heading: 0 } },
    { resolution_deg: 1, mount: { x: -0.55, y: 0, heading: 3.14159 } }],
};

/** Each takes one picture of a feature. */
const kFeatures = {
  async drive(p, base) {
    await load(p, base, { scenario: "demo", controller: "strip" });
    await step_to(base, 4);
    const { pose } = await session(base);
    const obstacle = { type: "cylinder", radius: 0.3,
      x: pose.x + 1.9 * Math.cos(pose.heading), y: pose.y + 1.9 * Math.sin(pose.heading) };
    await post(base, "/session/requests", { type: "add_obstacle", obstacle });
    await step_to(base, 6);
    await shoot(p.page, "drive", kMostFeature);
  },
  async goals(p, base) {
    await load(p, base, { scenario: "demo", controller: "strip" });
    await step_to(base, 8);
    await p.get("tool-goal").click();
    for (const goal of [{ x: 9, y: 5.2 }, { x: 4, y: 5.4 }, { x: -1, y: 5, heading: 3.14 }]) {
      await post(base, "/session/goal", goal);
    }
    await step_to(base, 9);
    await shoot(p.get("scene"), "goals", kMostFeature);
    await p.page.keyboard.press("v");
  },
  async people(p, base) {
    await load(p, base, { scenario: "people" });
    await step_to(base, 3);
    await shoot(p.get("scene"), "people", kMostFeature);
  },
  async fleet(p, base) {
    await load(p, base, { scenario: "swap" });
    await step_to(base, 11);
    await shoot(p.get("scene"), "fleet", kMostFeature);
  },
  async sensors(p, base) {
    await load(p, base, { scenario: "sensors" });
    await step_to(base, 4);
    await p.get("layers").click();
    await pause(500);
    await shoot(p.get("scene"), "sensors", kMostFeature);
    await p.get("layers").click();
  },
  async robot(p, base) {
    await load(p, base, { scenario: "case3", controller: "strip", robot: "carrier" });
    await step_to(base, 7);
    await shoot(p.page, "robot", kMostFeature);
  },
  async three(p, base) {
    await load(p, base, { scenario: "demo", controller: "strip" });
    await step_to(base, 11);
    await p.page.keyboard.press("3");
    await pause(6000);
    await shoot(p.page, "three", kMostFeature);
    await p.page.keyboard.press("3");
  },
  async arm(p, base) {
    await control(base, { action: "load", scenario: "arm_table" });
    await control(base, { action: "play" });
    await until("near the table", 120, () => session(base), (s) => s.arm === "goes" && s.pose.x > 1.1);
    await control(base, { action: "pause" });
    await p.page.keyboard.press("3");
    await p.get("tool-hand").click();
    await pause(3000);
    await shoot(p.page, "arm", kMostFeature);
    await p.page.keyboard.press("h");
    await p.page.keyboard.press("3");
  },
  async experiments(p, base) {
    const document = JSON.parse(readFileSync(join(repository, "docs/experiments/canonical.json"), "utf8"));
    const { id } = await post(base, "/experiments", document);
    await until("the experiment", 240, () => json(base, `/experiments/${id}`), (e) => e.state === "finished");
    await p.page.setViewportSize(kWide);
    await p.page.evaluate((hash) => (location.hash = hash), `#/experiments/${id}`);
    await p.get("experiment-results").waitFor();
    await pause(1500);
    await shoot(p.page, "experiments", kMostFeature);
    await p.page.setViewportSize(kSize);
  },
  async runs(p, base) {
    const { runs: before } = await post(base, "/runs", { scenario: "case3", controller: "original" });
    const { runs } = await post(base, "/runs", { scenario: "case3", controller: "modified" });
    await post(base, "/runs", { scenario: "case1", controller: "original" });
    await post(base, "/runs", { scenario: "case1", controller: "strip" });
    const last = (await post(base, "/runs", { scenario: "demo", controller: "vfh" })).runs[0];
    await until("the runs", 120, () => json(base, `/runs/${last}`), (r) => r.status === "finished");
    await p.page.setViewportSize(kWide);
    await p.get("nav-runs").click();
    await p.get(`select-${runs[0]}`).click();
    await p.get(`select-${before[0]}`).click();
    await p.get("selection-compare").click();
    await p.get("selection-clear").click();
    await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 60_000 });
    await pause(3000);
    const slider = p.get("timeline");
    const end = Number(await slider.getAttribute("max"));
    await slider.fill(String(Number((end / 2).toFixed(2))));
    await pause(2000);
    await shoot(p.page, "runs", kMostFeature);
    await p.get("nav-drive").click();
    await p.page.setViewportSize(kSize);
  },
  async teleop(p, base) {
    await load(p, base, { scenario: "demo", controller: "strip", robot: "robhaz" });
    await json(base, "/session/goal", { method: "DELETE" });
    const { x, y, heading } = (await session(base)).pose;
    const [c, s] = [Math.cos(heading), Math.sin(heading)];
    await post(base, "/session/requests", { type: "add_obstacle", // a wall at the right hand
      obstacle: { type: "box", x: x + 2.6 * c + 0.95 * s, y: y + 2.6 * s - 0.95 * c, heading, length: 5, width: 0.15 } });
    await p.get("nav-teleop").click();
    await p.pick_radio("stick-mode", "wall");
    await control(base, { action: "play" });
    const stick = await p.get("hand-stick").boundingBox();
    const [px, py] = [stick.x + stick.width / 2, stick.y + stick.height / 2];
    await p.page.mouse.move(px, py);
    await p.page.mouse.down();
    await p.page.mouse.move(px - 3, py - 0.29 * Math.min(stick.width, stick.height));
    await pause(3200);
    await shoot(p.page, "teleop", kMostFeature);
    await p.page.mouse.up();
    await p.get("nav-drive").click();
  },
  async barn(p, base) {
    if (!process.env.TAUTLINE_BARN_WORLD) return console.log("barn: left out, for TAUTLINE_BARN_WORLD names no file");
    const world = JSON.parse(readFileSync(process.env.TAUTLINE_BARN_WORLD));
    await json(base, `/scenarios/${world.name}`, { method: "PUT", body: JSON.stringify(world) });
    await load(p, base, { scenario: world.name, controller: "strip" });
    await step_to(base, 5.5);
    await shoot(p.get("scene"), "barn", kMostFeature);
  },
};

/** The page on emulated devices. */
async function hardware(browser) {
  const place = scratch();
  const robot = await devices(place.folder);
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", robot.file] });
  try {
    const p = await open(browser, server.base, { size: kSize, patience: 180_000 });
    await until("devices that are well", 60, () => session(server.base), (s) => s.hardware.devices.every((d) => d.well));
    await p.get("steps-close").click();
    await p.get("arm").click();
    await until("armed", 20, () => session(server.base), (s) => s.hardware.armed);
    await p.get("tool-goal").click();
    const at = await p.pixels(4, 2.4);
    await p.page.mouse.click(at.x, at.y);
    await p.get("go").waitFor();
    await pause(2000);
    await shoot(p.page, "hardware", kMostFeature);
    await p.close();
  } finally {
    await server.stop();
    robot.end();
    place.remove();
  }
}

mkdirSync(join(folder, "controllers"), { recursive: true });
const place = scratch();
const robots = join(place.folder, "robots");
mkdirSync(robots);
writeFileSync(join(robots, "carrier.json"), JSON.stringify(kCarrier));
const server = await serve({ database: place.database, scenario: kScene, more: ["--robots", robots] });
const browser = await launch(process.env.TAUTLINE_GL ? [process.env.TAUTLINE_GL] : []);
try {
  const names = (await json(server.base, "/catalog")).controllers.map((c) => c.name);
  const wanted = process.argv.length > 2 ? process.argv.slice(2) : [...Object.keys(kFeatures), "hardware", ...names];
  const p = await open(browser, server.base, { size: kSize, patience: 180_000 });
  await p.get("steps-close").click(); // a first visit's
  for (const name of wanted) {
    if (name === "hardware") await hardware(browser);
    else if (name in kFeatures) await kFeatures[name](p, server.base);
    else await controller(p, server.base, name);
  }
  await p.context.close();
} finally {
  await browser.close();
  await server.stop();
  place.remove();
}
