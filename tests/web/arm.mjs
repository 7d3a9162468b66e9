// tests/web/arm.mjs: a robot's arm on the page: its hand is sent by a gizmo in 3D, by a drag from above, by keys, by
// numbers and by touch; joints by sliders; a pose out of reach is said; nobody's goal is lost; stored and rewound runs
// show the arm.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { launch, open, phone } from "./page.mjs";
import { json, near, scratch, serve, until } from "./program.mjs";

let browser;
let server;
let store;

before(async () => {
  store = scratch();
  server = await serve({ database: store.database, scenario: "case1" });
  browser = await launch(["--enable-unsafe-swiftshader"]);
});
after(async () => {
  await browser?.close();
  await server?.stop();
  store?.remove();
});

/** A post between where the hand is and where it is sent. */
const kPost = { id: 1, type: "cylinder", x: 0.42, y: -0.42, radius: 0.04, height: 1.6 };
const kWorld = {
  name: "arm_page", title: "A post beside the arm", robot: "silvermate_arm", start: { x: 0, y: 0, heading: 0 }, obstacles: [kPost],
  controller: "strip", physics: "kinematic", time_limit: 600,
};
const kAhead = { qw: Math.SQRT1_2, qx: 0, qy: Math.SQRT1_2, qz: 0 }; // the hand points along x
const kLeast = 0.03; // [m] that the guard keeps

const session = () => json(server.base, "/session");
const send = (method, path, body) => json(server.base, path, { method, body: JSON.stringify(body) });
const control = (body) => send("POST", "/session/control", body);
const arrived = (what) => until(what, 90, session, (s) => s.arm === "arrived");

async function fresh(options = {}, scenario = kWorld) {
  await control({ action: "load", scenario });
  await control({ action: "pause" });
  const p = await open(browser, server.base, options);
  await control({ action: "play" });
  if ((await p.get("layers").getAttribute("aria-expanded")) === "true") await p.get("layers").click();
  return p;
}

/** The places [px of the page] where the handles of the gizmo can be held, once they rest. */
async function handles(p) {
  const canvas = p.page.locator(".three canvas");
  const rests = (e) => {
    if (e.dataset.gizmo !== e.test_gizmo) [e.test_gizmo, e.test_since] = [e.dataset.gizmo, performance.now()];
    return e.dataset.gizmo && performance.now() - e.test_since > 400 ? e.dataset.gizmo : null;
  };
  const told = await p.page.waitForFunction(rests, await canvas.elementHandle());
  const box = await canvas.boundingBox();
  return Object.fromEntries((await told.jsonValue()).split(", ").map((one) => {
    const [name, x, y] = one.split(" ");
    return [name, { x: box.x + Number(x), y: box.y + Number(y) }];
  }));
}

/** From the middle of the gizmo through a handle, `times` as far. */
const beyond = (at, name, times) => ({
  x: at.level.x + times * (at[name].x - at.level.x), y: at.level.y + times * (at[name].y - at.level.y),
});

