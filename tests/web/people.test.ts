// tests/web/people.test.ts: roles, and how the page speaks of others.
import assert from "node:assert/strict";
import { test } from "node:test";
import { SessionState } from "../../web/src/contract";
import { clean_name } from "../../web/src/link/name";
import { Me, may, person_words, refusal } from "../../web/src/people";
import { disarmed_words } from "../../web/src/views/hardware_words";
import { deeds } from "../../web/src/views/watching";

const me = (role: Me["role"], label = "Ann"): Me =>
  ({ role, name: label, address: "10.0.0.7", label, token_required: true, signed_in: true });

test("a name has no control character, no half letter, and at most 32 characters", () => {
  assert.equal(clean_name(" Ann\u0000 B\n\t"), "Ann B");
  assert.equal(clean_name("x".repeat(300)).length, 32);
  const robots = clean_name(`a${"🤖".repeat(40)}`);
  assert.equal(robots, `a${"🤖".repeat(15)}`);
  assert.doesNotThrow(() => encodeURIComponent(robots));
});

test("each role may do what the one before it may", () => {
  assert.equal(may(me("viewer"), "viewer"), true);
  assert.equal(may(me("viewer"), "operator"), false);
  assert.equal(may(me("operator"), "operator"), true);
  assert.equal(may(me("operator"), "admin"), false);
  assert.equal(may(me("admin"), "operator"), true);
  assert.match(refusal(me("viewer"), "operator"), /needs the role operator; yours is viewer/);
});

test("deeds name others, and oneself as you", () => {
  const by = { goal: "Ann", stop: "10.0.0.9", pause: null, arming: "Bob" };
  const session = { by, hardware: null } as unknown as SessionState;
  assert.deepEqual(deeds(session, me("viewer")), ["Stopped by 10.0.0.9.", "Goal by you."]);
  const armed = { by, hardware: { armed: true } } as unknown as SessionState;
  assert.ok(deeds(armed, me("viewer")).includes("Armed by Bob."));
  assert.deepEqual(deeds({} as SessionState, me("viewer")), [], "an older server");
  assert.equal(person_words(me("admin", "10.0.0.9"), "10.0.0.9"), "you");
});

test("a disarming has its time, and its reason once", () => {
  const disarmed = { why: "Ann has disarmed it.", at: "2026-11-26T14:03:12Z" };
  assert.match(disarmed_words(disarmed, "Ann has disarmed it."), /^Disarmed at [^:]+:[^A-Z]+( [AP]M)?\.$/);
  assert.match(disarmed_words(disarmed, "The laser is silent."), /: Ann has disarmed it\.$/);
});
