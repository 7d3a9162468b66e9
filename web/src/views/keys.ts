// web/src/views/keys.ts: the keyboard. Space stops everywhere but in a text field; the other keys
// act on the view, the tool and the selection.
import { App } from "../app";
import { duplicate, move_edit, remove_edit, round_cm, shifted } from "../edit/edits";
import { Tool, dragged_obstacle, is_ground_tool, is_sketch } from "../edit/drawn";
import { Point, radians, wrap_angle } from "../geometry";
import { Selection } from "../draw/scene";
import { Goal } from "../link/frame";
import { obstacle_title, present } from "../obstacle";
import { use_listener } from "../state/store";
import type { Hand } from "./drive";

const kArrows: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1],
};
const kStep = 0.1;      // [m]
const kFineStep = 0.01; // [m]
const kTurn = radians(5);
const kToolKeys: Record<string, Tool> = {
  v: "pan", g: "goal", s: "start", i: "pose", w: "wall", o: "polygon", k: "mover", c: "cylinder", b: "box", r: "ramp",
  e: "step", t: "trench", m: "measure",
};
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
      void (key === "y" || e.shiftKey ? app.editor.redo() : app.editor.undo());
    } else if (control && key === "d") {
      const o = app.selected_obstacle;
      if (!o || !app.ui.value.session?.robot.editable) return;
      e.preventDefault();
      void app.editor.add(duplicate(o));
    } else if (!control && !e.altKey && (app.desk?.key(e) || (e.key in kArrows && moves_selection(app, e)))) {
      e.preventDefault();
    }
  });
  use_keys({
    p: () => void app.toggle_play(),
    ".": () => void app.step(),
    ",": () => app.rewind.step(-1),
    end: () => app.go_live(),
    ...Object.fromEntries(Object.entries(kToolKeys).map(([key, tool]) => [key, () => app.pick_tool(tool)])),
    n: () => select_next(app),
    l: () => (app.ui.value.looking ? app.go_live() : app.show_layers(!app.ui.value.layers)),
    "3": () => app.show_three(!app.ui.value.three),
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
  const at = app.ui.value.selection ? null : crosshair_step(app, cursor ?? app.view, e);
  if (at) {
    hand.draft = { cursor: at, ...(hand.gestures.sketch.length > 0 && { sketch: [...hand.gestures.sketch, at] }) };
  } else if (e.key === "Enter" && cursor) {
    if (is_sketch(app.usable_tool)) {
      hand.gestures.tap(cursor);
      hand.draft = { ...hand.draft, cursor };
    } else {
      place(app, cursor, e.shiftKey);
      hand.draft = {};
    }
  } else {
    return;
  }
  app.redraw();
  e.preventDefault();
  e.stopPropagation();
}

/** The crosshair one step on from `from`, which is spoken; null for a key that does not move it. */
export function crosshair_step(app: App, from: Point, e: KeyboardEvent): Point | null {
  if (!(e.key in kArrows)) return null;
  const at = stepped(from, e);
  app.say(`${at.x.toFixed(2)}, ${at.y.toFixed(2)} metres`);
  return at;
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

/** Each goal, then each obstacle, then nothing. */
function select_next(app: App): void {
  const { goal, route, obstacles } = app.scene;
  const goals: Selection[] = route.goals.length > 1 ? route.goals.map((_, index) => ({ kind: "goal", index }))
    : goal ? [{ kind: "goal" }] : [];
  const all: Selection[] = [...goals, ...present(obstacles).map((o): Selection => ({ kind: "obstacle", id: o.id }))];
  const now = JSON.stringify(app.ui.value.selection);
  const next = all[all.findIndex((s) => JSON.stringify(s) === now) + 1] ?? null;
  app.ui.set({ selection: next });
  const obstacle = app.selected_obstacle;
  const name = next?.kind === "goal" && next.index !== undefined ? `Goal ${next.index + 1}` : "Goal";
  app.say(obstacle ? `${obstacle_title(obstacle)} selected` : next ? `${name} selected` : "Nothing selected");
}

/** The selected goal and the function that changes it. */
function selected_goal(app: App): [Goal, (to: Goal | null) => void] | null {
  const s = app.ui.value.selection;
  if (s?.kind !== "goal") return null;
  const { index } = s;
  const goal = index === undefined ? app.editor.shown_goal : app.scene.route.goals[index];
  if (!goal) return null;
  return [goal, (to) => (index === undefined ? app.editor.want_goal(to) : app.editor.change_goal(index, to))];
}

function moves_selection(app: App, e: KeyboardEvent): boolean {
  // A slider or a list in focus keeps its arrows.
  const focus = document.activeElement;
  if (focus && focus !== document.body && !(focus instanceof HTMLCanvasElement)) return false;
  const goal = selected_goal(app);
  if (goal) {
    const [g, change] = goal;
    change({ ...g, ...stepped(g, e) });
    return true;
  }
  const o = app.selected_obstacle;
  if (!o || !app.ui.value.session?.robot.editable) return false;
  const by = stepped(o.pose, e);
  if (o.path) void app.editor.change("Move path", o, shifted(o, by.x - o.pose.x, by.y - o.pose.y));
  else void app.editor.edit(move_edit(o, o.pose, { ...o.pose, ...by }));
  return true;
}

function turn(app: App, by: number): void {
  const o = app.selected_obstacle;
  const goal = selected_goal(app);
  if (o) {
    void app.editor.edit(move_edit(o, o.pose, { ...o.pose, heading: wrap_angle(o.pose.heading + by) }));
  } else if (goal) {
    const [g, change] = goal;
    change({ ...g, heading: wrap_angle((g.heading ?? 0) + by) });
  }
}

function remove_selected(app: App): void {
  const o = app.selected_obstacle;
  const goal = selected_goal(app);
  if (o && app.ui.value.session?.robot.editable) void app.editor.edit(remove_edit(o));
  else if (goal) {
    goal[1](null);
    app.ui.set({ selection: null });
  }
}

/** `further`: a goal is driven to after the others. */
function place(app: App, at: Point, further: boolean): void {
  const tool = app.usable_tool;
  if (tool === "goal") app.editor.want_goal({ ...at, heading: null }, further || app.ui.value.appending);
  if (tool === "hand") app.desk?.put(at);
  if (tool === "pose") void app.editor.set_pose({ ...at, heading: app.scene.frame?.pose.heading ?? 0 });
  if (tool === "start" && app.scene.start) app.editor.set_start({ ...at, heading: app.scene.start.heading });
  if (tool === "cylinder" || tool === "box" || is_ground_tool(tool)) void app.editor.add(dragged_obstacle(tool, at, at, false)!);
}
