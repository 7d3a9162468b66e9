// web/src/views/login.tsx: asks for the token of a server that wants one.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { Dialog } from "../ui/controls";
import { sentence_of } from "../words";

export function Login(): JSX.Element {
  const app = use_app();
  const [token, set_token] = useState("");
  const [problem, set_problem] = useState<string | null>(null);
  const submit = async (e: Event) => {
    e.preventDefault();
    set_problem(null);
    try {
      await app.login(token);
    } catch (error) {
      set_problem(sentence_of(error));
    }
  };
  return (
    <Dialog title="This server wants its token" name="login" on_close={() => app.ui.set({ locked: false })}>
      <form class="form" noValidate onSubmit={(e) => void submit(e)}>
        <label class="line"><span>Token</span>
          <input type="password" autocomplete="current-password" data-testid="token" value={token}
            autofocus onInput={(e) => set_token(e.currentTarget.value)} /></label>
        <p class="quiet">Ask the person who runs the server: it was given with --token or TAUTLINE_TOKEN.</p>
        {problem && <p class="problem" role="alert" data-testid="login-problem">{problem}</p>}
        <button type="submit" class="small primary" disabled={token === ""} data-testid="login-go">Sign in</button>
      </form>
    </Dialog>
  );
}
