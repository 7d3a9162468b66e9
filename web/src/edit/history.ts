// web/src/edit/history.ts: edits as values to do, undo and do again. A value holds the steps for
// both ways; a drag is one edit. What somebody else has changed since is left as it is.
import { Accepted } from "../contract";
import { NoAnswer } from "../link/no_answer";
import { Step } from "./edits";

export interface Edit {
  label: string;
  forward: Step;
  backward: Step | null; // null: cannot be undone
  at?: number;           // [ms] since 1970
}

export interface EditTarget {
  /** Carries out a step; resolves with the id of an added obstacle where there is one. */
  send(step: Step): Promise<Accepted>;
  /** Whether the world is still as `step` left it; else who or what has changed since. */
  stands(step: Step): Promise<string | null>;
  changed(): void;
}

export class EditHistory {
  private done_: Edit[] = [];
  private undone_: Edit[] = [];
  private readonly most_ = 200;
  private last_: Promise<unknown> = Promise.resolve();

  constructor(private readonly t_: EditTarget) {}

  get can_undo(): string | null {
    return this.done_.at(-1)?.label ?? null;
  }
  get can_redo(): string | null {
    return this.undone_.at(-1)?.label ?? null;
  }
  /** The edits that undo takes back, the newest first. */
  get done(): Edit[] {
    return [...this.done_].reverse();
  }

  clear(): void {
    this.done_ = [];
    this.undone_ = [];
    this.t_.changed();
  }

  /** Sends the edit and keeps it for undo when the server accepts it; rejects when refused. */
  perform(edit: Edit): Promise<Accepted> {
    return this.in_turn(async () => {
      const answer = await this.send(edit.forward);
      this.record(complete(edit, answer.id));
      return answer;
    });
  }

  /** Keeps the edit that `send` has sent itself, such as the end of a drag; null: it was refused. An undo that
   * is asked for meanwhile waits. */
  take(send: () => Promise<Edit | null>): Promise<void> {
    return this.in_turn(async () => {
      const edit = await send();
      if (edit) this.record(edit);
    });
  }

  private record(edit: Edit): void {
    if (edit.backward) this.done_.push({ ...edit, at: Date.now() });
    else if (edit.forward.type === "load") this.done_ = []; // there is no way back to the world of the older ones
    if (this.done_.length > this.most_) this.done_.shift();
    this.undone_ = [];
    this.t_.changed();
  }

  undo(): Promise<string | null> {
    return this.in_turn(async () => {
      const edit = this.done_.pop();
      return edit?.backward ? this.move(edit, edit.forward, edit.backward, this.done_, this.undone_) : null;
    });
  }

  redo(): Promise<string | null> {
    return this.in_turn(async () => {
      const edit = this.undone_.pop();
      return edit?.backward ? this.move(edit, edit.backward, edit.forward, this.undone_, this.done_) : null;
    });
  }

  /** Sends `step`. Where the answer is late, the world tells whether it was carried out. */
  private async send(step: Step): Promise<Accepted> {
    try {
      return await this.t_.send(step);
    } catch (error) {
      if (!(error instanceof NoAnswer) || (await this.t_.stands(step)) !== null) throw error;
      return {};
    }
  }

  /** Runs `act` after the answer to the edit before. */
  private in_turn<T>(act: () => Promise<T>): Promise<T> {
    const next = this.last_.then(act, act);
    this.last_ = next.catch(() => undefined);
    return next;
  }

  /** Takes `last` back with `step`. An edit that no longer stands is dropped: it is not ours alone. */
  private async move(edit: Edit, last: Step, step: Step, from: Edit[], to: Edit[]): Promise<string> {
    try {
      const changed = await this.t_.stands(last);
      if (changed) throw new EditDropped(`${changed} "${edit.label}" is left as it is.`);
      await this.send(step);
      to.push(edit);
      return edit.label;
    } catch (error) {
      if (!(error instanceof EditDropped)) from.push(edit);
      throw error;
    } finally {
      this.t_.changed();
    }
  }
}

class EditDropped extends Error {}

/** Gives an added obstacle the id of the answer: it keeps that id when it is removed and added again. */
function complete(edit: Edit, id: number | undefined): Edit {
  if (edit.forward.type !== "add_obstacle" || id === undefined) return edit;
  const obstacle = { ...edit.forward.obstacle, id };
  return { ...edit, forward: { type: "add_obstacle", obstacle }, backward: { type: "remove_obstacle", id } };
}
