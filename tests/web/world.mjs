// tests/web/world.mjs: a world is drawn, saved, opened and driven, by mouse, by touch and by keyboard; nothing
// that was built is lost.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { binary, json, near, scratch, serve, until } from "./program.mjs";

let browser;
let server;
let store;

const robots = () => join(store.folder, "robots"); // people's own
before(async () => {
  store = scratch();
  mkdirSync(robots());
  server = await serve({ database: store.database, scenario: "case1", more: ["--scenarios", join(store.folder, "worlds"), "--robots", robots()] });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  store?.remove();
});

const kFree = { name: "free", start: { x: 0, y: 0, heading: 0 }, controller: "strip" };
const kMostTime = 180_000; // [ms] to draw a room and to save it
const session = () => json(server.base, "/session");
const obstacles = async () => (await json(server.base, "/session/obstacles")).items;

async function fresh(options = {}) {
  await json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action: "load", scenario: kFree }) });
  return open(browser, server.base, options);
}

/** The view that shows the whole of a room of 8 x 6 m about (2, 1). */
async function show_room(p) {
  await p.get("scene").focus();
  if (await p.get("layers").getAttribute("aria-expanded") === "true") await p.get("layers").click();
  for (let i = 0; i < 12; ++i) {
    const a = await p.pixels(-2, 4);
    const b = await p.pixels(6, -2);
    const box = await p.get("scene").boundingBox();
    if (a.x > box.x + 70 && a.y > box.y + 150 && b.x < box.x + box.width - 40 && b.y < box.y + box.height - 140) return;
    await p.page.keyboard.press("-");
  }
}

/** Draws with `press` and `stroke` what the world holds: walls, a door, a person, three goals. */
async function draw_room({ press, stroke, pick, press_more }) {
  const wall = async (from, to) => {
    await pick("wall");
    await stroke(from, to);
  };
  await wall([-2, 4], [6, 4]);
  await wall([6, 4], [6, -2]);
  await wall([6, -2], [-2, -2]);
  await wall([-2, -2], [-2, 4]);
  await wall([2, 4], [2, 1.5]);
  await wall([2, 0.1], [2, -2]);
  await pick("mover");
  await press([4, -1]);
  await press([5.4, -1]);
  await press([5.4, -1]);
  await pick("goal");
  await press([3.2, 0.8]);
  await press_more([4.6, 2.6]);
  await press_more([-1, 2.6]);
  await until("the room stands", 10, obstacles, (list) => list.length === 7);
  await until("its goals", 10, session, (s) => s.goals_behind.length + s.goals_ahead.length + (s.goal ? 1 : 0) === 3);
  await check_room(await obstacles());
}

async function check_room(list) {
  const walls = list.filter((o) => o.type === "wall");
  assert.equal(walls.length, 6, JSON.stringify(list));
  assert.equal(list.filter((o) => o.path).length, 1);
  const { goal, goals_ahead, goals_behind } = await session();
  assert.equal(goals_behind.length + goals_ahead.length + (goal ? 1 : 0), 3);
}

test("a room with a door, a person and three goals: drawn with the mouse, saved, opened again, driven", { timeout: 180_000 }, async () => {
  const p = await fresh();
  await show_room(p);
  const at = async ([x, y]) => p.pixels(x, y);
  const press = async (place) => {
    const { x, y } = await at(place);
    await p.page.mouse.click(x, y);
    await p.page.waitForTimeout(120);
  };
  await draw_room({
    press,
    pick: (tool) => p.get(`tool-${tool}`).click(),
    press_more: async (place) => {
      await p.get("goal-append").check();
      await press(place);
    },
    stroke: async (from, to) => {
      await p.drag(await at(from), await at(to));
      await p.page.waitForTimeout(150);
    },
  });
  await p.get("tab-world").click();
  await p.get("world-name").fill("Two rooms with a door");
  await p.get("world-save").click();
  await until("saved", 5, () => session(), (s) => s.scenario.name === "two_rooms_with_a_door" && !s.edited);
  await p.shot("world-desktop");
  assert.deepEqual(await p.accessibility(), []);
  // Somebody else's page finds it without a reload, and drives it.
  await p.load("case1");
  await p.get("tab-world").click();
  await p.get("world-open").click();
  await p.get("open-two_rooms_with_a_door").click();
  await until("opened", 10, () => session(), (s) => s.scenario.name === "two_rooms_with_a_door");
  await check_room(await obstacles());
  await json(server.base, "/session/control", { method: "POST", body: '{"action":"speed","speed":0}' });
  await until("through the door to the second goal", 60, () => session(), (s) => s.goals_behind.length >= 1);
  await json(server.base, "/session/control", { method: "POST", body: '{"action":"speed","speed":1}' });
  await p.close();
});

