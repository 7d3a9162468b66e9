// web/src/three/shapes.ts: the shapes of the 3D view: z up, metres.
import * as THREE from "three";
import { Palette } from "../draw/palette";
import { Point, Pose, to_parent } from "../geometry";
import { Frame, Goal } from "../link/frame";
import { kConeAlpha, kHalfCone } from "../draw/sensing";
import { kScanHeight } from "../layer";
import { Obstacle, outline } from "../obstacle";
import { PlacedReadings } from "../state/ranging";
import { SceneState } from "../state/scene";

export function clear(group: THREE.Group): void {
  for (const child of [...group.children]) {
    group.remove(child);
    child.traverse((o) => {
      const mesh = o as THREE.Mesh;
      mesh.geometry?.dispose();
      for (const m of [mesh.material].flat()) {
        (m as THREE.SpriteMaterial | undefined)?.map?.dispose();
        m?.dispose();
      }
    });
  }
}

/** A geometry of vertices; `xyz` holds x, y, z in turn. */
export function vertices(xyz: number[]): THREE.BufferGeometry {
  return new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(xyz, 3));
}

export function placed(geometry: THREE.BufferGeometry, material: THREE.Material, at: Point,
  z: number): THREE.Mesh {
  const mesh = new THREE.Mesh(geometry, material);
  mesh.position.set(at.x, at.y, z);
  return mesh;
}

/** Points `size` pixels across at any distance. */
export function points(size: number): THREE.Points {
  const p = new THREE.Points(new THREE.BufferGeometry(),
    new THREE.PointsMaterial({ size: size * Math.min(2, devicePixelRatio || 1), sizeAttenuation: false }));
  p.frustumCulled = false;
  return p;
}

export function sun(): THREE.DirectionalLight {
  const light = new THREE.DirectionalLight(0xffffff, 1.6);
  light.position.set(-4, -6, 10);
  return light;
}

export function flat(colour: string): THREE.MeshBasicMaterial {
  return new THREE.MeshBasicMaterial({ color: colour, side: THREE.DoubleSide });
}

/** A line a metre, stronger every fifth, in pieces of a metre: some drivers drop a line that
 * passes behind the camera. */
export function grid(p: Palette, on_floor: <T extends THREE.Material>(material: T) => T): THREE.Group {
  const group = new THREE.Group();
  const half = 25;
  for (const strong of [false, true]) {
    const xyz: number[] = [];
    for (let k = -half; k <= half; ++k) {
      if ((k % 5 === 0) !== strong) continue;
      for (let i = -half; i < half; ++i) xyz.push(i, k, 0, i + 1, k, 0, k, i, 0, k, i + 1, 0);
    }
    group.add(new THREE.LineSegments(vertices(xyz),
      on_floor(new THREE.LineBasicMaterial({ color: strong ? p.line : p.grid2 }))));
  }
  return group;
}

export function solid(o: Obstacle, p: Palette, chosen: boolean): THREE.Object3D {
  const material = new THREE.MeshStandardMaterial({ color: p.obstline, roughness: 0.85 });
  const mesh = shape_of(o, material);
  mesh.userData.obstacle = o.id; // a pointer finds it
  const edges = new THREE.LineSegments(new THREE.EdgesGeometry(mesh.geometry, 30),
    new THREE.LineBasicMaterial({ color: chosen ? p.accent : p.muted }));
  mesh.add(edges);
  return mesh;
}

function shape_of(o: Obstacle, material: THREE.Material): THREE.Mesh {
  if (o.kind === "cylinder") {
    const geometry = new THREE.CylinderGeometry(o.radius, o.radius, o.height - o.bottom, 48);
    const mesh = placed(geometry, material, o.pose, (o.bottom + o.height) / 2);
    mesh.rotation.x = Math.PI / 2;
    return mesh;
  }
  const shape = new THREE.Shape(outline(o).map((c) => new THREE.Vector2(c.x, c.y)));
  const mesh = new THREE.Mesh(new THREE.ExtrudeGeometry(shape, { depth: o.height - o.bottom, bevelEnabled: false }), material);
  mesh.position.z = o.bottom;
  return mesh;
}

