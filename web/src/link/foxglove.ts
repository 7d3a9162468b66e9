// web/src/link/foxglove.ts: the bytes and texts of the Foxglove WebSocket protocol v1, without any
// I/O. Integers are little-endian.

export const kSubprotocols = ["foxglove.websocket.v1", "foxglove.sdk.v1"];

export interface Channel { id: number; topic: string; encoding: string; schemaName: string }
export interface Service { id: number; name: string }
export interface ParameterValue { name: string; value?: unknown; type?: string }

/** The text messages of a server that the page reads. */
export type ServerText =
  | { op: "serverInfo"; name: string; capabilities: string[]; sessionId?: string }
  | { op: "advertise"; channels: Channel[] }
  | { op: "unadvertise"; channelIds: number[] }
  | { op: "status"; level: number; message: string; id?: string }
  | { op: "parameterValues"; parameters: ParameterValue[]; id?: string }
  | { op: "advertiseServices"; services: Service[] }
  | { op: "unadvertiseServices"; serviceIds: number[] }
  | { op: "serviceCallFailure"; serviceId: number; callId: number; message: string };

export type ServerBinary =
  | { op: "message"; subscription: number; time_ns: bigint; payload: Uint8Array }
  | { op: "time"; time_ns: bigint }
  | { op: "service_response"; service: number; call: number; encoding: string; payload: Uint8Array };

const text_encoder = new TextEncoder();
const text_decoder = new TextDecoder();

/** A server's text frame, or nothing when it is no JSON object with an `op`. */
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

/** A server's binary frame, or nothing when a declared length does not fit or it is unknown. */
export function parse_binary(buffer: ArrayBuffer): ServerBinary | null {
  const view = new DataView(buffer);
  const size = buffer.byteLength;
  if (size < 1) return null;
  switch (view.getUint8(0)) {
    case 1:
      if (size < 13) return null;
      return {
        op: "message",
        subscription: view.getUint32(1, true),
        time_ns: view.getBigUint64(5, true),
        payload: new Uint8Array(buffer, 13),
      };
    case 2:
      return size < 9 ? null : { op: "time", time_ns: view.getBigUint64(1, true) };
    case 3: {
      if (size < 13) return null;
      const length = view.getUint32(9, true);
      if (13 + length > size) return null;
      return {
        op: "service_response",
        service: view.getUint32(1, true),
        call: view.getUint32(5, true),
        encoding: text_decoder.decode(new Uint8Array(buffer, 13, length)),
        payload: new Uint8Array(buffer, 13 + length),
      };
    }
    default:
      return null;
  }
}

export function payload_json(payload: Uint8Array): unknown {
  return JSON.parse(text_decoder.decode(payload));
}

/** Opcode 2: a service request with a JSON body. */
export function service_request(service: number, call: number, body: unknown): Uint8Array {
  const encoding = text_encoder.encode("json");
  const payload = text_encoder.encode(JSON.stringify(body));
  const out = new Uint8Array(13 + encoding.length + payload.length);
  const view = new DataView(out.buffer);
  view.setUint8(0, 2);
  view.setUint32(1, service, true);
  view.setUint32(5, call, true);
  view.setUint32(9, encoding.length, true);
  out.set(encoding, 13);
  out.set(payload, 13 + encoding.length);
  return out;
}
