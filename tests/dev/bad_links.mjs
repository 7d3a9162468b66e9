// tests/dev/bad_links.mjs: drives from the page over slow, jittering, lossy and broken links, a simulated robot and
// an emulated one, and prints the table of docs/teleoperation.md. Exit status 1 when the robot touched anything,
// moved after a hand had let go, or obeyed a stick of before an outage.
//
//   node tests/dev/bad_links.mjs [SECONDS of each drive, 30]
//
// Loss needs a network of its own, and so the right to make one (root); without it these rows are left out.
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { arm, devices } from "../web/devices.mjs";
import { launch, open } from "../web/page.mjs";
import { json, scratch, serve, until } from "../web/program.mjs";
import { slow_link } from "../web/slow_link.mjs";

const kLinks = [
  { name: "100 ms", round_trip: 100 },
  { name: "300 ms", round_trip: 300 },
  { name: "450 ms", round_trip: 450 },
  { name: "600 ms", round_trip: 600 },
  { name: "100 ms, 50 ms jitter", round_trip: 75, jitter: 50 },
  { name: "100 ms, 5 % loss", round_trip: 100, loss: 0.05 },
  { name: "100 ms, 10 s outage", round_trip: 100, outage: 10_000 },
];
const kKeys = [["w"], ["w", "a"], ["w", "d"], ["w"], ["s"], ["a"], ["d"], ["s", "d"]];
const kRadius = 0.35; // [m] of the hull

const wall = (x, y, width, depth) => ({
  type: "polygon", x, y, heading: 0,
  points: [[-width / 2, -depth / 2], [width / 2, -depth / 2], [width / 2, depth / 2], [-width / 2, depth / 2]],
});
/** A closed room of 5 m by 4 m with posts: wherever a hand drives for long, there is something to touch. */
const room = {
  name: "bad_links",
  start: { x: 1, y: 2, heading: 0 },
  goal: { x: 4, y: 2 },
  obstacles: [
    wall(2.5, -0.05, 5.2, 0.1), wall(2.5, 4.05, 5.2, 0.1), wall(-0.05, 2, 0.1, 4), wall(5.05, 2, 0.1, 4),
    wall(2.6, 3.0, 0.3, 0.3), wall(3.4, 1.1, 0.3, 0.3),
  ],
};

/** [m] From the hull of a robot at x, y to the nearest obstacle of the room, whose sides lie along the axes. */
function clearance(x, y) {
  return Math.min(...room.obstacles.map((o) => {
    const [half_x, half_y] = o.points[2];
    return Math.hypot(Math.max(0, Math.abs(x - o.x) - half_x), Math.max(0, Math.abs(y - o.y) - half_y));
  })) - kRadius;
}

const sleep = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
/** Numbers in [0, 1) that are the same each time. */
function seeded(seed) {
  return () => (seed = (seed * 16807) % 2147483647) / 2147483647;
}

/** Random full sticks for `seconds`; the middle at the end. */
async function drive(p, seconds, random) {
  const end = Date.now() + seconds * 1000;
  while (Date.now() < end) {
    const keys = kKeys[Math.floor(random() * kKeys.length)];
    for (const key of keys) await p.page.keyboard.down(key);
    await sleep(400 + 1600 * random());
    for (const key of keys) await p.page.keyboard.up(key);
    if (random() < 0.3) await sleep(300);
  }
}

/** Packets to and from `port` are lost with probability `loss`; 0 ends that. */
function lose(port, loss) {
  execFileSync("iptables", ["-F", "INPUT"]);
  if (loss > 0) {
    for (const end of ["--dport", "--sport"]) {
      execFileSync("iptables", ["-A", "INPUT", "-p", "tcp", end, String(port), "-m", "statistic", "--mode", "random",
        "--probability", String(loss), "-j", "DROP"]);
    }
  }
}

/** The rows of the run's record as objects of numbers, from tick `from` on. */
async function record(base, run, from) {
  const text = await (await fetch(`${base}/api/v1/runs/${run}/csv`)).text();
  const [head, ...rows] = text.trim().split("\n").map((line) => line.split(","));
  return rows.filter((row) => Number(row[0]) >= from)
    .map((row) => Object.fromEntries(head.map((name, i) => [name, row[i]])));
}

