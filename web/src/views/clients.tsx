// web/src/views/clients.tsx: the clients of the server with their rates, and the end of its log.
import { JSX } from "preact";
import { useRef } from "preact/hooks";
import { fixed } from "../words";

export interface ClientInfo {
  id: number;
  role: string;
  name: string;
  address: string;
  session: string;
  since: string;
  messages: number; // sent to it
  bytes: number;
  dropped: number;  // older messages that newer ones have replaced
}

interface Rate { messages: number; bytes: number } // a second
interface Asked { at: number; clients: ClientInfo[]; rates: Map<number, Rate> }

/** Rates since the list before this one, by the client's number. */
function use_rates(clients: ClientInfo[]): Map<number, Rate> {
  const last = useRef<Asked | null>(null);
  if (last.current?.clients === clients) return last.current.rates;
  const at = performance.now();
  const rates = new Map<number, Rate>();
  const seconds = last.current ? (at - last.current.at) / 1000 : 0;
  for (const c of clients) {
    const before = last.current?.clients.find((b) => b.id === c.id);
    if (!before || seconds <= 0) continue;
    rates.set(c.id, { messages: (c.messages - before.messages) / seconds, bytes: (c.bytes - before.bytes) / seconds });
  }
  last.current = { at, clients, rates };
  return rates;
}

export function Clients(props: { clients: ClientInfo[] }): JSX.Element {
  const rates = use_rates(props.clients);
  return (
    <section class="card block wide-block" data-testid="clients">
      <h2>Clients</h2>
      <div class="clients-scroll" tabIndex={0} role="region" aria-label="Clients">
        <table class="clients">
          <thead><tr>
            <th>Name</th><th>Role</th><th>Address</th><th>Session</th><th>Since</th><th>Messages/s</th><th>kB/s</th>
            <th>Left out</th>
          </tr></thead>
          <tbody>
            {props.clients.map((c) => {
              const rate = rates.get(c.id);
              return (
                <tr key={c.id}>
                  <td>{c.name || "–"}</td><td>{c.role}</td><td class="num">{c.address}</td>
                  <td>{c.session === "main" ? "main" : `${c.session.slice(0, 8)}…`}</td>
                  <td class="num">{new Date(c.since).toLocaleTimeString()}</td>
                  <td class="num" data-testid="rate">{fixed(rate?.messages, 0)}</td>
                  <td class="num">{fixed(rate && rate.bytes / 1000, 1)}</td>
                  <td class="num">{c.dropped}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      </div>
    </section>
  );
}

export function LogTail(props: { lines: string[] }): JSX.Element {
  return (
    <section class="card block wide-block" data-testid="log">
      <h2>The server's log</h2>
      {props.lines.length === 0 ? <p class="quiet">Nothing has been logged since the start.</p>
        : <pre class="log-tail" tabIndex={0} aria-label="The newest lines of the log">
          {[...props.lines].reverse().join("\n")}</pre>}
    </section>
  );
}