test("the gizmo sends the hand round a post: one axis alone moves, the arm keeps clear, and undo brings it back", { timeout: 300_000 }, async () => {
  const p = await fresh();
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.0, ...kAhead });
  await arrived("the first pose");
  await control({ action: "pause" }); // without a GPU each picture takes its time
  await p.get("three").click();
  await p.page.waitForSelector(".three canvas");
  await p.get("tool-hand").click();
  const at = await handles(p);
  await p.drag(at.y, beyond(at, "y", -0.68)); // away from y, past the post
  const sent = await until("another goal", 10, session, (s) => s.hand_goal && s.hand_goal.y < -0.4);
  assert.ok(near(sent.hand_goal.x, 0.4, 1e-9) && near(sent.hand_goal.z, 1.0, 1e-9), `only y moves: ${JSON.stringify(sent.hand_goal)}`);
  await p.shot("arm-3d-goes");
  await control({ action: "play" });
  const run = sent.run.id;
  const end = await until("the hand past the post", 120, session, (s) => ["arrived", "given_up"].includes(s.arm));
  assert.equal(end.arm, "arrived", `${end.what}. ${end.why}`);
  await until("the page says so", 20, () => p.get("arm-state").innerText(), (words) => words.includes("Arrived"));
  await p.shot("arm-3d-arrived");
  assert.deepEqual(await p.accessibility(), []);

  // Every tick of the run kept every link clear.
  await until("its record", 20, () => json(server.base, `/runs/${run}`), (r) => r.ticks > 100);
  const csv = await (await fetch(`${server.base}/api/v1/runs/${run}/csv`)).text();
  const [head, ...rows] = csv.trim().split("\n").map((line) => line.split(","));
  const least = ["mast", "upper_arm", "forearm", "hand"].map((link) => {
    const column = head.indexOf(`clearance.${link}`);
    return Math.min(...rows.map((row) => Number(row[column])).filter(Number.isFinite));
  });
  assert.ok(Math.min(...least) >= kLeast - 1e-3, `clearances ${least}`);
  console.log(`least clearances of mast, upper arm, forearm, hand: ${least.map((v) => v.toFixed(3)).join(", ")} m`);

  // A ring turns, and the two steps of undo bring both back.
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.0, ...kAhead });
  await p.page.waitForFunction(() => document.querySelector('[data-testid="hand-y"]').value === "-0.2");
  await p.page.waitForTimeout(500);
  const ring = await handles(p);
  await p.drag(ring.bearing, { x: 2 * ring.level.x - ring.bearing.x, y: ring.bearing.y }); // along its near side
  const same = (a, b) => Math.abs(a.qw * b.qw + a.qx * b.qx + a.qy * b.qy + a.qz * b.qz);
  const turned = await until("turned", 10, session, (s) => s.hand_goal && same(s.hand_goal, kAhead) < 0.999); // 5 degrees
  assert.ok(near(turned.hand_goal.x, 0.4, 1e-9) && near(turned.hand_goal.y, -0.2, 1e-9), "it stays where it is");
  await p.page.locator(".three canvas").focus().catch(() => undefined);
  await p.page.keyboard.press("Control+z");
  await until("the goal before", 10, session, (s) => s.hand_goal && same(s.hand_goal, kAhead) > 1 - 1e-9);
  await p.close();
});

test("by keys and numbers: the goal of the hand, the arm angle, a joint and the fold", { timeout: 240_000 }, async () => {
  const p = await fresh();
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.0, ...kAhead, base_stays: true });
  await arrived("the first pose");
  await p.get("hand-z").fill("1.15");
  assert.equal((await session()).hand_goal.z, 1.0, "a typed number is not sent yet");
  await p.page.locator(".arm-tab h2", { hasText: "not sent yet" }).waitFor();
  await p.page.keyboard.press("Enter");
  await until("typed and sent", 10, session, (s) => near(s.hand_goal?.z ?? 0, 1.15, 1e-9));
  await arrived("the typed height");
  await p.get("hand-pitch").fill("-30");
  await p.get("hand-go").click();
  const tilted = await until("a pitch", 10, session, (s) => s.hand_goal && near(s.hand_goal.qy, Math.sin((120 / 2) * Math.PI / 180), 1e-4));
  assert.ok(near(tilted.hand_goal.qw, Math.cos(Math.PI / 3), 1e-4));
  await p.page.locator("body").click({ position: { x: 2, y: 2 } });
  await p.page.keyboard.press("h");
  assert.equal(await p.get("tool-hand").getAttribute("aria-pressed"), "true");
  await p.get("scene").focus();
  const hand = await p.pixels(0.4, -0.2);
  await p.page.mouse.click(hand.x, hand.y); // on the goal: it is chosen, and stays
  await p.page.keyboard.press("ArrowLeft");
  await until("0.1 m to the left", 10, session, (s) => near(s.hand_goal?.x ?? 0, 0.3, 1e-6));
  await p.page.keyboard.press("PageDown");
  await until("0.1 m lower", 10, session, (s) => near(s.hand_goal?.z ?? 0, 1.05, 1e-6));

  // The angle of the arm: the elbow turns, the hand stays.
  await arrived("by keys");
  await p.get("arm-angle-number").fill("60");
  await p.get("arm-angle-number").press("Enter");
  await until("an arm angle", 10, session, (s) => near(s.hand_goal?.arm_angle ?? 0, Math.PI / 3, 1e-6));

  // Joints: the slider by keys, the number, the limits; and the fold.
  await p.get("joint-4").focus();
  await p.page.keyboard.press("ArrowRight");
  const one = await until("a joint's goal", 10, session, (s) => s.joint_goal !== null);
  assert.equal(one.hand_goal, null);
  await p.get("joint-7-number").fill("500");
  await p.get("joint-7-number").press("Enter");
  await until("at its limit", 10, session, (s) => near(s.joint_goal?.[6] ?? 0, (175 * Math.PI) / 180, 1e-6));
  await p.get("arm-fold").click();
  const { arm } = (await session()).robot;
  await until("folded", 60, session, (s) => s.arm === "arrived" && s.joints.every((q, k) => near(q, arm.rest[k], 0.01)));
  await p.page.waitForTimeout(400);
  await p.shot("arm-desktop");
  assert.deepEqual(await p.accessibility(), []);

  // Plots have the joints.
  await p.get("tab-signals").click();
  await p.page.waitForTimeout(800);
  assert.match(await p.page.locator(".signals").innerText(), /Joints/);
  await p.close();
});

