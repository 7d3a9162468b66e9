// web/src/arm/range.tsx: an angle as a slider and as a number. While it slides it tells so, and once more at its end.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { icons } from "../ui/icons";
import { Named } from "../ui/tip";
import { fixed } from "../words";

export function Range(props: {
  name: string; label: string; help: string; min: number; max: number; step: number; value: number; // [degrees]
  words?: string; // instead of a goal
  aim?: number;   // where it is going, if that is not where it is
  reset?: { label: string; act: () => void };
  on_slide: (value: number) => void; on_set: (value: number) => void;
}): JSX.Element {
  const { name, min, max, step, reset } = props;
  const [held, set_held] = useState<number | null>(null);
  const [typed, set_typed] = useState<string | null>(null); // stands while the arm moves
  const value = held ?? props.aim ?? props.value;
  const share = ((value - min) / (max - min)) * 100;
  const say = `${fixed(value, 0)}°`;
  const set = (v: number) => {
    set_held(null);
    props.on_set(Math.max(min, Math.min(max, v)));
  };
  const commit = () => {
    const angle = Number(typed);
    set_typed(null);
    if (typed !== null && typed !== "" && Number.isFinite(angle)) set(angle);
  };
  return (
    <div class="gain arm-range">
      <label for={name}><Named label={props.label} meaning={props.help} /></label>
      {reset && <button type="button" class="mini" aria-label={reset.label} title={reset.label} onClick={reset.act}>{icons.reset}</button>}
      <span class="arm-number">
        {props.words && held === null && <em>{props.words}</em>}
        <input class="num" type="number" min={min} max={max} step={step} value={typed ?? Math.round(value)}
          aria-label={`${props.label} in degrees`} data-testid={`${name}-number`} onInput={(e) => set_typed(e.currentTarget.value)}
          onKeyDown={(e) => {
            if (e.key !== "Enter") return;
            e.preventDefault(); // the angle alone is sent, not the form about it
            commit();
          }} onBlur={commit} />°
      </span>
      <span class="bound num" aria-hidden="true">{fixed(min, 0)}</span>
      <input id={name} data-testid={name} type="range" min={min} max={max} step={step} value={value} aria-valuetext={say}
        aria-description={props.help} ref={(e) => e?.style.setProperty("--share", `${share}%`)}
        onInput={(e) => {
          set_held(Number(e.currentTarget.value));
          props.on_slide(Number(e.currentTarget.value));
        }}
        onChange={(e) => set(Number(e.currentTarget.value))} />
      <span class="bound r num" aria-hidden="true">{fixed(max, 0)}</span>
    </div>
  );
}
