// web/src/views/place.ts: the place in an opened run that the address names: time and camera.
import { useEffect, useRef } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { View } from "../draw/view";
import { Player } from "../link/player";
import { print_route } from "../link/route";
import { StoredRun } from "../link/stored";
import { use_latest } from "../state/store";

const kRestMs = 400; // for which time and view rest before the address has them

/** Goes to the place of the address once it is fetched, and writes where one rests into the address. */
export function use_place(run: StoredRun, player: Player, view: View): void {
  const app = use_app();
  const { place } = use_ui("place");
  const aim = useRef<number | null>(null); // [s] not fetched yet
  useEffect(() => {
    aim.current = place.time;
    if (place.camera) view.show(place.camera);
  }, [place, view]);
  useEffect(() => {
    if (aim.current === null || run.rows === 0 || (!run.done && run.duration < aim.current)) return;
    player.seek(aim.current);
    aim.current = null;
  });

  const here = use_latest(() => ({
    time: player.time === run.opening ? null : player.time, camera: view.camera,
  }));
  useEffect(() => {
    const words = () => print_route({ view: "runs", run: run.item.id, ...here.current() });
    let noted = words();
    let before = noted;
    const timer = setInterval(() => {
      const now = words();
      if (now === before && now !== noted && aim.current === null && !player.playing) {
        noted = now;
        app.note_place(here.current());
      }
      before = now;
    }, kRestMs);
    return () => clearInterval(timer);
  }, [run, player]);
}
