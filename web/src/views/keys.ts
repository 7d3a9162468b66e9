// web/src/views/keys.ts: the keyboard. Space stops everywhere but in a text field; the other keys
// act on the view, the tool and the selection.
import { App } from "../app";
import { kUsualRadius, kUsualSide, move_edit, new_box, new_cylinder, remove_edit, round_cm } from "../edit/edits";
import { Point, radians, wrap_angle } from "../geometry";
import { obstacle_title } from "../obstacle";
import { use_listener } from "../state/store";
import type { Hand } from "./drive";

const kArrows: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};
const kStep = 0.1;      // [m]
const kFineStep = 0.01; // [m]
const kTurn = radians(5);
const kStepKeys = [".", ","]; // one tick on, one tick back

/** Whether the element in focus takes typed characters. */
export function typing(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) return !["range", "radio", "checkbox"].includes(target.type);
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/** Space is Stop in every view, and never a toggle. */
export function stop_key(app: App, e: KeyboardEvent): void {
  if (e.code !== "Space" || typing(e.target) || e.ctrlKey || e.metaKey || e.altKey) return;
  e.preventDefault(); // a button in focus is pressed with Enter
  if (e.type === "keydown" && !e.repeat) app.stop();
}

/** Listens to keys, by name, while the component is shown. Only steps repeat on a held key. */
export function use_keys(acts: Record<string, () => void>): void {
  use_listener("keydown", (e) => {
    if (e.ctrlKey || e.metaKey || e.altKey || !hears(e)) return;
    const act = acts[e.key.toLowerCase()];
    if (!act || (e.repeat && !kStepKeys.includes(e.key))) return;
    e.preventDefault();
    act();
  });
}

/** A dialog and a text field keep their keys. */
function hears(e: KeyboardEvent): boolean {
  return !typing(e.target) && !document.querySelector("dialog[open]");
}

/** The keys of the Drive view, wherever the focus is. */
export function use_scene_keys(app: App, hand: Hand): void {
  const set = app.ui.set.bind(app.ui);
  use_listener("keydown", (e) => {
    const key = e.key.toLowerCase();
    const control = e.ctrlKey || e.metaKey;
    if (!hears(e)) return;
    if (control && (key === "z" || key === "y")) {
      e.preventDefault();
      void (key === "y" || e.shiftKey ? app.redo() : app.undo());
    } else if (e.key in kArrows && !control && !e.altKey && moves_selection(app, e)) {
      e.preventDefault();
    }
  });
  use_keys({
    p: () => void app.toggle_play(),
    ".": () => void app.step(),
    v: () => app.pick_tool("pan"),
    g: () => app.pick_tool("goal"),
    c: () => app.pick_tool("cylinder"),
    b: () => app.pick_tool("box"),
    m: () => app.pick_tool("measure"),
    n: () => select_next(app),
    l: () => app.show_layers(!app.ui.value.layers),
    "3": () => set({ three: !app.ui.value.three }),
    f: () => app.fit_view(),
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
  });
}

/** On the scene, with nothing selected: arrows move a crosshair, Enter places an object. */
export function crosshair_key(app: App, hand: Hand, e: KeyboardEvent): void {
  const { cursor } = hand.draft;
  if (e.key in kArrows && !app.ui.value.selection) {
    const at = stepped(cursor ?? app.view, e);
    hand.draft = { cursor: at };
    app.say(`${at.x.toFixed(2)}, ${at.y.toFixed(2)} metres`);
  } else if (e.key === "Enter" && cursor) {
    place(app, cursor);
    hand.draft = {};
  } else {
    return;
  }
  app.redraw();
  e.preventDefault();
  e.stopPropagation();
}

/** `from` one step further by the arrow key of `e`. */
function stepped(from: Point, e: KeyboardEvent): Point {
  const [dx, dy] = kArrows[e.key];
  const step = e.shiftKey ? kFineStep : kStep;
  return { x: round_cm(from.x + dx * step), y: round_cm(from.y + dy * step) };
}

function zoom(app: App, factor: number): void {
  app.view.zoom_at(app.view.width / 2, app.view.height / 2, factor);
  app.redraw();
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
  const obstacle = app.selected_obstacle;
  app.say(obstacle ? `${obstacle_title(obstacle)} selected` : now ? "Goal selected" : "Nothing selected");
}

function moves_selection(app: App, e: KeyboardEvent): boolean {
  const s = app.ui.value.selection;
  // A slider or a list in focus keeps its arrows.
  const focus = document.activeElement;
  if (focus && focus !== document.body && !(focus instanceof HTMLCanvasElement)) return false;
  const g = app.shown_goal;
  if (s?.kind === "goal" && g) {
    app.want_goal({ ...g, ...stepped(g, e) });
    return true;
  }
  const o = app.selected_obstacle;
  if (!o || !app.ui.value.session?.robot.editable) return false;
  void app.edit(move_edit(o.id, o.pose, { ...o.pose, ...stepped(o.pose, e) }));
  return true;
}

function turn(app: App, by: number): void {
  const o = app.selected_obstacle;
  const g = app.shown_goal;
  if (o) {
    void app.edit(move_edit(o.id, o.pose, { ...o.pose, heading: wrap_angle(o.pose.heading + by) }));
  } else if (app.ui.value.selection?.kind === "goal" && g) {
    app.want_goal({ ...g, heading: wrap_angle((g.heading ?? 0) + by) });
  }
}

function remove_selected(app: App): void {
  const o = app.selected_obstacle;
  if (o && app.ui.value.session?.robot.editable) void app.edit(remove_edit(o));
  else if (app.ui.value.selection?.kind === "goal" && app.shown_goal) {
    app.want_goal(null);
    app.ui.set({ selection: null });
  }
}

function place(app: App, at: Point): void {
  const tool = app.usable_tool;
  if (tool === "goal") app.want_goal({ ...at, heading: null });
  if (tool === "cylinder") void app.add(new_cylinder(at.x, at.y, kUsualRadius));
  if (tool === "box") void app.add(new_box(at.x, at.y, kUsualSide, kUsualSide));
}
