// web/src/views/you.tsx: this page's own name and role, signing in and out, and links for others.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { clean_name, keep_name, kLongestName, own_name } from "../link/name";
import { Role, may, view_link } from "../people";
import { Facts, Problem, use_problem } from "../ui/controls";
import { use_me } from "../ui/guard";

const kMay: Record<Role, string> = {
  viewer: "sees everything and may press Stop",
  operator: "drives, edits the world, sets parameters and starts runs",
  admin: "does everything, also deletes runs and scenarios and ends sessions",
};

export function You(): JSX.Element {
  const me = use_me();
  const app = use_app();
  const [problem, attempt] = use_problem();
  return (
    <section class="card block you" data-testid="you">
      <h2>You</h2>
      <NameForm />
      <Facts rows={[
        ["Role", <span data-testid="role">{`${me.role}: ${kMay[me.role]}`}</span>],
        ["Address", me.address || "not known yet"],
      ]} />
      <Problem text={problem} />
      <div class="facts-acts">
        <ViewLink />
        {me.token_required && <button class="ghost" data-testid="sign-in"
          onClick={() => app.ui.set({ locked: true })}>Sign in with another token</button>}
        {me.signed_in && <button class="ghost" data-testid="logout"
          onClick={() => void attempt(() => app.entry.logout())}>Sign out</button>}
      </div>
    </section>
  );
}

/** The name is sent with each connection, so that a new one connects again. */
function NameForm(): JSX.Element {
  const app = use_app();
  const [name, set_name] = useState(own_name);
  const submit = (e: Event) => {
    e.preventDefault();
    keep_name(name);
    set_name(own_name());
    app.link.reconnect();
  };
  return (
    <form onSubmit={submit}>
      <label><span>Name</span>
        <input type="text" value={name} maxLength={kLongestName} placeholder="shown to the others" autocomplete="nickname"
          data-testid="name" onInput={(e) => set_name(e.currentTarget.value)} /></label>
      <button type="submit" class="ghost" disabled={clean_name(name) === own_name()} data-testid="name-set">Use</button>
    </form>
  );
}

/** Copies a link that lets others watch. Where the browser allows no copying, it shows the link. */
function ViewLink(): JSX.Element {
  const me = use_me();
  const app = use_app();
  const [link, set_link] = useState<string | null>(null);
  const why_not = !me.token_required
    ? "This server asks for no token, so everybody who opens it may drive: start it with --token first"
    : !may(me, "operator") ? "The person who gave you this link can give it to others" : undefined;
  const copy = async () => {
    const made = await app.attempt(view_link());
    if (made === null) return;
    set_link(made);
    await navigator.clipboard?.writeText(made).then(() => app.toast("info", "The link is copied."), () => undefined);
  };
  return (
    <>
      <button class="ghost" disabled={why_not !== undefined} title={why_not} data-testid="view-link"
        onClick={() => void copy()}>Copy a view-only link</button>
      {link !== null && <input class="view-link num" readOnly value={link} aria-label="View-only link"
        data-testid="view-link-text" onFocus={(e) => e.currentTarget.select()} />}
    </>
  );
}