test("by touch on a phone: the room, walls by two taps, a sketch that is ended by a button", { timeout: 120_000 }, async () => {
  const p = await fresh({ size: phone, touch: true });
  const at = async ([x, y]) => p.pixels(x, y);
  const tap = async (place) => {
    const { x, y } = await at(place);
    await p.page.touchscreen.tap(x, y);
    await p.page.waitForTimeout(120);
  };
  const began = Date.now();
  const cdp = await p.context.newCDPSession(p.page);
  for (let i = 0; i < 8; ++i) { // until the room fits, with two fingers
    const [a, b, box] = [await at([-2.3, 4.3]), await at([6.3, -2.3]), await p.get("scene").boundingBox()];
    if (a.x > box.x && a.y > box.y + 40 && b.x < box.x + box.width && b.y < box.y + box.height) break;
    await cdp.send("Input.synthesizePinchGesture", { x: box.x + 40, y: box.y + box.height - 60, scaleFactor: 0.8 });
  }
  await draw_room({
    press: tap,
    pick: (tool) => p.get(`tool-${tool}`).tap(),
    press_more: async (place) => {
      if (!await p.get("goal-append").isChecked()) await p.get("goal-append").tap();
      await tap(place);
    },
    stroke: async (from, to) => {
      await tap(from);
      await tap(to);
      await p.page.waitForTimeout(150);
    },
  });
  await p.shot("world-touch-room");
  await p.get("tune").tap();
  await p.get("tab-world").last().tap();
  await p.get("world-name").last().fill("By touch");
  await p.get("world-save").last().tap();
  await until("saved", 5, session, (s) => s.scenario.name === "by_touch" && !s.edited);
  assert.ok(Date.now() - began < kMostTime);
  await p.get("tune").tap();
  await json(server.base, "/session/control", { method: "POST", body: '{"action":"load","scenario":"by_touch"}' });
  await check_room(await obstacles());
  await json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action: "load", scenario: kFree }) });
  await p.get("tool-wall").tap();
  await tap([1, 1.5]);
  await p.shot("world-touch");
  await tap([2, 1.5]);
  await until("a wall", 5, obstacles, (list) => list.some((o) => o.type === "wall"));
  await p.get("tool-polygon").tap();
  for (const corner of [[1, -1.5], [2, -1.5], [2, -0.8]]) await tap(corner);
  await p.get("sketch-done").tap();
  await until("a polygon", 5, obstacles, (list) => list.some((o) => o.type === "polygon"));
  await p.shot("world-phone");
  await p.close();
});

