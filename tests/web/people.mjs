// tests/web/people.mjs: several people at one robot in a real browser: roles, names, who stopped, a
// view-only link, and the System view of each role.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { devices } from "./devices.mjs";
import { launch, open, phone } from "./page.mjs";
import { json, scratch, serve, until } from "./program.mjs";

const kAdmin = "the-token-of-the-admins-01";
const kOperator = "the-token-of-operators-012";
const kViewer = "the-token-of-the-viewers-0";
const kTokens = ["--token", kAdmin, "--operator-token", kOperator, "--viewer-token", kViewer];

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser?.close());

const reopened = (p) => p.page.waitForSelector('[data-testid="link"].open');
const text_of = (p, id) => until(`text of ${id}`, 10, () => p.get(id).textContent().catch(() => ""));

/** Types a name on the System view and goes back to Drive. */
async function call(p, name) {
  await p.get("nav-system").click();
  await p.get("name").fill(name);
  await p.get("name-set").click();
  await until(`the name ${name}`, 10, () => p.page.evaluate(async () => (await (await fetch("/api/v1/system")).json()).viewers));
  await reopened(p);
  await p.get("nav-drive").click();
}

test("a viewer watches and stops, an operator releases, and each reads who did it", { timeout: 180_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1", more: kTokens });
  try {
    const ann = await open(browser, server.base, { token: kOperator });
    await call(ann, "Ann");

    // Ann copies a view-only link. Bob opens it on his phone.
    await ann.get("nav-system").click();
    assert.match(await text_of(ann, "role"), /^operator/);
    await ann.get("view-link").click();
    const link = await until("the link", 10, () => ann.get("view-link-text").inputValue().catch(() => ""));
    assert.ok(link.startsWith(`${server.base}/`), link);
    assert.ok(!link.includes(kOperator) && link.includes(kViewer), link);
    await ann.shot("people-operator-system");
    assert.equal(await ann.get("clients").count(), 0, "addresses are for admins");
    assert.equal(await ann.get("log").count(), 1);
    assert.deepEqual(await ann.accessibility(), []);
    await ann.get("nav-drive").click();

    const bob = await open(browser, server.base, { hash: new URL(link).hash, size: phone });
    assert.ok(!bob.page.url().includes(kViewer), "the token is not left in the address");
    assert.match(await text_of(bob, "view-only"), /You are watching/);
    for (const id of ["scenario-menu", "play", "reset"]) assert.ok(await bob.get(id).isDisabled(), id);
    for (const id of ["tool-goal", "tool-cylinder", "undo"]) assert.equal(await bob.get(id).count(), 0, id);
    await bob.shot("people-viewer");
    assert.deepEqual(await bob.accessibility(), []);
    await until("two on Ann's page", 10, () => ann.get("watching").textContent().catch(() => ""),
      (words) => /2 connected/.test(words));

    // Bob cannot drive, even past the page.
    const status = await bob.page.evaluate(async () => (await fetch("/api/v1/session/goal", { method: "PUT",
      headers: { "Content-Type": "application/json" }, body: '{"x":1,"y":1}' })).status);
    assert.equal(status, 403);
    bob.forgive(/401|403/); // before the link signed in, and the request above
    await bob.page.keyboard.press("p");
    await until("the refusal in words", 10, () => bob.get("toasts").textContent(), (t) => /needs the role operator/.test(t));

    // Bob stops the robot. Ann reads who it was, and releases.
    await call(bob, "Bob");
    await bob.get("stop").click();
    await until("Ann reads it", 10, () => ann.get("stopped-by").textContent().catch(() => ""), (t) => t === "Bob pressed Stop.");
    await ann.shot("people-stopped-by");
    await until("Bob reads it", 10, () => bob.get("stopped-by").textContent().catch(() => ""), (t) => t === "You pressed Stop.");
    assert.equal(await bob.get("release").count(), 0);
    const stop = await bob.get("stop").boundingBox();
    assert.ok(stop.x >= 0 && stop.x + stop.width <= phone.width, "Stop stays in reach");
    await bob.shot("people-viewer-stopped");
    await ann.get("release").click();
    await until("released", 10, () => ann.get("release").count(), (n) => n === 0);

    // Ann's goal and her pause have her name.
    await ann.get("tool-goal").click();
    const at = await ann.pixels(1, 1);
    await ann.page.mouse.click(at.x, at.y);
    await ann.get("play").click();
    const session = () => ann.page.evaluate(async () => (await fetch("/api/v1/session")).json());
    await until("goal and pause by Ann", 10, session, (s) => s.by.goal === "Ann" && s.by.pause === "Ann");
    await bob.get("nav-system").click();
    await until("Bob reads them", 10, () => bob.page.locator(".system").textContent(),
      (t) => /Goal by Ann\. Paused by Ann\./.test(t));
    await bob.shot("people-viewer-system");
    await bob.close();
    await ann.close();

    const eve = await open(browser, server.base, { token: kAdmin, hash: "#/system" });
    await eve.get("clients").waitFor();
    assert.match(await eve.get("clients").textContent(), /admin127\.0\.0\.1main/);
    await until("a rate", 15, () => eve.get("rate").first().textContent(), (t) => Number(t) > 1);
    assert.match(await eve.get("log").textContent(), /has logged in as viewer/);
    await eve.shot("people-admin-system");
    assert.deepEqual(await eve.accessibility(), []);

    // The same browser becomes an operator, by another token.
    await eve.get("sign-in").click();
    await eve.get("token").fill(kOperator);
    await eve.get("login-go").click();
    await until("the new role", 10, () => text_of(eve, "role"), (t) => /^operator/.test(t));
    await eve.close();
  } finally {
    await server.stop();
    place.remove();
  }
});

