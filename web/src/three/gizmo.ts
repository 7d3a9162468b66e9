// web/src/three/gizmo.ts: the handles of the hand's goal in 3D: drawn over everything, large enough for a finger at any
// distance, and held with a pointer.
import * as THREE from "three";
import { Handle, HandleName, Ray, begin_drag, handle_at, handles_of, is_axis } from "../arm/gizmo";
import { place_of } from "../arm/pose";
import { Vec3 } from "../arm/vector";
import type { HandGoalJson } from "../contract";
import type { Palette } from "../draw/palette";
import type { Point } from "../geometry";
import { label } from "./layers";
import { clear, flat, tube } from "./shapes";

const kSize = 105;  // [px] of an axis
const kShare = 0.23; // of the smaller side of the view, at most
const kThick = 3;   // [px] of a line
const kSlack = { mouse: 12, touch: 26 }; // [px] about a handle
const kRoundness = 8; // corners of a line's section

/** The goal that people hold, as the page's desk tells it. */
export interface HeldGoal {
  readonly chosen: boolean;
  readonly goal: HandGoalJson | null;
  hold(goal: HandGoalJson | null): void;
  drop(goal: HandGoalJson): void;
}

interface Held { pointer: number; handle: Handle; to: (ray: Ray) => HandGoalJson; last: HandGoalJson; moved: boolean }

export class Gizmo {
  readonly group = new THREE.Group();
  private held_: Held | null = null;
  private over_: HandleName | null = null;
  private size_ = 1; // [m]
  private readonly pen_: [string, (e: PointerEvent) => void][];

  constructor(private readonly camera_: THREE.PerspectiveCamera, private readonly canvas_: HTMLCanvasElement,
    private readonly desk_: () => HeldGoal | null, private readonly redraw_: () => void) {
    this.pen_ = [
      ["pointerdown", (e) => this.down(e)], ["pointermove", (e) => this.move(e)], ["pointerup", (e) => this.up(e)],
      ["pointercancel", () => this.cancel()],
    ];
    // Before the controls of the camera hear it.
    for (const [type, act] of this.pen_) canvas_.addEventListener(type, act as EventListener, { capture: true });
    this.group.renderOrder = 10;
  }

  dispose(): void {
    for (const [type, act] of this.pen_) this.canvas_.removeEventListener(type, act as EventListener, { capture: true });
    clear(this.group);
  }

  /** The handle under the pointer or in the hand. */
  get name(): HandleName | null {
    return this.held_?.handle.name ?? this.over_;
  }

  private get goal(): HandGoalJson | null {
    const desk = this.desk_();
    return desk?.chosen ? this.held_?.last ?? desk.goal : null;
  }

  build(p: Palette): void {
    clear(this.group);
    const { goal } = this;
    if (!goal) {
      delete this.canvas_.dataset.gizmo;
      return;
    }
    const pixel = this.pixel_at(place_of(goal));
    const { clientWidth: w, clientHeight: h } = this.canvas_;
    this.size_ = Math.min(kSize, kShare * Math.min(w, h)) * pixel;
    const handles = handles_of(goal, this.size_);
    for (const handle of handles) this.add(handle, pixel, p);
    this.tell(handles);
  }

  /** Writes where the handles can be held [px] on the element, for a script. */
  private tell(handles: Handle[]): void {
    const places = handles.map(({ name, line }) => {
      const at = this.to_screen(line.length === 2 ? line[1] : line[Math.floor(line.length / 8)]);
      return `${name} ${at?.x.toFixed(1)} ${at?.y.toFixed(1)}`;
    }).join(", ");
    if (this.canvas_.dataset.gizmo !== places) this.canvas_.dataset.gizmo = places;
  }

