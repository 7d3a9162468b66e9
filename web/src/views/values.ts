// web/src/views/values.ts: the value boxes as one part of the page, fetched when the first one is needed.
export { GoalValues, PoseValues, StartValues } from "./goal_values";
export { NewGround } from "./new_ground";
export { NewValues, SketchValues } from "./new_values";
export { ObstacleValues } from "./obstacle_values";
