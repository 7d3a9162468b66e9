// web/src/edit/edits.ts: the edits of people, each as one value with its undo.
import { RequestJson } from "../contract";
import { Pose } from "../geometry";
import { Goal } from "../link/frame";
import { Obstacle, obstacle_to_json } from "../obstacle";
import { Edit } from "./history";

export function goal_json({ x, y, heading }: Goal): { x: number; y: number; heading?: number } {
  return heading === null ? { x, y } : { x, y, heading };
}

export function goal_request(goal: Goal | null): RequestJson {
  return goal ? { type: "set_goal", ...goal_json(goal) } : { type: "clear_goal" };
}

export function set_goal_edit(from: Goal | null, to: Goal | null): Edit {
  return {
    label: to ? "Set goal" : "Clear goal",
    forward: goal_request(to),
    backward: goal_request(from),
  };
}

export function add_goal_edit(goal: Goal): Edit {
  return {
    label: "Add waypoint",
    forward: { type: "add_goal", ...goal_json(goal) },
    backward: null, // the robot may drive there already
  };
}

export function add_edit(obstacle: Obstacle): Edit {
  return {
    label: "Add obstacle",
    forward: { type: "add_obstacle", obstacle: obstacle_to_json(obstacle) },
    backward: null, // the history adds it once the server has answered with the id
  };
}

export function move_request(id: number, pose: Pose): RequestJson {
  return { type: "move_obstacle", id, x: pose.x, y: pose.y, heading: pose.heading };
}

export function move_edit(id: number, from: Pose, to: Pose): Edit {
  return { label: "Move obstacle", forward: move_request(id, to), backward: move_request(id, from) };
}

export function remove_edit(obstacle: Obstacle): Edit {
  return {
    label: "Remove obstacle",
    forward: { type: "remove_obstacle", id: obstacle.id },
    backward: { type: "add_obstacle", obstacle: obstacle_to_json(obstacle) },
  };
}

/** Obstacles that are not drawn to size: [m] radius of a cylinder, sides of a box. */
export const kUsualRadius = 0.3;
export const kUsualSide = 0.6;

/** Hands are exact to a centimetre at best, and round values read better. */
export function round_cm(v: number): number {
  return Math.round(v * 100) / 100;
}

const kBlank = { id: 0, radius: 0, length: 0, width: 0, points: [], height: 1, extra: {} };

export function new_cylinder(x: number, y: number, radius: number): Obstacle {
  return { ...kBlank, kind: "cylinder", pose: { x, y, heading: 0 }, radius };
}

export function new_box(x: number, y: number, length: number, width: number, heading = 0): Obstacle {
  return { ...kBlank, kind: "box", pose: { x, y, heading }, length, width };
}
