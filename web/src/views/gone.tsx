// web/src/views/gone.tsx: says that the page has no session, and opens a new one.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { sentence_of } from "../words";

export function SessionGone(): JSX.Element | null {
  const app = use_app();
  const { gone } = use_ui("gone");
  const [problem, set_problem] = useState<string | null>(null);
  if (gone === null) return null;
  const open = async () => {
    set_problem(null);
    try {
      await app.new_session();
    } catch (error) {
      set_problem(sentence_of(error));
    }
  };
  return (
    <section class="gone" role="alertdialog" aria-label="No session" data-testid="session-gone">
      <p>{gone}</p>
      {problem && <p class="problem" role="alert" data-testid="session-problem">{problem}</p>}
      <button class="small primary" autofocus onClick={() => void open()} data-testid="session-new">Open a new session</button>
    </section>
  );
}
