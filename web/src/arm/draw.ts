// web/src/arm/draw.ts: an arm from above: its links as their shadow on the floor, the plan, the goal of the hand.
import type { HandGoalJson } from "../contract";
import { Context, arrow, circle, fill, polyline, stroke, write } from "../draw/marks";
import { Palette } from "../draw/palette";
import { draw_goal } from "../draw/robot";
import { Overlay, draw_arms } from "../draw/scene";
import { View } from "../draw/view";
import type { SceneState } from "../state/scene";
import { goal_from_json } from "../state/goals";
import { LinkAxis, link_axes } from "./chain";
import { kArmLayers } from "./layers";
import { arm_of, planned, spread } from "./plan";
import { axes_of, place_of, wrist_of } from "./pose";
import { Vec3 } from "./vector";

const kLeast = 5;       // [px] of a link's width
const kEdge = 1.5;      // [px] of its outline
const kShownPlaces = 9; // of a plan
const kArrow = 26;      // [px] of the hand's direction, where it is level
const kApart = 60;      // [px] between goals whose heights can both be read

const flat = ([x, y]: Vec3) => ({ x, y });

/** A link as a bar with round ends, `inner` within `edge`. */
function bar(g: Context, view: View, { from, to, radius }: LinkAxis, edge: string, inner: string, dash: number[] = []): void {
  const width = Math.max(kLeast, 2 * radius * view.scale);
  g.lineCap = "round";
  polyline(g, view, [flat(from), flat(to)], edge, width, dash);
  if (dash.length === 0) stroke(g, inner, width - 2 * kEdge);
}

/** The lowest link first, as they are seen from above. */
function draw_links(g: Context, view: View, links: LinkAxis[], edge: string, inner: string): void {
  const height = (l: LinkAxis) => l.from[2] + l.to[2];
  for (const link of links.sort((a, b) => height(a) - height(b))) bar(g, view, link, edge, inner);
}

function draw_plan(g: Context, view: View, palette: Palette, scene: SceneState, overlay: Overlay): void {
  const { arm } = scene;
  const places = planned(scene);
  if (!arm || places.length === 0 || overlay.hidden.has(kArmLayers.plan.name)) return;
  g.save();
  g.lineJoin = g.lineCap = "round";
  polyline(g, view, places.map((p) => p.base), palette.accent, 1.8, [2, 6]);
  polyline(g, view, places.map((p) => flat(p.arm.hand.at)), palette.accent, 1.4, [5, 4]);
  for (const i of spread(places.length, kShownPlaces)) {
    const last = i === places.length - 1;
    const { base, arm: at } = places[i];
    g.globalAlpha = last ? 0.9 : 0.3;
    if (last) {
      circle(g, view, base, scene.radius * view.scale);
      stroke(g, palette.accent, 1.4, [5, 4]);
    }
    polyline(g, view, [at.shoulder, at.elbow, at.wrist, at.hand.at].map(flat), palette.accent, last ? 2.5 : 1.5);
  }
  g.restore();
}

function draw_arm(g: Context, view: View, palette: Palette, scene: SceneState, overlay: Overlay): void {
  const { arm } = scene;
  if (!arm) return;
  g.save();
  const at = arm_of(scene);
  if (at) {
    draw_links(g, view, link_axes(arm, at), palette.robot, palette.panel);
    circle(g, view, flat(at.hand.at), Math.max(2, 0.5 * arm.link_radius * view.scale));
    fill(g, palette.robot);
  }
  const draft = overlay.draft.hand ?? overlay.hand ?? null;
  const goal = scene.frame?.arm?.hand_goal ?? null;
  const chosen = overlay.selection?.kind === "hand";
  if (goal) draw_hand_goal(g, view, palette, scene, goal, chosen && !draft, false);
  if (draft) draw_hand_goal(g, view, palette, scene, draft, true, true);
  if (goal && !(draft && view.scale * Math.hypot(draft.x - goal.x, draft.y - goal.y) < kApart)) write_height(g, view, palette, goal);
  if (draft) write_height(g, view, palette, draft);
  g.restore();
}

const ring_of = (view: View) => Math.max(9, 0.06 * view.scale);

/** The height of a goal of the hand, which the view from above cannot show. */
function write_height(g: Context, view: View, palette: Palette, { x, y, z }: HandGoalJson): void {
  write(g, `z ${z.toFixed(2)} m`, view.sx(x), view.sy(y) - ring_of(view) - 9, palette.ok, `600 12px ${palette.font}`);
}

/** The hand at its goal, and the direction in which it points. */
function draw_hand_goal(g: Context, view: View, palette: Palette, scene: SceneState, goal: HandGoalJson, chosen: boolean, draft: boolean): void {
  const { arm } = scene;
  if (!arm) return;
  const at = place_of(goal);
  const ahead = axes_of(goal)[2];
  const dash = draft ? [4, 4] : [];
  g.globalAlpha = 0.35;
  bar(g, view, { name: "hand", from: wrist_of(goal, arm.hand), to: at, radius: arm.link_radius }, palette.ok, palette.bg);
  g.globalAlpha = 1;
  circle(g, view, goal, ring_of(view));
  stroke(g, palette.ok, chosen ? 3.5 : 2.5, dash);
  circle(g, view, goal, 2.5);
  fill(g, palette.ok);
  const size = Math.max(kArrow / view.scale, arm.hand);
  arrow(g, view, goal, { x: ahead[0] * size, y: ahead[1] * size }, 1, palette.ok, 2.4, dash);
  const then = goal_from_json(goal.then);
  if (then) draw_goal(g, view, palette, then, false, true);
}

draw_arms({ draw_plan, draw_arm });
