// web/src/state/goals.ts: the goals of a stored run, reached and ahead, from its requests and frames.
import { GoalJson, ScenarioDocument } from "../contract";
import { Frame, FrameRequest, Goal } from "../link/frame";

/** The goals of a robot: it drives to goals[next], then on. */
export interface Route { goals: Goal[]; next: number; loop: boolean }

export function goal_from_json(goal: GoalJson | null | undefined): Goal | null {
  return goal ? { x: goal.x, y: goal.y, heading: goal.heading ?? null } : null;
}

/** The goals with which a run of `scenario` begins. */
export function first_route(scenario: ScenarioDocument | undefined): Route {
  const waypoints = (scenario?.waypoints ?? []) as GoalJson[];
  const goals = [scenario?.goal, ...waypoints].flatMap((g) => goal_from_json(g) ?? []);
  return { goals, next: 0, loop: scenario?.loop === true };
}

/** `route` after `request`; the same object if it changes no goals. */
export function rerouted(route: Route, request: FrameRequest): Route {
  switch (request.type) {
    case "set_goal":
      return { goals: request.goals, next: request.next, loop: request.loop };
    case "add_goal":
      return { ...route, goals: [...route.goals, request.goal] };
    case "clear_goal":
      return { goals: [], next: 0, loop: false };
    default:
      return route;
  }
}

/** `route` at the instant of `f`: all but the goals that it has ahead are reached. */
export function route_at(route: Route, f: Frame): Route {
  const left = f.goal ? 1 + f.goals_ahead.length : 0;
  return { ...route, next: f.goal ? Math.max(0, route.goals.length - left) : 0 };
}
