// web/src/words.ts: states, outcomes and numbers in words.
import { RunItem, SessionState } from "./contract";
import { LinkStatus } from "./link/live";
import { Frame } from "./link/frame";
import { age_words, motion, news_age } from "./state/age";
import { SceneState } from "./state/scene";

export type Tone = "ok" | "warn" | "bad" | "info" | "muted";
export interface Word { word: string; tone: Tone }

/** `value` with `digits` after the point and a typographic minus; a dash if there is no number. */
export function fixed(value: number | null | undefined, digits: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const text = Math.abs(value).toFixed(digits);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** "mm:ss.t"; from an hour on "h:mm:ss". */
export function clock(seconds: number): string {
  const tenths = Math.max(0, Math.round(seconds * 10));
  const s = Math.floor(tenths / 10);
  const two = (n: number) => String(n).padStart(2, "0");
  if (s >= 3600) return `${Math.floor(s / 3600)}:${two(Math.floor(s / 60) % 60)}:${two(s % 60)}`;
  return `${two(Math.floor(s / 60))}:${two(s % 60)}.${tenths % 10}`;
}

export function link_words(status: LinkStatus, now: number): string {
  if (status.phase === "connecting") return "Connecting";
  if (status.phase === "lost") {
    if (status.retry_at === Infinity) return "No session";
    const wait = Math.max(0, Math.ceil((status.retry_at - now) / 1000));
    return wait > 0 ? `Connection lost. Trying again in ${wait} s.` : "Connection lost. Trying now.";
  }
  const parts = ["Connected", `${status.rate} frames/s`];
  if (status.latency !== null) parts.push(`${Math.max(1, Math.round(status.latency))} ms`);
  return parts.join(" · ");
}

/** The state of the live robot. */
export function state_word(frame: Frame | null, session: SessionState | null, open: boolean): Word {
  if (!open) return { word: "No link", tone: "bad" };
  if (!session) return { word: "Waiting", tone: "muted" };
  if (session.stop || frame?.hold === "stopped") return { word: moving(frame) ? "Stopping" : "Stopped", tone: "bad" };
  if (session.pace.paused) return { word: "Paused", tone: "info" };
  if (frame && frame.hold !== "none") return { word: "Held", tone: "bad" };
  if (session.source === "replay") return { word: "Replaying", tone: "info" };
  return frame_word(frame);
}

/** At rest below the resolution of odometry. */
function moving(frame: Frame | null): boolean {
  return frame !== null && Math.hypot(frame.twist.v, frame.twist.omega) > 0.01;
}

/** "watched by 2 pages and a script", "watched by nobody". */
export function watchers_words(session: SessionState): string {
  const scripts = session.watched_by_script;
  const pages = session.watchers - (scripts ? 1 : 0);
  const by = [...(pages > 0 ? [pages === 1 ? "1 page" : `${pages} pages`] : []), ...(scripts ? ["a script"] : [])];
  return by.length > 0 ? `watched by ${by.join(" and ")}` : "watched by nobody";
}

/** Whether a stopped robot stands, and what Release will do. */
export function stopped_words(scene: SceneState, session: SessionState, open: boolean, now: number): string {
  const after = session.source === "hardware"
    ? "Its goals are cleared: Release moves nothing by itself."
    : session.goal ? "Release lets it drive on to its goal." : "Release lets it take goals again.";
  const age = news_age(scene, session, open, now);
  if (age !== null) {
    return `Stop is commanded. Whether the robot stands is not known: it was last heard ${age_words(age)} ago.`;
  }
  const { value, unit } = motion(scene);
  if (value !== 0) return `Stop is commanded. The wheels still turn: ${fixed(value, 2)} ${unit}.`;
  return `Stopped: the robot stands. ${after}`;
}

/** The state of the robot at the instant of a frame. */
export function frame_word(frame: Frame | null): Word {
  if (!frame) return { word: "Idle", tone: "muted" };
  const manual = frame.behaviour === "manual" && ["driving", "idle"].includes(frame.mission);
  if (frame.hold === "stopped") return { word: "Stopped", tone: "bad" };
  if (frame.hold !== "none") return { word: "Held", tone: "bad" };
  return manual ? { word: "Manual", tone: "info" } : kMissions[frame.mission];
}

const kMissions: Record<Frame["mission"], Word> = {
  idle: { word: "Idle", tone: "muted" },
  driving: { word: "Driving", tone: "ok" },
  arrived: { word: "Arrived", tone: "ok" },
  stuck: { word: "Stuck", tone: "warn" },
  held: { word: "Held", tone: "bad" },
};
const kOutcomes: Record<string, Word> = {
  running: { word: "Running", tone: "info" },
  reached: { word: "Reached", tone: "ok" },
  stuck: { word: "Stuck", tone: "warn" },
  out_of_time: { word: "Out of time", tone: "warn" },
  collided: { word: "Collided", tone: "bad" },
  overturned: { word: "Turned over", tone: "bad" },
  fallen: { word: "Fallen", tone: "bad" },
  stopped: { word: "Stopped", tone: "muted" },
  end_of_log: { word: "End of log", tone: "info" },
  failed: { word: "Failed", tone: "bad" },
};
const kStatuses: Record<string, Word> = {
  queued: { word: "Queued", tone: "muted" },
  recording: { word: "Recording", tone: "info" },
  interrupted: { word: "Interrupted", tone: "muted" },
  cancelled: { word: "Cancelled", tone: "muted" },
};

/** The question to which a trouble of a run is the answer, by its outcome. */
export const kQuestions: Record<string, string> = {
  stuck: "Why did it get stuck?", collided: "Why did it touch the obstacle?", overturned: "Why did it turn over?",
  fallen: "Why did it fall?",
};

/** The result of a run: its outcome once it has one, else its status. */
export function result_word(result: string): Word {
  return kOutcomes[result] ?? kStatuses[result] ?? { word: titled(result) || "Unknown", tone: "muted" };
}

/** How a live run went on after its outcome; empty if it did not. */
export function later_words(run: RunItem): string {
  if (!run.later) return "";
  const { outcome, time } = run.later;
  const on = `The run went on to ${clock(time)}`;
  if (outcome === run.outcome) return `${on}.`;
  const how: Record<string, string> = { running: "and drives on", stopped: "and was stopped there" };
  return `${on} ${how[outcome] ?? `and was last ${result_word(outcome).word.toLowerCase()}`}.`;
}

export const kind_words = {
  session: { word: "Live", help: "Driven live in a session" },
  background: { word: "Background", help: "Run in the background, from its start to its end" },
};

/** The controller of a run; "Replay" for a log. */
export function driver_word(run: { controller: string; physics: string }): string {
  return run.physics === "log" ? "Replay" : titled(run.controller);
}

export function speed_word(speed: number): string {
  return speed === 0 ? "Max" : `${speed}×`;
}

/** A label made of a name: "Modified c1" of "modified_c1". */
export function titled(name: string): string {
  const spaced = name.replace(/[_-]+/g, " ").replace(/([a-z]{2})(\d)/g, "$1 $2");
  return spaced.charAt(0).toUpperCase() + spaced.slice(1);
}

export function source_word(session: SessionState | null): { word: string; tone: string } | null {
  if (!session) return null;
  if (session.source === "hardware" && session.emulated) return { word: "Emulated devices", tone: "warn" };
  if (session.source === "hardware") return { word: "REAL HARDWARE", tone: "bad" };
  if (session.source === "replay") return { word: "Replay", tone: "replay" };
  return { word: "Simulation", tone: "info" };
}

/** Whether every word of `text` is in `found`, in any case and order. */
export function matches(found: string, text: string): boolean {
  return text.toLowerCase().split(/\s+/).every((word) => found.toLowerCase().includes(word));
}

export function sentence_of(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}
