// web/src/three/driven.ts: what a driver sees about the robot, in 3D: as draw/driven.ts draws it from above.
import * as THREE from "three";
import { Palette } from "../draw/palette";
import { Point, Pose } from "../geometry";
import { ring_sectors, sector_arc, wall_of, wall_words, ways_ahead } from "../state/driven";
import type { SceneState } from "../state/scene";
import { dashes, label } from "./layers";
import { ribbon, wedge } from "./shapes";

const kFloor = 0.015;    // [m] of sectors
const kWayHeight = 0.03; // [m]
const kWordsHeight = 0.1; // [m] above the floor
const kWordsSize = 0.17;  // of a label that shrinks with the distance, at 1 m

/** Words of the same size near and far. */
function words_at(text: string, at: Point, z: number, colour: string, p: Palette): THREE.Sprite {
  const sprite = label(text, { ...at, z: null }, z, colour, p.font);
  sprite.material.sizeAttenuation = false;
  sprite.scale.multiplyScalar(kWordsSize);
  return sprite;
}

export function build_sectors(scene: SceneState, p: Palette, pose: Pose): THREE.Object3D[] {
  return ring_sectors(scene).flatMap((s) => {
    const colour = s.limits ? p.external : p.filtered;
    const arc = sector_arc(pose, s);
    const end = s.echo ? [ribbon(arc, s.limits ? 0.05 : 0.03, kFloor + 0.005, colour)] : [];
    const middle = arc[arc.length >> 1];
    const words = s.echo ? [words_at(`${s.range.toFixed(2)} m`, middle, kWordsHeight, colour, p)] : [];
    return [wedge(pose, arc, kFloor, colour, s.limits ? 0.4 : s.echo ? 0.16 : 0.06), ...end, ...words];
  });
}

export function build_wall_words(scene: SceneState, p: Palette): THREE.Object3D[] {
  const wall = wall_of(scene);
  return wall ? [words_at(wall_words(wall), wall.words, kWordsHeight, p.internal, p)] : [];
}

export function build_ways_ahead(scene: SceneState, p: Palette, hidden: ReadonlySet<string>): THREE.Object3D[] {
  return ways_ahead(scene, hidden).flatMap(({ key, line }) => {
    const way = line.map((at) => ({ ...at, z: null }));
    return (key.style === "dashed" ? dashes(way) : [way]).map((piece) => ribbon(piece, 0.05, kWayHeight, p[key.token]));
  });
}