export function goal(at: Goal, p: Palette): THREE.Group {
  const group = new THREE.Group();
  group.add(ring(at, 0.18, 0.22, 0.02, p.ok));
  if (at.heading !== null) {
    push_arrow(group, at, { x: 0.5 * Math.cos(at.heading), y: 0.5 * Math.sin(at.heading) }, 1, p.ok);
  }
  return group;
}

export function ring(at: Point, inner: number, outer: number, z: number, colour: string): THREE.Mesh {
  return placed(new THREE.RingGeometry(inner, outer, 72), flat(colour), at, z);
}

/** The goals after `from`, and the line through them if the `route` is shown. */
export function goals_ahead(from: Point, ahead: Point[], p: Palette, route: boolean): THREE.Object3D[] {
  const rings = ahead.map((at) => ring(at, 0.12, 0.15, 0.02, p.ok));
  return route ? [ribbon([from, ...ahead], 0.015, 0.016, p.ok), ...rings] : rings;
}

export function dot(at: Point, radius: number, z: number, colour: string): THREE.Mesh {
  return placed(new THREE.SphereGeometry(radius, 14, 10), flat(colour), at, z);
}

/** A band `width` wide along `line`, at its own heights or at `z`. */
export function ribbon(line: (Point & { z?: number | null })[], width: number, z: number, colour: string): THREE.Mesh {
  const xyz: number[] = [];
  const faces: number[] = [];
  for (let i = 0; i < line.length; ++i) {
    const a = line[Math.max(0, i - 1)];
    const b = line[Math.min(line.length - 1, i + 1)];
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const nx = (-(b.y - a.y) / length) * (width / 2);
    const ny = ((b.x - a.x) / length) * (width / 2);
    const height = line[i].z ?? z;
    xyz.push(line[i].x + nx, line[i].y + ny, height, line[i].x - nx, line[i].y - ny, height);
    if (i > 0) faces.push(2 * i - 2, 2 * i - 1, 2 * i, 2 * i, 2 * i - 1, 2 * i + 1);
  }
  return new THREE.Mesh(vertices(xyz).setIndex(faces), flat(colour));
}

/** A round line through `places` of W, `radius` [m] thick. */
export function tube(places: readonly (readonly [number, number, number])[], radius: number, colour: string, sides = 6): THREE.Mesh {
  const path = new THREE.CurvePath<THREE.Vector3>();
  for (let i = 1; i < places.length; ++i) {
    const [a, b] = [new THREE.Vector3(...places[i - 1]), new THREE.Vector3(...places[i])];
    if (a.distanceTo(b) > 1e-6) path.add(new THREE.LineCurve3(a, b));
  }
  const geometry = path.curves.length > 0 ? new THREE.TubeGeometry(path, 2 * path.curves.length, radius, sides) : new THREE.BufferGeometry();
  return new THREE.Mesh(geometry, flat(colour));
}

/** The hull's outline at `pose`, on the floor. */
export function outline_at(pose: Pose, scene: SceneState, colour: string): THREE.Object3D {
  const { hull, radius } = scene;
  const corners = hull
    ? [[1, 1], [-1, 1], [-1, -1], [1, -1]].map(([a, b]) => [a * hull.half_length, b * hull.half_width])
    : Array.from({ length: 48 }, (_, k) => [radius * Math.cos((k * Math.PI) / 24), radius * Math.sin((k * Math.PI) / 24)]);
  const xyz = corners.flatMap(([x, y]) => {
    const p = to_parent(pose, x, y);
    return [p.x, p.y, 0.02];
  });
  return new THREE.LineLoop(vertices(xyz), new THREE.LineBasicMaterial({ color: colour }));
}

/** Sonar echoes as arcs, which hold the obstacle somewhere, with the free cone before them, and infrared returns as
 * dots, in the scan plane. */
export function ranging(readings: PlacedReadings, p: Palette): THREE.Object3D[] {
  return [...readings.values()].filter((r) => r.hit).flatMap(({ kind, origin, range }) => {
    const at = (turn: number): Point => ({
      x: origin.x + range * Math.cos(origin.heading + turn), y: origin.y + range * Math.sin(origin.heading + turn),
    });
    if (kind === "infrared") return dot(at(0), 0.02, kScanHeight, p.warn);
    const arc = Array.from({ length: 9 }, (_, k) => at((k / 4 - 1) * kHalfCone));
    return [ribbon(arc, 0.02, kScanHeight, p.scan), wedge(origin, arc, kScanHeight, p.scan, kConeAlpha)];
  });
}

