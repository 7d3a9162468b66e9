// web/src/ui/guard.tsx: controls that need a role: for a visitor of a lower one they are shown, but
// disabled, and say why.
import { ComponentChildren, JSX } from "preact";
import { use_app } from "../app";
import { Me, Role, may, refusal } from "../people";
import { use_store } from "../state/store";

export function use_me(): Me {
  return use_store(use_app().people.me, (me) => me);
}

/** Disables every control inside. A fieldset does so for buttons, fields and lists alike. */
export function Guard(props: { need: Role; children: ComponentChildren }): JSX.Element {
  const me = use_me();
  const allowed = may(me, props.need);
  return (
    <fieldset class="guard" disabled={!allowed} title={allowed ? undefined : refusal(me, props.need)}>
      {props.children}
    </fieldset>
  );
}
