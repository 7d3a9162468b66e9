// web/src/arm/part.ts: the arm's controls as one part of the page, fetched for a robot with an arm.
export { ArmDesk } from "./desk";
export { ArmTab } from "./tab";
export { HandTool } from "./tool";
