// tests/web/inspect.mjs: things in the scene tell the numbers of the wire: by mouse, touch and keyboard, live and
// stored, from above and in 3D. Run like e2e.mjs.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { desktop, launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";
import { decoder, frame_of, frames_of } from "./wire.mjs";

let browser;
let wire;
before(async () => {
  browser = await launch();
  wire = await decoder();
});
after(() => browser?.close());

const control = (base, body) => json(base, "/session/control", { method: "POST", body: JSON.stringify(body) });
const number = (text) => Number(text.replace("−", "-").replace(/[^-.\d].*$/, ""));

async function with_page(options, act) {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1" });
  const p = await open(browser, server.base, options);
  try {
    await act(p, server.base);
    await p.close();
  } finally {
    await server.stop();
    place.remove();
  }
}

/** Another run, at its first tick: the session tells the old run's newest one until then. */
async function load(p, base, controller) {
  await control(base, { action: "load", scenario: "case1", controller });
  await until("the page follows", 20, () => p.get("controller").inputValue(), (v) => v === controller);
  await control(base, { action: "step", ticks: 1 });
  await until("its first tick", 40, () => json(base, "/session"), (s) => s.tick <= 1);
}

/** Steps the paused run and waits until the page draws the tick and the record holds it. */
async function step(p, base, ticks) {
  const { tick: before } = await json(base, "/session");
  await control(base, { action: "step", ticks });
  const session = await until(`${ticks} ticks after ${before}`, 40, () => json(base, "/session"), (s) => s.tick >= before + ticks);
  const known = await until("the record has it", 40, () => frame_of(wire, base, session.run.id, session.tick));
  await p.draws(session.tick);
  await p.page.waitForTimeout(250); // the figures' next pulse
  return { session, ...known };
}

const card = (p) => p.page.locator('[data-testid="inspect"]');
const row = (p, label) => card(p).locator(`[data-row="${label}"] dd`).innerText();

/** Moves the mouse to a place of the world; the thing whose card opens there, or null. */
async function hover(p, at) {
  const px = await p.pixels(at.x, at.y);
  await p.page.mouse.move(px.x + 3, px.y); // a mouse that rests picks nothing anew
  await p.page.mouse.move(px.x, px.y);
  await p.page.waitForTimeout(250);
  if ((await card(p).count()) === 0) await p.page.waitForTimeout(600); // its code comes with the first card
  const thing = (await card(p).count()) > 0 ? await card(p).getAttribute("data-thing") : null;
  return thing && JSON.parse(thing);
}

const points_of = (frame, name) => {
  const { values } = frame.layers.find((l) => l.name === name) ?? { values: [] };
  return Array.from({ length: values.length / 2 }, (_, i) => ({ x: values[2 * i], y: values[2 * i + 1] }));
};
const end_of = (frame, sweep, i) => {
  const turn = frame.pose.heading + sweep.mount.heading + sweep.angle_min + i * sweep.angle_increment;
  const r = sweep.ranges[i] / 1000;
  return { x: frame.pose.x + r * Math.cos(turn), y: frame.pose.y + r * Math.sin(turn) };
};
const apart = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);

