// web/src/three/world.ts: the scene in 3D, from the state of the view from above: z up, metres.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { HandGoalJson, SessionState } from "../contract";
import type { Link } from "../arm/chain";
import type { HandleName } from "../arm/gizmo";
import { Palette } from "../draw/palette";
import { Selection, kDrift } from "../draw/scene";
import { Eye } from "../edit/inspect";
import { Point, distance, to_parent } from "../geometry";
import { height_at, tilt_of } from "../ground";
import { Place, kScanHeight } from "../layer";
import { is_ground, present } from "../obstacle";
import { sweep_age } from "../state/age";
import { kOwn, visible_layers } from "../state/layers";
import { drawing } from "../state/meter";
import { Orbit, orbits } from "../state/remembered";
import { kRing, kWall } from "../state/stick";
import { SceneState, robot_pose, scene_bounds } from "../state/scene";
import { PlacedSweep, sweep_points } from "../state/sweeps";
import { build_arm, build_hand_goal, build_plan } from "./arm";
import { build_sectors, build_wall_words, build_ways_ahead } from "./driven";
import { beside_holes, ground } from "./ground";
import { Gizmo, HeldGoal } from "./gizmo";
import { build_map } from "./known_map";
import { build_layer } from "./layers";
import {
  body, clear, goal, goals_ahead, grid, outline_at, points, pressed, ranging, ribbon, ring, solid, sun, vertices,
} from "./shapes";

interface Options {
  selection: Selection; force_scale: number; hidden: ReadonlySet<string>; follow: boolean; session: SessionState | null;
  chase?: boolean; // the camera rides behind the robot
  desk: (HeldGoal & { draft: HandGoalJson | null }) | null; // of an arm that may be moved here
}

// The camera that rides behind the robot [m], R: its eye, and the point ahead that it looks at.
const kChaseEye = [-2.4, 0, 1.9] as const, kChaseTarget = [1.3, 0, 0] as const;

const kArmHeight = 0.5; // [m] that the middle of the view has with an arm
const kMostPath = 1500;
const kLate = 80;       // [ms] from asking for a picture to drawing it
const kMostLate = 4;    // late ones in a row
const kCoarser = 0.7, kCoarsest = 0.35; // of the pixels of the page, along each axis

export class World3 {
  private readonly renderer_ = new THREE.WebGLRenderer({ antialias: true, stencil: true });
  private readonly world_ = new THREE.Scene();
  private readonly camera_ = new THREE.PerspectiveCamera(45, 1, 0.05, 300);
  private readonly controls_: OrbitControls;
  private readonly observer_: ResizeObserver;
  private readonly statics_ = new THREE.Group();  // grid, obstacles, goal
  private readonly moving_ = new THREE.Group();   // path, the controller's layers
  private readonly robot_ = new THREE.Group();
  private readonly arm_ = new THREE.Group();
  private readonly plan_ = new THREE.Group();
  private readonly gizmo_: Gizmo;
  /** From the level plane of the robot's senses and plans to the plane on which it stands. */
  private readonly stand_ = new THREE.Matrix4();
  private readonly raw_ = points(2.5);
  private readonly filtered_ = points(3.5);
  private pending_ = 0;
  private asked_ = 0; // [ms] when the pending drawing was asked for
  private late_ = 0;  // drawings in a row that came late
  private built_: unknown[] = [];
  private planned_: unknown[] = [];
  private hull_: unknown[] = []; // of the robot that was built
  private scenario_: string | null = null; // for which the camera was placed
  private turned_ = false;                 // by a hand
  private chases_ = false;                 // the camera rides behind the robot
  private last_robot_: Point | null = null;

  constructor(private readonly box_: HTMLElement, private palette_: Palette,
    private readonly scene_: () => SceneState, private readonly options_: () => Options) {
    this.renderer_.setPixelRatio(Math.min(2, devicePixelRatio || 1));
    this.renderer_.domElement.setAttribute("aria-label",
      "The world in 3D. Drag to look round it, wheel to come nearer.");
    this.renderer_.domElement.setAttribute("role", "img");
    box_.prepend(this.renderer_.domElement);
    this.camera_.up.set(0, 0, 1);
    this.gizmo_ = new Gizmo(this.camera_, this.renderer_.domElement, () => this.options_().desk, () => this.request());
    this.controls_ = new OrbitControls(this.camera_, this.renderer_.domElement);
    this.controls_.maxPolarAngle = Math.PI / 2 - 0.03;
    this.controls_.minDistance = 0.8;
    this.controls_.maxDistance = 60;
    this.controls_.addEventListener("change", () => this.request());
    this.controls_.addEventListener("start", () => (this.turned_ = true));
    this.world_.add(new THREE.HemisphereLight(0xffffff, 0x667788, 2.2), sun(), this.statics_,
      this.moving_, this.robot_, this.arm_, this.plan_, this.raw_, this.filtered_, this.gizmo_.group);
    this.observer_ = new ResizeObserver(() => this.resize());
    this.observer_.observe(box_);
    this.set_palette(palette_);
    this.resize();
  }

