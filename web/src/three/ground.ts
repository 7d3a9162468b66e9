// web/src/three/ground.ts: ramps, steps and trenches in 3D: wedges on the floor and holes in it.
import * as THREE from "three";
import "../draw/ground"; // the small map beside a view in 3D draws them too
import { Palette } from "../draw/palette";
import { Obstacle, outline } from "../obstacle";
import { vertices } from "./shapes";

// The order of drawing: first the rims of the holes mark their pixels, then the holes fill them, then all else; the grid
// leaves them out.
const kRimOrder = -3, kHoleOrder = -2;
const kHole = 1; // the mark of such a pixel

const marks: Partial<THREE.MaterialParameters> = {
  stencilWrite: true, stencilRef: kHole, stencilZPass: THREE.ReplaceStencilOp, colorWrite: false, depthWrite: false,
};
const inside: Partial<THREE.MaterialParameters> = { stencilWrite: true, stencilRef: kHole, stencilFunc: THREE.EqualStencilFunc };

/** Leaves the pixels of holes out: for what lies on the floor. */
export function beside_holes<T extends THREE.Material>(material: T): T {
  return Object.assign(material, { stencilWrite: true, stencilRef: kHole, stencilFunc: THREE.NotEqualStencilFunc });
}

/** Quads between corners 0-3 and 4-7 of a body, seen from outside. */
const kSides = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

function quads(corners: number[][], faces: number[][]): THREE.BufferGeometry {
  const geometry = vertices(faces.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].flatMap((k) => corners[k])));
  geometry.computeVertexNormals();
  return geometry;
}

/** A body between the floor and its top, or the hole between its bottom and the floor. */
export function ground(o: Obstacle, p: Palette, chosen: boolean): THREE.Object3D {
  const edge = new THREE.LineBasicMaterial({ color: chosen ? p.accent : p.muted });
  const around = outline(o);
  const at = (heights: number[]) => around.map(({ x, y }, k) => [x, y, heights[k]]);
  const mesh = o.kind === "trench" ? hole(at([0, 0, 0, 0]), at(Array(4).fill(o.low)), p)
    : rise(at([0, 0, 0, 0]), at([o.low, o.height, o.height, o.low]), p);
  mesh.userData.obstacle = o.id; // a pointer finds it
  mesh.userData.ground = true;
  if (o.kind === "trench") {
    mesh.add(new THREE.LineLoop(vertices(at([0.004, 0.004, 0.004, 0.004]).flat()), edge));
  } else {
    mesh.add(new THREE.LineSegments(new THREE.EdgesGeometry(mesh.geometry, 1), edge));
  }
  return mesh;
}

function rise(foot: number[][], top: number[][], p: Palette): THREE.Mesh {
  const material = new THREE.MeshStandardMaterial({ color: p.high, roughness: 0.95, side: THREE.DoubleSide });
  return new THREE.Mesh(quads([...foot, ...top], [...kSides, [4, 5, 6, 7]]), material);
}

/** A rim that marks its pixels, and in it the walls and the bottom. */
function hole(rim: number[][], bottom: number[][], p: Palette): THREE.Mesh {
  const mesh = new THREE.Mesh(quads(rim, [[0, 1, 2, 3]]), new THREE.MeshBasicMaterial(marks));
  mesh.renderOrder = kRimOrder;
  const walls = kSides.map(([a, b, c, d]) => [d, c, b, a]); // seen from within
  for (const [faces, color] of [[walls, p.high], [[[0, 1, 2, 3]], p.deep]] as const) {
    const body = new THREE.Mesh(quads([...bottom, ...rim], faces as number[][]),
      new THREE.MeshStandardMaterial({ color, roughness: 1, ...inside }));
    body.renderOrder = kHoleOrder;
    mesh.add(body);
  }
  return mesh;
}
