// web/src/views/gone.tsx: nothing to show: the page has no session, or its address names no view.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { use_listener, use_redraw } from "../state/store";
import { Problem, use_problem } from "../ui/controls";

/** Opens a new session. */
export function SessionGone(): JSX.Element | null {
  const app = use_app();
  const { gone } = use_ui("gone");
  const [problem, attempt] = use_problem();
  if (gone === null) return null;
  return (
    <section class="gone" role="alertdialog" aria-label="No session" data-testid="session-gone">
      <p>{gone}</p>
      <Problem text={problem} name="session-problem" />
      <button class="small primary" autofocus data-testid="session-new"
        onClick={() => void attempt(() => app.entry.new_session())}>Open a new session</button>
    </section>
  );
}

/** Says that the address names no view, and leads back. */
export function Nowhere(): JSX.Element {
  use_listener("hashchange", use_redraw());
  return (
    <main class="nowhere" data-testid="nowhere">
      <h1>Nothing is here</h1>
      <p>This page has no view at <code>{location.hash}</code>. The link may be old, or mistyped.</p>
      <p class="ways">
        <a class="small primary" href="#/drive">To the robot</a><a class="small" href="#/runs">To the runs</a>
      </p>
    </main>
  );
}