test("by keyboard alone: the room, a wall by its two ends, a person, undo of a reset", { timeout: 120_000 }, async () => {
  const p = await fresh();
  const { keyboard } = p.page;
  const began = Date.now();
  await p.get("scene").focus();
  const spoken = () => p.page.locator(".shell > .spoken").last().textContent();
  /** Moves the crosshair to a place, by its own words. */
  const go = async ([x, y]) => {
    const step = async () => { // once more if the robot said something meanwhile
      await keyboard.press("ArrowRight");
      await p.page.waitForTimeout(60);
      return spoken();
    };
    const words = await until("the crosshair", 5, step, (w) => /metres/.test(w));
    const [cx, cy] = words.replaceAll("−", "-").match(/-?[0-9.]+/g).map(Number);
    for (const [by, more, less] of [[x - cx, "ArrowRight", "ArrowLeft"], [y - cy, "ArrowUp", "ArrowDown"]]) {
      for (let i = 0; i < Math.round(Math.abs(by) * 10); ++i) await keyboard.press(by > 0 ? more : less);
    }
  };
  const press = async (place, key = "Enter") => {
    await go(place);
    await keyboard.press(key);
    await p.page.waitForTimeout(150);
  };
  await draw_room({
    press,
    press_more: (place) => press(place, "Shift+Enter"),
    pick: (tool) => keyboard.press({ wall: "w", mover: "k", goal: "g" }[tool]),
    stroke: async (from, to) => {
      await press(from);
      await press(to);
      await keyboard.press("Escape");
    },
  });
  await p.get("tab-robot").focus();
  await keyboard.press("ArrowRight");
  await p.get("world-name").focus();
  await keyboard.press("Control+a");
  await keyboard.type("By keys");
  await keyboard.press("Tab");
  await keyboard.press("Enter");
  await until("saved", 5, session, (s) => s.scenario.name === "by_keys" && !s.edited);
  assert.ok(Date.now() - began < kMostTime);
  await json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action: "load", scenario: kFree }) });
  await p.page.waitForSelector('[data-testid="scenario-menu"][data-scenario="free"]'); // another world puts the tool away
  await p.get("scene").focus();
  await keyboard.press("w");
  for (let i = 0; i < 12; ++i) await keyboard.press("ArrowUp");
  await keyboard.press("Enter");
  for (let i = 0; i < 10; ++i) await keyboard.press("ArrowRight");
  await keyboard.press("Enter");
  const [wall] = await until("a wall", 5, obstacles, (list) => list.length === 1);
  assert.ok(near(wall.length, 1, 0.05), JSON.stringify(wall));
  await keyboard.press("Escape");
  /** A path by its two corners; Enter on the last one ends it. */
  const draw_person = async () => {
    await keyboard.press("k");
    for (let i = 0; i < 15; ++i) await keyboard.press("ArrowDown");
    await keyboard.press("Enter");
    for (let i = 0; i < 5; ++i) await keyboard.press("ArrowLeft");
    await keyboard.press("Enter");
    await keyboard.press("Enter");
    return until("the path", 4, obstacles, (list) => list.some((o) => o.path)).catch(async () => {
      console.log(`# no person yet: ${await p.page.locator(".toast").allTextContents()}; ${await spoken()}`);
      await keyboard.press("Escape");
    });
  };
  if (!await draw_person()) await draw_person(); // once in ten on a busy machine, not understood
  await until("a person", 5, obstacles, (list) => list.some((o) => o.path));
  await keyboard.press("Control+z");
  await until("no person", 5, obstacles, (list) => list.length === 1);
  await p.close();
});

test("another controller, filter, robot and physics keep the world; a reset is taken back", { timeout: 120_000 }, async () => {
  const p = await fresh();
  await json(server.base, "/session/obstacles", { method: "POST", body: '{"type":"cylinder","x":3,"y":3,"radius":0.3}' });
  await json(server.base, "/session/goal", { method: "PUT", body: '{"x":4,"y":0}' });
  for (const [name, value] of [["controller", "strip"], ["robot", "jackal"]]) {
    await p.get(name).selectOption(value);
    await until(name, 10, session, (s) => (name === "robot" ? s.robot.name : s.controller) === value);
    assert.equal((await obstacles()).length, 1);
    assert.equal((await session()).goal.x, 4);
  }
  await p.pick_radio("physics", "kinematic");
  await until("kinematic", 10, session, (s) => s.physics === "kinematic");
  assert.equal((await obstacles()).length, 1);
  const far = await until("on its way", 30, session, (s) => s.pose?.x > 0.8);
  await p.get("reset").click();
  const reset = await until("back at the start", 10, session, (s) => s.pose && s.pose.x < 0.5);
  assert.equal(reset.goal.x, 4);
  await p.get("undo").click();
  await until("where it was", 10, session, (s) => s.pose && s.pose.x >= far.pose.x - 0.1);
  await p.close();
});