/** The area from `tip` to `arc`, see-through. */
export function wedge(tip: Point, arc: Point[], z: number, colour: string, opacity: number): THREE.Mesh {
  const xyz: number[] = [];
  for (let i = 1; i < arc.length; ++i) {
    xyz.push(tip.x, tip.y, z, arc[i - 1].x, arc[i - 1].y, z, arc[i].x, arc[i].y, z);
  }
  return new THREE.Mesh(vertices(xyz), Object.assign(flat(colour), { transparent: true, opacity, depthWrite: false }));
}

/** Bumpers that are pressed, as bands round the hull. */
export function pressed(f: Frame, radius: number, p: Palette): THREE.Object3D[] {
  const half = Math.PI / Math.max(3, f.bumpers.length);
  return f.bumpers.filter((b) => b.pressed).map(({ mount }) => {
    const middle = f.pose.heading + mount.heading;
    const at = (turn: number): Point => ({
      x: f.pose.x + radius * Math.cos(middle + turn), y: f.pose.y + radius * Math.sin(middle + turn),
    });
    return ribbon(Array.from({ length: 13 }, (_, k) => at((k / 6 - 1) * half)), 0.05, 0.25, p.bad);
  });
}

/** An arrow by `v` [m], `times` enlarged; level without its z. Arrows below 3 cm are left out. */
export function push_arrow(group: THREE.Group, at: Point, v: Point & { z?: number | null }, times: number, colour: string,
  z = 0.08): void {
  const up = v.z ?? 0;
  const length = Math.hypot(v.x, v.y, up) * times;
  if (length < 0.03) return;
  const head = Math.min(up === 0 ? 0.12 : 0.06, length * 0.5);
  const arrow = new THREE.ArrowHelper(new THREE.Vector3(v.x, v.y, up).normalize(),
    new THREE.Vector3(at.x, at.y, z), length, colour, head, head * 0.7);
  group.add(arrow);
}

const kSlit = 0.34; // [m] the upper end of the slit through which the scanners of a high base see

/** A hull with wheels, a scanner and an arrowhead, in R. */
export function body(scene: SceneState, p: Palette): THREE.Object3D[] {
  const r = scene.radius;
  const paint = (colour: string) => new THREE.MeshStandardMaterial({ color: colour, roughness: 0.6 });
  const upright = (geometry: THREE.BufferGeometry, colour: string, z: number) => {
    const mesh = new THREE.Mesh(geometry, paint(colour));
    mesh.rotation.x = Math.PI / 2;
    mesh.position.z = z;
    return mesh;
  };
  const hull = scene.hull
    ? new THREE.Mesh(new THREE.BoxGeometry(2 * scene.hull.half_length, 2 * scene.hull.half_width, 0.18),
        paint(p.robot))
    : upright(new THREE.CylinderGeometry(r, r, 0.18, 48), p.robot, 0.15);
  hull.position.z = 0.15;
  const width = scene.hull ? scene.hull.half_width : r;
  const scanner = upright(new THREE.CylinderGeometry(0.06, 0.07, 0.1, 24), p.filtered, 0.29);
  const wheels = [-1, 1].map((side) => {
    const wheel = new THREE.Mesh(new THREE.CylinderGeometry(0.09, 0.09, 0.05, 24), paint(p.obstline));
    wheel.position.set(0, side * Math.min(scene.half_track, width - 0.03), 0.09);
    return wheel;
  });
  const head = new THREE.Shape([[0.86, 0], [0.36, 0.34], [0.36, -0.34]].map(([x, y]) =>
    new THREE.Vector2(x * (scene.hull?.half_length ?? r), y * width)));
  const nose = new THREE.Mesh(new THREE.ShapeGeometry(head), flat(p.bg));
  nose.position.z = 0.245;
  const rest = [hull, scanner, ...wheels, nose];
  const top = scene.arm?.base_height ?? 0; // above the slit for the scanners
  if (top <= kSlit) return rest;
  const upper = upright(new THREE.CylinderGeometry(r, r, top - kSlit, 48), p.robot, (top + kSlit) / 2);
  nose.position.z = top + 0.005;
  return [...rest, upper];
}
