// web/src/people.ts: who this page is to the server: role, name and address; and links for others.
import * as rest from "./link/rest";
import { Store } from "./state/store";

export type Role = "viewer" | "operator" | "admin";

/** The answer of /me. Until it has come, and from an older server, nothing is held back. */
export interface Me {
  role: Role;
  name: string;
  address: string;
  label: string; // what others read: the name, else the address
  token_required: boolean;
  signed_in: boolean;
}

const kRanks: Role[] = ["viewer", "operator", "admin"];
const kUnknown: Me =
  { role: "admin", name: "", address: "", label: "", token_required: false, signed_in: false };

/** Whether `me` may do what needs the role `needed`. */
export function may(me: Me, needed: Role): boolean {
  return kRanks.indexOf(me.role) >= kRanks.indexOf(needed);
}

/** Why `me` may not do it, for a tooltip. */
export function refusal(me: Me, needed: Role): string {
  return `This needs the role ${needed}; yours is ${me.role}. Sign in on the System view.`;
}

/** "you", or the name or address of another person. */
export function person_words(me: Me, label: string): string {
  return label === me.label ? "you" : label;
}

export class People {
  readonly me = new Store<Me>(kUnknown);

  async fetch(): Promise<void> {
    const me = await rest.get<Me>("/me").catch(() => null);
    if (me && kRanks.includes(me.role)) this.me.set(me);
  }

  may(needed: Role): boolean {
    return may(this.me.value, needed);
  }
}

/** The token of a view-only link that opened this page; null without one. */
export function view_token(): string | null {
  return location.hash.startsWith("#view=") ? new URLSearchParams(location.hash.slice(1)).get("view") : null;
}

/** A link to this page's session that lets others watch, whatever role this page has. */
export async function view_link(): Promise<string> {
  const { token } = await rest.get<{ token: string }>("/view_link");
  const url = new URL(location.href);
  url.hash = `view=${token}`;
  return url.href;
}
