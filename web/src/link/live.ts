// web/src/link/live.ts: the live session over /ws: subscribes, calls services, sets parameters,
// measures rate and round trip, and connects again after a loss.
import { SessionState } from "../contract";
import { Frame, Sweep, decode_frame, decode_sweep } from "./frame";
import {
  ParameterValue, ServerBinary, ServerText, kSubprotocols, parse_binary, parse_text, payload_json,
  service_request,
} from "./foxglove";
import { Legends } from "./legend";
import { NoAnswer } from "./no_answer";

export interface LinkStatus {
  phase: "connecting" | "open" | "lost";
  retry_at: number;       // [ms] performance.now() of the next try while lost; Infinity: the session is gone
  rate: number;           // [frames/s] received over the last second
  latency: number | null; // [ms] round trip; null before the first answer
}

export interface LinkEvents {
  frame(frame: Frame): void;
  /** A filtered scan; only while it is wanted. */
  filtered(sweep: Sweep): void;
  state(state: SessionState): void;
  status(status: LinkStatus): void;
  /** A sentence from the server; level 0 info, 1 warning, 2 error. */
  notice(level: number, message: string): void;
  log(message: string): void;
  /** Another server process or session: its run has nothing to do with the run before. */
  new_session(): void;
  /** There is no session at this address; the link waits for reconnect(). */
  gone(why: string): void;
}

/** The part of a WebSocket that the link uses; tests bring their own. */
export interface SocketLike {
  binaryType: string;
  readyState: number;
  bufferedAmount: number; // [byte] not yet sent
  send(data: string | Uint8Array<ArrayBuffer>): void;
  close(): void;
  onopen: (() => void) | null;
  onclose: ((event?: { code: number; reason: string }) => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  onerror: (() => void) | null;
}
export type OpenSocket = (url: string, protocols: string[]) => SocketLike;

type Timer = ReturnType<typeof setTimeout>;
interface Pending { resolve(value: unknown): void; reject(error: Error): void; timer: Timer }

const kTopics = ["/telemetry", "/state", "/log"];
const kFiltered = "/tautline/filtered";
const kCallTimeout = 10_000;   // [ms]
const kConnectTimeout = 8_000; // [ms]
const kSilenceLimit = 6_000;   // [ms] of silence after which the connection counts as lost
const kPingPeriod = 1_000;     // [ms]
const kGone = 4404;            // close code: there is no such session
export const kBackoff = [500, 1000]; // [ms] pauses before the tries to connect

export class LiveLink {
  private socket_: SocketLike | null = null;
  private attempt_ = 0;
  private services_ = new Map<string, number>();
  private channels_ = new Map<string, number>(); // by topic
  private subscriptions_ = new Map<number, string>();
  private legends_ = new Legends();
  private wants_filtered_ = false;
  private pending_ = new Map<number | string, Pending>(); // by id of the message
  private next_id_ = 1;
  private session_id_: string | null = null;
  private status_: LinkStatus = { phase: "connecting", retry_at: 0, rate: 0, latency: null };
  private arrivals_: number[] = [];
  private last_heard_ = 0;
  private connect_started_ = 0;
  private timer_: Timer | undefined;
  private retry_timer_: Timer | undefined;
  private closed_ = false;

  constructor(
    private readonly url_: () => string,
    private readonly events_: LinkEvents,
    private readonly open_: OpenSocket = (url, protocols) =>
      new WebSocket(url, protocols) as unknown as SocketLike,
  ) {}

  start(): void {
    this.timer_ = setInterval(() => this.heartbeat(), kPingPeriod);
    this.connect();
  }

  close(): void {
    this.closed_ = true;
    clearInterval(this.timer_);
    clearTimeout(this.retry_timer_);
    this.socket_?.close();
  }

  get is_open(): boolean {
    return this.status_.phase === "open";
  }

  /** Connects at once if the connection is lost. */
  retry_now(): void {
    if (this.status_.phase !== "lost") return;
    clearTimeout(this.retry_timer_);
    this.connect();
  }

  /** Connects again: to another address, or as somebody else. */
  reconnect(): void {
    if (this.socket_) this.lose();
    clearTimeout(this.retry_timer_);
    this.attempt_ = 0;
    this.connect();
  }