  private add(handle: Handle, pixel: number, p: Palette): void {
    const { name, axis, line } = handle;
    const on = name === this.name;
    const colour = on ? p.accent : is_axis(handle) || name === "level" ? p.ok : p.internal;
    const thick = (on ? 1.6 : 1) * kThick * pixel / 2;
    if (name === "level") {
      this.group.add(over(new THREE.Mesh(new THREE.SphereGeometry(6 * pixel, 18, 12), flat(colour)), at(line[0])));
      return;
    }
    this.group.add(over(tube(line, thick, colour, kRoundness)));
    if (line.length !== 2) return;
    const head = new THREE.Mesh(new THREE.ConeGeometry(6 * pixel, 16 * pixel, 18), flat(colour));
    head.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), at(axis));
    this.group.add(over(head, at(line[1])));
    const beyond = at(line[1]).addScaledVector(at(axis), 18 * pixel);
    const word = label(name, { ...beyond, z: null }, beyond.z, colour, p.font);
    word.scale.multiplyScalar((17 * pixel) / word.scale.y);
    this.group.add(over(word));
  }

  /** [m] of a pixel at `place`. */
  private pixel_at(place: Vec3): number {
    const far = -at(place).applyMatrix4(this.camera_.matrixWorldInverse).z;
    return (2 * Math.tan((this.camera_.fov * Math.PI) / 360) * Math.max(0.1, far)) / Math.max(1, this.canvas_.clientHeight);
  }
  private readonly to_screen = (place: Vec3): Point | null => {
    const p = at(place).project(this.camera_);
    const { clientWidth: w, clientHeight: h } = this.canvas_;
    return p.z < 1 ? { x: ((p.x + 1) / 2) * w, y: ((1 - p.y) / 2) * h } : null;
  };

  private px(e: PointerEvent): Point {
    const box = this.canvas_.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }
  private ray(e: PointerEvent): Ray {
    const { x, y } = this.px(e);
    const { clientWidth: w, clientHeight: h } = this.canvas_;
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2((2 * x) / w - 1, 1 - (2 * y) / h), this.camera_);
    const { origin, direction } = caster.ray;
    return { from: [origin.x, origin.y, origin.z], along: [direction.x, direction.y, direction.z] };
  }
  private under(e: PointerEvent): Handle | null {
    const { goal } = this;
    const slack = e.pointerType === "mouse" ? kSlack.mouse : kSlack.touch;
    return goal && handle_at(handles_of(goal, this.size_), this.px(e), slack, this.to_screen);
  }

  private down(e: PointerEvent): void {
    if (this.held_) {
      e.stopImmediatePropagation(); // a second finger turns no camera meanwhile
      return;
    }
    const handle = e.button === 0 ? this.under(e) : null;
    const { goal } = this;
    if (!handle || !goal) return;
    e.stopImmediatePropagation();
    e.preventDefault();
    this.canvas_.setPointerCapture(e.pointerId);
    this.held_ = { pointer: e.pointerId, handle, to: begin_drag(handle, goal, this.ray(e)), last: goal, moved: false };
    this.redraw_();
  }
  private move(e: PointerEvent): void {
    const { held_: held } = this;
    if (held?.pointer === e.pointerId) {
      e.stopImmediatePropagation();
      held.last = held.to(this.ray(e));
      held.moved = true;
      this.desk_()?.hold(held.last);
      return;
    }
    const over = e.buttons === 0 && e.pointerType === "mouse" ? this.under(e)?.name ?? null : this.over_;
    if (over === this.over_) return;
    this.over_ = over;
    this.canvas_.style.cursor = over ? "grab" : "";
    this.redraw_();
  }
  private up(e: PointerEvent): void {
    const { held_: held } = this;
    if (held?.pointer !== e.pointerId) return;
    e.stopImmediatePropagation();
    this.held_ = null;
    this.over_ = null;
    if (held.moved) this.desk_()?.drop(held.last);
    this.redraw_();
  }
  /** Escape, or a pointer that was taken away. */
  cancel(): void {
    if (!this.held_) return;
    this.held_ = null;
    this.desk_()?.hold(null);
  }
}

const at = ([x, y, z]: Vec3) => new THREE.Vector3(x, y, z);

/** Draws `object` over the world. */
function over<T extends THREE.Mesh | THREE.Sprite>(object: T, place?: THREE.Vector3): T {
  const material = object.material as THREE.Material;
  Object.assign(material, { depthTest: false, transparent: true });
  object.renderOrder = 10;
  if (place) object.position.copy(place);
  return object;
}
