// tests/web/ground.mjs: ramps, steps and trenches are drawn with the mouse, by touch and by keys, changed, saved and
// opened again; a robot drives over them, seen from above and in 3D.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

let browser;
let server;
let store;

before(async () => {
  store = scratch();
  server = await serve({ database: store.database, scenario: "case1", more: ["--scenarios", join(store.folder, "worlds")] });
  browser = await launch(["--enable-unsafe-swiftshader"]);
});
after(async () => {
  await browser?.close();
  await server?.stop();
  store?.remove();
});

const kEmpty = { name: "empty", start: { x: 0, y: 0, heading: 0 }, controller: "strip", physics: "bullet" };
const session = () => json(server.base, "/session");
const obstacles = async () => (await json(server.base, "/session/obstacles")).items;
const control = (body) => json(server.base, "/session/control", { method: "POST", body: JSON.stringify(body) });

async function fresh(scenario, options = {}) {
  await control({ action: "load", scenario });
  const p = await open(browser, server.base, options);
  if ((await p.get("layers").getAttribute("aria-expanded")) === "true") await p.get("layers").click();
  return p;
}

/** Zooms out until `places` [m] lie in the free part of the scene. */
async function show(p, ...places) {
  await p.get("scene").focus();
  for (let i = 0; i < 14; ++i) {
    const box = await p.get("scene").boundingBox();
    const wide = box.width > 500;
    const at = await Promise.all(places.map(([x, y]) => p.pixels(x, y)));
    if (at.every((a) => a.x > box.x + (wide ? 80 : 20) && a.x < box.x + box.width - 30 && a.y > box.y + (wide ? 120 : 60) && a.y < box.y + box.height - (wide ? 140 : 30))) return;
    await p.page.keyboard.press("-");
  }
}

const ends = (o) => [-1, 1].map((side) => [o.x + (side * o.length * Math.cos(o.heading)) / 2, o.y + (side * o.length * Math.sin(o.heading)) / 2]);
const same = (a, b) => near(a[0], b[0], 0.02) && near(a[1], b[1], 0.02);

test("with the mouse: a ramp uphill, a step, a trench; typed heights, undo, save and open", { timeout: 150_000 }, async () => {
  const p = await fresh(kEmpty);
  await show(p, [-1, 2.5], [7.5, -2.5]);
  const draw = async (kind, from, to) => {
    await p.get("tool-ground").click();
    if (kind !== "ramp") await p.pick_radio("ground-kind", kind);
    const before = (await obstacles()).length;
    await p.drag(await p.pixels(...from), await p.pixels(...to));
    return (await until(`a ${kind}`, 8, obstacles, (list) => list.length === before + 1)).at(-1);
  };
  const ramp = await draw("ramp", [2, 0], [4, 0]);
  assert.equal(ramp.type, "ramp");
  assert.ok(same(ends(ramp)[0], [2, 0]) && same(ends(ramp)[1], [4, 0]), `uphill along the drag: ${JSON.stringify(ramp)}`);
  assert.deepEqual([ramp.low, ramp.height], [0, 0.15]);
  const step = await draw("step", [4.01, 0.01], [5.5, 0]);
  assert.equal(step.type, "step");
  assert.ok(same(ends(step)[0], [4, 0]), "it snaps to the end of the ramp");
  assert.ok(near(step.height, 0.15, 1e-9), "and goes on at its height");
  const trench = await draw("trench", [6, -1.5], [6, -1.1]);
  assert.equal(trench.type, "trench");
  assert.ok(near(trench.length, 0.4, 0.02) && near(trench.heading, Math.PI / 2, 0.02), JSON.stringify(trench));

  // A typed height counts to a millimetre.
  await p.get("tool-pan").click();
  const on_step = await p.pixels(4.7, 0.3);
  await p.page.mouse.click(on_step.x, on_step.y);
  await p.page.waitForSelector('[data-testid="obstacle-values"]');
  await p.get("obstacle-height").fill("0.153");
  await p.get("obstacle-set").click();
  await until("its height", 5, obstacles, (list) => near(list[1].height, 0.153, 1e-9) && list[1].type === "step");
  await p.page.keyboard.press("Control+z");
  await until("its height before", 5, obstacles, (list) => near(list[1].height, 0.15, 1e-9));
  await p.page.keyboard.press("Control+Shift+z");
  await until("its height again", 5, obstacles, (list) => near(list[1].height, 0.153, 1e-9));
  await p.page.keyboard.press("Escape");

  // The pointer tells height and slope.
  const on_ramp = await p.pixels(3, -0.4);
  await p.page.mouse.move(on_ramp.x + 3, on_ramp.y);
  await p.page.mouse.move(on_ramp.x, on_ramp.y);
  const card = p.page.locator('[data-testid="inspect"]');
  await card.waitFor();
  assert.match(await card.innerText(), /Ramp 1[^]*Height here\s+0\.0[78]\d? m[^]*Slope\s+\+4\.3°/);
  await p.shot("ground-edit-desktop");
  assert.deepEqual(await p.accessibility(), []);

  // The legend switches it off.
  await p.get("layers").click();
  await p.get("layer-ground").click();
  assert.equal(await p.get("layer-ground").getAttribute("aria-checked"), "false");
  await p.get("layer-ground").click();

  // Saved and opened again it is the same ground.
  const drawn = await obstacles();
  await p.get("tab-world").click();
  await p.get("world-name").fill("Small hills");
  await p.get("world-save").click();
  await until("saved", 5, session, (s) => s.scenario.name === "small_hills" && !s.edited);
  assert.match(await p.get("world-words").innerText(), /1 ramp, 1 step, 1 trench/);
  await p.load("case1");
  await p.load("small_hills");
  const opened = await until("opened", 10, obstacles, (list) => list.length === 3);
  assert.deepEqual(opened, drawn);

  // In 3D the pointer finds it as well.
  await p.get("three").click();
  await p.page.waitForSelector(".three canvas");
  await p.page.waitForTimeout(1200);
  await p.shot("ground-3d-desktop");
  await p.close();
});

