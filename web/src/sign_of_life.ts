// web/src/sign_of_life.ts: tells the server that someone can see this page and press its Stop. The
// sign follows a drawn frame. A tab gives none if it is frozen, hidden or closed, hears nothing, or
// has its Stop out of reach. Without signs a real robot stops.

const kPeriod = 400; // [ms]; the server waits for 1.5 s

export interface SignEnvironment {
  visible(): boolean;
  /** Calls `act` before the next frame is drawn; never in a hidden tab. */
  next_frame(act: () => void): void;
  every(ms: number, act: () => void): void;
}

/** Gives signs while the page is visible and `stop_works`: a press reaches the server. */
export function give_signs_of_life(env: SignEnvironment, stop_works: () => boolean,
  give: () => void): void {
  const able = () => env.visible() && stop_works();
  let waiting = false;
  env.every(kPeriod, () => {
    if (waiting || !able()) return;
    waiting = true;
    // Two frames: the second one begins only after the first one was drawn.
    env.next_frame(() => env.next_frame(() => {
      waiting = false;
      if (able()) give();
    }));
  });
}

export const browser: SignEnvironment = {
  visible: () => document.visibilityState === "visible",
  next_frame: (act) => void requestAnimationFrame(act),
  every: (ms, act) => void setInterval(act, ms),
};

/** Whether a press on the middle of the Stop button would reach it: enabled, shown, not covered. */
export function stop_in_reach(): boolean {
  const button = document.querySelector<HTMLButtonElement>("button.stop");
  if (!button || button.disabled) return false;
  const box = button.getBoundingClientRect();
  const hit = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  return hit !== null && button.contains(hit);
}
