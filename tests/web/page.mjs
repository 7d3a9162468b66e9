// tests/web/page.mjs: a browser page for the end-to-end tests: collects faults, clicks at world
// positions, keeps screenshots.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { repository, require, until } from "./program.mjs";

const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");
const kShots = process.env.TAUTLINE_SCREENSHOTS ?? join(repository, "build/screenshots");

/** Of the pages whose test names none: TAUTLINE_THEME=light looks at every state of a suite in the other one. */
export const usual_theme = process.env.TAUTLINE_THEME ?? "dark";
export const desktop = { width: 1440, height: 900 };
export const phone = { width: 390, height: 844 };

/** Without a GPU process: where there is no GPU, drawing by an emulated one is six times slower. */
export function launch(more = []) {
  return chromium.launch({
    executablePath: process.env.TAUTLINE_CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--disable-gpu", ...more],
  });
}

/** Chromium changes the renderer of a canvas that is read often, and with it the edges of lines: one from the start. */
function read_scene() {
  const get = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    return get.call(this, kind, kind === "2d" ? { ...options, willReadFrequently: true } : options);
  };
}

/** A page in a browser context of its own. `faults` gathers console errors, exceptions and CSP; with `reads` a test may read the scene's pixels often. `token` signs in first. */
export async function open(browser, base, { size = desktop, theme = usual_theme, hash = "", touch = false, patience = 20_000, reads = false, token = "" } = {}) {
  const context = await browser.newContext({ viewport: size, colorScheme: theme, hasTouch: touch, reducedMotion: "reduce" });
  if (token) await context.request.post(`${base}/api/v1/login`, { data: { token }, headers: { Origin: base } });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (m) => {
    // The software renderer's own warning about reading pixels is no fault of the page.
    if (["error", "warning"].includes(m.type()) && !/ReadPixels/.test(m.text())) faults.push(`${m.type()}: ${m.text()} ${m.location().url.replace(/^.*:\d+/, "")}`);
  });
  page.on("pageerror", (e) => faults.push(`exception: ${e.message}`));
  if (reads) await page.addInitScript(read_scene);
  await page.addInitScript(() => {
    window.violations = [];
    document.addEventListener("securitypolicyviolation", (e) => window.violations.push(`${e.violatedDirective} ${e.blockedURI}`));
  });
  await page.goto(`${base}/${hash}`);
  await page.waitForSelector('[data-testid="link"].open', { timeout: patience });
  // The page handles keys only once it has drawn; an earlier key is lost.
  await page.evaluate(() => new Promise((done) =>
    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)))));
  const get = (id) => page.getByTestId(id);
  return {
    page, context, faults, get,
    /** Ends the page. `on_purpose`: faults that the test brought about; others of their kind may come up to the end. */
    async close(on_purpose) {
      assert.deepEqual(await page.evaluate(() => window.violations), [], "content security policy");
      if (on_purpose) this.forgive(on_purpose);
      assert.deepEqual(faults, [], "console");
      await context.close();
    },
    /** Forgets faults that a test brought about on purpose, such as a server that goes away. */
    forgive(pattern) {
      for (let i = faults.length - 1; i >= 0; --i) if (pattern.test(faults[i])) faults.splice(i, 1);
    },
    async shot(name) {
      mkdirSync(kShots, { recursive: true });
      await page.screenshot({ path: join(kShots, `${name}.png`) });
    },
    /** Pixels of a place of the world [m], once the view rests. */
    async pixels(x, y) {
      const scene = get("scene");
      // The view refits when a card below it grows, so wait until it stays the same for a while.
      const rests = (e) => {
        if (e.dataset.view !== e.test_view) [e.test_view, e.test_since] = [e.dataset.view, performance.now()];
        return e.dataset.view && performance.now() - e.test_since > 250 ? e.dataset.view : null;
      };
      const view = await page.waitForFunction(rests, await scene.elementHandle());
      const [cx, cy, scale] = (await view.jsonValue()).split(" ").map(Number);
      const box = await scene.boundingBox();
      return { x: box.x + box.width / 2 + (x - cx) * scale, y: box.y + box.height / 2 - (y - cy) * scale };
    },
    /** Waits until the scene shows `tick`. */
    async draws(tick) {
      await page.waitForFunction(([e, t]) => e.dataset.tick === t, [await get("scene").elementHandle(), String(tick)], { timeout: 40_000 });
    },
    /**
     * Holds a key until what `ask` gives is `good`; presses it again, as a person would, when the page was too busy to
     * take it. An error holds the `words` too.
     */
    hold_key(key, ask, good, words = async () => ({})) {
      return until(`the effect of ${key}`, 45, async () => {
        await page.keyboard.up(key);
        await page.waitForTimeout(300); // the page sends that the key is up, or a held one would not go on
        await page.keyboard.down(key);
        return until("taken", 3, ask, good).catch(async () => ({ ...await words(), ...await ask() }));
      }, good);
    },
    async drag(from, to) {
      await page.mouse.move(from.x, from.y);
      await page.mouse.down();
      await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
      await page.mouse.move(to.x, to.y);
      await page.mouse.up();
    },
    /** The scenario by its menu, as a person does it. */
    async load(name) {
      await get("scenario-menu").click();
      await page.getByRole("combobox", { name: "Find a scenario" }).fill(name);
      await get(`scenario-${name}`).click();
      await page.waitForSelector(`[data-testid="scenario-menu"][data-scenario="${name}"]`);
      await page.waitForFunction(() => !/^Loading/.test(document.querySelector(".menu-name").textContent));
    },
    async pick_radio(group, value) {
      await get(group).locator(`label:has(input[value="${value}"])`).click();
    },
    /** Faults of accessibility by WCAG A and AA and best practice, as sentences. */
    async accessibility() {
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() => window.axe.run(document, {
        runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"],
      }));
      return violations.map((v) => `${v.id}: ${v.help}: ${v.nodes.slice(0, 3).map((n) => n.target.join(" ")).join(", ")}`);
    },
  };
}
