// web/src/link/session.ts: the session of this page: the one that its address names, else `main`.
import { own_name } from "./name";
import * as rest from "./rest";

/** The id in the address of this page; null: `main`. */
export function session_id(): string | null {
  return new URLSearchParams(location.search).get("session");
}

/** The address of the session's WebSocket. */
export function socket_url(): string {
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  const query = new URLSearchParams();
  const id = session_id();
  if (id !== null) query.set("session", id);
  if (own_name() !== "") query.set("name", own_name());
  return `${scheme}//${location.host}/ws${query.size > 0 ? `?${query}` : ""}`;
}

/** The REST path of the session, or of a resource `below` it, such as "/control". */
export function session_path(below = ""): string {
  const id = session_id();
  return (id === null ? "/session" : `/sessions/${encodeURIComponent(id)}`) + below;
}

/** Opens a session and puts its id into the address of this page. The caller connects again. */
export async function open_session(): Promise<void> {
  const { id } = await rest.post<{ id: string }>("/sessions", {});
  const url = new URL(location.href);
  url.searchParams.set("session", id);
  history.replaceState(null, "", url);
}