  /** Calls a service. Rejects with the server's sentence, or ours when there is no connection. */
  call<T = unknown>(name: string, body: unknown = {}): Promise<T> {
    const service = this.services_.get(name);
    if (this.is_open && service === undefined) {
      return Promise.reject(new Error(`This server does not offer ${name}.`));
    }
    const call = this.next_id_++;
    return this.ask<T>(call, () => this.send(service_request(service!, call, body)));
  }

  /** The answer to the message that `send` sends, which comes under `id`. */
  private ask<T>(id: number | string, send: () => void): Promise<T> {
    if (!this.is_open) {
      return Promise.reject(new Error("There is no connection to the server. Nothing was sent."));
    }
    return new Promise<T>((resolve, reject) => {
      const late = new NoAnswer("The server did not answer within 10 s.");
      const timer = setTimeout(() => this.settle(id, (call) => call.reject(late)), kCallTimeout);
      this.pending_.set(id, { resolve: resolve as (value: unknown) => void, reject, timer });
      send();
    });
  }

  /** Asks the server to compute and send filtered scans, or no longer to. */
  want_filtered(wanted: boolean): void {
    if (wanted === this.wants_filtered_) return;
    this.wants_filtered_ = wanted;
    if (wanted) {
      this.subscribe(kFiltered);
      return;
    }
    for (const [id, topic] of this.subscriptions_) {
      if (topic !== kFiltered) continue;
      this.subscriptions_.delete(id);
      this.send_json({ op: "unsubscribe", subscriptionIds: [id] });
    }
  }

  private subscribe(topic: string): void {
    const channel = this.channels_.get(topic);
    if (channel === undefined) return;
    const id = this.next_id_++;
    this.subscriptions_.set(id, topic);
    this.send_json({ op: "subscribe", subscriptions: [{ id, channelId: channel }] });
  }

  /** Calls a service without waiting for the answer; does nothing without a connection. */
  tell(name: string): void {
    const service = this.services_.get(name);
    if (this.is_open && service !== undefined) this.send(service_request(service, this.next_id_++, {}));
  }

  /** Whether everything said so far has left this computer. */
  get is_clear(): boolean {
    return this.is_open && this.socket_?.bufferedAmount === 0;
  }

  /** [ms] Since the last message of the server. */
  get silence(): number {
    return now() - this.last_heard_;
  }

  /** Sets a parameter; resolves with the server's value, which may be the old one. */
  async set_parameter(name: string, value: number): Promise<number> {
    const id = `set-${this.next_id_++}`;
    const values = await this.ask<ParameterValue[]>(id, () =>
      this.send_json({ op: "setParameters", id, parameters: [{ name, value, type: "float64" }] }));
    const held = values.find((v) => v.name === name)?.value;
    return typeof held === "number" ? held : value;
  }

  private connect(): void {
    if (this.closed_) return;
    this.update({ phase: "connecting", latency: null, rate: 0 });
    this.connect_started_ = now();
    this.last_heard_ = now();
    let socket: SocketLike;
    try {
      socket = this.open_(this.url_(), kSubprotocols);
    } catch {
      this.lose();
      return;
    }
    this.socket_ = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.last_heard_ = now();
      this.attempt_ = 0;
      this.update({ phase: "open" });
      this.send_json({ op: "subscribeParameterUpdates", parameterNames: [] });
    };
    socket.onmessage = (event) => {
      if (socket === this.socket_) this.receive(event.data);
    };
    socket.onclose = (event) => {
      if (socket !== this.socket_) return;
      this.lose();
      if (event?.code !== kGone) return;
      clearTimeout(this.retry_timer_);
      this.update({ retry_at: Infinity });
      this.events_.gone(event.reason);
    };
    socket.onerror = () => undefined; // a close always follows
  }

  private lose(): void {
    const socket = this.socket_;
    this.socket_ = null;
    if (socket) socket.onclose = null;
    socket?.close();
    this.services_.clear();
    this.channels_.clear();
    this.subscriptions_.clear();
    const lost = new Error("The connection was lost before the server answered.");
    for (const id of this.pending_.keys()) this.settle(id, (call) => call.reject(lost));
    if (this.closed_) return;
    const pause = kBackoff[Math.min(this.attempt_++, kBackoff.length - 1)];
    this.update({ phase: "lost", retry_at: now() + pause, rate: 0, latency: null });
    this.retry_timer_ = setTimeout(() => this.connect(), pause);
  }

