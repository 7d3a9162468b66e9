// web/src/views/watching.tsx: the others: how many are connected, who stopped, set the goal, paused,
// and this page's own role where that is less than it could be.
import { JSX } from "preact";
import { use_ui } from "../app";
import { SessionState } from "../contract";
import { Me, person_words } from "../people";
import { use_me } from "../ui/guard";

/** A link to the System view: the role of a page that only watches, and how many are connected. */
export function Watching(): JSX.Element | null {
  const me = use_me();
  const { session } = use_ui("session");
  const viewers = session?.viewers ?? 1;
  const view_only = me.role === "viewer";
  if (!view_only && viewers < 2) return null;
  return (
    <a class="watching wide" href="#/system" data-testid="watching"
      title={session ? deeds(session, me).join(" ") : undefined}>
      {view_only && <b>View only</b>}
      {viewers > 1 && <span class="num">{viewers} connected</span>}
    </a>
  );
}

/** Said in the scene of a page that may only watch. */
export function ViewOnly(): JSX.Element | null {
  if (use_me().role !== "viewer") return null;
  return <p class="card view-only" data-testid="view-only">You are watching. You may press Stop.</p>;
}

/** "Ann pressed Stop.", in a strip that says the rest. */
export function StoppedBy(props: { label: string | null }): JSX.Element | null {
  const me = use_me();
  return props.label === null ? null
    : <span data-testid="stopped-by">{props.label === me.label ? "You" : props.label} pressed Stop.</span>;
}

/** Who did what still holds, as sentences. */
export function deeds(session: SessionState, me: Me): string[] {
  const { by } = session;
  const said = (words: string, label: string | null | undefined) =>
    label ? [`${words} ${person_words(me, label)}.`] : [];
  if (!by) return [];
  const armed = session.hardware?.armed ? "Armed by" : "Disarmed by";
  return [...said("Stopped by", by.stop), ...said("Goal by", by.goal), ...said("Paused by", by.pause),
    ...(session.hardware ? said(armed, by.arming) : [])];
}
