// web/src/edit/empty_world.ts: a world without obstacles and goals, for the robot of another.
import { ScenarioDocument } from "../contract";

const kSensors = ["lasers", "sonar", "infrared", "sensors", "gyro", "bumpers", "encoders", "line_camera", "inclinometer",
  "floor_sensors"];

/** An empty world for the robot and the controller of `now`. A robot of your own is a whole model, whose sensors stand
 *  beside it; a name stands for the sensors too. */
export function empty_world(now: ScenarioDocument): ScenarioDocument {
  const { robot, controller, filter, physics } = now;
  const sensors = typeof robot === "object" ? kSensors.filter((key) => key in now).map((key) => [key, now[key]]) : [];
  return {
    name: "new_world", title: "New world", start: { x: 0, y: 0, heading: 0 }, robot, controller, filter, physics,
    ...Object.fromEntries(sensors),
  };
}