test("one's own robot is chosen; once its file is broken, the reason stands there once, and the robot drives on", { timeout: 120_000 }, async () => {
  const file = join(robots(), "carrier.json");
  writeFileSync(file, JSON.stringify({ name: "carrier", title: "Carrier", hull: { length: 0.8, width: 0.6 }, mass: 80, track: 0.5, wheel_radius: 0.1, limits: { speed: 0.8, turn: 1.2 }, lasers: [{ resolution_deg: 0.5 }] }));
  const p = await fresh();
  await p.get("robot").selectOption("carrier");
  await until("the carrier", 10, session, (s) => s.robot.name === "carrier");
  writeFileSync(file, "{ broken");
  await p.page.reload();
  await p.page.getByText(/^carrier\.json: bad JSON/).first().waitFor();
  assert.equal(await p.page.getByText(/^carrier\.json: bad JSON/).count(), 1);
  await p.get("controller").selectOption("dwa");
  await until("its world with another controller", 10, session, (s) => s.controller === "dwa" && s.robot.name === "carrier");
  rmSync(file);
  await p.close();
});

test("a refused drag goes back; one person's undo leaves what another has changed", { timeout: 120_000 }, async () => {
  const a = await fresh();
  await json(server.base, "/session/control", { method: "POST", body: '{"action":"pause"}' });
  await json(server.base, "/session/obstacles", { method: "POST", body: '{"type":"cylinder","x":2,"y":1,"radius":0.3}' });
  const b = await open(browser, server.base);
  await a.get("tool-box").click();
  const from = await a.pixels(2, 1);
  await a.drag(from, await a.pixels(3, 1));
  await until("moved", 5, obstacles, ([o]) => near(o.x, 3, 0.15));
  // Onto the robot: refused, and the cylinder is where the drag began.
  const robot = (await session()).pose;
  await a.drag(await a.pixels(3, 1), await a.pixels(robot.x, robot.y));
  await until("back", 5, obstacles, ([o]) => near(o.x, 3, 0.15));
  // Escape puts it back in the midst of a drag. There is nothing to undo about that.
  const last = await a.get("undo").getAttribute("title");
  const [here, there] = [await a.pixels(3, 1), await a.pixels(4, 2)];
  await a.page.mouse.move(here.x, here.y);
  await a.page.mouse.down();
  await a.page.mouse.move(there.x, there.y);
  await until("on its way", 5, obstacles, ([o]) => o.y > 1.5);
  await a.page.keyboard.press("Escape");
  await a.page.mouse.up();
  await until("put back", 5, obstacles, ([o]) => near(o.x, 3, 0.15) && near(o.y, 1, 0.15));
  await a.page.keyboard.press("Control+z");
  await until("the drag before it is undone", 5, obstacles, ([o]) => near(o.x, 2, 0.15));
  await a.page.keyboard.press("Control+Shift+z");
  await until("and done again", 5, obstacles, ([o]) => near(o.x, 3, 0.15));
  await until("it is the last edit again", 5, () => a.get("undo").getAttribute("title"), (title) => title === last);
  await json(server.base, "/session/obstacles/1", { method: "PUT", body: '{"x":4,"y":-2}' });
  await a.page.waitForTimeout(300);
  await a.get("undo").click();
  await a.page.getByText("has been moved since").waitFor();
  assert.ok(near((await obstacles())[0].x, 4, 1e-6));
  await json(server.base, "/session/control", { method: "POST", body: '{"action":"play"}' });
  await a.close();
  await b.close();
});

test("waypoints are reordered and looped in the list, and sizes are typed", { timeout: 120_000 }, async () => {
  const p = await fresh();
  const goals = [[2, 0], [3, 1], [4, 0]].map(([x, y]) => ({ x, y }));
  await json(server.base, "/session/goals", { method: "PUT", body: JSON.stringify({ goals }) });
  await p.get("tab-world").click();
  await p.get("earlier-3").click();
  await until("reordered", 5, session, (s) => s.goals_ahead[0]?.x === 4);
  await p.get("route-loop").check();
  await until("looped", 5, session, (s) => s.loop);
  await p.get("undo").click();
  await until("not looped", 5, session, (s) => !s.loop && s.goals_ahead[0].x === 4);
  // The robot gets another goal while somebody types: the digits stay, and are the ones that are sent.
  await p.get("route-loop").uncheck();
  await json(server.base, "/session/goal", { method: "PUT", body: '{"x":4,"y":0}' });
  await p.get("tool-goal").click();
  await p.get("goal-y").fill("2.5");
  await json(server.base, "/session/goal", { method: "PUT", body: '{"x":3,"y":1}' });
  await until("the other goal", 5, () => p.get("goal-x").inputValue(), (x) => x === "3");
  await p.get("goal-y").press("Enter");
  await until("the typed number", 5, session, (s) => s.goal.x === 3 && s.goal.y === 2.5);
  await p.get("tool-box").click();
  await p.get("new-x").fill("3");
  await p.get("new-y").fill("3");
  await p.get("new-add").click();
  await until("a box", 5, obstacles, (list) => list.length === 1);
  await p.get("obstacle-width").fill("2");
  await p.get("obstacle-width").fill(""); // what was deleted is not set
  await p.get("obstacle-length").fill("1.5");
  await p.get("obstacle-set").click();
  const [{ width }] = await until("longer", 5, obstacles, ([o]) => o.length === 1.5);
  assert.notEqual(width, 2);
  await p.get("obstacle-copy").click();
  await until("two", 5, obstacles, (list) => list.length === 2);
  await p.close();
});

