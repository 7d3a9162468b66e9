// web/src/views/keys.ts: the keyboard of the Drive view. Space stops from everywhere but a text
// field; the rest acts on the tool and the selection.
import { App } from "../app";
import { add_edit, move_edit, new_box, new_cylinder, remove_edit } from "../edit/edits";
import { Pose, wrap_angle } from "../geometry";
import { Obstacle, obstacle_title } from "../obstacle";
import type { Hand } from "./drive";

const kArrows: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};
const kStep = 0.1;      // [m]
const kFineStep = 0.01; // [m]
const kTurn = (5 * Math.PI) / 180;

/** Whether typing belongs to the element in focus. */
export function typing(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) return !["range", "radio", "checkbox"].includes(target.type);
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/** Space is Stop in every view, and never a toggle. */
export function stop_key(app: App): (e: KeyboardEvent) => void {
  return (e) => {
    if (e.code !== "Space" || typing(e.target) || e.ctrlKey || e.metaKey || e.altKey) return;
    e.preventDefault(); // a button in focus is pressed with Enter
    if (e.type === "keydown" && !e.repeat) app.stop();
  };
}

export function scene_keys(app: App, hand: Hand): {
  window: (e: KeyboardEvent) => void; canvas: (e: KeyboardEvent) => void;
} {
  const set = app.ui.set.bind(app.ui);
  const simple: Record<string, () => void> = {
    p: () => void app.toggle_play(),
    ".": () => void app.step(),
    v: () => set({ tool: "pan", selection: null }),
    g: () => set({ tool: "goal", selection: null }),
    c: () => set({ tool: "cylinder", selection: null }),
    b: () => set({ tool: "box", selection: null }),
    m: () => set({ tool: "measure", selection: null }),
    n: () => select_next(app),
    l: () => app.show_layers(!app.ui.value.layers),
    "3": () => set({ three: !app.ui.value.three }),
    f: () => {
      app.view.fitted = true;
      app.redraw();
    },
    "+": () => zoom(app, 1.25),
    "=": () => zoom(app, 1.25),
    "-": () => zoom(app, 0.8),
    "[": () => turn(app, kTurn),
    "]": () => turn(app, -kTurn),
    delete: () => remove_selected(app),
    backspace: () => remove_selected(app),
    escape: () => {
      hand.gestures.cancel();
      hand.draft = {};
      set({ selection: null, sheet: false, preview: null });
      app.redraw();
    },
  };
  const window_key = (e: KeyboardEvent) => {
    if (typing(e.target) || document.querySelector("dialog[open]")) return;
    if ((e.ctrlKey || e.metaKey) && e.key.toLowerCase() === "z") {
      e.preventDefault();
      void (e.shiftKey ? app.redo() : app.undo());
      return;
    }
    if ((e.ctrlKey || e.metaKey) && e.key.toLowerCase() === "y") {
      e.preventDefault();
      void app.redo();
      return;
    }
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (e.key in kArrows && moves_selection(app, e)) {
      e.preventDefault();
      return;
    }
    const act = simple[e.key.toLowerCase()];
    if (!act || (e.repeat && e.key !== ".")) return;
    e.preventDefault();
    act();
  };
  // On the scene itself, with nothing selected, arrows lead a crosshair and Enter places.
  const canvas_key = (e: KeyboardEvent) => {
    if (e.key in kArrows && !app.ui.value.selection) {
      const c = hand.draft.cursor ?? { x: round(app.view.x), y: round(app.view.y) };
      const [dx, dy] = kArrows[e.key];
      const step = e.shiftKey ? kFineStep : kStep;
      hand.draft = { cursor: { x: round(c.x + dx * step), y: round(c.y + dy * step) } };
      const at = hand.draft.cursor!;
      app.say(`${at.x.toFixed(2)}, ${at.y.toFixed(2)} metres`);
      app.redraw();
      e.preventDefault();
      e.stopPropagation();
    } else if (e.key === "Enter" && hand.draft.cursor) {
      place(app, hand.draft.cursor);
      hand.draft = {};
      app.redraw();
      e.preventDefault();
      e.stopPropagation();
    }
  };
  return { window: window_key, canvas: canvas_key };
}

