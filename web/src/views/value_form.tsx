// web/src/views/value_form.tsx: the card of numbers that the value boxes share.
import { ComponentChildren, JSX } from "preact";
import { useEffect, useState } from "preact/hooks";

/** Fields over a value that the server may change, until someone types: the fields, a function that types
 * into them, one that drops what was typed, and whether something was typed. A change of `parts` drops it too,
 * unless someone is at it: a robot that gets its next goal takes no digits away. */
export function use_typed<T>(value: T, parts: readonly unknown[] = []): [T, (change: Partial<T>) => void, () => void, boolean] {
  const [typed, set_typed] = useState<Partial<T> | null>(null);
  const forget = () => set_typed(null);
  useEffect(() => {
    if (!document.activeElement?.closest(".values")) forget();
  }, parts);
  return [{ ...value, ...typed }, (change) => set_typed({ ...typed, ...change }), forget, typed !== null];
}

export function tenths(v: number): number {
  return Math.round(10 * v) / 10;
}

/** A card of fields; `on_submit` is called for Enter and for its button. */
export function Form(props: {
  label: string; name: string; class?: string; on_submit: () => void; children: ComponentChildren;
}): JSX.Element {
  return (
    <form class={`card values ${props.class ?? ""}`} noValidate aria-label={props.label} data-testid={props.name}
      onSubmit={(e) => {
        e.preventDefault();
        props.on_submit();
      }}>{props.children}</form>
  );
}