test("by touch on a phone, and by keys: a ramp and a trench", { timeout: 90_000 }, async () => {
  const p = await fresh(kEmpty, { size: phone, touch: true });
  const cdp = await p.context.newCDPSession(p.page);
  const drag = async (from, to) => {
    const [a, b] = [await p.pixels(...from), await p.pixels(...to)];
    const touch = (type, x, y) => cdp.send("Input.dispatchTouchEvent", { type, touchPoints: type === "touchEnd" ? [] : [{ x, y }] });
    await touch("touchStart", a.x, a.y);
    for (const k of [0.3, 0.7, 1]) await touch("touchMove", a.x + k * (b.x - a.x), a.y + k * (b.y - a.y));
    await touch("touchEnd");
  };
  await p.get("tool-ground").tap();
  await drag([1, 1], [1, 2.5]);
  const [ramp] = await until("a ramp", 8, obstacles, (list) => list.length === 1);
  assert.equal(ramp.type, "ramp");
  assert.ok(near(ramp.heading, Math.PI / 2, 0.05) && near(ramp.length, 1.5, 0.1), JSON.stringify(ramp));
  await p.shot("ground-edit-phone");
  // The keys: T for a trench, arrows for the crosshair, Enter.
  await p.page.keyboard.press("Escape");
  await p.page.keyboard.press("t");
  await p.get("scene").focus();
  for (let i = 0; i < 35; ++i) await p.page.keyboard.press("ArrowDown"); // clear of the robot
  await p.page.keyboard.press("Enter");
  const trench = (await until("a trench", 8, obstacles, (list) => list.length === 2)).at(-1);
  assert.deepEqual([trench.type, trench.depth, trench.length], ["trench", 0.1, 0.1]);
  await p.page.keyboard.press("Control+z");
  await until("one less", 5, obstacles, (list) => list.length === 1);
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

test("a robot drives over a hill drawn with the mouse: it tilts from above, in 3D and on the horizon", { timeout: 240_000 }, async () => {
  const p = await fresh({ ...kEmpty, robot: "jackal", controller: "modified", parameters: { v_max: 0.5 }, drive: { max_v: 0.5 } });
  await show(p, [-1, 2], [9.5, -2]);
  assert.equal(await p.get("terrain").count(), 0, "the floor is level so far");
  const draw = async (kind, from, to, values) => {
    await p.get("tool-ground").click();
    if (kind !== "ramp") await p.pick_radio("ground-kind", kind);
    const before = (await obstacles()).length;
    await p.drag(await p.pixels(...from), await p.pixels(...to));
    await until(`a ${kind}`, 8, obstacles, (list) => list.length === before + 1);
    await p.page.waitForSelector('[data-testid="obstacle-values"]');
    for (const [name, value] of Object.entries(values)) await p.get(`obstacle-${name}`).fill(value);
    await p.get("obstacle-set").click();
    await until("its values", 5, obstacles, (list) => Object.entries(values).every(([name, value]) => near(list[before][name], Number(value), 1e-9)));
    await p.page.keyboard.press("Escape");
  };
  await draw("ramp", [2, 0], [5, 0], { width: "3", height: "0.2" });        // 3.8 degrees up
  await draw("ramp", [8, 0], [5, 0], { width: "3", height: "0.2" });        // and down again
  await draw("trench", [1.2, 0], [1.3, 0], { length: "0.02", width: "3", depth: "0.05" });
  await p.get("terrain").waitFor();
  await p.get("tool-goal").click();
  const goal = await p.pixels(9, 0);
  await p.page.mouse.click(goal.x, goal.y);
  await until("a goal", 8, session, (s) => s.goal !== null);
  await p.get("tool-pan").click();

  const pitch = async () => Number((await p.get("terrain-pitch").innerText()).replace("−", "-").replace(/[^-\d.]/g, ""));
  const seen = { up: 0, down: 0 };
  await until("uphill", 60, pitch, (degrees) => (seen.up = degrees) < -3);
  await control({ action: "pause" }); // so that both views show the same, and a machine without a GPU has the time
  await p.page.waitForTimeout(500);
  await p.shot("ground-drive-desktop");
  await p.page.keyboard.press("3");
  await p.page.waitForSelector(".three canvas");
  await p.page.waitForTimeout(1500);
  await p.shot("ground-drive-3d-desktop");
  await p.page.keyboard.press("3");
  await p.page.waitForSelector('[data-testid="scene"]');
  await control({ action: "play" });
  await until("downhill", 60, pitch, (degrees) => (seen.down = degrees) > 3);
  await until("at the goal", 60, session, (s) => s.run?.outcome === "reached");
  assert.ok(seen.up > -6 && seen.down < 6, JSON.stringify(seen));
  assert.deepEqual(await p.accessibility(), []);

  await p.get("steps-close").click();
  for (const [name, size] of [["phone", phone], ["landscape", { width: 844, height: 390 }], ["small", { width: 320, height: 640 }]]) {
    await p.page.setViewportSize(size);
    await p.page.keyboard.press("f");
    await p.page.waitForTimeout(400);
    const [card, scene, room] = await Promise.all(["terrain", "scene"].map((id) => p.get(id).boundingBox()).concat(p.page.evaluate(() => [innerWidth, innerHeight])));
    assert.ok(card.x >= 0 && card.x + card.width <= room[0] + 0.5 && card.y + card.height <= room[1] + 0.5, `${name}: ${JSON.stringify(card)}`);
    assert.ok(card.y >= scene.y + scene.height || card.x >= scene.x + scene.width, `${name}: the card covers no scene`);
    await p.shot(`ground-drive-${name}`);
  }
  await p.page.setViewportSize(desktop);
  await p.close();
});

test("kinematic physics has no heights: the server refuses ground in words, and the page shows them", { timeout: 60_000 }, async () => {
  const p = await fresh({ ...kEmpty, physics: "kinematic" });
  await p.get("tool-ground").click();
  await p.drag(await p.pixels(2, 0), await p.pixels(3, 0));
  const toast = p.page.locator(".toast");
  await toast.waitFor();
  assert.match(await toast.innerText(), /bullet/i);
  assert.deepEqual(await obstacles(), []);
  await p.close();
});
