// web/src/teleop/second_thumb.ts: presses by a second finger. Browsers make clicks of the first finger on the glass only,
// so while one thumb holds the stick, the other one would press Stop in vain.
import { useEffect } from "preact/hooks";

const kPressable = "button, label, a[href], input[type=radio], input[type=checkbox]";
const kClickAfter = 400; // [ms] within which a browser that does make a click makes it

function pressable(e: PointerEvent): HTMLElement | null {
  return e.target instanceof Element ? e.target.closest<HTMLElement>(kPressable) : null;
}

/** While the component is shown, a further finger presses what a first one would. */
export function use_second_thumb(): void {
  useEffect(() => {
    const down = new Map<number, HTMLElement>();
    let pressed: { what: HTMLElement; at: number } | null = null;
    const press = (e: PointerEvent) => {
      const what = e.isPrimary || e.pointerType !== "touch" ? null : pressable(e);
      if (what) down.set(e.pointerId, what);
    };
    const release = (e: PointerEvent) => {
      const what = down.get(e.pointerId);
      down.delete(e.pointerId);
      if (!what || document.elementFromPoint(e.clientX, e.clientY)?.closest(kPressable) !== what) return;
      what.click();
      pressed = { what, at: performance.now() };
    };
    const cancel = (e: PointerEvent) => down.delete(e.pointerId);
    const click = (e: MouseEvent) => {
      if (!e.isTrusted || !pressed || performance.now() - pressed.at > kClickAfter) return;
      if (!(e.target instanceof Node) || !pressed.what.contains(e.target)) return;
      e.preventDefault();
      e.stopPropagation();
    };
    addEventListener("pointerdown", press, true);
    addEventListener("pointerup", release, true);
    addEventListener("pointercancel", cancel, true);
    addEventListener("click", click, true);
    return () => {
      removeEventListener("pointerdown", press, true);
      removeEventListener("pointerup", release, true);
      removeEventListener("pointercancel", cancel, true);
      removeEventListener("click", click, true);
    };
  }, []);
}
