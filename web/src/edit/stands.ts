// web/src/edit/stands.ts: whether the world is still as an edit of this page left it.
import { GoalJson } from "../contract";
import { Point, Pose, distance, wrap_angle } from "../geometry";
import { Obstacle, ObstacleJson, obstacle_from_json, obstacle_title } from "../obstacle";
import { SceneState } from "../state/scene";
import { Step } from "./edits";

const kSame = 2e-3; // [m], [rad] below which two values are one

/** What has changed since `step`, as a sentence; null if its effect still stands. */
export function change_since(step: Step, scene: SceneState): string | null {
  switch (step.type) {
    case "add_obstacle":
    case "change_obstacle": {
      const now = scene.obstacles.find((o) => o.id === step.obstacle.id);
      if (!now) return gone(step.obstacle.id ?? 0);
      return same_obstacle(now, step.obstacle) ? null : `${obstacle_title(now)} has been changed since.`;
    }
    case "move_obstacle": {
      const now = scene.obstacles.find((o) => o.id === step.id);
      if (!now) return gone(step.id);
      return same_pose(now.pose, step) ? null : `${obstacle_title(now)} has been moved since.`;
    }
    case "remove_obstacle":
      return scene.obstacles.some((o) => o.id === step.id) ? "It has been put back since." : null;
    case "set_goals":
      return same_goals(scene.route.goals, step.goals) && scene.route.loop === (step.loop ?? false) && !of_hand(scene.arm_asked)
        ? null : "The goals have been changed since.";
    case "clear_goal":
      return scene.arm_asked ? "The arm has got another goal since." : null;
    case "set_hand_goal":
    case "set_joints":
    case "carry":
      return alike(scene.arm_asked, step) ? null : "The arm has got another goal since.";
    case "start":
      return scene.start && same_place(scene.start, step.pose)
        ? null : "The start has been moved since.";
    default:
      return null;
  }
}

function gone(id: number): string {
  return `Obstacle ${id} has been removed since.`;
}

/** Whether goals of the base would replace it. */
function of_hand(asked: SceneState["arm_asked"]): boolean {
  return asked !== null && asked.type !== "set_joints";
}

/** Whether `now` has all that `then` has. */
function alike(now: unknown, then: unknown): boolean {
  if (typeof then === "number") return near(Number(now), then);
  if (typeof then !== "object" || then === null) return now === then || (!now && !then);
  return Object.entries(then).every(([key, value]) => alike((now as Record<string, unknown> | null)?.[key], value));
}

function near(a: number, b: number): boolean {
  return Math.abs(a - b) < kSame;
}

function same_goals(now: GoalJson[], then: GoalJson[]): boolean {
  return now.length === then.length && now.every((g, i) => same_place(g, then[i]) &&
    (g.heading ?? null) === null === ((then[i].heading ?? null) === null) && near(g.heading ?? 0, then[i].heading ?? 0));
}

function same_pose(now: Pose, then: Pose): boolean {
  return same_place(now, then) && near(wrap_angle(now.heading - then.heading), 0);
}

function same_place(now: Point, then: Point): boolean {
  return distance(now, then) < kSame;
}

/** Where something that moves by itself is now says nothing. */
function same_obstacle(now: Obstacle, json: ObstacleJson): boolean {
  const then = obstacle_from_json(json);
  return (now.path || same_pose(now.pose, then.pose)) && now.kind === then.kind && near(now.radius, then.radius) && near(now.length, then.length) &&
    near(now.width, then.width) && near(now.low, then.low) && near(now.height, then.height) && near(now.bottom, then.bottom) && now.points.length === then.points.length && !now.path === !then.path;
}