test("without a token everybody is an admin, and the page says why there is no link", { timeout: 90_000 }, async () => {
  const place = scratch();
  const server = await serve({ database: place.database, scenario: "case1" });
  try {
    const p = await open(browser, server.base, { hash: "#/system" });
    await until("the role", 10, () => text_of(p, "role"), (t) => /^admin/.test(t));
    assert.ok(await p.get("view-link").isDisabled());
    assert.match(await p.get("view-link").getAttribute("title"), /asks for no token/);
    await p.get("clients").waitFor();
    await p.close();
  } finally {
    await server.stop();
    place.remove();
  }
});

test("emulated devices are called so, and a disarmed robot says why and when", { timeout: 120_000 }, async () => {
  const place = scratch();
  const robot = await devices(place.folder, { named: true });
  const server = await serve({ database: place.database, scenario: null, more: ["--robot", robot.file] });
  try {
    const session = () => json(server.base, "/session");
    const p = await open(browser, server.base);
    assert.equal(await text_of(p, "source"), "Emulated devices");
    assert.match(await text_of(p, "hardware-bar"), /EMULATED DEVICES/);
    assert.equal(await p.get("disarmed").count(), 0, "nobody has armed it yet");
    await call(p, "Ann");
    await until("devices that are well", 30, session, (s) => s.hardware.devices.every((d) => d.well));
    /** A loop that came late on a busy machine refuses for a moment. */
    const arm = async () => {
      const ask = () => json(server.base, "/session/control", { method: "POST", body: '{"action":"arm"}' })
        .catch(() => null);
      await until("armed", 20, ask);
      await until("armed on the page", 10, () => p.get("arm").getAttribute("aria-pressed"), (v) => v === "true");
    };
    await arm();
    await p.get("arm").click();
    await until("disarmed by Ann", 10, () => p.get("hardware-bar").textContent(),
      (t) => /Ann has disarmed it\..*Disarmed at/.test(t));
    await p.shot("people-disarmed-by");

    // A fault: its sentence stays when it is over, and for a page that opens later.
    // On a busy machine a late loop or a slow page may disarm it first: then once more.
    for (let why = "", i = 0; !/stop button/i.test(why); ++i) {
      assert.ok(i < 5, `disarmed, but for another reason: ${why}`);
      await arm();
      robot.tell("stop on");
      const { hardware } = await until("a fault", 10, session, (s) => !s.hardware.armed);
      why = hardware.disarmed.why;
      if (!/stop button/i.test(why)) robot.tell("stop off");
    }
    robot.tell("stop off");
    await p.close();
    const q = await open(browser, server.base);
    await q.get("disarmed").waitFor();
    const bar = await text_of(q, "hardware-bar");
    assert.match(bar, /stop button/i);
    assert.match(bar, /Disarmed at \d/);
    await q.shot("people-disarmed-fault");
    await q.close();
  } finally {
    await server.stop();
    robot.end();
    place.remove();
  }
});