test("from above the goal is dragged at its height; a pose out of reach is said before and after it is sent", { timeout: 120_000 }, async () => {
  const p = await fresh();
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.0, ...kAhead });
  await arrived("the first pose");
  const from = await p.pixels(0.4, -0.2);
  await p.page.mouse.click(from.x, from.y); // the resting tool selects it
  await p.drag(from, await p.pixels(0.45, 0.1));
  const dragged = await until("dragged", 10, session, (s) => s.hand_goal && near(s.hand_goal.y, 0.1, 0.02));
  assert.ok(near(dragged.hand_goal.z, 1.0, 1e-9) && near(dragged.hand_goal.x, 0.45, 0.02));
  await p.get("hand-z").fill("2.5");
  assert.match(await p.get("hand-reach").innerText(), /Out of reach from every place of the base\. The wrist would be 1\.55 m above the shoulder/);
  await p.get("hand-go").click();
  await until("given up", 30, session, (s) => s.arm === "given_up");
  await p.page.waitForFunction(() => /farthest it can be/.test(document.querySelector('[data-testid="arm-why"]').textContent));
  assert.match(await p.get("arm-state").innerText(), /No way to the goal[^]*The wrist would be/);
  await p.page.waitForTimeout(300);
  await p.shot("arm-out-of-reach");
  assert.deepEqual(await p.accessibility(), []);
  await p.get("hand-clear").click();
  await until("cleared", 10, session, (s) => s.hand_goal === null);
  await p.close();
});

test("two people: neither an undo nor a goal of the base loses the other's goal of the hand", { timeout: 90_000 }, async () => {
  const p = await fresh();
  await p.get("hand-z").fill("1.1");
  await p.get("hand-go").click();
  await until("mine", 10, session, (s) => near(s.hand_goal?.z ?? 0, 1.1, 1e-9));
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.2, ...kAhead });
  await p.page.waitForTimeout(500);
  await p.get("undo").click();
  await p.page.locator(".toast", { hasText: "another goal since" }).waitFor();
  assert.equal((await session()).hand_goal.z, 1.2);
  // A goal of the base takes its place, and undo brings it back.
  await p.get("tool-goal").click();
  const at = await p.pixels(-0.6, 0.6);
  await p.page.mouse.click(at.x, at.y);
  await until("a goal of the base", 10, session, (s) => s.goal !== null && s.hand_goal === null);
  await p.page.waitForTimeout(400);
  await p.get("undo").click();
  await until("the hand's goal again", 10, session, (s) => near(s.hand_goal?.z ?? 0, 1.2, 1e-9));
  await p.close();
});

