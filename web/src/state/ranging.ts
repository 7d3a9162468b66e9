// web/src/state/ranging.ts: the newest readings of sonar and infrared, with poses in W.
import { Pose, compose } from "../geometry";
import { Frame, RangeReading } from "../link/frame";

export type RangeKind = "sonar" | "infrared";

export interface PlacedReading {
  kind: RangeKind;
  origin: Pose;  // of the sensor in W, its axis the heading
  range: number; // [m]
  hit: boolean;  // there was a return
  stamp: number; // [s] of the frame it came in
}

/** By sensor: kind and mount. */
export type PlacedReadings = Map<string, PlacedReading>;

export const kReadingHolds = 1; // [s] after which a reading is too old
const kOk = 0;   // BeamStatus.Ok

export function reading_key(kind: RangeKind, mount: Pose): string {
  return `${kind} ${mount.x} ${mount.y} ${mount.heading}`;
}

/** Takes the readings of `f`, and forgets readings that are too old or later than `f`. */
export function place_readings(placed: PlacedReadings, f: Frame): void {
  for (const [key, reading] of placed) {
    if (reading.stamp > f.stamp || f.stamp - reading.stamp > kReadingHolds) placed.delete(key);
  }
  const take = (kind: RangeKind, readings: RangeReading[]): void => {
    for (const { mount, range, status } of readings) {
      placed.set(reading_key(kind, mount), {
        kind, origin: compose(f.pose, mount), range, hit: status === kOk, stamp: f.stamp,
      });
    }
  };
  take("sonar", f.sonar);
  take("infrared", f.infrared);
}
