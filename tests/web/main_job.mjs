// tests/web/main_job.mjs: the main use of the page: load case1, choose `modified`, drag a goal,
// drop an obstacle in the way, watch it reach, scrub that run.
import assert from "node:assert/strict";
import { json, near, until } from "./program.mjs";

/** On the open page `p` of the server at `base`. */
export async function main_job(p, base, physics) {
  // Load case1, choose the physics and the controller.
  await p.load("case1");
  await p.pick_radio("physics", physics);
  await until("the physics is chosen", 10, () => json(base, "/session"), (s) => s.physics === physics);
  for (const controller of ["original", "modified"]) {
    await p.get("controller").selectOption(controller);
    await until(`${controller} is chosen`, 10, () => json(base, "/session"), (s) => s.controller === controller);
  }
  await until("the page follows", 10, () => p.get("controller").inputValue(), (v) => v === "modified");

  // From its start, and held there while the world is changed: on a slow machine the robot would
  // otherwise be where the obstacle is to stand.
  await p.get("reset").click();
  await p.get("play").click();
  await until("paused", 10, () => json(base, "/session"), (s) => s.pace.paused && s.controller === "modified");

  // Drag a goal: pressed at (3.2, 5.0), drawn to the upper right.
  await p.get("tool-goal").click();
  const goal = await p.pixels(3.2, 5.0);
  await p.drag(goal, { x: goal.x + 60, y: goal.y - 60 });
  const aimed = await until("the goal is set", 10, () => json(base, "/session"),
    (s) => s.goal && near(s.goal.x, 3.2, 0.05) && near(s.goal.y, 5.0, 0.05));
  assert.ok(near(aimed.goal.heading, Math.PI / 4, 0.05), `heading ${aimed.goal.heading}`);

  // Drop an obstacle in the way.
  await p.get("tool-cylinder").click();
  const way = await p.pixels(0.85, 1.35);
  await p.page.mouse.click(way.x, way.y);
  const world = await until("the obstacle stands", 10, () => json(base, "/session"), (s) => s.obstacles.length === 2);
  const dropped = world.obstacles.find((o) => o.id !== 1);
  assert.ok(near(dropped.x, 0.85, 0.05) && near(dropped.y, 1.35, 0.05), JSON.stringify(dropped));
  await p.page.keyboard.press("Escape");

  // Watch it reach, at 8 times real time.
  await p.get("speed").selectOption("8");
  await p.get("play").click();
  await until("the page shows it driving", 20, () => p.get("state").textContent(), (w) => w === "Driving");
  await p.shot(`drive-${physics}-under-way`);
  await until("the page shows it arrived", 150, () => p.get("state").textContent(), (w) => w === "Arrived");
  assert.ok(Number.parseFloat(await p.get("figure-to-goal").textContent()) < 0.2);
  assert.match(await p.get("explain").textContent(), /\w/);
  const session = await json(base, "/session");
  assert.equal(session.run.outcome, "reached");
  await p.shot(`drive-${physics}-arrived`);

  // Open that run and scrub it.
  const run = session.run.id;
  await p.get("nav-runs").click();
  await p.get(`run-${run}`).click();
  await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
  const slider = p.get("timeline");
  const end = await until("the run's frames are there", 30, async () => Number(await slider.getAttribute("max")), (t) => t > 5);
  // Without the last zero of 46.90, which a range would not say: one run in ten ended there.
  const half = String(Number((end / 2).toFixed(2)));
  await slider.fill(half);
  const middle = await p.get("run-time").textContent();
  const words = await p.get("run-explain").textContent();
  await slider.fill("0");
  assert.notEqual(await p.get("run-time").textContent(), middle);
  assert.match(await p.get("run-time").textContent(), /^00:00\.0/);
  assert.notEqual(await p.get("run-explain").textContent(), "");
  await slider.fill(half);
  assert.equal(await p.get("run-time").textContent(), middle);
  assert.equal(await p.get("run-explain").textContent(), words, "the same instant has the same sentence");
  await p.get("run-play").click();
  await until("it plays", 10, () => p.get("run-time").textContent(), (t) => t !== middle);
  await p.shot(`runs-${physics}`);
  const csv = await fetch(`${base}/api/v1/runs/${run}/csv?units=1`);
  assert.equal(csv.status, 200);
  assert.equal(await p.get("csv").getAttribute("href"), `/api/v1/runs/${run}/csv?units=1`);
}