test("what one person saves and imports does not replace another's worlds", { timeout: 120_000 }, async () => {
  const a = await fresh();
  const b = await open(browser, server.base);
  const title = async (name) => (await json(server.base, `/scenarios/${name}`)).title;
  const world = (title) => ({ name: "mine.json", mimeType: "application/json", buffer: Buffer.from(JSON.stringify({ name: "mine", title, goal: { x: 3, y: 0 } })) });
  for (const p of [a, b]) await p.get("tab-world").click();
  await a.get("world-files").setInputFiles([world("Of Ann")]);
  await until("Ann's import", 10, session, (s) => s.scenario.name === "mine");
  await b.get("world-files").setInputFiles([world("Of Bob")]);
  await until("Bob's import has another name", 10, session, (s) => s.scenario.name === "mine_2");
  assert.equal(await title("mine"), "Of Ann");

  await until("both pages have Bob's world", 10, () => a.get("world-name").inputValue(), (name) => name === "Of Bob");
  await a.get("world-name").fill("Lab");
  await a.get("world-save").click();
  await until("Ann's world is saved", 10, session, (s) => s.scenario.name === "lab");
  await b.get("world-new").click();
  await until("a new one", 10, session, (s) => s.scenario.name !== "lab");
  await b.get("world-name").fill("Lab");
  await b.get("world-save").click();
  await b.get("replace-dialog").waitFor();
  await b.get("replace-yes").click();
  await until("Bob's world is saved", 10, session, (s) => s.scenario.name === "lab");
  await a.close();
  await b.close();
});

test("worlds are imported and exported, copied, deleted and brought back; bad files say why", { timeout: 120_000 }, async () => {
  const p = await fresh({ size: desktop, theme: "light" });
  await p.get("tab-world").click();
  const path = (name, text) => {
    writeFileSync(join(store.folder, name), text);
    return join(store.folder, name);
  };
  const grey = Array.from({ length: 60 }, (_, row) => Array.from({ length: 80 }, (_, c) => (row === 10 && c < 70 ? 0 : 254)).join(" "));
  const files = [path("hall.pgm", `P2\n80 60\n255\n${grey.join("\n")}\n`),
    path("hall.yaml", "image: hall.pgm\nresolution: 0.1\norigin: [-2, -3, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n")];
  await p.get("world-files").setInputFiles(files);
  await until("the map", 10, session, (s) => s.scenario.name === "hall");
  assert.equal((await obstacles()).length, 1);
  await p.get("world-files").setInputFiles([path("bad.json", '{"name":"bad","obstacles":[{"type":"cylinder","x":0}]}')]);
  await p.page.getByText(/obstacles\/0\/(y|radius)/).waitFor();
  p.forgive(/422/);
  await p.page.getByLabel("Dismiss").first().click();
  const small = '{"start":[0,0,0],"goal":[3,0],"obstacles":[[1.5,0.5]]}';
  await p.get("world-files").setInputFiles([path("two.json", `{"worlds":[${small},${small}]}`)]);
  await p.get("which-world").selectOption("1");
  await until("the second of two", 10, session, (s) => s.scenario.name === "barn-2");
  await p.get("which-dialog").waitFor({ state: "detached" });
  await control({ action: "load", scenario: "hall" });
  // The page forgets a name that was typed for another world, so it must have the map before a name is typed.
  await until("the page has the map again", 10, () => p.get("world-name").inputValue(), (name) => name === "hall");
  await p.get("world-name").fill("Case1"); // built in: that it cannot be replaced is said, not asked
  await p.get("world-save").click();
  await until("it says why", 20, () => p.get("world-problem").textContent().catch(() => ""), (w) => /built in/.test(w));
  assert.equal(await p.get("replace-dialog").count(), 0);
  p.forgive(/409/);
  await p.get("world-name").fill("hall");
  const [file] = await Promise.all([p.page.waitForEvent("download"), p.get("world-export").selectOption("json")]);
  assert.equal(JSON.parse(readFileSync(await file.path())).name, "hall");
  await p.get("world-open").click();
  await p.get("copy-hall").click();
  await p.get("open-hall_copy").waitFor();
  await p.get("delete-hall_copy").click();
  await p.get("open-hall_copy").waitFor({ state: "detached" });
  await p.page.keyboard.press("Escape");
  await p.get("toast-undo").click();
  await until("back", 5, () => json(server.base, "/scenarios"), ({ items }) => items.some((s) => s.name === "hall_copy"));
  await p.close();
});

