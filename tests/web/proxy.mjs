// tests/web/proxy.mjs: the literal recipe of docs/install.md: nginx with TLS in front of the
// real program; page, login, cookie, WebSocket, and forty visitors at once.
import assert from "node:assert/strict";
import { execFileSync, spawn } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import https from "node:https";
import { createServer } from "node:net";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { launch } from "./page.mjs";
import { repository, require, scratch, serve, until } from "./program.mjs";

const WebSocket = require("ws");
const kToken = "not-to-be-guessed-0123456789";
const kName = "robot.example";
const kSubprotocol = "foxglove.websocket.v1";

const free_port = () => new Promise((resolve) => {
  const probe = createServer().listen(0, "127.0.0.1", () => {
    const { port } = probe.address();
    probe.close(() => resolve(port));
  });
});

/** The nginx block of the recipe, with this test's names for the host's own. */
function recipe({ folder, tls, app }) {
  const text = readFileSync(join(repository, "docs/install.md"), "utf8");
  const [, block] = text.match(/```nginx\n([^]*?)```/) ?? assert.fail("docs/install.md has no nginx block");
  const replaced = [
    ["listen 443 ssl;", `listen 127.0.0.1:${tls} ssl;`],
    ["/etc/ssl/certs/robot.example.pem", join(folder, "cert.pem")],
    ["/etc/ssl/private/robot.example.key", join(folder, "key.pem")],
    ["http://127.0.0.1:8080", `http://127.0.0.1:${app}`],
  ];
  return replaced.reduce((out, [from, to]) => {
    assert.ok(out.includes(from), `the recipe says "${from}"`);
    return out.replace(from, to);
  }, block);
}

/** The program's options of the recipe, as a list. */
function documented_options() {
  const text = readFileSync(join(repository, "docs/install.md"), "utf8");
  const [, line] = text.match(/^TAUTLINE_TOKEN=\S+ \.\/dev run (.*)$/m) ?? assert.fail("docs/install.md has no command for the proxy");
  return line.trim().split(/\s+/);
}

async function start_nginx(folder, ports) {
  const nginx = ["/usr/sbin/nginx", "/usr/bin/nginx"].find(existsSync) ?? "nginx";
  execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-days", "2",
    "-subj", `/CN=${kName}`, "-addext", `subjectAltName=DNS:${kName}`, "-keyout", join(folder, "key.pem"), "-out", join(folder, "cert.pem")],
    { stdio: "ignore" });
  mkdirSync(join(folder, "tmp"));
  const temporary = ["client_body", "proxy", "fastcgi", "uwsgi", "scgi"].map((n) => `${n}_temp_path ${folder}/tmp/${n};`).join(" ");
  const conf = join(folder, "nginx.conf");
  writeFileSync(conf, `daemon off; pid ${folder}/nginx.pid; error_log ${folder}/error.log; worker_processes 1;
events { worker_connections 2048; }
http { access_log off; ${temporary}
${recipe({ folder, ...ports })}
}`);
  execFileSync(nginx, ["-t", "-c", conf], { stdio: "pipe" });
  const child = spawn(nginx, ["-c", conf], { stdio: "ignore" });
  await until("nginx", 20, () => ask({ port: ports.tls, path: "/" }).then((a) => a.status, () => 0), (status) => status !== 0);
  return () => new Promise((resolve) => {
    child.once("exit", resolve);
    child.kill("SIGTERM");
  });
}

/** One request to the proxy as a browser at `from` would make it. */
function ask({ port, path, method = "GET", body, headers = {}, from = "127.0.0.1", agent }) {
  return new Promise((resolve, reject) => {
    const request = https.request({
      host: "127.0.0.1", port, path, method, localAddress: from, rejectUnauthorized: false, servername: kName, agent,
      headers: { Host: `${kName}:${port}`, ...(body ? { "Content-Type": "application/json" } : {}),
        ...(method === "GET" ? {} : { Origin: `https://${kName}:${port}` }), ...headers },
    }, (answer) => {
      let text = "";
      answer.on("data", (part) => (text += part));
      answer.on("end", () => resolve({ status: answer.statusCode, headers: answer.headers, text }));
    });
    request.on("error", reject);
    request.end(body);
  });
}

const log_in = (port, { token = kToken, ...more } = {}) =>
  ask({ port, path: "/api/v1/login", method: "POST", body: JSON.stringify({ token }), ...more });
const cookie_of = (answer) => answer.headers["set-cookie"][0].split(";")[0];

/** An open WebSocket that has been greeted; rejects with the status otherwise. */
function connect(port, { cookie = "", from = "127.0.0.1", origin = `https://${kName}:${port}` } = {}) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(`wss://127.0.0.1:${port}/ws`, [kSubprotocol], {
      localAddress: from, rejectUnauthorized: false, servername: kName, origin,
      headers: { Host: `${kName}:${port}`, ...(cookie ? { Cookie: cookie } : {}) },
    });
    socket.once("message", () => resolve(socket));
    socket.once("unexpected-response", (_, answer) => reject(new Error(String(answer.statusCode))));
    socket.once("error", reject);
  });
}

