// tests/web/foxglove.mjs: an independent client (@foxglove/ws-protocol) against the real program:
// every channel, every JSON message against its advertised schema, a goal, a gain, a reset.
import assert from "node:assert/strict";
import { test } from "node:test";
import { json, require, scratch, serve, until } from "./program.mjs";

const { FoxgloveClient } = require("@foxglove/ws-protocol");
const WebSocket = require("ws");

/** The schemas are draft 2020-12 as far as they use it; base64 text and URIs are checked by hand. */
function validators() {
  const Draft = require("ajv/dist/2020.js");
  const ajv = new (Draft.default ?? Draft)({ strict: false, allErrors: true });
  ajv.addFormat("base64", /^[A-Za-z0-9+/]*={0,2}$/);
  ajv.addFormat("uri", { validate: (text) => URL.canParse?.(text) ?? /^\w+:/.test(text) });
  ajv.removeKeyword("contentEncoding"); // the draft only notes it
  ajv.addKeyword({ keyword: "contentEncoding", schemaType: "string", validate: (encoding, data) =>
    encoding !== "base64" || typeof data !== "string" || /^[A-Za-z0-9+/]*={0,2}$/.test(data) });
  return ajv;
}

async function connect(base, protocols = [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) {
  const socket = new WebSocket(`${base.replace("http", "ws")}/ws`, protocols);
  const client = new FoxgloveClient({ ws: socket });
  const seen = { channels: new Map(), services: new Map(), statuses: [], parameters: [], info: null };
  client.on("serverInfo", (info) => (seen.info = info));
  client.on("advertise", (list) => list.forEach((c) => seen.channels.set(c.topic, c)));
  client.on("advertiseServices", (list) => list.forEach((s) => seen.services.set(s.name, s)));
  client.on("status", (s) => seen.statuses.push(s));
  client.on("parameterValues", (p) => seen.parameters.push(p));
  await new Promise((resolve, reject) => {
    client.on("open", resolve);
    client.on("error", reject);
  });
  await until("the server's channels and services", 10, () => seen.channels.size > 0 && seen.services.size > 0);
  let call = 0;
  const service = (name, body) => new Promise((resolve, reject) => {
    const { id } = seen.services.get(name);
    const mine = ++call;
    const answer = (m) => {
      if (m.callId !== mine) return;
      client.off("serviceCallResponse", answer);
      resolve(JSON.parse(new TextDecoder().decode(m.data)));
    };
    client.on("serviceCallResponse", answer);
    client.on("serviceCallFailure", (f) => f.callId === mine && reject(new Error(f.message)));
    const data = new TextEncoder().encode(JSON.stringify(body));
    client.sendServiceCallRequest({ serviceId: id, callId: mine, encoding: "json", data: new DataView(data.buffer) });
  });
  return { client, seen, service, socket };
}

async function with_server(act) {
  const place = scratch();
  const server = await serve({ database: place.database });
  try {
    await act(server);
  } finally {
    await server.stop();
    place.remove();
  }
}

const kTopics = ["/telemetry", "/tautline/filtered", "/state", "/scan", "/tf", "/odom", "/layers", "/obstacles", "/goal",
  "/trajectory", "/log"];

test("every channel's messages match its schema", { timeout: 90_000 }, () => with_server(async ({ base }) => {
  const { client, seen, service } = await connect(base);
  assert.deepEqual([...seen.channels.keys()].sort(), [...kTopics].sort());
  for (const capability of ["clientPublish", "time", "parameters", "parametersSubscribe", "services"]) {
    assert.ok(seen.info.capabilities.includes(capability), `${capability} is offered`);
  }
  const ajv = validators();
  const counts = new Map();
  const faults = [];
  const topics = new Map();
  for (const channel of seen.channels.values()) {
    const check = channel.encoding === "json" ? ajv.compile(JSON.parse(channel.schema)) : null;
    topics.set(client.subscribe(channel.id), { channel, check });
  }
  client.on("message", ({ subscriptionId, data }) => {
    const { channel, check } = topics.get(subscriptionId);
    counts.set(channel.topic, (counts.get(channel.topic) ?? 0) + 1);
    if (!check) {
      assert.ok(data.byteLength > 100, "a frame of telemetry, a filtered scan");
      return;
    }
    const text = new TextDecoder().decode(data);
    const value = JSON.parse(text);
    if (!check(value)) faults.push(`${channel.topic}: ${ajv.errorsText(check.errors)}\n${text.slice(0, 300)}`);
  });
  // Events for /log: a stop holds the robot; a refused request is an event too.
  await service("/request", { type: "stop", engaged: true });
  await service("/request", { type: "stop", engaged: false });
  await service("/request", { type: "set_goal", x: 2, y: 3, heading: 0.5 });
  await assert.rejects(service("/request", { type: "remove_obstacle", id: 999 }), /999/);
  await until("a message on every channel", 30, () => kTopics.filter((t) => !counts.get(t)), (missing) => missing.length === 0);
  await until("enough frames", 20, () => counts.get("/telemetry"), (n) => n > 20);
  assert.deepEqual(faults, []);
  client.close();
}));

test("a viewer who connects at rest sees the scene", { timeout: 60_000 }, () => with_server(async ({ base }) => {
  const goal = { type: "set_goal", x: 3, y: 3 };
  await json(base, "/session/requests", { method: "POST", body: JSON.stringify(goal) });
  await until("some way", 20, () => json(base, "/session"), (s) => s.tick > 40);
  await json(base, "/session/control", { method: "POST", body: JSON.stringify({ action: "pause" }) });
  const still = await until("rest", 10, async () => {
    const before = await json(base, "/session");
    await new Promise((resolve) => setTimeout(resolve, 300));
    const now = await json(base, "/session");
    return before.tick === now.tick ? now : null;
  });
  // Twice: the second viewer finds the channels encoded for the first.
  for (let viewer = 0; viewer < 2; ++viewer) {
    const { client, seen } = await connect(base);
    const got = new Map();
    let clock = null;
    client.on("time", ({ timestamp }) => (clock = timestamp));
    const topics = new Map([...seen.channels.values()].map((c) => [client.subscribe(c.id), c]));
    client.on("message", ({ subscriptionId, data, timestamp }) => {
      const { topic, encoding } = topics.get(subscriptionId);
      got.set(topic, { timestamp, value: encoding === "json" ? JSON.parse(new TextDecoder().decode(data)) : data });
    });
    await until(`the newest of every channel, viewer ${viewer}`, 10, () => kTopics.filter((t) => !got.has(t)), (none) => none.length === 0);
    assert.ok(got.get("/scan").value.ranges.length > 300, "a scan");
    const entities = got.get("/layers").value.entities.map((e) => e.id);
    assert.ok(entities.some((id) => /strip/.test(id)), `the strip is among ${entities}`);
    const pose = got.get("/odom").value.pose.position;
    assert.ok(Math.hypot(pose.x - still.pose.x, pose.y - still.pose.y) < 1e-6, "where the robot stands");
    assert.ok(got.get("/trajectory").value.poses.length > 1, "the way it came");
    assert.equal(got.get("/tf").timestamp, BigInt(Math.floor(still.stamp * 1e9)));
    if (viewer === 1) client.close();
  }
}));

test("a goal, a gain and a reset from outside", { timeout: 60_000 }, () => with_server(async ({ base }) => {
  const { client, seen, service } = await connect(base);
  // A goal as viewers publish it: PoseStamped, heading 90 degrees.
  const id = client.advertise({ topic: "/goal_pose", encoding: "json", schemaName: "geometry_msgs/PoseStamped" });
  const half = Math.SQRT1_2;
  const pose = { header: { stamp: { sec: 0, nsec: 0 }, frame_id: "map" },
    pose: { position: { x: 1.5, y: 2.25, z: 0 }, orientation: { x: 0, y: 0, z: half, w: half } } };
  client.sendMessage(id, new TextEncoder().encode(JSON.stringify(pose)));
  const aimed = await until("the goal", 10, () => json(base, "/session"), (s) => s.goal?.x === 1.5);
  assert.equal(aimed.goal.y, 2.25);
  assert.ok(Math.abs(aimed.goal.heading - Math.PI / 2) < 1e-6);

  // A gain: accepted and returned to the client; out of limits: refused with a sentence and the old value.
  client.subscribeParameterUpdates(["k_r"]);
  const last = () => seen.parameters.flatMap((p) => p.parameters).filter((p) => p.name === "k_r").at(-1)?.value;
  client.setParameters([{ name: "k_r", value: 0.45, type: "float64" }], "one");
  await until("the gain", 10, last, (v) => v === 0.45);
  assert.equal((await json(base, "/session/parameters")).k_r, 0.45);
  seen.statuses.length = 0;
  client.setParameters([{ name: "k_r", value: 1e6, type: "float64" }], "two");
  await until("a sentence", 10, () => seen.statuses.length > 0);
  assert.match(seen.statuses[0].message, /\w+ \w+/);
  await until("the old value", 10, () => seen.parameters.find((p) => p.id === "two")?.parameters[0]?.value, (v) => v === 0.45);

  // Reset: another run of the same scenario, from its start.
  const before = await json(base, "/session");
  const answer = await service("/reset", {});
  assert.equal(answer.ok, true);
  const now = await until("another run", 10, () => json(base, "/session"), (s) => s.run.id !== before.run.id);
  assert.equal(now.scenario.name, before.scenario.name);
  client.close();
}));

test("both subprotocol names are accepted, another is refused", { timeout: 30_000 }, () => with_server(async ({ base }) => {
  const ask = (protocols) => new Promise((resolve) => {
    const socket = new WebSocket(`${base.replace("http", "ws")}/ws`, protocols);
    socket.on("open", () => {
      const spoken = socket.protocol;
      socket.close();
      resolve(spoken);
    });
    socket.on("error", () => resolve(null));
  });
  assert.equal(await ask(["foxglove.websocket.v1"]), "foxglove.websocket.v1");
  assert.equal(await ask(["foxglove.sdk.v1"]), "foxglove.sdk.v1");
  assert.equal(await ask(["foxglove.websocket.v1", "foxglove.sdk.v1"]), "foxglove.websocket.v1");
  assert.equal(await ask(["chat"]), null);
}));