/** The result of "0.10 + 0.60 (1.35 − 1.19) m". */
function worked_out(numbers) {
  const sum = numbers.replace(/ m$/, "").replaceAll("−", "-").replaceAll("×", "*").replaceAll("²", "**2").replace(/(\d) \(/g, "$1 * (");
  return Function(`"use strict"; return ${sum};`)();
}

/** Holds the mouse over a place of the world until the card of a thing that fits opens. */
const find = (p, what, at, fits) => until(what, 10, () => hover(p, at), (thing) => thing && fits(thing));

test("a beam's card has the wire's ranges, and its equation gives the wire's force, for several controllers and ticks", { timeout: 240_000 }, () =>
  with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    let compared = 0;
    for (const controller of ["modified", "original", "modified_published"]) {
      await load(p, base, controller);
      for (const ticks of [150, 40, 25]) {
        const { frame, filtered } = await step(p, base, ticks);
        for (const point of points_of(frame, "scan.nearest")) {
          const beams = [...filtered.ranges.keys()].filter((i) => filtered.ranges[i] < 65520);
          const beam = beams.reduce((a, b) => (apart(end_of(frame, filtered, b), point) < apart(end_of(frame, filtered, a), point) ? b : a));
          const thing = await find(p, `${controller}, tick ${frame.tick}: a beam`, point, ({ kind }) => kind === "beam");
          // Neighbours may be nearer to the pointer's whole pixel than the beam itself.
          const title = await card(p).locator("h2").innerText();
          const shown = filtered.ranges[thing.beam] / 1000;
          assert.ok(near(number(await row(p, "Range, filtered")), shown, 0.0051), `${title}: ${shown}`);
          if (thing.beam !== beam || (await card(p).locator('[data-row="External force"]').count()) === 0) continue;
          const side = /nearest (left|right)/.exec(title)[1];
          const force = frame.measures.find((m) => m.name === `strip.${side}`).value;
          assert.ok(near(number(await row(p, "External force")), force, force < 0.1 ? 0.00051 : 0.0051), `${controller}: ${title}, ${force}`);
          const [law, numbers] = (await p.get("inspect-law").innerText()).split("\n");
          const source = { modified: /E\.3/, original: /Eq\. 7/, modified_published: /E\.2/ }[controller];
          assert.match(law, source);
          if (/[(/]/.test(numbers ?? "")) {
            assert.ok(near(worked_out(numbers), force, 0.008 + 0.02 * force), `${controller}, tick ${frame.tick}: ${numbers} is ${force}`);
            ++compared;
          }
        }
      }
    }
    assert.ok(compared >= 5, `${compared} equations compared`);
  }));

test("robot, goal, strip and obstacle tell the wire's numbers, the figures too; what is not drawn tells none", { timeout: 200_000 }, () =>
  with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    await load(p, base, "modified");
    for (const ticks of [60, 90]) {
      const { session, frame } = await step(p, base, ticks);
      const { pose } = session;
      const back = { x: pose.x - 0.2 * Math.cos(pose.heading), y: pose.y - 0.2 * Math.sin(pose.heading) };
      await find(p, "the robot", back, ({ kind }) => kind === "robot");
      assert.equal(await row(p, "Position x, y"), `${pose.x.toFixed(2)}, ${pose.y.toFixed(2)} m`.replaceAll("-", "−"));
      assert.ok(near(number(await row(p, "True clearance")), frame.truth.clearance, 0.0051));
      assert.ok(near(number(await p.get("figure-clearance").innerText()), frame.truth.clearance, 0.0051), "the true one in simulation");
      assert.ok(near(number(await p.get("figure-speed").innerText()), frame.twist.v, 0.0051));
      const d = apart(pose, session.goal);
      assert.ok(near(number(await p.get("figure-to-goal").innerText()), d, 0.0051));
      await find(p, "the goal", session.goal, ({ kind, index }) => kind === "goal" && index === 0);
      assert.ok(near(number(await row(p, "From the robot, D")), d, 0.0051));
      const [end] = points_of(frame, "strip.nodes");
      await find(p, "the strip's point", end, ({ kind }) => kind === "mark");
      const o = session.obstacles.find((each) => each.type === "cylinder");
      await find(p, "the obstacle", o, ({ kind, id }) => kind === "obstacle" && id === o.id);
      assert.ok(near(number(await row(p, "Radius")), o.radius, 0.0051));
    }
    await p.shot("inspect-obstacle");
    const { session } = await step(p, base, 1);
    const o = session.obstacles.find((each) => each.type === "cylinder");
    // The card stands beside its thing.
    await find(p, "the obstacle", o, ({ kind, id }) => kind === "obstacle" && id === o.id);
    const box = await card(p).boundingBox();
    const px = await p.pixels(o.x, o.y);
    assert.ok(px.x < box.x || px.x > box.x + box.width || px.y < box.y || px.y > box.y + box.height);
    // Another tool at work needs the place itself.
    await p.page.keyboard.press("g");
    await card(p).waitFor({ state: "detached" });
    await p.page.keyboard.press("v");
    // A controller without a strip has none, in the legend or on the ground.
    await load(p, base, "go_to_goal");
    await step(p, base, 30);
    await p.page.locator('[data-testid="layer-strip"]').waitFor({ state: "detached" });
    assert.deepEqual(await p.page.locator(".layer-groups h3").allInnerTexts(), ["Senses", "Ways", "World"]);
    assert.deepEqual(await p.accessibility(), []);
  }));

