// web/src/state/layer_groups.ts: the rows of the legend, by groups.
import { kArmLayers } from "../arm/layers";
import { is_ground } from "../obstacle";
import { LayerKey, is_sensed, kOwn, own } from "./layers";
import type { SceneState } from "./scene";

const kCompared = [
  { ...kOwn.path, token: "accent" as const }, own("second", "Second run", "elastic", "polyline", "solid", true),
];

const kGroups = ["Senses", "Forces", "Ways", "World"] as const;
type Group = (typeof kGroups)[number];

/** Tracks and cells are of the world; the other layers of a controller are ways that it weighs or takes. */
function group_of(key: LayerKey): Group {
  if (is_sensed(key.name)) return "Senses";
  if (key.scaled) return "Forces";
  return key.name === "arm.near" || key.token === "warn" || key.kind === "grid" || key.kind === "polar" ? "World" : "Ways";
}

/**
 * The rows of the legend: everything that is drawn. A log has only sensors and the path. Beside a second run the
 * first one has the accent.
 */
export function layer_groups(scene: SceneState, compared = false): { title: Group; keys: LayerKey[] }[] {
  const known = [...scene.known.values()];
  const { frame, drives, readings } = scene;
  const when = (drawn: boolean, ...keys: LayerKey[]) => (drawn ? keys : []);
  const own: Record<Group, [LayerKey[], LayerKey[]]> = {
    Senses: [[kOwn.scan, kOwn.filtered],
      [...when(readings.size > 0, kOwn.ranging), ...when((frame?.bumpers.length ?? 0) > 0, kOwn.bumpers)]],
    Forces: [[], []],
    Ways: [[], [...(compared ? kCompared : [kOwn.path]), ...when(scene.stick !== null, kOwn.wanted, kOwn.executed),
      ...when(!!frame?.truth, kOwn.truth), ...when(drives, kOwn.route), ...when(!!frame?.arm, kArmLayers.plan)]],
    World: [[...when(drives, kOwn.safety, kOwn.goal), kOwn.robot, ...when(!!frame?.map_pose, kOwn.sure), ...when(scene.arm !== null, kArmLayers.links, kArmLayers.goal), ...when(scene.world, kOwn.start, kOwn.obstacles),
      ...when(scene.obstacles.some(is_ground), kOwn.ground), ...when(scene.obstacles.some((o) => o.path), kOwn.ways)], [...when(scene.map !== null, kOwn.map), kOwn.mesh]],
  };
  return kGroups.map((title) => {
    const [first, last] = own[title];
    return { title, keys: [...first, ...known.filter((k) => group_of(k) === title), ...last] };
  }).filter((group) => group.keys.length > 0);
}
