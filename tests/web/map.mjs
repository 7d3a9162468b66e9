// tests/web/map.mjs: a robot that knows a map on the page: in a room that looks the same from two sides it is lost and
// refuses goals; its pose is given by a drag, by keys and by numbers; then it drives. The map and the ellipse are layers.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

const kLong = 10, kWide = 6; // [m] of the room
const kCell = 0.05;          // [m]

const wall = (x, y, length, heading) => ({ type: "wall", x, y, length, thickness: 0.1, heading });
const kRoom = {
  name: "room", title: "A room that looks the same from two sides", physics: "kinematic", controller: "strip",
  start: { x: 2, y: 2, heading: 0 }, drive: { odometry_scale: 0.05, odometry_noise: 0.02 }, time_limit: 600,
  obstacles: [wall(kLong / 2, 0, kLong, 0), wall(kLong / 2, kWide, kLong, 0), wall(0, kWide / 2, kWide, Math.PI / 2),
    wall(kLong, kWide / 2, kWide, Math.PI / 2)],
};

/** The room's walls as a map of map_server, with a metre of the unknown about it. */
function write_map(folder) {
  const columns = (kLong + 2) / kCell, rows = (kWide + 2) / kCell;
  const grey = Buffer.alloc(columns * rows, 205);
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      const x = (column + 0.5) * kCell - 1, y = (rows - row - 0.5) * kCell - 1;
      const beyond = Math.max(-x, x - kLong, -y, y - kWide); // the walls' faces are 0.05 m inside
      if (beyond < 0.05) grey[row * columns + column] = beyond > -0.05 ? 0 : 254;
    }
  }
  writeFileSync(join(folder, "room.pgm"), Buffer.concat([Buffer.from(`P5\n${columns} ${rows}\n255\n`), grey]));
  writeFileSync(join(folder, "room.yaml"), `image: room.pgm\nresolution: ${kCell}\norigin: [-1, -1, 0]\nnegate: 0\n`);
  writeFileSync(join(folder, "room.json"), JSON.stringify(kRoom));
}

let browser, server, store;

before(async () => {
  store = scratch();
  write_map(store.folder);
  server = await serve({
    database: store.database, scenario: join(store.folder, "room.json"), more: ["--map", join(store.folder, "room.yaml"), "--lost"],
  });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
  store?.remove();
});

const session = () => json(server.base, "/session");
const fix = (what, state) => until(what, 60, session, (s) => s.fix?.state === state);
const reset = () => json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action: "reset" }) });

test("a robot that is lost says so and refuses goals; a drag tells it where it is, and it drives", { timeout: 240_000 }, async () => {
  await fix("the room looks the same from two sides", "not_unique");
  const p = await open(browser, server.base);
  await p.page.getByText("Several places on the map look like this one").first().waitFor();
  await until("the first step is the pose", 5, () => p.get("steps").textContent(), (w) => /Tell the robot where it is/.test(w));
  await p.page.keyboard.press("g");
  const goal = await p.pixels(8, 4);
  await p.page.mouse.click(goal.x, goal.y);
  await p.page.getByText("Where the robot is on the map is not known: give an initial pose.").first().waitFor();
  await p.shot("map-lost");

  await p.page.keyboard.press("i");
  await p.get("pose-values").waitFor();
  await p.drag(await p.pixels(2.3, 1.7), await p.pixels(3.3, 1.8));
  const found = await fix("the dragged pose is found", "located");
  assert.ok(near(found.pose.x, 2, 0.1) && near(found.pose.y, 2, 0.1), JSON.stringify(found.pose));
  assert.equal(await p.get("tool-pan").getAttribute("aria-pressed"), "true", "the next press gives no pose");
  await until("the first step is a goal", 5, () => p.get("steps").textContent(), (w) => /Send the robot somewhere/.test(w));
  await p.page.keyboard.press("g");
  await p.page.mouse.click(goal.x, goal.y);
  await until("the robot drives", 20, session, (s) => s.mission === "driving");
  await p.page.waitForTimeout(3000);
  await p.shot("map-driving");
  const end = await until("the goal is reached", 90, session, (s) => s.run.outcome === "reached");
  assert.ok(near(end.pose.x, 8, 0.4) && near(end.pose.y, 4, 0.4), JSON.stringify(end.pose));
  assert.deepEqual(await p.accessibility(), []);
  await p.close();
});

