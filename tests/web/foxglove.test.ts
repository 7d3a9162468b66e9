// tests/web/foxglove.test.ts: the protocol's bytes, and the live link over a fake socket.
import assert from "node:assert/strict";
import { test } from "node:test";
import { kBackoff, LinkStatus, LiveLink, SocketLike } from "../../web/src/link/live";
import { parse_binary, parse_text, service_request } from "../../web/src/link/foxglove";
import { Frame, Sweep } from "../../web/src/link/frame";
import { hand_wound } from "./timers";
import { frame_bytes, scan_bytes } from "./wire";

const hex = (text: string) => Uint8Array.from(text.match(/../g)!.map((b) => parseInt(b, 16))).buffer as ArrayBuffer;

test("message data: the protocol's own vector", () => {
  const m = parse_binary(hex("01070000001581e97df4102211"));
  assert.ok(m && m.op === "message");
  assert.equal(m.subscription, 7);
  assert.equal(m.payload.length, 0);
});

test("frames cut at every byte are refused or read, without an exception", () => {
  const whole = new Uint8Array(hex("03010000000200000004000000" + "6a736f6e" + "7b7d"));
  for (let n = 0; n < whole.length; ++n) {
    const m = parse_binary(whole.slice(0, n).buffer);
    if (n < 17) assert.equal(m, null, `${n} bytes`);
  }
  const m = parse_binary(whole.buffer);
  assert.ok(m && m.op === "service_response");
  assert.equal(new TextDecoder().decode(m.payload), "{}");
});

test("a declared length beyond the frame is refused", () => {
  assert.equal(parse_binary(hex("030100000002000000ffffffff6a736f6e")), null);
});

test("text that is no message is ignored", () => {
  for (const text of ["", "{", "[]", "3", "null", '{"a":1}']) assert.equal(parse_text(text), null);
  assert.equal(parse_text('{"op":"status","level":1,"message":"x"}')?.op, "status");
});

test("a service request is laid out as the protocol says", () => {
  // opcode 2, service 1, call 258, length 4, "json", {}
  assert.equal(Buffer.from(service_request(1, 258, {})).toString("hex"),
    "02" + "01000000" + "02010000" + "04000000" + "6a736f6e" + "7b7d");
});

