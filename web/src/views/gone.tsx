// web/src/views/gone.tsx: tells that the page has no session, and opens a new one.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { Problem, use_problem } from "../ui/controls";

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
        onClick={() => void attempt(() => app.new_session())}>Open a new session</button>
    </section>
  );
}
