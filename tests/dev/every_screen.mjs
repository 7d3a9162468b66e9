// tests/dev/every_screen.mjs: goes through every view as a person does, at five sizes and in both themes, checks
// accessibility, and keeps a picture of each state, for a look by eye:
//   node tests/dev/every_screen.mjs FOLDER [SIZE ...]
// FOLDER gets SIZE-THEME-STATE.png and one sheet a state and theme. Exit status 1 where a step or a check failed.
import { mkdirSync, readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { arm, devices } from "../web/devices.mjs";
import { launch, open } from "../web/page.mjs";
import { json, scratch, serve, until } from "../web/program.mjs";

const kSizes = {
  desktop: { width: 1440, height: 900 }, zoomed: { width: 720, height: 450 }, upright: { width: 390, height: 844 },
  sideways: { width: 844, height: 390 }, small: { width: 320, height: 640 },
};
const kTouch = ["upright", "sideways", "small"];
const kThemes = ["dark", "light"];
const kRest = 350; // [ms] before a picture
/** [px] The most that a picture takes on a sheet of two rows. */
const kOnSheet = { desktop: [900, 562], upright: [260, 562], small: [281, 562], zoomed: [720, 450], sideways: [800, 370] };
const kSheet = { width: 1560, height: 1030 };

const [folder, ...chosen] = process.argv.slice(2);
if (!folder || chosen.some((name) => !kSizes[name])) {
  console.error(`usage: node tests/dev/every_screen.mjs FOLDER [${Object.keys(kSizes).join("|")} ...]`);
  process.exit(2);
}
const sizes = chosen.length > 0 ? chosen : Object.keys(kSizes);
const faults = [];

const post = (base, path, body = {}) => json(base, path, { method: "POST", body: JSON.stringify(body) });
const session = (base) => json(base, "/session");
const drives = (base) => until("it drives", 20, () => session(base), (s) => Math.abs(s.command?.v ?? 0) > 0.05); // none while a world is loaded

/** What a person does in one view; `shot` after each state. Each step stands alone: a failed one is told of. */
const kSteps = {
  async first_sight({ shot }) {
    await shot("first");
  },
  async help({ p, go, shot }) {
    await go("drive");
    await p.page.keyboard.press("?");
    await p.get("shortcuts").waitFor();
    await shot("help");
    await p.page.keyboard.press("Escape");
  },
  async drive({ p, base, go, press, shot }) {
    await go("drive");
    await p.load("case3");
    await p.page.waitForTimeout(300);
    if (!(await p.get("controller").isVisible())) await press("tune");
    await p.get("controller").last().selectOption("strip");
    if (await p.get("sheet").count()) await shot("tune");
    await p.page.keyboard.press("Escape");
    if (await p.get("sheet").count()) await press("tune");
    await drives(base);
    await p.page.waitForTimeout(2500);
    await shot("drive");
  },
  async three_dimensions({ p, press, shot }) {
    await press("three");
    await p.get("scene-3d").waitFor({ timeout: 30_000 });
    await p.page.waitForTimeout(2500);
    await shot("drive-3d");
    await press("three");
    await p.get("scene").waitFor();
  },
  async reset_and_undo({ p, base, press, shot }) {
    await post(base, "/session/requests", { type: "add_obstacle", obstacle: { type: "box", x: 1, y: -1.5, length: 0.4, width: 0.4 } });
    const built = (await json(base, "/session/obstacles")).items.length;
    await press("reset");
    await shot("reset");
    await press("undo");
    await until("undone", 10, () => json(base, "/session/obstacles"), (l) => l.items.length === built);
  },
  async wall({ p, base, press, shot }) {
    await post(base, "/session/control", { action: "pause" });
    await press("fit");
    await press("tool-wall");
    const { pose } = await session(base);
    const [a, b] = [await p.pixels(pose.x + 0.6, pose.y + 0.9), await p.pixels(pose.x + 1.8, pose.y + 0.9)];
    const before = (await json(base, "/session/obstacles")).items.length;
    await p.drag(a, b);
    await until("a wall", 10, () => json(base, "/session/obstacles"), (l) => l.items.length === before + 1);
    await shot("wall");
    await p.page.keyboard.press("Escape");
  },
  async values({ p, base, press, shot }) {
    await press("tool-goal");
    const { goal } = await session(base);
    if (goal) {
      const at = await p.pixels(goal.x, goal.y);
      await p.page.mouse.click(at.x, at.y);
    }
    await p.page.waitForTimeout(300);
    await shot("goal-values");
    await p.page.keyboard.press("Escape");
    await p.page.keyboard.press("v");
  },
  async world({ p, press, shot }) {
    if (!(await p.get("tab-world").last().isVisible())) await press("tune");
    await p.get("tab-world").last().click();
    await p.page.waitForTimeout(200);
    await p.get("world-name").last().fill("By hand");
    await shot("world");
    await p.get("tab-signals").last().click();
    await p.page.waitForTimeout(1000);
    await shot("signals");
    await p.get("tab-robot").last().click();
    await p.page.keyboard.press("Escape");
    if (await p.get("sheet").count()) await press("tune");
  },
  async layers({ p, press, shot }) {
    if (!(await p.get("layer-panel").count())) await press("layers"); // a wide page begins with it
    await p.get("layer-panel").waitFor();
    await shot("layers");
    await p.get("layer-panel").getByRole("button", { name: "Close" }).click();
  },
  async inspect({ p, base, press, shot }) {
    await post(base, "/session/control", { action: "play" });
    await p.page.waitForTimeout(700);
    await post(base, "/session/control", { action: "pause" });
    await press("fit");
    await p.page.waitForTimeout(400);
    const { pose } = await session(base);
    const at = await p.pixels(pose.x, pose.y);
    await p.page.mouse.click(at.x, at.y);
    await p.get("inspect").first().waitFor({ timeout: 5000 }).catch(() => undefined);
    await shot("inspect");
    await p.page.keyboard.press("Escape");
  },
  async rewind({ p, base, press, shot }) {
    await post(base, "/session/control", { action: "play" });
    await until("a few seconds to look back at", 30, () => session(base), (s) => s.stamp > 5);
    const bar = p.get("live-timeline");
    const box = await bar.boundingBox();
    const now = Number(await bar.inputValue()) / Number(await bar.getAttribute("max"));
    await p.page.mouse.click(box.x + 0.5 * now * box.width, box.y + box.height / 2);
    await p.get("live").waitFor({ timeout: 10_000 });
    await shot("rewind");
    await press("live");
  },
  async menu({ p, press, shot }) {
    await press("scenario-menu");
    await p.page.waitForTimeout(300);
    await shot("scenarios");
    await p.page.keyboard.press("Escape");
  },
  async stopped({ p, base, press, shot }) {
    await press("stop");
    await until("stopped", 10, () => session(base), (s) => Math.hypot(s.command.v, s.command.omega) < 1e-9);
    await shot("stopped");
    await p.get("release").first().click();
  },
  async teleop({ p, base, go, shot }) {
    await post(base, "/session/control", { action: "load", scenario: "ramp", robot: "robhaz" });
    await json(base, "/session/goal", { method: "DELETE" });
    await go("teleop");
    const box = await p.get("hand-stick").boundingBox();
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    await p.page.mouse.move(x, y);
    await p.page.mouse.down();
    await p.page.mouse.move(x, y - box.height * 0.15);
    await drives(base);
    await p.page.waitForTimeout(1500);
    await shot("teleop");
    await p.page.mouse.up();
    await shot("teleop-rest");
  },
  async arm({ p, base, go, press, shot }) {
    await post(base, "/session/control", { action: "load", scenario: "arm_table" });
    await post(base, "/session/control", { action: "play" });
    await go("drive");
    await until("a plan that is followed", 60, () => session(base), (s) => s.arm === "goes" && s.pose.x > 0.3);
    await post(base, "/session/control", { action: "pause" });
    if (!(await p.get("tab-arm").last().isVisible())) await press("tune");
    await p.get("tab-arm").last().click();
    await p.get("hand-z").last().fill("2.4");
    await shot("arm");
    await p.page.keyboard.press("Escape");
    if (await p.get("sheet").count()) await press("tune");
    await press("three");
    await p.get("scene-3d").waitFor({ timeout: 30_000 });
    await press("tool-hand");
    await p.page.waitForTimeout(2500);
    await shot("arm-3d");
    await press("tool-hand");
    await press("three");
    await p.get("scene").waitFor();
  },
  async runs({ p, press, go, shot }) {
    await go("runs");
    await p.page.locator("a.run-link, tbody tr").first().waitFor();
    await shot("runs");
    await p.get("runs-filter").fill("case1");
    await p.page.waitForTimeout(600);
    await shot("runs-search");
    await p.get("runs-filter").fill("");
    await press("start-run");
    await p.get("start-dialog").waitFor();
    await shot("runs-start");
    await p.page.keyboard.press("Escape");
  },
  async opened_run({ p, shot, runs }) {
    await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), runs[0]);
    await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
    await p.page.waitForTimeout(800);
    await shot("run");
    await p.page.evaluate((ids) => (location.hash = `#/runs/${ids[0]}?with=${ids.slice(1, 3).join(",")}`), runs);
    await p.page.waitForTimeout(2500);
    await shot("compare");
  },
  async experiments({ p, go, press, shot, experiment }) {
    await go("experiments");
    await p.page.waitForTimeout(600);
    await shot("experiments");
    await press("new-experiment");
    await p.get("experiment-check").click();
    await p.get("experiment-estimate").waitFor();
    await shot("experiment-new");
    await p.page.keyboard.press("Escape");
    await p.page.evaluate((id) => (location.hash = `#/experiments/${id}`), experiment);
    await p.get("experiment-results").waitFor({ timeout: 20_000 });
    await p.page.waitForTimeout(1200);
    await shot("experiment");
    await p.get("experiment-paths").scrollIntoViewIfNeeded({ timeout: 5000 }).catch(() => undefined);
    await p.page.waitForTimeout(800);
    await shot("experiment-lower");
  },
  async system({ p, go, shot }) {
    await go("system");
    await p.page.waitForTimeout(800);
    await shot("system");
    await p.get("log").last().scrollIntoViewIfNeeded({ timeout: 5000 }).catch(() => undefined);
    await shot("system-lower");
  },
  async nowhere({ p, shot }) {
    await p.page.evaluate(() => (location.hash = "#/nowhere"));
    await p.get("nowhere").waitFor();
    await shot("nowhere");
  },
  async server_gone({ p, go, shot, server }) {
    await go("drive");
    await server.stop();
    await p.page.waitForTimeout(2500);
    await shot("server-gone", { checks: false });
  },
};