  private receive(data: unknown): void {
    this.last_heard_ = now();
    if (typeof data === "string") {
      const message = parse_text(data);
      if (message) this.text(message);
    } else if (data instanceof ArrayBuffer) {
      const message = parse_binary(data);
      if (message) this.binary(message);
    }
  }

  private text(message: ServerText): void {
    switch (message.op) {
      case "serverInfo":
        if (this.session_id_ !== null && message.sessionId !== this.session_id_) {
          this.events_.new_session();
        }
        this.session_id_ = message.sessionId ?? null;
        break;
      case "advertise":
        for (const channel of message.channels) {
          this.channels_.set(channel.topic, channel.id);
          if (kTopics.includes(channel.topic) || (channel.topic === kFiltered && this.wants_filtered_)) {
            this.subscribe(channel.topic);
          }
        }
        break;
      case "advertiseServices":
        for (const service of message.services) this.services_.set(service.name, service.id);
        break;
      case "unadvertiseServices":
        for (const [name, id] of this.services_) {
          if (message.serviceIds.includes(id)) this.services_.delete(name);
        }
        break;
      case "status":
        this.events_.notice(message.level, message.message);
        break;
      case "parameterValues":
        if (message.id !== undefined) this.settle(message.id, (call) => call.resolve(message.parameters));
        break;
      case "serviceCallFailure":
        this.settle(message.callId, (call) => call.reject(new Error(message.message)));
        break;
    }
  }

  private binary(message: ServerBinary): void {
    if (message.op === "service_response") {
      this.settle(message.call, (call) => {
        try {
          call.resolve(payload_json(message.payload));
        } catch {
          call.reject(new Error("The server's answer could not be read."));
        }
      });
    } else if (message.op === "message") {
      this.publish(this.subscriptions_.get(message.subscription), message.payload);
    }
  }

  private publish(topic: string | undefined, payload: Uint8Array): void {
    try {
      if (topic === "/telemetry") {
        this.arrivals_.push(now());
        this.events_.frame(decode_frame(payload, this.legends_));
      } else if (topic === kFiltered) {
        const sweep = decode_sweep(payload);
        if (sweep) this.events_.filtered(sweep);
      } else if (topic === "/state") {
        this.events_.state(payload_json(payload) as SessionState);
      } else if (topic === "/log") {
        this.events_.log((payload_json(payload) as { message: string }).message);
      }
    } catch (error) {
      console.warn(`Tautline: a message on ${topic} could not be read`, error);
    }
  }

  private settle(id: number | string, act: (call: Pending) => void): void {
    const call = this.pending_.get(id);
    if (!call) return;
    this.pending_.delete(id);
    clearTimeout(call.timer);
    act(call);
  }

  private heartbeat(): void {
    const t = now();
    if (this.status_.phase === "connecting" && t - this.connect_started_ > kConnectTimeout) {
      this.lose();
    } else if (this.status_.phase === "open") {
      if (t - this.last_heard_ > kSilenceLimit) {
        this.lose();
        return;
      }
      while (this.arrivals_.length > 0 && this.arrivals_[0] < t - 1000) this.arrivals_.shift();
      this.update({ rate: this.arrivals_.length });
      this.ping().catch(() => undefined); // the silence tells of a lost connection
    }
  }

  private async ping(): Promise<void> {
    const sent = now();
    const id = `ping-${this.next_id_++}`;
    await this.ask(id, () => this.send_json({ op: "getParameters", parameterNames: ["k_r"], id }));
    const round_trip = now() - sent;
    const old = this.status_.latency;
    this.update({ latency: old === null ? round_trip : 0.7 * old + 0.3 * round_trip });
  }

  private send(data: string | Uint8Array): void {
    if (this.socket_?.readyState === 1) this.socket_.send(data as string | Uint8Array<ArrayBuffer>);
  }
  private send_json(message: unknown): void {
    this.send(JSON.stringify(message));
  }

  private update(change: Partial<LinkStatus>): void {
    this.status_ = { ...this.status_, ...change };
    this.events_.status(this.status_);
  }
}

function now(): number {
  return performance.now();
}
