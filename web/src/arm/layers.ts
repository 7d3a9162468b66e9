// web/src/arm/layers.ts: what is drawn of an arm beside its controller's layers, as the legend lists it.
import { own } from "../state/layers";

export const kArmLayers = {
  links: own("arm", "Arm, its links", "robot", "polyline", "solid", true),
  goal: own("arm.goal", "Goal of the hand", "ok", "arrows", "solid", true),
  plan: own("arm.plan", "Plan of base and arm", "accent", "polyline", "dashed"),
};
