// web/src/views/login.tsx: asks for the token of a server that needs one.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { Dialog, Problem, use_problem } from "../ui/controls";

export function Login(): JSX.Element {
  const app = use_app();
  const [token, set_token] = useState("");
  const [problem, attempt] = use_problem();
  const submit = (e: Event) => {
    e.preventDefault();
    void attempt(() => app.entry.login(token));
  };
  return (
    <Dialog title="Sign in with a token" name="login" on_close={() => app.ui.set({ locked: false })}>
      <form class="form" noValidate onSubmit={submit}>
        <label class="line"><span>Token</span>
          <input type="password" autocomplete="current-password" data-testid="token" value={token}
            autofocus onInput={(e) => set_token(e.currentTarget.value)} /></label>
        <p class="quiet">Ask the person who runs the server. There may be three tokens: of viewers, who
          watch and may press Stop, of operators, who drive, and of admins.</p>
        <Problem text={problem} name="login-problem" />
        <button type="submit" class="small primary" disabled={token === ""} data-testid="login-go">Sign in</button>
      </form>
    </Dialog>
  );
}
