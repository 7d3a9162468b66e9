// web/src/views/hardware_words.ts: sentences about real hardware.

/** When the robot was disarmed, and why, unless `shown` says so already. */
export function disarmed_words(disarmed: { why: string; at: string }, shown: string): string {
  const at = new Date(disarmed.at).toLocaleTimeString();
  return `Disarmed at ${at}${shown === disarmed.why ? "." : `: ${disarmed.why}`}`;
}