function round(v: number): number {
  return Math.round(v * 100) / 100;
}

function zoom(app: App, factor: number): void {
  app.view.zoom_at(app.view.width / 2, app.view.height / 2, factor);
  app.redraw();
}

function selected_obstacle(app: App): Obstacle | null {
  const s = app.ui.value.selection;
  return s?.kind === "obstacle" ? app.scene.obstacles.find((o) => o.id === s.id) ?? null : null;
}

/** The goal, then each obstacle, then nothing. */
function select_next(app: App): void {
  const s = app.ui.value.selection;
  const ids = app.scene.obstacles.map((o) => o.id);
  const first = ids.length > 0 ? ({ kind: "obstacle", id: ids[0] } as const) : null;
  if (!s) {
    app.ui.set({ selection: app.scene.goal ? { kind: "goal" } : first });
  } else if (s.kind === "goal") {
    app.ui.set({ selection: first });
  } else {
    const next = ids[ids.indexOf(s.id) + 1];
    app.ui.set({ selection: next === undefined ? null : { kind: "obstacle", id: next } });
  }
  const now = app.ui.value.selection;
  const obstacle = selected_obstacle(app);
  app.say(obstacle ? `${obstacle_title(obstacle)} selected` : now ? "Goal selected" : "Nothing selected");
}

function moves_selection(app: App, e: KeyboardEvent): boolean {
  const [dx, dy] = kArrows[e.key];
  const step = e.shiftKey ? kFineStep : kStep;
  const s = app.ui.value.selection;
  // A slider or a list in focus keeps its arrows.
  const focus = document.activeElement;
  if (focus && focus !== document.body && !(focus instanceof HTMLCanvasElement)) return false;
  const g = app.shown_goal;
  if (s?.kind === "goal" && g) {
    app.want_goal({ ...g, x: round(g.x + dx * step), y: round(g.y + dy * step) });
    return true;
  }
  const o = selected_obstacle(app);
  if (!o || !app.ui.value.session?.robot.editable) return false;
  void app.edit(move_edit(o.id, o.pose,
    { ...o.pose, x: round(o.pose.x + dx * step), y: round(o.pose.y + dy * step) }));
  return true;
}

function turn(app: App, by: number): void {
  const turned = (pose: Pose): Pose => ({ ...pose, heading: wrap_angle(pose.heading + by) });
  const o = selected_obstacle(app);
  if (o) {
    void app.edit(move_edit(o.id, o.pose, turned(o.pose)));
  } else if (app.ui.value.selection?.kind === "goal" && app.shown_goal) {
    const g = app.shown_goal;
    app.want_goal({ ...g, heading: wrap_angle((g.heading ?? 0) + by) });
  }
}

function remove_selected(app: App): void {
  const o = selected_obstacle(app);
  if (o && app.ui.value.session?.robot.editable) void app.edit(remove_edit(o));
  else if (app.ui.value.selection?.kind === "goal" && app.shown_goal) {
    app.want_goal(null);
    app.ui.set({ selection: null });
  }
}

function place(app: App, at: { x: number; y: number }): void {
  const { tool, session } = app.ui.value;
  if (tool === "goal" && session?.robot.drives) {
    app.want_goal({ ...at, heading: null });
  } else if (tool === "cylinder" && session?.robot.editable) {
    add(app, new_cylinder(at.x, at.y, 0.3));
  } else if (tool === "box" && session?.robot.editable) {
    add(app, new_box(at.x, at.y, 0.6, 0.6));
  }
}

function add(app: App, obstacle: Obstacle): void {
  void app.edit(add_edit(obstacle)).then((answer) => {
    if (answer?.id !== undefined) app.ui.set({ selection: { kind: "obstacle", id: answer.id } });
  });
}
