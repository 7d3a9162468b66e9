// web/src/ui/tip.tsx: names with a meaning: hovered, tapped or in focus, they show it in words.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { use_listener } from "../state/store";

const kGap = 6;     // [px] from the name to its words
const kMargin = 8;  // [px] from the edge of the window

/** A name that tells what it means; a name without a meaning is plain text. */
export function Named(props: { label: string; meaning: string | null }): JSX.Element {
  if (props.meaning === null) return <>{props.label}</>;
  return <span class="named" tabIndex={0} data-tip={props.meaning} aria-description={props.meaning}>{props.label}</span>;
}

/** The words of the name under the pointer or in focus. One for the whole page. */
export function Tips(): JSX.Element | null {
  const [of, set_of] = useState<HTMLElement | null>(null);
  const box = useRef<HTMLDivElement>(null);
  const named = (e: Event) => (e.target as Element | null)?.closest?.<HTMLElement>("[data-tip]") ?? null;
  use_listener("pointerover", (e) => {
    // A finger has no place to rest: it sets the focus.
    if (e.pointerType === "mouse") set_of(named(e) ?? focused());
  });
  use_listener("focusin", (e) => set_of(named(e)));
  use_listener("focusout", () => set_of(null));
  use_listener("keydown", (e) => {
    if (e.key === "Escape") set_of(null);
  });
  use_listener("scroll", () => set_of(null), true);
  useEffect(() => {
    const tip = box.current;
    if (!tip || !of) return;
    const name = of.getBoundingClientRect();
    const { offsetWidth: w, offsetHeight: h } = tip;
    const below = name.bottom + kGap + h < innerHeight - kMargin;
    tip.style.left = `${Math.max(kMargin, Math.min(innerWidth - w - kMargin, name.left))}px`;
    tip.style.top = `${below ? name.bottom + kGap : Math.max(kMargin, name.top - kGap - h)}px`;
  });
  if (!of || !of.isConnected) return null;
  return <div class="tip" role="tooltip" aria-hidden="true" data-testid="tip" ref={box}>{of.dataset.tip}</div>;
}

function focused(): HTMLElement | null {
  return document.activeElement?.closest<HTMLElement>("[data-tip]") ?? null;
}
