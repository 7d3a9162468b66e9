// web/src/entry.ts: how the page is let in: tokens, view-only links, and a session to show.
import * as rest from "./link/rest";
import { LiveLink } from "./link/live";
import { open_session, session_id } from "./link/session";
import { view_token } from "./people";
import { Store } from "./state/store";
import { UiState } from "./state/ui";
import { sentence_of } from "./words";

export class Entry {
  constructor(private readonly ui_: Store<UiState>, private readonly link_: LiveLink) {}

  /** Signs in with the token of a view-only link, unless this browser is let in already. Rejects if the link
   * is no longer valid. */
  async by_link(): Promise<void> {
    const token = view_token();
    if (token === null) return;
    history.replaceState(null, "", "#/drive"); // the token is not left in the address
    try {
      await rest.get("/me").catch(() => rest.post("/login", { token }));
    } catch {
      throw new Error("This view-only link is no longer valid. Ask for a new one.");
    }
  }

  /** Exchanges the token for a cookie. Rejects with the server's sentence. */
  async login(token: string): Promise<void> {
    await rest.post("/login", { token });
    this.ui_.set({ locked: false });
    this.link_.reconnect();
  }

  /** Returns the cookie: the server closes its connections, and the page asks for the token. */
  async logout(): Promise<void> {
    await rest.post("/logout", {});
    this.ui_.set({ locked: true });
  }

  /** Asks whether the server wants a token: a refused socket gives no reason, but a request does. */
  async look_for_lock(): Promise<void> {
    try {
      await rest.get("/version");
      this.ui_.set({ locked: false });
    } catch (error) {
      this.ui_.set({ locked: error instanceof rest.RestError && error.status === 401 });
    }
  }

  /** Opens a new session and shows it. Rejects with the server's sentence. */
  async new_session(): Promise<void> {
    await open_session();
    this.ui_.set({ gone: null });
    this.link_.reconnect();
  }

  /** Opens a new session unless the address names one: then the person decides. */
  async session_gone(why: string): Promise<void> {
    if (session_id() !== null) {
      this.ui_.set({ gone: why });
      return;
    }
    try {
      await this.new_session();
    } catch (error) {
      this.ui_.set({ gone: sentence_of(error) });
    }
  }
}