/** One drive over `about` by a page of `browser`; the figures of its row. `truth` knows where the emulated robot was. */
async function trial(browser, server, about, seconds, truth) {
  const session = () => json(server.base, "/session");
  const act = (action) => json(server.base, "/session/control", { method: "POST", body: JSON.stringify({ action }) });
  const rests = async () => Math.hypot(...Object.values((await session()).command)) < 1e-9;
  const link = await slow_link(server.port);
  const p = await open(browser, link.base, { hash: "#/teleop" });
  try {
    await p.get("hand-stick").waitFor();
    if (truth) {
      await arm(p, session);
    } else {
      await act("reset");
      await json(server.base, "/session/goal", { method: "DELETE" });
    }
    link.set_round_trip(about.round_trip, about.jitter);
    if (about.loss) lose(server.port, about.loss);
    await sleep(4000); // the link's figure settles
    const { tick: first, run } = await session();
    truth?.mark();
    await drive(p, seconds, seeded(7));
    // The outage comes with a stick pushed.
    let since = Infinity, stopped = "", resumed = false;
    if (about.outage) {
      await p.page.keyboard.down("a");
      await sleep(1500);
      const heard = link.hold(), at = Date.now();
      await until("at rest in the outage", 10, rests);
      stopped = `${((Date.now() - at) / 1000).toFixed(1)} s`;
      since = (await session()).tick + 10;
      await sleep(about.outage);
      heard();
      await sleep(4000); // the key is still held
      resumed = !(await rests());
    }
    for (const key of ["w", "a", "s", "d"]) await p.page.keyboard.up(key);
    await sleep(3000);
    const after = await session();
    await sleep(1000); // the record is written
    const rows = await record(server.base, run.id, first);
    const poses = truth ? truth.poses() : rows.map((row) => [Number(row["truth.x"]), Number(row["truth.y"])]);
    let way = 0;
    for (let i = 1; i < poses.length; ++i) way += Math.hypot(poses[i][0] - poses[i - 1][0], poses[i][1] - poses[i - 1][1]);
    const pushed = rows.filter((row) => Number(row["stick.forward"]) || Number(row["stick.turn"]));
    const trips = pushed.map((row) => Number(row["stick.round_trip"])).sort((a, b) => a - b);
    return {
      name: about.name,
      measured: trips.length ? `${Math.round(1000 * trips[trips.length >> 1])} ms` : "no stick accepted",
      way,
      least: Math.min(...poses.map(([x, y]) => clearance(x, y))),
      still: Math.hypot(...Object.values(after.command)) < 1e-9,
      stale: pushed.filter((row) => Number(row.tick) >= since).length,
      refused: Object.values(after.driving.dropped).reduce((a, b) => a + b, 0),
      stopped,
      resumed,
    };
  } finally {
    if (about.loss) lose(server.port, 0);
    p.forgive(/./); // a broken link is no fault of the page
    await p.close();
    await link.close();
  }
}

/** The true poses [m] of the emulated robot since `mark`, from the emulator's record. */
function truth_of(path) {
  let from = 0;
  const text = () => readFileSync(path, "utf8");
  return {
    mark: () => (from = text().length),
    poses: () => text().slice(from).split("\n").filter((line) => line.startsWith("pose "))
      .map((line) => line.split(" ").slice(2, 4).map((mm) => Number(mm) / 1000)),
  };
}

/** All links, on a simulated or an emulated robot; whether all went well. */
async function all_links(browser, links, seconds, emulated) {
  const place = scratch();
  const world = join(place.folder, "bad_links.json");
  writeFileSync(world, JSON.stringify(room));
  const path = join(place.folder, "truth");
  const robot = emulated ? await devices(place.folder, { scenario: world, record: path, speed: 0.3 }) : null;
  let server = null, well = true;
  try {
    server = await serve({
      database: place.database, scenario: emulated ? null : world, more: emulated ? ["--robot", robot.file] : [],
    });
    if (emulated) await until("a scan", 30, () => json(server.base, "/session"), (s) => s.hardware.devices.every((d) => d.well));
    for (const about of links) {
      const row = await trial(browser, server, about, seconds, emulated ? truth_of(path) : null);
      const good = row.least > 0 && row.still && row.stale === 0 && !row.resumed && (about.round_trip <= 500 || row.way < 0.02);
      well = well && good;
      console.log(`| ${emulated ? "emulated" : "simulated"} | ${row.name} | ${row.measured} | ${row.way.toFixed(1)} m | ` +
        `${(100 * row.least).toFixed(0)} cm | ${row.refused} | ${row.stopped || "-"} | ${row.stale} | ${good ? "held" : "FAILED"} |`);
    }
  } finally {
    await server?.stop();
    robot?.end();
    place.remove();
  }
  return well;
}

async function main() {
  if (!process.env.BAD_LINKS_INSIDE && spawnSync("unshare", ["--net", "true"]).status === 0) {
    const script = 'ip link set lo up && exec "$0" "$@"';
    const child = spawn("unshare", ["--net", "bash", "-c", script, process.execPath, ...process.argv.slice(1)],
      { stdio: "inherit", env: { ...process.env, BAD_LINKS_INSIDE: "1" } });
    return new Promise((resolve) => child.on("exit", (code) => resolve(code ?? 1)));
  }
  const seconds = Number(process.argv[2] ?? 30);
  const lossy = process.env.BAD_LINKS_INSIDE && spawnSync("iptables", ["-L", "INPUT"]).status === 0;
  if (!lossy) console.error("NOT TRIED: loss. It needs a network namespace (root) and iptables.");
  const links = kLinks.filter((about) => lossy || !about.loss);
  console.log("| robot | round trip | measured | driven | nearest to anything | sticks dropped | outage: at rest after | stale sticks obeyed | |");
  console.log("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
  const browser = await launch();
  try {
    const simulated = await all_links(browser, links, seconds, false);
    const emulated = await all_links(browser, links, seconds, true);
    return simulated && emulated ? 0 : 1;
  } finally {
    await browser.close();
  }
}

process.exit(await main());
