// web/src/plots/save_dialog.tsx: what can be saved of a run: plots and scene as pictures, the ticks as CSV.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_ui } from "../app";
import { Dialog, Problem, use_problem } from "../ui/controls";
import { icons } from "../ui/icons";
import "../ui/switch";
import { ScenePart, Sheet, scene_picture, sheet_picture } from "./pictures";
import { save_picture } from "./save";

export interface SaveProps {
  title: string; // of the pictures: run and scenario
  file: string;  // start of the files' names
  csv: { run: number; name: string }[]; // the runs with a record
  scene?: () => ScenePart;
}

export function SaveDialog(props: SaveProps & { sheet: () => Sheet; on_close: () => void }): JSX.Element {
  const { theme } = use_ui("theme");
  const [light, set_light] = useState(true);
  const [problem, attempt] = use_problem();
  const save = (what: "plots" | "scene", kind: "svg" | "png") => void attempt(() => save_picture(
    what === "plots" ? sheet_picture(props.sheet()) : scene_picture(props.scene!(), props.title),
    `${props.file}-${what}`, kind, light ? "light" : theme));
  const pair = (what: "plots" | "scene", label: string) => (
    <div class="save-line" role="group" aria-label={label}>
      <span>{label}</span>
      <button class="ghost" data-testid={`save-${what}-svg`} onClick={() => save(what, "svg")}>SVG</button>
      <button class="ghost" data-testid={`save-${what}-png`} onClick={() => save(what, "png")}>PNG</button>
    </div>
  );
  return (
    <Dialog title="Save" name="save-dialog" on_close={props.on_close}>
      <div class="form">
        {pair("plots", "Plots")}
        {props.scene && pair("scene", "Scene from above")}
        <button class="layer save-light" role="switch" aria-checked={light} data-testid="save-light"
          onClick={() => set_light(!light)}><span>Light background</span><i class="switch" /></button>
        {props.csv.map(({ run, name }) => (
          <div class="save-line" role="group" aria-label={`Table of run ${run}`} key={run}>
            <span>Ticks of run {run} with units</span>
            <a class="ghost" href={`/api/v1/runs/${run}/csv?units=1`} download={`${name}.csv`} data-testid={`save-csv-${run}`}>{icons.download}CSV</a>
            <a class="ghost" href={`/api/v1/runs/${run}/csv?units=1&arrays=1`} download={`${name}-scans.csv`}
              title="Also the ranges of all scans, and the obstacles that move by themselves">with scans</a>
          </div>
        ))}
        <Problem text={problem} />
      </div>
    </Dialog>
  );
}
