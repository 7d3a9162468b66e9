// web/src/experiments/results_table.tsx: a line a controller: rates with their intervals, times,
// clearances, and the tests against the baseline.
import { JSX } from "preact";
import { result_word } from "../words";
import { Arm, Comparison } from "./contract";
import { count, counted, interval_words, mean_words, median_words, p_words, percent } from "./words";

interface Props {
  arms: Arm[]; comparisons: Comparison[]; baseline: string | null; picked: string | null; on_pick: (label: string) => void;
}

/** Ends that only some worlds have: a column each where a run has ended so. */
const kRare = ["overturned", "fallen"];

export function ResultsTable(props: Props): JSX.Element {
  const rare = kRare.filter((outcome) => props.arms.some((arm) => (arm.rates[outcome]?.count ?? 0) > 0));
  return (
    <div class="results-box">
      <table class="results-table" data-testid="experiment-results">
        <thead><tr>
          <th scope="col">Controller</th><th scope="col">Reached</th><th scope="col">Collided</th><th scope="col">Stuck</th>
          {rare.map((outcome) => <th scope="col" key={outcome}>{result_word(outcome).word}</th>)}
          <th scope="col">Time <u>s</u></th><th scope="col">Path <u>m</u></th><th scope="col">Clearance <u>m</u></th>
        </tr></thead>
        <tbody>{props.arms.map((arm) => <Line key={arm.label} arm={arm} rare={rare} {...props} />)}</tbody>
      </table>
    </div>
  );
}

/** The colour of a controller: one is amber, the baseline violet, the others grey. */
export function tone_of(label: string, baseline: string | null, picked: string | null): string {
  return label === picked ? "accent" : label === baseline ? "elastic" : "muted";
}

function Line(props: Props & { arm: Arm; rare: string[] }): JSX.Element {
  const { arm, baseline, picked } = props;
  const { reached, collided, stuck } = arm.rates;
  const { time_s, path_m, min_clearance_m } = arm.figures;
  return (
    <tr class={`tone-${tone_of(arm.label, baseline, picked)} ${arm.label === picked ? "on" : ""}`} onClick={() => props.on_pick(arm.label)}>
      <th scope="row">
        <button class="text" onClick={() => props.on_pick(arm.label)} aria-pressed={arm.label === picked}>{arm.label}</button>
        <small>{arm.label === baseline ? "baseline, " : ""}{counted(arm.runs, "run")}{arm.missing > 0 && `, ${count(arm.missing)} missing`}</small>
      </th>
      <td class="num"><b>{percent(reached)}</b> <small>{interval_words(reached)}</small>
        <Versus tests={props.comparisons.find((c) => c.label === arm.label)} of="reached" /></td>
      <td class="num"><b>{percent(collided)}</b> <small>{interval_words(collided)}</small></td>
      <td class="num"><b>{percent(stuck)}</b> <small>{interval_words(stuck)}</small></td>
      {props.rare.map((outcome) => (
        <td class="num" key={outcome}><b>{percent(arm.rates[outcome])}</b> <small>{interval_words(arm.rates[outcome])}</small></td>
      ))}
      <td class="num"><b>{median_words(time_s, 1)}</b> <small>{mean_words(time_s, 1)}</small>
        <Versus tests={props.comparisons.find((c) => c.label === arm.label)} of="time_s" /></td>
      <td class="num"><b>{median_words(path_m, 2)}</b> <small>{mean_words(path_m, 2)}</small></td>
      <td class="num"><b>{median_words(min_clearance_m, 2)}</b> <small>{mean_words(min_clearance_m, 2)}</small></td>
    </tr>
  );
}

/** The paired test against the baseline. */
function Versus(props: { tests: Comparison | undefined; of: string }): JSX.Element | null {
  const test = props.tests?.[props.of] as { p_holm?: number; pairs?: number } | undefined;
  if (typeof test?.p_holm !== "number" || !test.pairs) return null;
  return <small class="versus" title={`Against ${props.tests!.baseline}, ${test.pairs} pairs, corrected by Holm`}>{p_words(test.p_holm)}</small>;
}