/**
 * Two far aside make a square of 12 x 8 m; a third walks before the robot from 2 s to 6 s of the recording, and a fourth
 * behind it, where it sees nobody, from 3.5 s to 5.5 s.
 */
const kPeople = "100 1 0 0\n2600 1 0 0\n100 2 12 8\n2600 2 12 8\n150 3 6 1.5\n250 3 10 1.5\n187.5 4 1 1.5\n237.5 4 1 3\n";
const kFourth = /^Cylinder 4\s+moves by itself, here from 3.5 to 5.5 s$/;
const control = (body) => json(server.base, "/session/control", { method: "POST", body: JSON.stringify(body) });

/** Drops a file of this name and text onto the page. */
async function drop(p, name, text) {
  const drag = (type) => p.page.evaluate(([type, name, text]) => {
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([text], name, { type: "text/plain" }));
    const event = new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true });
    document.body.dispatchEvent(event);
    return event.defaultPrevented;
  }, [type, name, text]);
  await until("the page asks for it", 5, async () => {
    await drag("dragover"); // a browser repeats it
    return p.get("drop").count();
  });
  assert.ok(await drag("drop"), "the file does not take the place of the page");
  await p.get("drop").waitFor({ state: "detached" });
}

/** Plays up to `tick` and waits until it is drawn. */
async function play_to(p, tick) {
  const { tick: now } = await session();
  await control({ action: "step", ticks: tick - now });
  await until(`tick ${tick}`, 40, session, (s) => s.tick >= tick);
  await p.draws(tick);
}

/** The title of the card that opens under the mouse at a place of the world, or "". */
async function card_at(p, x, y) {
  await p.page.mouse.move(5, 5);
  await p.page.getByTestId("inspect").waitFor({ state: "detached" });
  const px = await p.pixels(x, y);
  await p.page.mouse.move(px.x - 1, px.y);
  await p.page.mouse.move(px.x, px.y);
  await p.page.waitForTimeout(700); // the card's code comes with the first card
  return await p.page.getByTestId("inspect").count() > 0 ? p.page.locator('[data-testid="inspect"] h2').innerText() : "";
}