test("the crosshair and a finger find the same; a screen reader hears it once", { timeout: 120_000 }, async () => {
  await with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    await step(p, base, 20);
    const { pose, goal } = await json(base, "/session");
    await p.page.mouse.move(5, 5);
    await p.get("scene").focus();
    for (let i = 0; i < 2; ++i) await p.page.keyboard.press("ArrowRight");
    const [x, y] = (await p.get("scene").getAttribute("data-view")).split(" ").map(Number);
    // From the middle of the view to the goal.
    for (const [way, more, less] of [[goal.x - x - 0.2, "ArrowRight", "ArrowLeft"], [goal.y - y, "ArrowUp", "ArrowDown"]]) {
      for (let i = 0; i < Math.round(Math.abs(way) * 10); ++i) await p.page.keyboard.press(way > 0 ? more : less);
    }
    await until("the goal's card", 5, () => card(p).locator("h2").innerText(), (t) => t.startsWith("Goal"));
    const said = await until("it is spoken", 5, () => p.get("inspect-said").innerText(), (t) => t.startsWith("Goal"));
    assert.match(said, new RegExp(`From the robot, D ${apart(pose, goal).toFixed(2)} m`));
    await p.page.keyboard.press("Escape");
    await card(p).waitFor({ state: "detached" });
  });
  await with_page({ size: phone, touch: true }, async (p, base) => {
    await control(base, { action: "pause" });
    const { session } = await step(p, base, 20);
    const px = await p.pixels(session.pose.x, session.pose.y);
    await p.page.touchscreen.tap(px.x, px.y);
    await until("the robot's card", 5, () => card(p).locator("h2").innerText(), (t) => t.startsWith("Robot"));
    const stop = await p.get("stop").boundingBox();
    assert.ok((await card(p).boundingBox()).y > stop.y + stop.height, "Stop stays free");
    await p.shot("inspect-phone");
    // The card stays with the robot, and goes with a tap on nothing.
    const { session: later } = await step(p, base, 40);
    await until("its numbers go on", 5, () => row(p, "Position x, y"), (t) => number(t) === Number(later.pose.x.toFixed(2)));
    const scene = await p.get("scene").boundingBox();
    await p.page.touchscreen.tap(scene.x + scene.width - 20, scene.y + scene.height - 140);
    await card(p).waitFor({ state: "detached" });
  });
});

test("a stored run tells the same numbers, and its figures are those of the record at fifty ticks", { timeout: 200_000 }, () =>
  with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    await load(p, base, "modified");
    const { session, frame } = await step(p, base, 300);
    const run = session.run.id;
    await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), run);
    await p.page.waitForSelector('[data-testid="run-view"][aria-busy="false"]', { timeout: 30_000 });
    const { items } = await json(base, `/runs/${run}/ticks?from=0&limit=1000`);
    const frames = await frames_of(wire, base, run, 0, items.length);
    for (let i = 0; i < 50; ++i) {
      const at = items[Math.floor(Math.random() * items.length)];
      await p.get("timeline").evaluate((slider, t) => {
        slider.value = t;
        slider.dispatchEvent(new Event("input", { bubbles: true }));
      }, Math.ceil(at.t * 100 - 1e-6) / 100);
      const { twist } = frames.find((f) => f.tick === at.tick);
      const wanted = { clearance: at.clearance, v: at.v, omega: at.omega, "odometry.v": twist.v, "odometry.omega": twist.omega };
      for (const [name, value] of Object.entries(wanted)) {
        const shown = () => p.get(`value-${name}`).innerText();
        // Before the first reading the wire has 0, which no plot shows.
        const same = (text) => (text.startsWith("–") ? name === "clearance" && value === 0 : near(number(text), value, 0.0051));
        await until(`tick ${at.tick}: ${name} ${value}`, 3, shown, same);
      }
    }
    await p.get("timeline").focus();
    await p.page.keyboard.press("End");
    await p.get("run-step").click();
    const { x: x_W, y: y_W, heading } = session.pose;
    const back = { x: x_W - 0.2 * Math.cos(heading), y: y_W - 0.2 * Math.sin(heading) };
    await find(p, "the robot", back, ({ kind }) => kind === "robot");
    assert.ok(near(number(await row(p, "True clearance")), frame.truth.clearance, 0.0051));
    await p.shot("inspect-stored");
    // By the keyboard: the crosshair goes from the middle of the view to the robot, off the strip's nodes.
    await p.page.mouse.move(5, 5);
    await p.get("scene").focus();
    const [x, y] = (await p.get("scene").getAttribute("data-view")).split(" ").map(Number);
    for (const [way, more, less] of [[back.x - x, "ArrowRight", "ArrowLeft"], [back.y - y, "ArrowUp", "ArrowDown"]]) {
      for (let i = 0; i < Math.round(Math.abs(way) * 10); ++i) await p.page.keyboard.press(way > 0 ? more : less);
    }
    await until("the robot's card", 5, () => card(p).locator("h2").innerText(), (t) => t.startsWith("Robot"));
    await p.page.keyboard.press("Escape");
    await card(p).waitFor({ state: "detached" });
  }));