let place, server, stop_nginx, port;
before(async () => {
  place = scratch();
  process.env.TAUTLINE_TOKEN = kToken;
  port = await free_port();
  server = await serve({ database: place.database, more: documented_options() });
  stop_nginx = await start_nginx(place.folder, { tls: port, app: server.port });
});
after(async () => {
  await stop_nginx?.();
  await server?.stop();
  place?.remove();
});

test("page, login, cookie and WebSocket through TLS", { timeout: 60_000 }, async () => {
  const page = await ask({ port, path: "/" });
  assert.equal(page.status, 200);
  assert.match(page.headers["content-type"], /text\/html/);
  assert.equal((await ask({ port, path: "/api/v1/session" })).status, 401);

  const right = await log_in(port);
  assert.equal(right.status, 204, right.text);
  for (const part of [/; Secure/, /; HttpOnly/, /; SameSite=Strict/, /; Max-Age=\d{5,}/]) {
    assert.match(right.headers["set-cookie"][0], part);
  }
  const cookie = cookie_of(right);
  assert.equal((await ask({ port, path: "/api/v1/session", headers: { Cookie: cookie } })).status, 200);
  const stop = await ask({ port, path: "/api/v1/session/control", method: "POST", headers: { Cookie: cookie }, body: `{"action":"stop"}` });
  assert.equal(stop.status, 200, stop.text);

  const socket = await connect(port, { cookie });
  await assert.rejects(connect(port), /401/);
  await assert.rejects(connect(port, { cookie, origin: "https://evil.example" }), /403/);
  await assert.rejects(connect(port, { cookie, origin: `http://${kName}:${port}` }), /403/);

  const left = new Promise((resolve) => socket.once("close", resolve));
  const out = await ask({ port, path: "/api/v1/logout", method: "POST", headers: { Cookie: cookie } });
  assert.equal(out.status, 204);
  assert.match(out.headers["set-cookie"][0], /Max-Age=0.*; Secure/);
  assert.equal(await left, 1008);
  assert.equal((await ask({ port, path: "/api/v1/session", headers: { Cookie: cookie } })).status, 401);
});

test("forty visitors at once, and one who guesses tokens", { timeout: 120_000 }, async () => {
  const guesser = "127.0.9.9";
  const answers = [];
  for (let i = 0; i < 15; ++i) answers.push(await log_in(port, { token: `guess-number-${i}-of-many`, from: guesser }));
  assert.equal(answers[0].status, 401);
  assert.equal(answers.at(-1).status, 429);
  assert.ok(Number(answers.at(-1).headers["retry-after"]) > 0);

  const visitors = await Promise.all(Array.from({ length: 40 }, async (_, i) => {
    const from = `127.0.1.${i + 1}`;
    const agent = new https.Agent({ keepAlive: true, maxSockets: 6 }); // as a browser has
    const signed_in = await log_in(port, { from, agent });
    assert.equal(signed_in.status, 204, `${from}: ${signed_in.text}`);
    const cookie = cookie_of(signed_in);
    const socket = await connect(port, { cookie, from });
    const paths = ["/", "/api/v1/session", "/api/v1/catalog", "/api/v1/scenarios", "/api/v1/runs", "/api/v1/version"];
    for (const answer of await Promise.all(paths.map((path) => ask({ port, path, from, agent, headers: { Cookie: cookie } })))) {
      assert.equal(answer.status, 200, `${from}: ${answer.text.slice(0, 200)}`);
    }
    return { socket, agent };
  }));
  assert.equal(visitors.filter(({ socket }) => socket.readyState === WebSocket.OPEN).length, 40);
  for (const { socket, agent } of visitors) {
    socket.close();
    agent.destroy();
  }
  await until("the guesses in the log, by their own address", 5, () => server.said(), (said) => said.includes(`from ${guesser}`));
  assert.ok(!/guess-number|not-to-be-guessed/.test(server.said()), "no token in the log");
});

test("a browser signs in", { timeout: 90_000 }, async () => {
  const browser = await launch([`--host-resolver-rules=MAP ${kName} 127.0.0.1`]);
  try {
    const context = await browser.newContext({ ignoreHTTPSErrors: true });
    const page = await context.newPage();
    await page.goto(`https://${kName}:${port}/`);
    await page.getByTestId("token").fill(kToken);
    await page.getByTestId("login-go").click();
    await page.waitForSelector('[data-testid="link"].open', { timeout: 20_000 });
    const [cookie] = await context.cookies();
    assert.equal(cookie.secure, true);
    assert.equal(cookie.httpOnly, true);
    assert.ok(cookie.expires > Date.now() / 1000 + 3600, "it outlives the browser's session");
    await page.goto(`https://${kName}:${port}/#/system`);
    await page.getByTestId("logout").click();
    await page.getByTestId("token").waitFor();
    assert.deepEqual(await context.cookies(), []);
  } finally {
    await browser.close();
  }
});
