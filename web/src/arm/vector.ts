// web/src/arm/vector.ts: vectors in three dimensions.
export type Vec3 = readonly [number, number, number];
/** The x, y and z axis of a frame. */
export type Axes = readonly [Vec3, Vec3, Vec3];

export const scaled = (v: Vec3, by: number): Vec3 => [v[0] * by, v[1] * by, v[2] * by];
export const add = (...all: Vec3[]): Vec3 =>
  all.reduce<Vec3>((sum, v) => [sum[0] + v[0], sum[1] + v[1], sum[2] + v[2]], [0, 0, 0]);
export const minus = (a: Vec3, b: Vec3): Vec3 => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec3, b: Vec3): Vec3 =>
  [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (v: Vec3): number => Math.sqrt(dot(v, v));
export const kUnit: Axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