test("in 3D the robot and an obstacle tell their numbers", { timeout: 120_000 }, () =>
  with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    await step(p, base, 20);
    await p.get("three").click();
    await p.page.waitForSelector('[data-testid="scene-3d"] canvas');
    await p.page.waitForTimeout(1500);
    const scene = await p.get("scene-3d").boundingBox();
    const kinds = new Set();
    for (let y = 0.2; y < 0.9 && !(kinds.has("robot") && kinds.has("obstacle")); y += 0.03) {
      for (let x = 0.1; x < 0.75; x += 0.02) {
        await p.page.mouse.move(scene.x + x * scene.width, scene.y + y * scene.height);
        await p.page.waitForTimeout(30);
        const thing = await p.page.evaluate(() => document.querySelector('[data-testid="inspect"]')?.dataset.thing ?? null);
        if (thing) kinds.add(JSON.parse(thing).kind);
      }
    }
    assert.ok(kinds.has("robot") && kinds.has("obstacle"), [...kinds].join());
    await p.shot("inspect-3d");
  }));

test("361 beams and a strip of many nodes are drawn well within a frame of 60 a second", { timeout: 60_000 }, () =>
  with_page({ size: desktop }, async (p, base) => {
    await control(base, { action: "pause" });
    await control(base, { action: "load", scenario: "demo", controller: "strip" });
    await until("the page follows", 20, () => p.get("controller").inputValue(), (v) => v === "strip");
    await control(base, { action: "step", ticks: 1 });
    await until("its first tick", 40, () => json(base, "/session"), (s) => s.tick <= 1);
    const { frame, filtered } = await step(p, base, 40);
    assert.equal(filtered.ranges.length, 361);
    const nodes = points_of(frame, "strip").length;
    assert.ok(nodes >= 40, `${nodes} nodes`);
    await p.get("scene").evaluate(async (scene) => {
      for (let i = 0; i < 130; ++i) {
        scene.dispatchEvent(new PointerEvent("pointermove", { pointerType: "mouse", clientX: 300 + i, clientY: 400, bubbles: true }));
        await new Promise((done) => requestAnimationFrame(done));
      }
    });
    const words = await until("it is told", 5, () => p.get("draw-time").innerText(), (t) => /[1-9]/.test(t));
    const mean = Number(/([\d.]+) ms/.exec(words)[1]);
    assert.ok(mean > 0 && mean < 1000 / 60, `${nodes} nodes: ${words}`);
  }));

test("every figure tells its meaning to a mouse, a finger and the keyboard", { timeout: 60_000 }, async () => {
  await with_page({ size: desktop }, async (p) => {
    const name = p.page.locator(".stat .named").first();
    await name.hover();
    assert.match(await p.get("tip").innerText(), /Unit: m\.$/);
    await p.page.mouse.move(5, 400);
    await p.get("tip").waitFor({ state: "detached" });
    await name.focus();
    assert.match(await p.get("tip").innerText(), /hull/);
    await p.page.keyboard.press("Escape");
    await p.get("tip").waitFor({ state: "detached" });
    assert.match(await name.getAttribute("aria-description"), /hull/);
    await until("the time of drawing", 5, () => p.get("draw-time").innerText(), (t) => /^A frame is drawn in [\d.]+ ms/.test(t));
    await p.page.evaluate(() => (location.hash = "#/system"));
    assert.match(await p.page.locator("dt", { hasText: "Drawing a frame" }).locator("xpath=../dd").innerText(), /^[\d.]+ ms/);
    assert.ok(await p.page.locator("dt .named").count() > 10);
    assert.deepEqual(await p.accessibility(), []);
  });
  await with_page({ size: phone, touch: true }, async (p) => {
    await p.get("steps-close").tap(); // the steps stand where the figures will
    await p.page.locator(".stat .named").nth(1).tap();
    assert.match(await p.get("tip").innerText(), /Unit: m\/s\.$/);
    const tip = await p.get("tip").boundingBox();
    assert.ok(tip.x >= 0 && tip.x + tip.width <= 390);
  });
});