async function walk(browser, theme, size) {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "demo" });
  const { base } = server;
  const runs = [];
  for (const controller of ["strip", "modified", "dwa"]) {
    const batch = await post(base, "/runs", { scenario: "case1", controller, physics: "kinematic" });
    runs.push(...batch.runs);
  }
  const { id: experiment } = await post(base, "/experiments", {
    name: "near-and-far", physics: "kinematic", repeats: 10, comparisons: { baseline: "original" },
    scenarios: [{ name: "near", goal: { x: 1, y: 0.2 } }, { name: "far", goal: { x: 1.5, y: 0.2 } }],
    controllers: ["original", "go_to_goal", "strip"],
  });
  const p = await open(browser, base, { size: kSizes[size], theme, touch: kTouch.includes(size) });
  p.page.setDefaultTimeout(8000);
  const where = `${size}, ${theme}`;
  const known = new Set();
  const context = {
    p, base, runs, experiment, server,
    async go(view) {
      const link = p.get(`nav-${view}`);
      if (await link.isVisible()) await link.click();
      else await p.page.evaluate((v) => (location.hash = `#/${v}`), view);
      await p.page.waitForTimeout(kRest);
    },
    press: (id) => p.get(id).locator("visible=true").first().click(),
    async shot(name, { checks = true } = {}) {
      await p.page.waitForTimeout(kRest);
      await p.page.screenshot({ path: join(folder, `${size}-${theme}-${name}.png`) });
      if (!checks) return;
      for (const fault of await p.accessibility()) {
        if (known.has(fault)) continue;
        known.add(fault);
        faults.push(`${where}, ${name}: ${fault}`);
      }
    },
  };
  for (const id of runs) await until("the runs are over", 60, () => json(base, `/runs/${id}`), (r) => r.status === "finished");
  for (const [name, step] of Object.entries(kSteps)) {
    await step(context).catch(async (e) => {
      faults.push(`${where}, ${name}: ${e.message.split("\n")[0]}`);
      await p.page.screenshot({ path: join(folder, `${size}-${theme}-failed-${name}.png`) });
      for (let i = 0; i < 3; ++i) await p.page.keyboard.press("Escape");
    });
  }
  p.forgive(/Failed to load|ERR_|WebSocket|Failed to fetch/);
  faults.push(...p.faults.map((f) => `${where}: ${f}`));
  await p.context.close();
  await server.stop().catch(() => undefined);
  place.remove();
}

