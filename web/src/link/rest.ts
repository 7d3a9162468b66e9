// web/src/link/rest.ts: GET, POST, PUT, PATCH, DELETE on /api/v1, with the server's own sentence on failure.
import { lease_key } from "./lease_key";
import { own_name } from "./name";

/** A failed request. The message is a sentence for people; the status is 0 without an answer. */
export class RestError extends Error {
  constructor(message: string, readonly status: number) {
    super(message);
  }
}

/** Who sends. A header holds no letters beyond ASCII as they are. */
function named(): Record<string, string> {
  const name = own_name(), key = lease_key();
  return {
    ...(name === "" ? {} : { "X-Tautline-Name": encodeURIComponent(name) }),
    ...(key === "" ? {} : { "X-Tautline-Lease": key }),
  };
}

async function ask(method: string, path: string, body?: unknown, signal?: AbortSignal):
  Promise<Response> {
  let response: Response;
  try {
    response = await fetch(`/api/v1${path}`, {
      method,
      headers: { ...named(), ...(body === undefined ? {} : { "Content-Type": "application/json" }) },
      body: body === undefined ? undefined : JSON.stringify(body),
      signal,
    });
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new RestError("The server cannot be reached. Nothing was changed.", 0);
  }
  if (response.ok) return response;
  let sentence = `The server answered ${response.status}.`;
  try {
    const problem = (await response.json()) as { detail?: string; title?: string };
    sentence = problem.detail ?? problem.title ?? sentence;
  } catch {
    // not a problem document: the sentence names the status alone
  }
  throw new RestError(sentence, response.status);
}

export async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  return (await (await ask("GET", path, undefined, signal)).json()) as T;
}

export async function get_bytes(path: string, signal?: AbortSignal):
  Promise<{ bytes: Uint8Array; next: number | null }> {
  const response = await ask("GET", path, undefined, signal);
  const next = response.headers.get("X-Next-Tick");
  return {
    bytes: new Uint8Array(await response.arrayBuffer()),
    next: next === null || next === "" ? null : Number(next),
  };
}

export async function post<T>(path: string, body: unknown): Promise<T> {
  const text = await (await ask("POST", path, body)).text();
  return (text === "" ? {} : JSON.parse(text)) as T;
}

export async function put<T>(path: string, body: unknown): Promise<T> {
  return (await (await ask("PUT", path, body)).json()) as T;
}

export async function patch<T>(path: string, body: unknown): Promise<T> {
  return (await (await ask("PATCH", path, body)).json()) as T;
}

export function remove(path: string): Promise<Response> {
  return ask("DELETE", path);
}
