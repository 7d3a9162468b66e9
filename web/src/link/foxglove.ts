// web/src/link/foxglove.ts: the bytes and texts of the Foxglove WebSocket protocol v1, without any
// I/O. Integers are little-endian.

export const kSubprotocols = ["foxglove.websocket.v1", "foxglove.sdk.v1"];

export interface ParameterValue { name: string; value?: unknown }

/** The server's text messages, and of each the fields that the page reads. */
export type ServerText =
  | { op: "serverInfo"; sessionId?: string }
  | { op: "advertise"; channels: { id: number; topic: string }[] }
  | { op: "status"; level: number; message: string }
  | { op: "parameterValues"; parameters: ParameterValue[]; id?: string }
  | { op: "advertiseServices"; services: { id: number; name: string }[] }
  | { op: "unadvertiseServices"; serviceIds: number[] }
  | { op: "serviceCallFailure"; callId: number; message: string };

export type ServerBinary =
  | { op: "message"; subscription: number; payload: Uint8Array }
  | { op: "service_response"; call: number; payload: Uint8Array };

const text_encoder = new TextEncoder();
const text_decoder = new TextDecoder();

/** The message in a text frame; null unless it is a JSON object with an `op`. */
export function parse_text(text: string): ServerText | null {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return null;
  }
  const known = typeof value === "object" && value !== null && "op" in value;
  return known ? (value as ServerText) : null;
}

const kHead = 13; // bytes before the payload of message data, and before the encoding of an answer

/** The message in a binary frame; null if it is cut short or of an unknown kind. */
export function parse_binary(buffer: ArrayBuffer): ServerBinary | null {
  const view = new DataView(buffer);
  if (buffer.byteLength < kHead) return null;
  const kind = view.getUint8(0);
  if (kind === 1) {
    return { op: "message", subscription: view.getUint32(1, true), payload: new Uint8Array(buffer, kHead) };
  }
  const start = kHead + view.getUint32(9, true); // behind the name of the encoding, which is JSON
  if (kind !== 3 || start > buffer.byteLength) return null;
  return { op: "service_response", call: view.getUint32(5, true), payload: new Uint8Array(buffer, start) };
}

export function payload_json(payload: Uint8Array): unknown {
  return JSON.parse(text_decoder.decode(payload));
}

/** Opcode 2: a service request with a JSON body. */
export function service_request(service: number, call: number, body: unknown): Uint8Array {
  const encoding = text_encoder.encode("json");
  const payload = text_encoder.encode(JSON.stringify(body));
  const out = new Uint8Array(kHead + encoding.length + payload.length);
  const view = new DataView(out.buffer);
  view.setUint8(0, 2);
  view.setUint32(1, service, true);
  view.setUint32(5, call, true);
  view.setUint32(9, encoding.length, true);
  out.set(encoding, kHead);
  out.set(payload, kHead + encoding.length);
  return out;
}