  request(): void {
    if (this.pending_) return;
    this.asked_ = performance.now();
    this.pending_ = requestAnimationFrame(() => this.draw());
  }

  set_palette(palette: Palette): void {
    this.palette_ = palette;
    this.world_.background = new THREE.Color(palette.bg);
    (this.raw_.material as THREE.PointsMaterial).color.set(palette.scan);
    this.built_ = []; // so that everything is built again in the new colours
    this.planned_ = [];
    clear(this.robot_);
    this.request();
  }

  /** The handle of the gizmo that a pointer is on. */
  get handle(): HandleName | null {
    return this.gizmo_.name;
  }

  /** How a pointer at `px` of the view sees the scene. */
  eye(px: Point, slack: number): Eye {
    const { clientWidth: w, clientHeight: h } = this.box_;
    const ray = new THREE.Raycaster();
    ray.setFromCamera(new THREE.Vector2((2 * px.x) / w - 1, 1 - (2 * px.y) / h), this.camera_);
    const floor = ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), 0), new THREE.Vector3());
    return {
      px, slack, at: floor && { x: floor.x, y: floor.y },
      to_screen: (p, height) => {
        const at = new THREE.Vector3(p.x, p.y, height).project(this.camera_);
        return at.z < 1 ? { x: ((at.x + 1) / 2) * w, y: ((1 - at.y) / 2) * h } : null;
      },
      body: () => {
        const link = ray.intersectObject(this.arm_, true).at(0);
        const hull = ray.intersectObject(this.robot_, true).at(0)?.distance ?? Infinity;
        const robot = Math.min(hull, link?.distance ?? Infinity);
        const solids = this.statics_.children.filter((o) => o.userData.obstacle !== undefined);
        const hit = ray.intersectObjects(solids, false).at(0);
        if (hit && hit.distance < robot) {
          const { obstacle: id, ground } = hit.object.userData as { obstacle: number; ground?: boolean };
          return ground ? { kind: "ground", id, at: { x: hit.point.x, y: hit.point.y } } : { kind: "obstacle", id };
        }
        if (link && link.distance <= hull) return { kind: "link", link: (link.object.userData.link as Link | undefined) ?? "hand" };
        return robot < Infinity ? { kind: "robot" } : null;
      },
    };
  }

  dispose(): void {
    this.keep_orbit();
    cancelAnimationFrame(this.pending_);
    this.observer_.disconnect();
    this.controls_.dispose();
    this.gizmo_.dispose();
    for (const group of [this.statics_, this.moving_, this.robot_, this.arm_, this.plan_]) clear(group);
    for (const p of [this.raw_, this.filtered_]) p.geometry.dispose();
    this.renderer_.dispose();
    this.renderer_.domElement.remove();
  }

  private resize(): void {
    const w = Math.max(2, this.box_.clientWidth);
    const h = Math.max(2, this.box_.clientHeight);
    this.renderer_.setSize(w, h, false);
    this.camera_.aspect = w / h;
    this.camera_.updateProjectionMatrix();
    this.request();
  }

  private draw(): void {
    this.pending_ = 0;
    const scene = this.scene_();
    const options = this.options_();
    const scenario = options.session?.scenario.name ?? "";
    if (scenario !== this.scenario_ || this.chases_ !== (options.chase ?? false)) {
      this.keep_orbit();
      this.scenario_ = scenario;
      this.chases_ = options.chase ?? false;
      this.place_camera(scene, orbits.get(scenario));
    }
    this.controls_.enabled = !this.chases_;
    if (this.chases_) this.keep_pace();
    drawing.around(() => {
      this.build_statics(scene, options.selection, options.hidden);
      this.place_robot(scene, options.follow);
      this.build_moving(scene, options);
      this.build_arm(scene, options);
      this.place_points(scene, options.hidden);
      if (this.chases_) this.ride_behind(scene);
      else this.controls_.update();
      this.camera_.updateMatrixWorld();
      this.gizmo_.build(this.palette_);
      this.renderer_.render(this.world_, this.camera_);
    });
  }

  /** Looks at the whole world again, now and at the next visit. */
  fit(): void {
    this.turned_ = false;
    orbits.set(this.scenario_ ?? "", null);
    this.place_camera(this.scene_(), null);
    this.request();
  }
  /** Keeps the camera that a hand has turned for the next visit. */
  keep_orbit(): void {
    if (!this.turned_ || !this.scenario_) return;
    orbits.set(this.scenario_, { eye: this.camera_.position.toArray(), target: this.controls_.target.toArray() });
    this.turned_ = false;
  }

  private place_camera(scene: SceneState, orbit: Orbit | null): void {
    if (orbit) {
      this.controls_.target.fromArray(orbit.target);
      this.camera_.position.fromArray(orbit.eye);
      return;
    }
    const b = scene_bounds(scene);
    const middle = new THREE.Vector3((b.min_x + b.max_x) / 2, (b.min_y + b.max_y) / 2, scene.arm ? kArmHeight : 0);
    // On a phone held upright the view is narrower than high.
    const span = Math.max(3, b.max_x - b.min_x, b.max_y - b.min_y) / Math.min(1, this.camera_.aspect);
    this.controls_.target.copy(middle);
    this.camera_.position.set(middle.x - 0.3 * span, middle.y - 0.85 * span, middle.z + 0.85 * span);
  }

  /** Builds grid, obstacles and goal again only when one of them has changed. */
  private build_statics(scene: SceneState, selection: Selection, hidden: ReadonlySet<string>): void {
    const mesh = !hidden.has(kOwn.mesh.name);
    const hills = !hidden.has(kOwn.ground.name);
    const known = hidden.has(kOwn.map.name) ? null : scene.map;
    const key = [mesh, hills, known, scene.obstacles, scene.goal?.x, scene.goal?.y, scene.goal?.heading,
      selection?.kind, selection?.kind === "obstacle" ? selection.id : null];
    if (!changed(this.built_, key)) return;
    clear(this.statics_);
    const p = this.palette_;
    if (mesh) this.statics_.add(grid(p, beside_holes));
    const map = known && build_map(p);
    if (map) this.statics_.add(map);
    for (const o of present(scene.obstacles)) {
      const chosen = selection?.kind === "obstacle" && selection.id === o.id;
      if (!is_ground(o)) this.statics_.add(solid(o, p, chosen));
      else if (hills) this.statics_.add(ground(o, p, chosen));
    }
    if (scene.goal) this.statics_.add(goal(scene.goal, p));
  }

  private build_moving(scene: SceneState, options: Options): void {
    clear(this.moving_);
    const p = this.palette_;
    const on = (layer: { name: string }) => !options.hidden.has(layer.name);
    if (on(kOwn.path)) this.build_path(scene, 0.045, 0.012, p.path, false);
    if (on(kOwn.truth)) this.build_path(scene, 0.03, 0.011, p.muted, true);
    const pose = robot_pose(scene);
    const tilted = new THREE.Group(); // what has no heights of its own
    placed_by(tilted, this.stand_);
    this.moving_.add(tilted);
    if (pose && scene.drives && on(kOwn.safety)) {
      tilted.add(ring(pose, scene.safety_distance - 0.012, scene.safety_distance + 0.012, 0.014, p.safe));
    }
    if (scene.goal && scene.goals_ahead.length > 0) {
      this.moving_.add(...goals_ahead(scene.goal, scene.goals_ahead, p, on(kOwn.route)));
    }
    if (on(kOwn.ranging)) for (const o of ranging(scene.readings, p)) this.moving_.add(o);
    const f = scene.frame;
    if (!f) return;
    for (const o of pressed(f, scene.radius, p)) this.moving_.add(o);
    if (f.truth && on(kOwn.truth) && distance(f.truth.pose, f.pose) > kDrift) {
      this.moving_.add(outline_at(f.truth.pose, scene, p.muted));
    }
    const stage = { group: tilted, palette: p, robot: f.pose, radius: scene.radius, times: options.force_scale };
    const pixel = (2 * Math.tan((this.camera_.fov * Math.PI) / 360)) / Math.max(1, this.box_.clientHeight);
    for (const layer of visible_layers(scene, options.hidden)) {
      if (layer.name === kRing) tilted.add(...build_sectors(scene, p, f.pose, pixel));
      else build_layer(layer.axes > 2 ? { ...stage, group: this.moving_ } : stage, layer);
      if (layer.name === kWall) tilted.add(...build_wall_words(scene, p, pixel));
    }
    for (const o of build_ways_ahead(scene, p, options.hidden)) tilted.add(o);
  }

  private build_arm(scene: SceneState, { hidden, desk }: Options): void {
    clear(this.arm_);
    if (!scene.arm) {
      clear(this.plan_);
      return;
    }
    for (const o of build_arm(scene, this.palette_)) this.arm_.add(o);
    placed_by(this.arm_, this.stand_);
    for (const o of build_hand_goal(scene, this.palette_, desk?.draft ?? null)) this.moving_.add(o);
    if (!changed(this.planned_, [scene.arm_plan?.ghost, scene.frame?.arm?.state === "arrived", hidden])) return;
    clear(this.plan_);
    for (const o of build_plan(scene, this.palette_, hidden)) this.plan_.add(o);
  }

  private build_path(scene: SceneState, width: number, z: number, colour: string, truly: boolean): void {
    const rows = Math.min(scene.rows, scene.columns.length);
    if (rows < 2) return;
    const line: Place[] = [];
    const hills = scene.obstacles.filter(is_ground);
    scene.columns.each_place(0, rows, kMostPath, (x, y) => {
      if (Number.isFinite(x)) line.push({ x, y, z: z + (hills.length > 0 ? Math.max(0, height_at(hills, { x, y })) : 0) });
    }, truly);
    this.moving_.add(ribbon(line, width, z, colour));
  }

  /** A driver needs a new picture more than a fine one: where pictures come late they get coarser. */
  private keep_pace(): void {
    this.late_ = performance.now() - this.asked_ > kLate ? this.late_ + 1 : 0;
    const ratio = this.renderer_.getPixelRatio();
    if (this.late_ < kMostLate || ratio <= kCoarsest) return;
    this.late_ = 0;
    this.renderer_.setPixelRatio(Math.max(kCoarsest, ratio * kCoarser));
  }

  private ride_behind(scene: SceneState): void {
    const pose = robot_pose(scene);
    if (!pose) return;
    const at = ([x, y, z]: readonly [number, number, number]) => {
      const p = to_parent(pose, x, y);
      return new THREE.Vector3(p.x, p.y, z);
    };
    this.camera_.position.copy(at(kChaseEye));
    this.camera_.lookAt(at(kChaseTarget));
  }

  private place_robot(scene: SceneState, follow: boolean): void {
    const pose = robot_pose(scene);
    if (!pose) return;
    if (this.robot_.children.length === 0 || changed(this.hull_, [scene.hull, scene.radius, scene.arm?.base_height])) {
      clear(this.robot_);
      this.robot_.add(...body(scene, this.palette_));
    }
    const { z, roll, pitch } = tilt_of(scene) ?? { z: 0, roll: 0, pitch: 0 };
    this.robot_.position.set(pose.x, pose.y, z);
    this.robot_.rotation.set(roll, pitch, pose.heading, "ZYX"); // algo::Tilt says the order
    this.robot_.updateMatrix();
    const level = new THREE.Matrix4().makeRotationZ(pose.heading).setPosition(pose.x, pose.y, 0);
    this.stand_.multiplyMatrices(this.robot_.matrix, level.invert());
    const last = this.last_robot_;
    if (follow && last) {
      const step = new THREE.Vector3(pose.x - last.x, pose.y - last.y, 0);
      this.camera_.position.add(step);
      this.controls_.target.add(step);
    } else if (follow) {
      this.controls_.target.set(pose.x, pose.y, 0);
    }
    this.last_robot_ = follow ? { x: pose.x, y: pose.y } : null;
  }

  private place_points(scene: SceneState, hidden: ReadonlySet<string>): void {
    const filtered = scene.filtered.shown;
    const old = filtered !== null && sweep_age(scene, filtered) !== null;
    (this.filtered_.material as THREE.PointsMaterial).color.set(old ? this.palette_.scan : this.palette_.filtered);
    set_points(this.raw_, hidden.has(kOwn.scan.name) ? [] : scene.sweeps);
    set_points(this.filtered_, filtered && !hidden.has(kOwn.filtered.name) ? [filtered] : []);
    for (const points of [this.raw_, this.filtered_]) placed_by(points, this.stand_);
  }
}

/** Whether `now` differs from what `before` holds; afterwards it holds that. */
function changed(before: unknown[], now: unknown[]): boolean {
  if (now.length === before.length && now.every((v, i) => v === before[i])) return false;
  before.splice(0, before.length, ...now);
  return true;
}

function placed_by(object: THREE.Object3D, matrix: THREE.Matrix4): void {
  object.matrixAutoUpdate = false;
  object.matrix.copy(matrix);
  object.matrixWorldNeedsUpdate = true;
}

function set_points(points: THREE.Points, sweeps: PlacedSweep[]): void {
  const xyz: number[] = [];
  for (const sweep of sweeps) {
    const { hits } = sweep_points(sweep);
    for (let i = 0; i < hits.length; i += 2) xyz.push(hits[i], hits[i + 1], kScanHeight);
  }
  points.geometry.dispose();
  points.geometry = vertices(xyz);
}
