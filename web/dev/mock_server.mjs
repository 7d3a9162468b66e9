// web/dev/mock_server.mjs: the wire contract with a toy robot behind it, to work on the page without
// the server: static files, REST, and the Foxglove subset the page uses.
// Usage: node dev/mock_server.mjs [PORT]   (after npm run build)
import { createServer } from "node:http";
import { readFileSync, existsSync } from "node:fs";
import { dirname, extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import * as esbuild from "esbuild";
import { WebSocketServer } from "ws";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const port = Number(process.argv[2] ?? 8099);
const wire_path = join(root, ".test/mock_wire.mjs");
await esbuild.build({
  stdin: { contents: 'export * from "./src/wire/telemetry_generated"; export { Builder } from "flatbuffers";',
    resolveDir: root, loader: "ts" },
  bundle: true, format: "esm", outfile: wire_path, platform: "node",
});
const fb = await import(wire_path);

// --- world ---------------------------------------------------------------------------------------
const cyl = (id, x, y, radius) => ({ id, type: "cylinder", x, y, radius });
const box = (id, x, y, length, width, heading = 0) => ({ id, type: "box", x, y, heading, length, width });
const scenarios = {
  demo: { title: "A short drive", goal: { x: 3, y: 1 }, obstacles: [cyl(1, 1.5, 0.2, 0.2)] },
  case1: { title: "One obstacle on the line", goal: { x: 3.5, y: 5 }, obstacles: [cyl(1, 1.75, 2.5, 0.3)] },
  case3: { title: "Three obstacles", goal: { x: 5, y: 4, heading: 0.7 },
    obstacles: [cyl(1, 1.7, 2, 0.4), cyl(2, 3.4, 2.05, 0.3), box(3, 3.4, 3.8, 0.6, 0.6)] },
  wall: { title: "A flat face", goal: { x: 5, y: 0 }, obstacles: [box(1, 2.5, 0, 0.3, 0.8),
    { id: 2, type: "wall", from: [0, 2.5], to: [5, 2.5], thickness: 0.1 },
    { id: 3, type: "polygon", points: [[3.1, -1.9], [3.9, -1.7], [3.5, -1.2]] }] },
  "freiburg-079": { title: "Real LMS200 data", log: "freiburg-079.log", obstacles: [] },
};
for (const [name, s] of Object.entries(scenarios)) {
  Object.assign(s, { name, description: s.title, parameters: { k_r: 0.6 },
    start: { x: 0, y: 0, heading: s.goal ? Math.atan2(s.goal.y, s.goal.x) : 0 } });
}
const parameter = (name, label, unit, min, max, step, initial) =>
  ({ name, label, unit, min, max, step, initial, help: `${label}: how strongly it counts.` });
const catalog = {
  controllers: ["original", "original_side", "modified_published", "modified_c1", "modified", "via_kept", "go_to_goal"]
    .map((name) => ({ name, label: name.charAt(0).toUpperCase() + name.slice(1).replace(/_/g, " "),
      help: "Elastic strip with the force of both sides and a side choice." })),
  filters: [["pseudomedian", "Pseudomedian"], ["median", "Median"], ["lulu", "LULU"], ["none", "None"]]
    .map(([name, label]) => ({ name, label, help: label })),
  vehicles: [{ name: "bullet", label: "Bullet", help: "Physics" }, { name: "kinematic", label: "Kinematic", help: "Exact" }],
  parameters: [parameter("k_c", "Contraction K_c", "", 0, 2, 0.05, 0.8), parameter("k_r", "Repulsion K_r", "", 0, 2, 0.05, 0.6),
    parameter("safety_distance", "Safety distance", "m", 0.2, 2, 0.05, 1), parameter("strip_step", "Step S", "m", 0.05, 0.6, 0.01, 0.2),
    parameter("v_max", "Top speed", "m/s", 0.02, 1, 0.01, 0.3), parameter("w_max", "Top turn rate", "rad/s", 0.1, 3, 0.1, 1),
    parameter("filter_half_width", "Filter half width N", "", 0, 8, 1, 1)],
};

let run_id = 0;
const runs = [];
let s; // the session
function load(name, change = {}) {
  if (s) finish("stopped");
  const scenario = scenarios[name];
  const p = Object.fromEntries(catalog.parameters.map((x) => [x.name, x.initial]));
  s = { name, tick: 0, pose: { ...scenario.start }, v: 0, w: 0, goal: scenario.goal ?? null, since: 0,
    obstacles: structuredClone(scenario.obstacles), parameters: { ...p, ...scenario.parameters, ...change.parameters },
    controller: change.controller ?? "modified", filter: change.filter ?? "pseudomedian",
    vehicle: change.vehicle ?? "bullet", seed: change.seed ?? 1, paused: s?.paused ?? false, speed: s?.speed ?? 1,
    stop: false, requests: [], next: 10, moved: 0, least: 9, mission: "Driving", log: !!scenario.log };
  s.run = { id: ++run_id, status: "recording", outcome: "running", scenario: name, controller: s.controller,
    filter: s.filter, vehicle: s.vehicle, seed: s.seed, parameters: s.parameters, version: "0.1.0", reason: null,
    started: new Date().toISOString(), ticks: 0, time: 0, lost_ticks: 0, bytes: 0, metrics: null,
    document: { scenario: structuredClone(scenario) }, frames: [] };
  runs.unshift(s.run);
}
function finish(outcome) {
  const r = s.run;
  if (r.status !== "recording") return;
  Object.assign(r, { status: "finished", outcome, metrics: { outcome, time: r.time, path_length: s.moved,
    min_clearance: s.least, intrusion: Math.max(0, 0.65 - s.least), infringed_time: 0, turning: 2.1, via_points: 3,
    ticks: r.ticks, collided: outcome === "collided" } });
}
const state = () => ({ run: { id: s.run.id, status: s.run.status, outcome: s.run.outcome },
  source: s.log ? "replay" : "simulation", scenario: scenarios[s.name], controller: s.controller, filter: s.filter,
  vehicle: s.vehicle, seed: s.seed, robot: { name: "silvermate", radius: 0.35, half_track: 0.25, period: 0.026,
    max_v: 0.5, max_omega: 1, editable: !s.log, paceable: true, drives: !s.log },
  pace: { paused: s.paused, speed: s.speed }, stop: s.stop, goal: s.goal, obstacles: s.obstacles,
  parameters: s.parameters, lost_ticks: 0, problem: null });

// --- sensing and driving -------------------------------------------------------------------------
function segments() {
  const out = [[-1.6, -2.4, 7, -2.4], [7, -2.4, 7, 6.6], [7, 6.6, -1.6, 6.6], [-1.6, 6.6, -1.6, -2.4]];
  for (const o of s.obstacles) {
    if (o.type === "cylinder") continue;
    let c;
    if (o.type === "polygon") c = o.points;
    else {
      const wall = o.type === "wall";
      const x = wall ? (o.from[0] + o.to[0]) / 2 : o.x, y = wall ? (o.from[1] + o.to[1]) / 2 : o.y;
      const h = wall ? Math.atan2(o.to[1] - o.from[1], o.to[0] - o.from[0]) : o.heading;
      const a = (wall ? Math.hypot(o.to[0] - o.from[0], o.to[1] - o.from[1]) : o.length) / 2;
      const b = (wall ? o.thickness : o.width) / 2;
      c = [[-a, -b], [a, -b], [a, b], [-a, b]].map(([u, v]) =>
        [x + u * Math.cos(h) - v * Math.sin(h), y + u * Math.sin(h) + v * Math.cos(h)]);
    }
    c.forEach((p, i) => out.push([...p, ...c[(i + 1) % c.length]]));
  }
  return out;
}
function cast(px, py, angle, lines) {
  const dx = Math.cos(angle), dy = Math.sin(angle);
  let best = 8.191;
  for (const o of s.obstacles) {
    if (o.type !== "cylinder") continue;
    const fx = o.x - px, fy = o.y - py, b = fx * dx + fy * dy, q = fx * fx + fy * fy - b * b;
    if (b > 0 && q < o.radius ** 2) best = Math.min(best, b - Math.sqrt(o.radius ** 2 - q));
  }
  for (const [ax, ay, bx, by] of lines) {
    const ex = bx - ax, ey = by - ay, d = dx * ey - dy * ex;
    if (Math.abs(d) < 1e-12) continue;
    const t = ((ax - px) * ey - (ay - py) * ex) / d, u = ((ax - px) * dy - (ay - py) * dx) / d;
    if (t > 0 && u >= 0 && u <= 1) best = Math.min(best, t);
  }
  return best;
}
let seed = 7;
const rnd = () => (seed = (seed * 16807) % 2147483647) / 2147483647;
function tick() {
  const dt = 0.026, { pose, parameters: p } = s;
  if (s.log) Object.assign(pose, { x: 2 + 1.6 * Math.cos(s.tick / 300), y: 2 + 1.6 * Math.sin(s.tick / 300), heading: s.tick / 300 + Math.PI / 2 });
  const lines = segments();
  const ranges = new Uint16Array(361);
  const d0 = p.safety_distance + 0.35, B = p.strip_step / 2;
  const sides = [null, null]; // right, left
  for (let i = 0; i < 361; ++i) {
    const a = pose.heading - Math.PI / 2 + (i * Math.PI) / 360;
    const r = cast(pose.x, pose.y, a, lines);
    const noisy = r + (rnd() - 0.5) * 0.04;
    ranges[i] = r >= 8.19 ? 65535 : rnd() < 0.004 ? 65530 : Math.round(1000 * (rnd() < 0.012 ? r * (0.3 + 0.6 * rnd()) : noisy));
    const k = i < 180 ? 0 : 1;
    if (i > 30 && i < 330 && r < 8 && (!sides[k] || r < sides[k].distance)) {
      sides[k] = { distance: r, beam: i, x: pose.x + r * Math.cos(a), y: pose.y + r * Math.sin(a) };
    }
  }
  const force = (x, y, n) => {
    if (!n) return [0, 0];
    const d = Math.hypot(x - n.x, y - n.y), f = d < d0 ? B + p.k_r * (d0 - d) : B * B / (B + p.k_r * (d - d0));
    return [(f * (x - n.x)) / d, (f * (y - n.y)) / d];
  };
  const strip = [{ x: pose.x, y: pose.y, e: [0, 0] }];
  let pass = null, L = [0, 0], R = [0, 0], F = [0, 0];
  const D = s.goal ? Math.hypot(s.goal.x - pose.x, s.goal.y - pose.y) : 0;
  if (s.goal) {
    let x = pose.x, y = pose.y;
    for (let k = 0; k < 14; ++k) {
      const d = Math.hypot(s.goal.x - x, s.goal.y - y);
      if (d < p.strip_step) break;
      const ux = (s.goal.x - x) / d, uy = (s.goal.y - y) / d;
      const l = force(x, y, sides[1]), r = force(x, y, sides[0]);
      let f = [l[0] + r[0], l[1] + r[1]];
      const m = Math.hypot(...f), against = -(f[0] * ux + f[1] * uy) / (m || 1);
      const alpha = Math.min(1, Math.max(0, (against - 0.707) / 0.26)) * m;
      f = [f[0] + alpha * uy, f[1] - alpha * ux];
      if (k === 0) [L, R, F] = [l, r, f];
      const nx = x + p.strip_step * ux + f[0], ny = y + p.strip_step * uy + f[1];
      const step = Math.hypot(nx - x, ny - y) || 1, go = Math.min(0.35, Math.max(0.15, step));
      x += (go * (nx - x)) / step; y += (go * (ny - y)) / step;
      strip.push({ x, y, e: f });
      if (k === 0) pass = { x, y };
    }
    strip.push({ x: s.goal.x, y: s.goal.y, e: [0, 0] });
  }
  const arrived = s.goal && D < 0.2;
  let v = 0, w = 0;
  if (pass && !arrived && !s.stop && !s.log) {
    const turn = Math.atan2(pass.y - pose.y, pass.x - pose.x) - pose.heading, wrapped = Math.atan2(Math.sin(turn), Math.cos(turn));
    w = Math.max(-p.w_max, Math.min(p.w_max, 2 * wrapped));
    v = p.v_max * Math.max(0, Math.cos(wrapped));
  }
  s.v += Math.max(-0.02, Math.min(0.02, v - s.v)); s.w += Math.max(-0.1, Math.min(0.1, w - s.w));
  if (!s.log) { pose.x += s.v * Math.cos(pose.heading) * dt; pose.y += s.v * Math.sin(pose.heading) * dt; pose.heading += s.w * dt; }
  s.moved += Math.abs(s.v) * dt;
  const near = Math.min(sides[0]?.distance ?? 8, sides[1]?.distance ?? 8);
  s.least = Math.min(s.least, near - 0.35);
  const mission = s.stop ? "Held" : !s.goal ? "Idle" : arrived ? "Arrived" : "Driving";
  const what = s.log ? "Replaying the log" : s.stop ? "Stopped" : mission === "Idle" ? "Waiting for a goal" : arrived ? "Arrived at the goal"
    : Math.hypot(...L) > Math.hypot(...R) ? "Passing the left obstacle on its right" : "Passing the right obstacle on its left";
  const why = s.log ? `Scan ${s.tick}.` : s.stop ? "Stop is engaged. Release it to go on." : mission !== "Driving" ? "" :
    `External force ${Math.hypot(...F).toFixed(2)} m from the nearest return at ${near.toFixed(2)} m.`;
  const bytes = encode({ ranges, sides, strip, pass, L, R, F, clearance: near - 0.35, mission, what, why });
  s.run.frames.push(bytes);
  s.run.bytes += bytes.length;
  s.requests = [];
  s.tick++;
  s.run.ticks = s.tick;
  s.run.time = s.tick * dt;
  if (arrived && s.run.status === "recording") { finish("reached"); broadcast_state(); }
  return bytes;
}
function encode(t) {
  const b = new fb.Builder(4096), S = t.strip, p = s.pose;
  const ranges = fb.LaserScan.createRangesVector(b, t.ranges);
  fb.LaserScan.startLaserScan(b);
  fb.LaserScan.addMount(b, fb.Pose2.createPose2(b, 0, 0, 0));
  fb.LaserScan.addStamp(b, s.tick * 0.026);
  fb.LaserScan.addAngleMin(b, -Math.PI / 2);
  fb.LaserScan.addAngleIncrement(b, Math.PI / 360);
  fb.LaserScan.addRangeMax(b, 8.191);
  fb.LaserScan.addRanges(b, ranges);
  const scans = fb.Frame.createScansVector(b, [fb.LaserScan.endLaserScan(b)]);
  const boxes = s.requests.map((r) => box_request(b, r)).filter((x) => x);
  const requests = fb.Frame.createRequestsVector(b, boxes);
  let goal = 0;
  if (s.goal) {
    fb.SetGoal.startSetGoal(b);
    fb.SetGoal.addPosition(b, fb.Vec2.createVec2(b, s.goal.x, s.goal.y));
    if (s.goal.heading != null) { fb.SetGoal.addHeading(b, s.goal.heading); fb.SetGoal.addHasHeading(b, true); }
    goal = fb.SetGoal.endSetGoal(b);
  }
  fb.Frame.startStripVector(b, S.length);
  for (let i = S.length - 1; i >= 0; --i) fb.Node.createNode(b, S[i].x, S[i].y, -0.06, 0.14, S[i].e[0], S[i].e[1]);
  const strip = b.endVector();
  const what = b.createString(t.what), why = b.createString(t.why);
  fb.Frame.startFrame(b);
  fb.Frame.addTick(b, BigInt(s.tick));
  fb.Frame.addStamp(b, s.tick * 0.026);
  fb.Frame.addOdometry(b, fb.Odometry.createOdometry(b, s.tick * 0.026, p.x, p.y, p.heading, s.v, s.w));
  fb.Frame.addScans(b, scans);
  fb.Frame.addRequests(b, requests);
  fb.Frame.addCommand(b, fb.Twist2.createTwist2(b, s.v, s.w));
  if (goal) fb.Frame.addGoal(b, goal);
  fb.Frame.addHold(b, s.stop ? 1 : 0);
  fb.Frame.addMission(b, fb.Mission[t.mission]);
  fb.Frame.addBehaviour(b, 1);
  fb.Frame.addClearance(b, t.clearance);
  fb.Frame.addStrip(b, strip);
  if (t.pass) fb.Frame.addPass(b, fb.Vec2f.createVec2f(b, t.pass.x, t.pass.y));
  const [right, left] = t.sides;
  if (left) fb.Frame.addLeft(b, fb.Nearest.createNearest(b, left.x, left.y, left.distance, left.beam));
  if (right) fb.Frame.addRight(b, fb.Nearest.createNearest(b, right.x, right.y, right.distance, right.beam));
  fb.Frame.addExternalLeft(b, fb.Vec2f.createVec2f(b, ...t.L));
  fb.Frame.addExternalRight(b, fb.Vec2f.createVec2f(b, ...t.R));
  fb.Frame.addElastic(b, fb.Vec2f.createVec2f(b, ...t.F));
  fb.Frame.addWhat(b, what);
  fb.Frame.addWhy(b, why);
  b.finish(fb.Frame.endFrame(b));
  return Buffer.from(b.asUint8Array());
}
function box_request(b, r) {
  let type, at;
  if (r.type === "add_obstacle") {
    const o = r.obstacle, kind = ["cylinder", "box", "polygon", "wall"].indexOf(o.type);
    fb.Obstacle.startObstacle(b);
    fb.Obstacle.addId(b, o.id);
    fb.Obstacle.addPose(b, fb.Pose2.createPose2(b, o.x ?? 0, o.y ?? 0, o.heading ?? 0));
    fb.Obstacle.addKind(b, kind);
    fb.Obstacle.addSize(b, fb.Vec2.createVec2(b, o.radius ?? o.length ?? 0, o.width ?? 0));
    const ob = fb.Obstacle.endObstacle(b);
    [type, at] = [fb.Request.AddObstacle, fb.AddObstacle.createAddObstacle(b, ob)];
  } else if (r.type === "set_goal") {
    fb.SetGoal.startSetGoal(b);
    fb.SetGoal.addPosition(b, fb.Vec2.createVec2(b, r.x, r.y));
    [type, at] = [fb.Request.SetGoal, fb.SetGoal.endSetGoal(b)];
  } else if (r.type === "move_obstacle") {
    fb.MoveObstacle.startMoveObstacle(b);
    fb.MoveObstacle.addId(b, r.id);
    fb.MoveObstacle.addPose(b, fb.Pose2.createPose2(b, r.x, r.y, r.heading ?? 0));
    [type, at] = [fb.Request.MoveObstacle, fb.MoveObstacle.endMoveObstacle(b)];
  } else if (r.type === "stop") {
    [type, at] = [fb.Request.Stop, fb.Stop.createStop(b, r.engaged)];
  } else return 0;
  return fb.RequestBox.createRequestBox(b, type, at);
}

// --- requests and services -----------------------------------------------------------------------
function request(r) {
  if (r.type === "set_goal") s.goal = { x: r.x, y: r.y, heading: r.heading ?? null };
  else if (r.type === "clear_goal") s.goal = null;
  else if (r.type === "add_obstacle") {
    const o = { ...r.obstacle, id: ++s.next };
    if (o.x !== undefined && Math.hypot(o.x - s.pose.x, o.y - s.pose.y) < 0.35 + (o.radius ?? 0.3)) throw new Error("The obstacle would overlap the robot. Place it at least 0.35 m from the robot's centre.");
    s.obstacles = [...s.obstacles, o];
    s.requests.push({ ...r, obstacle: o });
    return { ok: true, id: o.id };
  } else if (r.type === "move_obstacle") {
    s.obstacles = s.obstacles.map((o) => o.id === r.id ? { ...o, x: r.x, y: r.y, heading: r.heading } : o);
  } else if (r.type === "remove_obstacle") s.obstacles = s.obstacles.filter((o) => o.id !== r.id);
  else if (r.type === "stop") s.stop = r.engaged;
  s.requests.push(r);
  return { ok: true };
}
const services = {
  "/request": request,
  "/watch": () => ({ ok: true }),
  "/check_goal": () => ({ ok: true, trouble: null }),
  "/load": (b) => { load(b.scenario, b); return { ok: true }; },
  "/reset": () => { load(s.name, s); return { ok: true }; },
  "/pause": () => { s.paused = true; return { ok: true }; },
  "/play": () => { s.paused = false; return { ok: true }; },
  "/step": () => { if (s.paused) send_frame(tick()); return { ok: true }; },
  "/speed": (b) => { s.speed = b.speed; return { ok: true }; },
};
const names = Object.keys(services);
const channels = [{ id: 1, topic: "/telemetry", encoding: "flatbuffer", schemaName: "tautline.wire.Frame", schema: "" },
  { id: 2, topic: "/state", encoding: "json", schemaName: "tautline.State", schema: "{}" }];
const clients = new Set();
const session_id = String(Date.now());
function message(c, channel, payload) {
  const id = c.subs.get(channel);
  if (id === undefined) return;
  const out = Buffer.alloc(13 + payload.length);
  out.writeUInt8(1, 0); out.writeUInt32LE(id, 1); payload.copy(out, 13);
  c.ws.send(out);
}
function send_frame(bytes) { for (const c of clients) message(c, 1, bytes); }
function broadcast_state() { for (const c of clients) message(c, 2, Buffer.from(JSON.stringify(state()))); }
function connect(ws) {
  const c = { ws, subs: new Map() };
  clients.add(c);
  ws.on("close", () => clients.delete(c));
  const json = (o) => ws.send(JSON.stringify(o));
  json({ op: "serverInfo", name: "Tautline mock", capabilities: ["clientPublish", "parameters", "services"], sessionId: session_id });
  json({ op: "advertise", channels });
  json({ op: "advertiseServices", services: names.map((name, i) => ({ id: i + 1, name, type: name })) });
  ws.on("message", (data, binary) => {
    if (binary) {
      const service = data.readUInt32LE(1), call = data.readUInt32LE(5), n = data.readUInt32LE(9);
      try {
        const answer = Buffer.from(JSON.stringify(services[names[service - 1]](JSON.parse(data.subarray(13 + n).toString()))));
        const out = Buffer.concat([Buffer.alloc(13), Buffer.from("json"), answer]);
        out.writeUInt8(3, 0); out.writeUInt32LE(service, 1); out.writeUInt32LE(call, 5); out.writeUInt32LE(4, 9);
        ws.send(out);
        broadcast_state();
      } catch (e) { json({ op: "serviceCallFailure", serviceId: service, callId: call, message: e.message }); }
      return;
    }
    const m = JSON.parse(data.toString());
    if (m.op === "subscribe") for (const x of m.subscriptions) {
      c.subs.set(x.channelId, x.id);
      if (x.channelId === 2) message(c, 2, Buffer.from(JSON.stringify(state())));
    }
    if (m.op === "getParameters") json({ op: "parameterValues", id: m.id, parameters: m.parameterNames.map((name) => ({ name, value: s.parameters[name] })) });
    if (m.op === "setParameters") {
      for (const q of m.parameters) {
        if (q.name === "k_r" && q.value * s.parameters.safety_distance <= s.parameters.strip_step) {
          json({ op: "status", level: 1, message: "K_r times the safety distance must stay above the step S (0.20 m), or the strip can be pushed into an obstacle. The old value is kept." });
        } else s.parameters = { ...s.parameters, [q.name]: q.value };
      }
      json({ op: "parameterValues", id: m.id, parameters: m.parameters.map((q) => ({ name: q.name, value: s.parameters[q.name] })) });
      broadcast_state();
    }
  });
}
let last = Date.now(), owed = 0;
setInterval(() => {
  const now = Date.now();
  owed = s.paused ? 0 : owed + ((now - last) / 1000) * (s.speed || 12);
  last = now;
  let bytes = null;
  for (let n = 0; owed >= 0.026 && n < 40; ++n, owed -= 0.026) bytes = tick();
  if (bytes) send_frame(bytes);
}, 26);

// --- HTTP ----------------------------------------------------------------------------------------
const types = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml", ".ico": "image/x-icon" };
const csp = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
function api(method, url, body) {
  const path = url.pathname.slice(7), q = url.searchParams;
  const row = ({ frames, document, ...r }) => r;
  if (path === "/catalog") return catalog;
  if (path === "/version") return { name: "tautline", version: "0.1.0", protocol: 1, database: { path: "state/tautline.db", bytes: 1234567, runs: runs.length } };
  if (path === "/session") return { ...state(), tick: s.tick, pose: s.pose };
  if (path === "/scenarios") return { items: Object.values(scenarios).map((x) => ({ name: x.name, title: x.title, description: x.description, builtin: true, kind: x.log ? "log" : "world" })), next: null };
  if (path === "/runs" && method === "POST") return { runs: [run_id] };
  if (path === "/runs") {
    const from = Number(q.get("cursor") ?? 0), all = runs.filter((r) => !q.get("outcome") || r.outcome === q.get("outcome"));
    return { items: all.slice(from, from + 50).map(row), next: all.length > from + 50 ? String(from + 50) : null };
  }
  const [, id, what] = path.match(/^\/runs\/(\d+)(?:\/(\w+))?$/) ?? [];
  const r = runs.find((x) => x.id === Number(id));
  if (!r) return null;
  if (method === "DELETE") { runs.splice(runs.indexOf(r), 1); return {}; }
  if (what === "frames") {
    const from = Number(q.get("from") ?? 0), page = r.frames.slice(from, from + Number(q.get("limit") ?? 100));
    const next = from + page.length < r.frames.length ? from + page.length : null;
    return { next, bytes: Buffer.concat(page.flatMap((f) => { const n = Buffer.alloc(4); n.writeUInt32LE(f.length); return [n, f]; })) };
  }
  if (what === "ticks") return { items: [], next: null };
  return { ...row(r), document: r.document };
}
const server = createServer((req, res) => {
  const url = new URL(req.url, "http://x");
  res.setHeader("Content-Security-Policy", csp);
  if (url.pathname.startsWith("/api/v1")) {
    const answer = api(req.method, url);
    if (!answer) { res.writeHead(404, { "Content-Type": "application/problem+json" }); res.end('{"detail":"There is no such run.","status":404}'); return; }
    if (answer.bytes instanceof Buffer) { if (answer.next !== null) res.setHeader("X-Next-Tick", answer.next); res.end(answer.bytes); return; }
    res.setHeader("Content-Type", "application/json");
    res.end(JSON.stringify(answer));
    return;
  }
  const file = join(root, "dist", normalize(url.pathname === "/" ? "/index.html" : url.pathname));
  if (!file.startsWith(join(root, "dist")) || !existsSync(file)) { res.writeHead(404); res.end(); return; }
  res.setHeader("Content-Type", types[extname(file)] ?? "application/octet-stream");
  res.end(readFileSync(file));
});
const wss = new WebSocketServer({ server, path: "/ws", handleProtocols: (p) => [...p][0] });
wss.on("connection", connect);

// A few finished runs, so that the Runs view has something to show.
for (const [name, k] of [["case1", 0.6], ["case3", 0.6], ["wall", 0.4], ["case3", 0.3]]) {
  load(name, { parameters: { k_r: k } });
  for (let i = 0; i < 2600 && s.run.status === "recording"; ++i) tick();
  finish("stuck");
}
load("case3");
server.listen(port, "127.0.0.1", () => console.log(`http://127.0.0.1:${server.address().port}/`));