/** A robot of hardware, at rest and armed: its bar, and what its controls leave free. */
async function hardware(browser, theme) {
  const place = scratch();
  const emulated = await devices(place.folder);
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", emulated.file] });
  for (const size of sizes) {
    const p = await open(browser, server.base, { size: kSizes[size], theme, touch: kTouch.includes(size) });
    const shot = (name) => p.page.screenshot({ path: join(folder, `${size}-${theme}-${name}.png`) });
    try {
      await shot("hardware");
      await arm(p, () => session(server.base));
      await shot("hardware-armed");
      faults.push(...(await p.accessibility()).map((f) => `${size}, ${theme}, hardware: ${f}`));
      await p.get("arm").click();
    } catch (e) {
      faults.push(`${size}, ${theme}, hardware: ${e.message.split("\n")[0]}`);
    }
    await p.context.close();
  }
  await server.stop().catch(() => undefined);
  emulated.end();
  place.remove();
}

/** One sheet a state and theme, all sizes beside each other. */
async function sheets(browser) {
  const files = readdirSync(folder).filter((f) => /^\w+-(dark|light)-.*\.png$/.test(f) && !f.startsWith("sheet"));
  const states = [...new Set(files.map((f) => f.replace(/^\w+-/, "")))].sort();
  const page = await browser.newPage({ viewport: kSheet });
  for (const state of states) {
    const shown = Object.entries(kOnSheet).filter(([size]) => files.includes(`${size}-${state}`));
    writeFileSync(join(folder, "sheet.html"), `<body style="margin:4px;background:#888;display:flex;flex-wrap:wrap;gap:8px;align-items:start">${
      shown.map(([size, [w, h]]) => `<img src="${size}-${state}" style="max-width:${w}px;max-height:${h}px">`).join("")}</body>`);
    await page.goto(`file://${join(folder, "sheet.html")}`);
    await page.screenshot({ path: join(folder, `sheet-${state}`) });
  }
  console.log(`${states.length} sheets in ${folder}`);
}

mkdirSync(folder, { recursive: true });
const browser = await launch();
for (const theme of kThemes) {
  for (const size of sizes) await walk(browser, theme, size);
  await hardware(browser, theme);
}
await sheets(browser);
await browser.close();
for (const fault of faults) console.log(fault);
console.log(faults.length === 0 ? "no fault" : `${faults.length} faults`);
process.exit(faults.length === 0 ? 0 : 1);