test("the pose is given by numbers, the map is searched again, and its layer has a switch", { timeout: 240_000 }, async () => {
  await reset();
  await fix("lost again", "not_unique");
  const p = await open(browser, server.base, { reads: true });
  await p.get("tool-pose").click();
  await p.get("pose-x").fill("2.2");
  await p.get("pose-y").fill("2.1");
  await p.get("pose-heading").fill("5");
  await p.get("pose-set").click();
  await fix("the typed pose is found", "located");
  await p.get("tool-pose").click();
  await p.get("pose-search").click();
  await fix("the map is searched", "not_unique");

  if ((await p.get("layers").getAttribute("aria-expanded")) !== "true") await p.get("layers").click();
  const places = await p.pixels(1, 5); // floor of the map, behind the robot
  const colour = () => p.page.evaluate(({ x, y }) => {
    const canvas = document.querySelector('[data-testid="scene"]');
    const box = canvas.getBoundingClientRect();
    const k = canvas.width / box.width;
    return [...canvas.getContext("2d").getImageData((x - box.x) * k, (y - box.y) * k, 1, 1).data].join();
  }, places);
  const shown = await colour();
  await p.page.getByRole("switch", { name: "Known map" }).or(p.page.getByLabel("Known map")).first().click();
  await until("the map is gone", 10, colour, (c) => c !== shown);
  await p.shot("map-layers");
  await p.close();
});

test("the keys give a pose at the crosshair, on a small screen too", { timeout: 240_000 }, async () => {
  await reset();
  await fix("lost again", "not_unique");
  const small = await open(browser, server.base, { size: phone });
  await small.shot("map-phone");
  await small.close();
  const p = await open(browser, server.base, { size: desktop, theme: "light" });
  await p.page.keyboard.press("i");
  await p.get("scene").focus();
  // The crosshair begins in the middle of the view; steps of 0.1 m lead to the robot.
  await p.page.keyboard.press("ArrowLeft");
  for (let k = 0; k < 29; ++k) await p.page.keyboard.press("ArrowLeft");
  for (let k = 0; k < 9; ++k) await p.page.keyboard.press("ArrowDown");
  await p.page.keyboard.press("Enter");
  await fix("the pose at the crosshair is found", "located");
  await p.shot("map-light");
  await p.close();
});

test("a pose off the map is told; a run on the served map is driven again; a run starts with a world that is there", { timeout: 240_000 }, async () => {
  await reset();
  const p = await open(browser, server.base);
  await p.get("tool-pose").click();
  await p.get("pose-x").fill("50");
  await p.get("pose-set").click();
  await p.page.getByText("The map shows nothing within 2 m of this pose").waitFor();
  assert.equal(await p.get("tool-pose").getAttribute("aria-pressed"), "true", "the next press gives another");

  const { run } = await session();
  await p.page.goto(`${server.base}/#/runs/${run.id}`);
  await p.get("drive-again").selectOption("dwa");
  await until("both are compared", 60, () => p.page.url(), (url) => /with=\d+/.test(url));
  await p.get("start-run").click();
  assert.equal(await p.get("start-scenario").inputValue(), (await json(server.base, "/scenarios")).items[0].name, "the room is in no list");
  await p.page.keyboard.press("Escape");

  await p.get("nav-drive").click();
  await p.load("case1");
  await p.page.keyboard.press("Control+z");
  await until("the room and its map are back", 20, session, (s) => s.scenario.name === "room" && s.map === "room.yaml");
  await p.close();
});

test("a map that comes late is not drawn in the world that was loaded meanwhile", { timeout: 120_000 }, async () => {
  const p = await open(browser, server.base);
  if ((await p.get("layers").getAttribute("aria-expanded")) !== "true") await p.get("layers").click();
  const layer = p.page.getByRole("switch", { name: "Known map" }).or(p.page.getByLabel("Known map")).first();
  await layer.waitFor();
  let asked = 0, sent = 0;
  await p.page.route("**/session/map", async (route) => {
    ++asked;
    const response = await route.fetch();
    await p.page.waitForTimeout(4000);
    await route.fulfill({ response });
    ++sent;
  });
  await reset();
  await until("the map of the new run is asked for", 10, () => asked);
  await p.load("case1");
  await layer.waitFor({ state: "detached" });
  await until("it comes", 10, () => sent);
  await p.page.waitForTimeout(500);
  assert.equal(await layer.count(), 0);
  await p.page.keyboard.press("Control+z");
  await layer.waitFor();
  await p.close();
});