test("carried past a post: the legend, a link's card, an earlier instant, the stored run", { timeout: 240_000 }, async () => {
  const p = await fresh({}, "arm_post");
  await until("carrying", 60, session, (s) => s.arm === "goes" && s.pose.x > 0.8);
  await p.get("layers").click();
  await p.get("layer-arm.plan").waitFor();
  assert.match(await p.get("layer-panel").innerText(), /Arm, its links[^]*Goal of the hand/);
  await p.shot("arm-post-layers");
  await p.get("layers").click();
  await until("past the post", 90, session, (s) => s.pose.x > 2.1);
  await control({ action: "pause" });
  await p.page.waitForTimeout(700);
  const { joints, run } = await session();
  assert.equal(joints.length, 7);
  await p.get("tool-pan").click();
  const [x, y, bearing] = await Promise.all(["hand-x", "hand-y", "hand-bearing"].map(async (id) => Number(await p.get(id).inputValue()))); // where the hand is
  const turn = (bearing * Math.PI) / 180;
  const tip = await p.pixels(x - 0.07 * Math.cos(turn), y - 0.07 * Math.sin(turn)); // half way to the wrist
  await p.page.mouse.move(tip.x + 3, tip.y);
  await p.page.mouse.move(tip.x, tip.y);
  await p.get("inspect").waitFor();
  assert.match(await p.get("inspect").innerText(), /of the arm, as measured[^]*Clear of things/);
  await p.shot("arm-post-inspect");

  await p.get("step-back").click();
  await p.get("live").waitFor();
  assert.match(await p.page.locator(".arm-tab").innerText(), /earlier instant/);
  await p.page.keyboard.press("3");
  await p.page.waitForSelector(".three canvas");
  await p.page.waitForTimeout(1500);
  await p.shot("arm-post-3d-past");
  await p.page.keyboard.press("3");
  await p.get("live").click();

  await p.page.evaluate((id) => (location.hash = `#/runs/${id}`), run.id);
  await p.page.waitForSelector('[data-testid="run-view"]');
  await p.page.waitForTimeout(2500);
  await p.get("run-view").locator(".layers-tool").click();
  await p.page.waitForFunction(() => /Arm, its links/.test(document.querySelector('[data-testid="layer-panel"]')?.textContent ?? ""));
  await p.shot("arm-post-stored");
  await p.close();
});

test("along a path: the page says that the hand follows it, and draws it", { timeout: 120_000 }, async () => {
  const world = await json(server.base, "/scenarios/arm_follow");
  const p = await fresh({}, { ...world, physics: "kinematic" });
  await control({ action: "speed", speed: 4 });
  await control({ action: "play" });
  await until("on the path", 60, async () => (await session()).why === "The robot follows its path with the hand.");
  await p.page.getByText("The robot follows its path with the hand.").first().waitFor();
  await control({ action: "pause" });
  await p.shot("arm_follow");
  await control({ action: "play" });
  await arrived("the end of the path");
  const { pose, why } = await session();
  assert.equal(why, "The hand is at the end of its path.");
  assert.ok(pose.x > 2, "the base has come along");
  await p.close();
});

test("by touch: the sheet on a phone, the gizmo under a finger, every size", { timeout: 240_000 }, async () => {
  const p = await fresh({ size: phone, touch: true });
  await send("PUT", "/session/hand_goal", { x: 0.4, y: -0.2, z: 1.0, ...kAhead, base_stays: true });
  await arrived("the first pose");
  await control({ action: "pause" });
  await p.get("steps-close").tap().catch(() => undefined);
  await p.get("three").tap();
  await p.page.waitForSelector(".three canvas");
  await p.get("tool-hand").tap();
  const at = await handles(p);
  const cdp = await p.context.newCDPSession(p.page);
  const touch = (type, point) => cdp.send("Input.dispatchTouchEvent", { type, touchPoints: point ? [point] : [] });
  const begin = { x: at.z.x + 10, y: at.z.y - 6 }; // a finger is not exact
  const end = beyond(at, "z", 1.5);
  await touch("touchStart", begin);
  for (const k of [0.3, 0.6, 1]) await touch("touchMove", { x: begin.x + k * (end.x - at.z.x), y: begin.y + k * (end.y - at.z.y) });
  await p.shot("arm-phone-gizmo");
  await touch("touchEnd");
  const lifted = await until("lifted", 10, session, (s) => s.hand_goal?.z > 1.02);
  assert.ok(near(lifted.hand_goal.x, 0.4, 1e-9), JSON.stringify(lifted.hand_goal));
  await p.get("tune").tap();
  await p.get("arm-state").last().waitFor();
  await p.page.waitForTimeout(500);
  await p.shot("arm-phone-sheet");
  assert.deepEqual(await p.accessibility(), []);
  await p.get("joint-2").last().scrollIntoViewIfNeeded();
  await p.shot("arm-phone-joints");
  for (const [name, size] of [["sideways", { width: 844, height: 390 }], ["zoomed", { width: 720, height: 450 }], ["small", { width: 320, height: 640 }]]) {
    await p.page.setViewportSize(size);
    await p.page.waitForTimeout(900);
    await p.shot(`arm-${name}`);
    assert.deepEqual(await p.accessibility(), [], name);
  }
  await p.close();
});
