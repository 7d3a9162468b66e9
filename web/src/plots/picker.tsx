// web/src/plots/picker.tsx: the list of signals to choose from: search, groups, a switch for each.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { Choices, is_shown } from "../state/measures";
import { Signal } from "../state/signals";
import { matches } from "../words";

export function Picker(props: {
  signals: Signal[]; choices: Choices; on_choose: (choices: Choices) => void; on_close: () => void;
}): JSX.Element {
  const { signals, choices } = props;
  const [text, set_text] = useState("");
  const find = useRef<HTMLInputElement>(null);
  useEffect(() => {
    find.current?.focus({ preventScroll: true });
    find.current?.closest(".plots")?.scrollTo(0, 0); // it stands above the plots
    find.current?.scrollIntoView({ block: "nearest" });
  }, []);
  const found = signals.filter((s) => matches(`${s.label} ${s.name} ${s.unit} ${s.group} ${s.meaning}`, text));
  const groups = [...new Set(found.map((s) => s.group))];
  return (
    <div class="picker" role="group" aria-label="Signals to plot" data-testid="picker" onKeyDown={(e) => {
      if (e.key !== "Escape") return;
      e.stopPropagation();
      props.on_close();
    }}>
      <div class="picker-find">
        <input type="search" aria-label="Find a signal" placeholder="Find a signal" value={text} data-testid="picker-find"
          ref={find} onInput={(e) => set_text(e.currentTarget.value)} />
        <button class="text" onClick={() => props.on_choose({})} data-testid="picker-usual"
          title="The signals that are shown when nobody has chosen">Usual ones</button>
      </div>
      <div class="picker-list">
        {found.length === 0 && <p class="quiet">No signal of this run has these words.</p>}
        {groups.map((group) => (
          <div role="group" aria-label={group} key={group}>
            <h2>{group}</h2>
            {found.filter((s) => s.group === group).map((s) => (
              <SignalRow key={s.name} of={s} on={is_shown(s, choices)}
                on_press={(on) => props.on_choose({ ...choices, [s.name]: on })} />
            ))}
          </div>
        ))}
      </div>
    </div>
  );
}

/** Enter switches the signal; Space is Stop, as everywhere. */
function SignalRow(props: { of: Signal; on: boolean; on_press: (on: boolean) => void }): JSX.Element {
  const { name, label, unit, meaning } = props.of;
  return (
    <button class="signal-row" role="checkbox" aria-checked={props.on} data-testid={`signal-${name}`} title={meaning}
      onClick={() => props.on_press(!props.on)}>
      <i class="box-mark" aria-hidden="true" />
      <span>{label}{unit && <u> {unit}</u>}<small>{meaning}</small></span>
    </button>
  );
}