test("recorded people are dropped onto the page, walk at their times and are gone after them", { timeout: 180_000 }, async () => {
  const p = await fresh({ size: desktop, theme: "light" });
  await drop(p, "bad.txt", "0 1 2 3\n0 2 nan 3\n");
  await p.page.getByText('bad.txt, line 2: "nan 3" is no place in metres.').waitFor();
  await drop(p, "My square.txt", kPeople);
  await until("the people", 10, session, (s) => s.scenario.name === "my_square");
  await control({ action: "pause" });
  await control({ action: "reset" });
  await until("the beginning", 10, session, (s) => s.tick === 0);
  assert.equal((await obstacles()).length, 4);
  if (await p.get("layers").getAttribute("aria-expanded") === "true") await p.get("layers").click();
  await p.get("tool-pan").click();

  await play_to(p, 60);
  assert.equal(await card_at(p, 1, 1.5), "", "not yet there");
  await play_to(p, 90);
  assert.match(await card_at(p, 1, 2.25), kFourth, "half way");
  const room = await p.get("figure-clearance").innerText();
  await p.shot("people-walk");
  await play_to(p, 125);
  for (const y of [1.5, 2.25, 3]) assert.equal(await card_at(p, 1, y), "", "gone");
  await p.shot("people-gone");
  // Looking back, they walk again.
  const look_back = async (t) => {
    await p.get("live-timeline").fill(String(t));
    await p.draws(Math.round(t / 0.05));
  };
  await look_back(4.5);
  await until("the past of the person", 10, () => card_at(p, 1, 2.25), (title) => kFourth.test(title));
  assert.equal(await p.get("figure-clearance").innerText(), room, "of that instant");
  await look_back(3);
  await until("before the person came", 10, () => card_at(p, 1, 2.25), (title) => title === "");
  await p.close();

  // The command line makes the same world of the same file.
  const [file, made] = [join(store.folder, "My square.txt"), join(store.folder, "made.json")];
  writeFileSync(file, kPeople);
  execFileSync(binary, ["crowd", file, "--scenario", made]);
  const kept = await json(server.base, "/scenarios/my_square");
  assert.deepEqual(JSON.parse(readFileSync(made)), kept);
  assert.match(execFileSync(binary, ["run", made, "--seed", "1"], { encoding: "utf8" }), /outcome +reached/);
});

test("a crowd of 5 MB is driven among from the folder of worlds; too large to be sent, it is refused in words", { timeout: 180_000 }, async () => {
  const p = await fresh();
  await p.get("tab-world").click();
  const lines = Array.from({ length: 60_000 }, (_, i) => `${Math.floor(i / 60)} ${i % 60} ${(i % 97) / 7} ${(i % 89) / 9}`);
  await p.get("world-files").setInputFiles([{ name: "large.txt", mimeType: "text/plain", buffer: Buffer.from(lines.join("\n")) }]);
  await p.page.getByText(/^"People of large" is a world of [\d.]+ MB; the page can send 1 MB/).waitFor();

  const walker = (i) => ({
    id: i, type: "cylinder", x: 20, y: i, radius: 0.25,
    path: { period: 2000, comes_and_goes: true, keys: Array.from({ length: 1000 }, (_, k) => [k + 0.125, 20.125 + k / 1000, i + 0.125]) },
  });
  const crowd = { name: "crowd", title: "Crowd", goal: { x: 5, y: 0 }, obstacles: Array.from({ length: 200 }, (_, i) => walker(i + 1)) };
  const text = JSON.stringify(crowd);
  assert.ok(text.length > 4.2e6, `${text.length} bytes`);
  mkdirSync(join(store.folder, "worlds"), { recursive: true });
  writeFileSync(join(store.folder, "worlds/crowd.json"), text);
  await control({ action: "load", scenario: "crowd" });
  await until("the page is in it", 20, () => p.get("scenario-menu").getAttribute("data-scenario"), (name) => name === "crowd");
  const [file] = await Promise.all([p.page.waitForEvent("download"), p.get("world-export").selectOption("json")]);
  assert.equal(JSON.parse(readFileSync(await file.path())).obstacles.length, 200);
  await p.get("tab-robot").click();
  await p.get("controller").selectOption("dwa");
  await until("the controller", 20, session, (s) => s.controller === "dwa" && s.scenario.name === "crowd");
  await p.get("reset").click();
  await until("a new run", 20, session, (s) => s.tick < 100);
  assert.equal(await p.get("link").getAttribute("class").then((c) => /open/.test(c)), true);
  assert.ok(await p.get("undo").isDisabled(), "the way back would be too large");
  await p.close();
});

test("people on a phone come by the dialog", { timeout: 120_000 }, async () => {
  const p = await fresh({ size: phone, touch: true, theme: "light" });
  const file = join(store.folder, "square.txt");
  writeFileSync(file, kPeople);
  await p.get("tune").click();
  await p.get("sheet").getByTestId("tab-world").click();
  await p.get("sheet").getByTestId("world-files").setInputFiles([file]);
  await until("the people", 10, session, (s) => s.scenario.name === "square");
  await p.get("tune").click();
  await control({ action: "pause" });
  await control({ action: "reset" });
  await until("the beginning", 10, session, (s) => s.tick === 0);
  await play_to(p, 90);
  await p.shot("people-phone");
  await p.close();
});
