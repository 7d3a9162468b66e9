// web/src/views/lanes.tsx: the plots of a stored run, or of up to four compared ones. The cursor is the
// instant that the scene shows.
import { JSX } from "preact";
import { StoredRun } from "../link/stored";
import { ScenePart } from "../plots/pictures";
import { file_name } from "../plots/save";
import { PlotStack } from "../plots/stack";
import { driver_word, titled } from "../words";

export function Lanes(props: {
  runs: StoredRun[];   // the first is the one that the scene shows
  time: number;
  playing: boolean;    // a moving pointer then leaves the instant alone
  on_pick: (t: number) => void;
  scene: () => ScenePart;
}): JSX.Element {
  const items = props.runs.map((r) => r.item);
  const names = items.map((item) => `Run ${item.id}`).join(", ");
  return (
    <PlotStack runs={props.runs.map((run) => ({ label: String(run.item.id), columns: run.columns }))} live={false} usual={Infinity}
      time={props.time} seek={props.on_pick} follows={!props.playing} folds height={56}
      save={{
        title: `${names}: ${titled(items[0].scenario)}, ${[...new Set(items.map(driver_word))].join(" and ")}`,
        file: file_name(items[0].id, items[0].scenario),
        csv: items.map((item) => ({ run: item.id, name: file_name(item.id, item.scenario) })),
        scene: props.scene,
      }} />
  );
}
