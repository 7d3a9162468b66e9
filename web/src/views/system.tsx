// web/src/views/system.tsx: the System view: who you are, server, storage, clients, log, session, keys.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { system_meaning } from "../figures";
import { SessionState } from "../contract";
import * as rest from "../link/rest";
import { drawing } from "../state/meter";
import css from "../style/system.css?text";
import { use_pulse } from "../state/store";
import { Facts, Problem, use_problem } from "../ui/controls";
import { use_me } from "../ui/guard";
import { adopt } from "../ui/sheet";
import { fixed, link_words, titled, watchers_words } from "../words";
import { Clients, ClientInfo, LogTail } from "./clients";
import { Devices } from "./hardware";
import { ShortcutTable } from "./shortcuts";
import { deeds } from "./watching";
import { You } from "./you";

adopt(css);

/** The answer of /system; what this page's role may not see is null. */
interface SystemInfo {
  version: string;
  started: string;
  storage: { status: string; sentence: string; bytes: number; limit: number };
  limits: {
    sessions: { open: number; most: number };
    session_runs: number;
    session_idle: number;
    connections: { open: number; most: number };
  };
  viewers: number;
  clients: ClientInfo[] | null;
  log: string[] | null;
}

const kPeriod = 2000; // [ms] between two questions

function use_system(): [SystemInfo | null, string | null] {
  const { link } = use_ui("link");
  const [system, set_system] = useState<SystemInfo | null>(null);
  const [problem, attempt] = use_problem();
  useEffect(() => {
    if (link.phase !== "open") return;
    const ask = () => void attempt(async () => set_system(await rest.get<SystemInfo>("/system")));
    ask();
    const timer = setInterval(ask, kPeriod);
    return () => clearInterval(timer);
  }, [link.phase]);
  return [system, problem];
}

export function System(): JSX.Element {
  const app = use_app();
  const { session, link, theme } = use_ui("session", "link", "theme");
  const me = use_me();
  const [system, problem] = use_system();
  use_pulse(500);
  return (
    <main class="system" aria-label="System">
      <You />
      <section class="card block" data-testid="server">
        <h2>Server</h2>
        <Problem text={problem} />
        <Facts meaning={system_meaning} rows={system ? server_rows(system) : [["Version", "not known yet"]]} />
        <p class="quiet">The folder docs of the project explains it: first-steps.md, interfaces.md,
          hardware.md, install.md.</p>
      </section>
      <section class="card block">
        <h2>Connection</h2>
        <Facts meaning={system_meaning} rows={[
          ["State", link_words(link, performance.now())],
          ["Address", location.host],
          ["WebSocket", "/ws, Foxglove protocol v1"],
          ["REST", "/api/v1"],
          ["Drawing a frame", drawing.words() ?? "nothing is drawn yet"],
        ]} />
        <div class="facts-acts">
          <button class="ghost" onClick={() => app.set_theme(theme === "dark" ? "light" : "dark")}>
            Use the {theme === "dark" ? "light" : "dark"} theme
          </button>
          <a class="ghost" href="/api/v1/openapi.json" target="_blank" rel="noreferrer">OpenAPI document</a>
        </div>
      </section>
      {session?.hardware && <Devices hardware={session.hardware} />}
      {session && <section class="card block">
        <h2>Session</h2>
        <Facts meaning={system_meaning} rows={session_rows(session, deeds(session, me))} />
      </section>}
      {system?.clients && <Clients clients={system.clients} />}
      {system?.log && <LogTail lines={system.log} />}
      <section class="card block keys-block">
        <h2>Keys</h2>
        <ShortcutTable />
        <p class="quiet">Stop brings the robot to rest by its own brakes. It does not replace an emergency stop.</p>
      </section>
    </main>
  );
}

function server_rows(system: SystemInfo): [string, string][] {
  const { storage, limits } = system;
  return [
    ["Version", system.version],
    ["Started", new Date(system.started).toLocaleString()],
    ["Storage", `${size(storage.bytes)} ${storage.limit > 0 ? `of ${size(storage.limit)}` : "in use"}`],
    ["Record", storage.sentence],
    ["Connected", system.viewers === 1 ? "1 page or script" : `${system.viewers} pages and scripts`],
    ["Connections", `${limits.connections.open} of ${limits.connections.most}`],
    ["Sessions beside main", `${limits.sessions.open} of ${limits.sessions.most}`],
    ["Loads of such a session", limits.session_runs > 0 ? `at most ${limits.session_runs}` : "no limit"],
    ["It ends unused after", `${fixed(limits.session_idle / 60, 0)} min`],
  ];
}

function session_rows(session: SessionState, said: string[]): [string, string][] {
  return [
    ["Robot", titled(session.robot.name)],
    ["Source", titled(session.source)],
    ["Scenario", titled(session.scenario.name)],
    ["Run", session.run ? `${session.run.id}, ${session.run.status}` : "none is recorded"],
    ["Tick", `${fixed(session.robot.period * 1000, 0)} ms`],
    ["Hull radius", `${fixed(session.robot.radius, 2)} m`],
    ["Limits", `${fixed(session.robot.max_v, 2)} m/s, ${fixed(session.robot.max_omega, 2)} rad/s`],
    ["Seed", String(session.seed)],
    ["Watched", watchers_words(session)],
    ["Last deeds", said.length > 0 ? said.join(" ") : "none that holds"],
    ["Record", session.record.sentence],
    ...(session.record.deleted ? [["Deleted", session.record.deleted] as [string, string]] : []),
    ["Lost ticks", String(session.lost_ticks)],
    ["Missed periods", String(session.missed_periods)],
  ];
}

function size(bytes: number): string {
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(1)} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(1)} MB` : `${(bytes / 1e9).toFixed(2)} GB`;
}
