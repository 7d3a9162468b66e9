// web/src/three/driven.ts: what a driver sees about the robot, in 3D: as draw/driven.ts draws it from above.
import * as THREE from "three";
import { Palette } from "../draw/palette";
import { Point, Pose } from "../geometry";
import { full_stick, kAhead, ring_sectors, sector_arc, wall_of, wall_words, way_of } from "../state/driven";
import { kOwn } from "../state/layers";
import type { SceneState } from "../state/scene";
import { dashes, label } from "./layers";
import { flat, ribbon, vertices } from "./shapes";

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
    const xyz: number[] = [];
    for (let i = 1; i < arc.length; ++i) {
      xyz.push(pose.x, pose.y, kFloor, arc[i - 1].x, arc[i - 1].y, kFloor, arc[i].x, arc[i].y, kFloor);
    }
    const material = Object.assign(flat(colour), { transparent: true, opacity: s.limits ? 0.4 : s.echo ? 0.16 : 0.06, depthWrite: false });
    const end = s.echo ? [ribbon(arc, s.limits ? 0.05 : 0.03, kFloor + 0.005, colour)] : [];
    const middle = arc[arc.length >> 1];
    const words = s.echo ? [words_at(`${s.range.toFixed(2)} m`, middle, kWordsHeight, colour, p)] : [];
    return [new THREE.Mesh(vertices(xyz), material), ...end, ...words];
  });
}

export function build_wall_words(scene: SceneState, p: Palette): THREE.Object3D[] {
  const wall = wall_of(scene);
  return wall ? [words_at(wall_words(wall), wall.words, kWordsHeight, p.internal, p)] : [];
}

export function build_ways_ahead(scene: SceneState, p: Palette, pose: Pose, hidden: ReadonlySet<string>): THREE.Object3D[] {
  const { stick, frame } = scene;
  if (!stick || !frame) return [];
  const full = full_stick(scene);
  const way = (key: typeof kOwn.wanted, v: number, omega: number) => {
    if (hidden.has(key.name) || Math.abs(v) * kAhead < 0.05) return [];
    const line = way_of(pose, v, omega).map((at) => ({ ...at, z: null }));
    return (key.style === "dashed" ? dashes(line) : [line]).map((piece) => ribbon(piece, 0.05, kWayHeight, p[key.token]));
  };
  return [...way(kOwn.wanted, stick.forward * full.v, stick.turn * full.omega), ...way(kOwn.executed, frame.twist.v, frame.twist.omega)];
}
