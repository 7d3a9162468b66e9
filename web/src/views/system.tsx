// web/src/views/system.tsx: the System view: server, connection, session, and keys.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import * as rest from "../link/rest";
import { use_pulse } from "../state/store";
import { Facts, Problem, use_problem } from "../ui/controls";
import { fixed, link_words, titled, watchers_words } from "../words";
import { Devices } from "./hardware";
import { ShortcutTable } from "./shortcuts";

export function System(): JSX.Element {
  const app = use_app();
  const { session, link, theme } = use_ui("session", "link", "theme");
  const [version, set_version] = useState<Record<string, unknown> | null>(null);
  const [problem, attempt] = use_problem();
  use_pulse(500);
  useEffect(() => {
    if (link.phase === "open") void attempt(async () => set_version(await rest.get("/version")));
  }, [link.phase]);
  return (
    <main class="system" aria-label="System">
      <section class="card block">
        <h2>Server</h2>
        <Problem text={problem} />
        <Facts rows={flat_rows(version)} />
      </section>
      <section class="card block">
        <h2>Connection</h2>
        <Facts rows={[
          ["State", link_words(link, performance.now())],
          ["Address", location.host],
          ["WebSocket", "/ws, Foxglove protocol v1"],
          ["REST", "/api/v1"],
        ]} />
        <div class="facts-acts">
          <button class="ghost" onClick={() => app.set_theme(theme === "dark" ? "light" : "dark")}>
            Use the {theme === "dark" ? "light" : "dark"} theme
          </button>
          <a class="ghost" href="/api/v1/openapi.json" target="_blank" rel="noreferrer">OpenAPI document</a>
          {version?.signed_in === true && <button class="ghost" data-testid="logout"
            onClick={() => void attempt(() => app.logout())}>Sign out</button>}
        </div>
      </section>
      {session?.hardware && <Devices hardware={session.hardware} />}
      {session && <section class="card block">
        <h2>Session</h2>
        <Facts rows={[
          ["Robot", titled(session.robot.name)],
          ["Source", titled(session.source)],
          ["Scenario", titled(session.scenario.name)],
          ["Run", session.run ? `${session.run.id}, ${session.run.status}` : "none is recorded"],
          ["Tick", `${fixed(session.robot.period * 1000, 0)} ms`],
          ["Hull radius", `${fixed(session.robot.radius, 2)} m`],
          ["Limits", `${fixed(session.robot.max_v, 2)} m/s, ${fixed(session.robot.max_omega, 2)} rad/s`],
          ["Seed", String(session.seed)],
          ["Watched", watchers_words(session)],
          ["Record", session.record.sentence],
          ...(session.record.deleted ? [["Deleted", session.record.deleted] as [string, string]] : []),
          ["Lost ticks", String(session.lost_ticks)],
          ["Missed periods", String(session.missed_periods)],
        ]} />
      </section>}
      <section class="card block keys-block">
        <h2>Keys</h2>
        <ShortcutTable />
        <p class="quiet">Stop brings the robot to rest by its own brakes. It does not replace an emergency stop.</p>
      </section>
    </main>
  );
}

/** The plain values of a document as rows, down to one level of nesting. */
function flat_rows(doc: Record<string, unknown> | null): [string, string][] {
  if (!doc) return [["Version", "not known yet"]];
  const rows: [string, string][] = [];
  for (const [name, value] of Object.entries(doc)) {
    if (value !== null && typeof value === "object") {
      for (const [inner, v] of Object.entries(value)) {
        if (v === null || typeof v !== "object") rows.push([`${titled(name)} ${inner.replace(/_/g, " ")}`, shown(inner, v)]);
      }
    } else {
      rows.push([titled(name), shown(name, value)]);
    }
  }
  return rows;
}

function shown(name: string, value: unknown): string {
  if (typeof value === "number" && /bytes|size/.test(name)) {
    return value < 1e6 ? `${(value / 1e3).toFixed(1)} kB` : `${(value / 1e6).toFixed(1)} MB`;
  }
  return String(value ?? "–");
}