class FakeSocket implements SocketLike {
  binaryType = "";
  readyState = 0;
  sent: (string | Uint8Array)[] = [];
  onopen: (() => void) | null = null;
  onclose: ((event?: { code: number; reason: string }) => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  onerror: (() => void) | null = null;
  send(data: string | Uint8Array) {
    this.sent.push(data);
  }
  close() {
    this.readyState = 3;
  }
  open() {
    this.readyState = 1;
    this.onopen?.();
  }
  text(message: unknown) {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
  /** Message data: the payload starts at byte 13. */
  message(subscription: number, payload: Uint8Array) {
    const message = new Uint8Array(13 + payload.length);
    message[0] = 1;
    new DataView(message.buffer).setUint32(1, subscription, true);
    message.set(payload, 13);
    this.onmessage?.({ data: message.buffer });
  }
  ops(): { op: string; [key: string]: unknown }[] {
    return this.sent.filter((s): s is string => typeof s === "string").map((s) => JSON.parse(s));
  }
}

function linked() {
  const sockets: FakeSocket[] = [];
  const seen = { frames: [] as Frame[], filtered: [] as Sweep[], states: [] as unknown[], notices: [] as string[],
    status: [] as LinkStatus[], gone: [] as string[], sessions: 0 };
  const link = new LiveLink(() => "ws://x/ws", {
    frame: (f) => seen.frames.push(f), filtered: (s) => seen.filtered.push(s), state: (s) => seen.states.push(s),
    status: (s) => seen.status.push(s), notice: (_, m) => seen.notices.push(m), log: () => undefined,
    new_session: () => ++seen.sessions, gone: (why) => seen.gone.push(why),
  }, () => {
    const socket = new FakeSocket();
    sockets.push(socket);
    return socket;
  });
  link.start();
  const ready = (socket: FakeSocket, session = "a") => {
    socket.open();
    socket.text({ op: "serverInfo", name: "t", capabilities: [], sessionId: session });
    socket.text({ op: "advertise", channels: [{ id: 5, topic: "/telemetry", encoding: "flatbuffer", schemaName: "" },
      { id: 6, topic: "/scan", encoding: "json", schemaName: "" },
      { id: 7, topic: "/tautline/filtered", encoding: "flatbuffer", schemaName: "LaserScan" }] });
    socket.text({ op: "advertiseServices", services: [{ id: 9, name: "/reset" }] });
  };
  return { link, sockets, seen, ready };
}

test("the link subscribes only to the channels that the page reads", () => {
  const { link, sockets, ready } = linked();
  ready(sockets[0]);
  const subscribed = sockets[0].ops().filter((o) => o.op === "subscribe");
  assert.deepEqual(subscribed.map((o) => (o.subscriptions as { channelId: number }[])[0].channelId), [5]);
  link.close();
});

test("filtered scans are requested while they are wanted, over a new connection too", () => {
  const timers = hand_wound();
  const { link, sockets, seen, ready } = linked();
  const asked = (socket: FakeSocket) => socket.ops().filter((o) => o.op === "subscribe")
    .flatMap((o) => o.subscriptions as { id: number; channelId: number }[]);
  link.want_filtered(true); // before there is a connection
  ready(sockets[0]);
  const [first] = asked(sockets[0]).filter((s) => s.channelId === 7);
  sockets[0].message(first.id, scan_bytes({ ranges: [1000, 2000, 65535], stamp: 2.5 }));
  sockets[0].message(first.id, new Uint8Array(0));
  assert.deepEqual(seen.filtered.map((s) => [s.stamp, ...s.ranges]), [[2.5, 1000, 2000, 65535]]);
  link.want_filtered(false);
  link.want_filtered(false);
  assert.deepEqual(sockets[0].ops().filter((o) => o.op === "unsubscribe"), [{ op: "unsubscribe", subscriptionIds: [first.id] }]);
  sockets[0].message(first.id, scan_bytes({ ranges: [1, 2, 3] }));
  assert.equal(seen.filtered.length, 1, "what was under way is not shown any more");
  link.want_filtered(true);
  assert.equal(asked(sockets[0]).filter((s) => s.channelId === 7).length, 2);
  sockets[0].onclose?.();
  timers.tick(kBackoff[0]);
  ready(sockets[1]);
  assert.equal(asked(sockets[1]).filter((s) => s.channelId === 7).length, 1);
  link.close();
  timers.restore();
});

test("a frame is read, even at an odd address in the message", () => {
  const { link, sockets, seen, ready } = linked();
  ready(sockets[0]);
  const id = (sockets[0].ops().find((o) => o.op === "subscribe")!.subscriptions as { id: number }[])[0].id;
  sockets[0].message(id, frame_bytes({ tick: 3, ranges: [1000, 2000, 65535] }));
  assert.equal(seen.frames.length, 1);
  assert.deepEqual([...seen.frames[0].sweeps[0].ranges], [1000, 2000, 65535]);
  link.close();
});

test("a service answers with its value, or with the server's sentence", async () => {
  const { link, sockets, ready } = linked();
  ready(sockets[0]);
  const good = link.call<{ ok: boolean }>("/reset");
  const request = sockets[0].sent.at(-1) as Uint8Array;
  const call = new DataView(request.buffer).getUint32(5, true);
  const answer = Buffer.concat([Buffer.from("0309000000", "hex"), Buffer.alloc(4), Buffer.from("04000000", "hex"),
    Buffer.from('json{"ok":true}')]);
  answer.writeUInt32LE(call, 5);
  sockets[0].onmessage?.({ data: answer.buffer.slice(answer.byteOffset, answer.byteOffset + answer.length) });
  assert.deepEqual(await good, { ok: true });

  const bad = link.call("/reset");
  sockets[0].text({ op: "serviceCallFailure", serviceId: 9, callId: call + 1, message: "Not while hung up." });
  await assert.rejects(bad, /Not while hung up/);
  await assert.rejects(link.call("/nothing"), /does not offer \/nothing/);
  link.close();
});

test("a refused parameter resolves with the value the server kept", async () => {
  const { link, sockets, seen, ready } = linked();
  ready(sockets[0]);
  const set = link.set_parameter("k_r", 9);
  const asked = sockets[0].ops().find((o) => o.op === "setParameters")!;
  sockets[0].text({ op: "status", level: 1, message: "k_r must be at most 2." });
  sockets[0].text({ op: "parameterValues", id: asked.id, parameters: [{ name: "k_r", value: 0.6 }] });
  assert.equal(await set, 0.6);
  assert.deepEqual(seen.notices, ["k_r must be at most 2."]);
  link.close();
});

test("a lost connection is reported, tries again after its pauses, and fails pending calls", async () => {
  const timers = hand_wound();
  const { link, sockets, seen, ready } = linked();
  ready(sockets[0]);
  const under_way = link.call("/reset");
  sockets[0].onclose?.();
  await assert.rejects(under_way, /connection was lost/);
  assert.equal(seen.status.at(-1)?.phase, "lost");
  for (let i = 0; i < kBackoff.length + 1; ++i) {
    const pause = kBackoff[Math.min(i, kBackoff.length - 1)];
    timers.tick(pause - 1);
    assert.equal(sockets.length, i + 1, "too early");
    timers.tick(1);
    assert.equal(sockets.length, i + 2);
    sockets.at(-1)!.onclose?.();
  }
  link.close();
  timers.restore();
});

test("another server process invalidates the known state", () => {
  const timers = hand_wound();
  const { link, sockets, seen, ready } = linked();
  ready(sockets[0], "a");
  sockets[0].onclose?.();
  timers.tick(500);
  ready(sockets[1], "a");
  assert.equal(seen.sessions, 0);
  sockets[1].onclose?.();
  timers.tick(500);
  ready(sockets[2], "b");
  assert.equal(seen.sessions, 1);
  assert.ok(sockets[2].ops().some((o) => o.op === "subscribe"));
  link.close();
  timers.restore();
});

test("an ended session is reported, and not requested again and again", () => {
  const timers = hand_wound();
  const { link, sockets, seen, ready } = linked();
  ready(sockets[0]);
  sockets[0].onclose?.({ code: 4404, reason: "This session has ended." });
  assert.deepEqual(seen.gone, ["This session has ended."]);
  assert.equal(seen.status.at(-1)?.retry_at, Infinity);
  timers.tick(60_000);
  assert.equal(sockets.length, 1);
  link.reconnect();
  ready(sockets[1], "b");
  assert.equal(seen.status.at(-1)?.phase, "open");
  assert.equal(seen.sessions, 1);
  link.close();
  timers.restore();
});

test("calls without a connection fail at once", async () => {
  const { link } = linked();
  await assert.rejects(link.call("/reset"), /no connection/);
  await assert.rejects(link.set_parameter("k_r", 1), /no connection/);
  link.close();
});
