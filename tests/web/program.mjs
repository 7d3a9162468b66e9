// tests/web/program.mjs: starts and stops the program under test; finds packages of web/.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

export const repository = dirname(dirname(dirname(fileURLToPath(import.meta.url))));
export const require = createRequire(join(repository, "web/package.json"));
export const binary = process.env.TAUTLINE_BIN ?? join(repository, "build/release/server/tautline");

export const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;

/** A folder for one test's database, gone with `remove`. */
export function scratch() {
  const folder = mkdtempSync(join(tmpdir(), "tautline-web-"));
  return { folder, database: join(folder, "runs.db"), remove: () => rmSync(folder, { recursive: true, force: true }) };
}

/**
 * `tautline serve` on a free port (or `port`), once it has printed its address; `scenario` null: none.
 * `limit`: a shell command to run first, such as "ulimit -f 400".
 */
export async function serve({ database, scenario = "case1", port = 0, more = [], limit = ":" }) {
  const args = ["serve", "--port", String(port), "--db", database, ...more];
  if (scenario) args.push("--scenario", scenario);
  const child = spawn("bash", ["-c", `${limit}; exec "$0" "$@"`, binary, ...args],
    { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  const address = await new Promise((resolve, reject) => {
    const late = setTimeout(() => reject(new Error(`no address within 20 s; it said:\n${said}`)), 20_000);
    const hear = (bytes) => {
      said += bytes;
      const found = said.match(/http:\/\/[\w.:[\]-]+/);
      if (found) {
        clearTimeout(late);
        resolve(found[0]);
      }
    };
    child.stdout.on("data", hear);
    child.stderr.on("data", hear);
    child.on("error", reject);
    child.on("exit", (code) => reject(new Error(`${binary} ended with ${code}:\n${said}`)));
  });
  const ended = () => child.exitCode !== null || child.signalCode !== null;
  const url = new URL(address);
  return {
    base: `http://${url.host}`,
    port: Number(url.port),
    pid: child.pid,
    said: () => said,
    /** Closes the pipes that the program speaks into. */
    hang_up: () => [child.stdout, child.stderr].forEach((stream) => stream.destroy()),
    kill: () => child.kill("SIGKILL"),
    /** Its exit status; rejects when the program has ended before it was told to. */
    stop: (signal = "SIGTERM") => new Promise((resolve, reject) => {
      if (ended()) {
        reject(new Error(`the program ended by itself (${child.exitCode ?? child.signalCode}):\n${said}`));
        return;
      }
      child.once("exit", (code) => resolve(code));
      child.kill(signal);
      setTimeout(() => child.kill("SIGKILL"), 10_000).unref();
    }),
  };
}

export async function json(base, path, options = {}) {
  const response = await fetch(`${base}/api/v1${path}`, {
    ...options,
    headers: options.body ? { "Content-Type": "application/json" } : {},
  });
  const text = await response.text();
  if (!response.ok) throw new Error(`${options.method ?? "GET"} ${path}: ${response.status} ${text}`);
  return text === "" ? null : JSON.parse(text);
}

/** Asks until `good` accepts the answer; throws `what` with the last answer after `seconds`. */
export async function until(what, seconds, ask, good = Boolean) {
  const end = Date.now() + seconds * 1000;
  let last;
  while (Date.now() < end) {
    last = await ask();
    if (good(last)) return last;
    await new Promise((resolve) => setTimeout(resolve, 150));
  }
  throw new Error(`${what}: not within ${seconds} s; last: ${JSON.stringify(last)?.slice(0, 400)}`);
}
