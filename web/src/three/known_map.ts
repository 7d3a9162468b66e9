// web/src/three/known_map.ts: the map that the robot knows, flat on the floor.
import * as THREE from "three";
import { kOpacity, map_picture } from "../draw/known_map";
import { Palette } from "../draw/palette";

const kAboveFloor = 0.004; // [m]
const kMostPixels = 8192;  // along an edge, that every graphics card can take

/** Null where no map is known, or one too large to be drawn. */
export function build_map(palette: Palette): THREE.Mesh | null {
  const known = map_picture(palette);
  if (!known || Math.max(known.map.columns, known.map.rows) > kMostPixels) return null;
  const { min_x, min_y, max_x, max_y } = known.bounds;
  const map = new THREE.CanvasTexture(known.picture);
  map.colorSpace = THREE.SRGBColorSpace;
  map.magFilter = THREE.NearestFilter; // each cell is a square
  const mesh = new THREE.Mesh(new THREE.PlaneGeometry(max_x - min_x, max_y - min_y),
    new THREE.MeshBasicMaterial({ map, transparent: true, opacity: kOpacity, depthWrite: false }));
  mesh.position.set((min_x + max_x) / 2, (min_y + max_y) / 2, kAboveFloor);
  return mesh;
}
