// web/src/edit/history.ts: edits as values to do, undo and do again. A value holds the requests for
// both ways; a drag is one step.
import { Accepted, RequestJson } from "../contract";

export interface Edit {
  label: string;
  forward: RequestJson;
  backward: RequestJson | null; // null: cannot be undone
}

/** Sends a request; resolves with the id of an added obstacle where there is one. */
export type Send = (request: RequestJson) => Promise<Accepted>;

export class EditHistory {
  private done_: Edit[] = [];
  private undone_: Edit[] = [];
  private readonly most_ = 200;
  private last_: Promise<unknown> = Promise.resolve();

  constructor(private readonly send_: Send, private readonly changed_: () => void = () => undefined) {}

  get can_undo(): string | null {
    return this.done_.at(-1)?.label ?? null;
  }
  get can_redo(): string | null {
    return this.undone_.at(-1)?.label ?? null;
  }

  clear(): void {
    this.done_ = [];
    this.undone_ = [];
    this.changed_();
  }

  /** Sends the edit and keeps it for undo when the server accepts it; rejects when refused. */
  perform(edit: Edit): Promise<Accepted> {
    return this.in_turn(async () => {
      const answer = await this.send_(edit.forward);
      this.record(complete(edit, answer.id));
      return answer;
    });
  }

  /** Keeps an edit that has already been sent, such as the end of a drag. */
  record(edit: Edit): void {
    if (edit.backward) this.done_.push(edit);
    if (this.done_.length > this.most_) this.done_.shift();
    this.undone_ = [];
    this.changed_();
  }

  undo(): Promise<string | null> {
    return this.in_turn(async () => {
      const edit = this.done_.pop();
      return edit?.backward ? this.move(edit, edit.backward, this.done_, this.undone_) : null;
    });
  }

  redo(): Promise<string | null> {
    return this.in_turn(async () => {
      const edit = this.undone_.pop();
      return edit ? this.move(edit, edit.forward, this.undone_, this.done_) : null;
    });
  }

  /** Runs `act` after the answer to the edit before. */
  private in_turn<T>(act: () => Promise<T>): Promise<T> {
    const next = this.last_.then(act, act);
    this.last_ = next.catch(() => undefined);
    return next;
  }

  private async move(edit: Edit, request: RequestJson, from: Edit[], to: Edit[]): Promise<string> {
    try {
      const answer = await this.send_(request);
      // An obstacle that comes back has a new id, which all other edits of it must use.
      const old = id_of(edit);
      if (request.type === "add_obstacle" && answer.id !== undefined && old !== null) {
        to.push(renumbered(edit, old, answer.id));
        this.done_ = this.done_.map((e) => renumbered(e, old, answer.id!));
        this.undone_ = this.undone_.map((e) => renumbered(e, old, answer.id!));
      } else {
        to.push(edit);
      }
      return edit.label;
    } catch (error) {
      from.push(edit);
      throw error;
    } finally {
      this.changed_();
    }
  }
}

/** The id the edit is about. */
function id_of(edit: Edit): number | null {
  for (const r of [edit.forward, edit.backward]) {
    if (r && "id" in r) return r.id;
  }
  return null;
}

/** Gives an added obstacle the id of the answer, so that undo can remove it. */
function complete(edit: Edit, id: number | undefined): Edit {
  if (edit.forward.type !== "add_obstacle" || id === undefined) return edit;
  return { ...edit, backward: { type: "remove_obstacle", id } };
}

function renumbered(edit: Edit, old: number, fresh: number): Edit {
  const change = (r: RequestJson | null): RequestJson | null =>
    r && "id" in r && r.id === old ? { ...r, id: fresh } : r;
  return { ...edit, forward: change(edit.forward)!, backward: change(edit.backward) };
}
