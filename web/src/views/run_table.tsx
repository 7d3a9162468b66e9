// web/src/views/run_table.tsx: the table of runs: sorted by its heads, selected by its boxes, a batch
// as one line that opens.
import { JSX } from "preact";
import { useRef, useState } from "preact/hooks";
import { use_app } from "../app";
import { RunItem, RunPage } from "../contract";
import { use_fetched } from "../link/fetched";
import { icons } from "../ui/icons";
import { driver_word, fixed, kind_words, result_word, titled } from "../words";
import { Selection, key_of, runs_words } from "./run_actions";
import { RunList, query_of } from "./run_list";

const kMembers = 20;
const kMembersMs = 3000;

interface Column { name: string; sort: string; unit?: string; figure?: boolean; wide?: string; help?: string }
const kColumns: Column[] = [
  { name: "Run", sort: "id" },
  { name: "Scenario", sort: "scenario" },
  { name: "Controller", sort: "controller", wide: "no-phone" },
  { name: "Outcome", sort: "outcome", help: "The first outcome: later goals of a live run do not change it" },
  { name: "Seed", sort: "seed", figure: true, wide: "wide" },
  { name: "Time", sort: "time", unit: "s", figure: true, help: "To the first outcome; to the newest tick while there is none" },
  { name: "Path", sort: "path_length", unit: "m", figure: true, wide: "wide", help: "Length of the way driven" },
  { name: "Clearance", sort: "min_clearance", unit: "m", figure: true, wide: "wide", help: "Least true distance from the hull to an obstacle" },
  { name: "Intrusion", sort: "intrusion", unit: "m", figure: true, wide: "wide widest", help: "Greatest depth into the safety circle" },
];
const kAscendsFirst = ["scenario", "controller", "outcome", "min_clearance"];

interface TableProps {
  list: RunList; open: number | null; compare: readonly number[]; selection: Selection;
  on_select: (selection: Selection) => void;
}

export function RunTable(props: TableProps): JSX.Element {
  const { list, selection } = props;
  const [opened, set_opened] = useState<ReadonlySet<number>>(new Set());
  const last = useRef<string | null>(null); // the line pressed last, from which Shift selects
  const { items } = list;
  const all = items.length > 0 && items.every((r) => selection.has(key_of(r)));

  const select = (run: RunItem, range: boolean) => {
    const next = new Map(selection);
    const on = !selection.has(key_of(run));
    const from = range ? items.findIndex((r) => key_of(r) === last.current) : -1;
    const to = items.indexOf(run);
    const chosen = from < 0 || to < 0 ? [run] : items.slice(Math.min(from, to), Math.max(from, to) + 1);
    for (const r of chosen) on ? next.set(key_of(r), r) : next.delete(key_of(r));
    last.current = key_of(run);
    props.on_select(next);
  };
  const select_page = () => {
    const next = new Map(selection);
    for (const r of items) all ? next.delete(key_of(r)) : next.set(key_of(r), r);
    props.on_select(next);
  };
  const toggle = (batch: number) => {
    const next = new Set(opened);
    next.delete(batch) || next.add(batch);
    set_opened(next);
  };
  return (
    <table class="run-table" data-testid="run-table">
      <thead>
        <tr>
          <th class="box-cell"><Box label="Select the runs of this page" name="select-page" checked={all}
            on_press={select_page} /></th>
          {kColumns.map((c) => <Head key={c.sort} column={c} list={list} />)}
        </tr>
      </thead>
      <tbody>
        {items.map((r) => r.group
          ? <Batch key={key_of(r)} run={r} opened={opened.has(r.group.first)} on_toggle={toggle} select={select} {...props} />
          : <Row key={key_of(r)} run={r} select={select} {...props} />)}
      </tbody>
    </table>
  );
}

function Head(props: { column: Column; list: RunList }): JSX.Element {
  const { column, list } = props;
  const { search } = list;
  const on = search.sort === column.sort;
  const press = () => list.set_search(on ? { descending: !search.descending }
    : { sort: column.sort, descending: !kAscendsFirst.includes(column.sort) });
  return (
    <th scope="col" class={`${column.figure ? "r" : ""} ${column.wide ?? ""}`}
      aria-sort={on ? (search.descending ? "descending" : "ascending") : undefined}>
      <button class="sort" data-testid={`sort-${column.sort}`} title={column.help} onClick={press}>
        {column.name}{column.unit && <u> {column.unit}</u>}
        <i class={on ? "on" : ""}>{on && !search.descending ? icons.up : icons.down}</i>
      </button>
    </th>
  );
}

/** A check box that Enter switches too: Space is Stop everywhere. */
function Box(props: { label: string; name: string; checked: boolean; on_press: (range: boolean) => void }): JSX.Element {
  return (
    <label class="box" onClick={(e) => e.stopPropagation()}>
      <input type="checkbox" aria-label={props.label} data-testid={props.name} checked={props.checked}
        onClick={(e) => props.on_press(e.shiftKey)}
        onKeyDown={(e) => {
          if (e.key !== "Enter") return;
          e.preventDefault();
          props.on_press(e.shiftKey);
        }} />
    </label>
  );
}

interface LineProps extends TableProps { run: RunItem; select: (run: RunItem, range: boolean) => void }

/** Arrows move between the lines, with Shift they select; X selects the line in focus. */
function line_keys(e: KeyboardEvent, run: RunItem, select: LineProps["select"]): void {
  const by = { ArrowDown: 1, ArrowUp: -1 }[e.key];
  if (e.key.toLowerCase() === "x" && !e.ctrlKey && !e.metaKey && !e.altKey) select(run, e.shiftKey);
  else if (by === undefined) return;
  e.preventDefault();
  if (by === undefined) return;
  const links = [...(e.currentTarget as HTMLElement).closest("table")!.querySelectorAll<HTMLElement>(".run-link")];
  const next = links[links.indexOf(e.currentTarget as HTMLElement) + by];
  if (e.shiftKey) select(run, false);
  next?.focus();
}

function Row(props: LineProps & { member?: boolean }): JSX.Element {
  const app = use_app();
  const { run: r } = props;
  const on = r.id === props.open;
  const second = props.compare.includes(r.id);
  const key = key_of(r);
  const m = r.metrics;
  const kind = kind_words[r.kind];
  return (
    <tr class={`${on ? "on" : second ? "second" : ""} ${props.member ? "member" : ""} ${props.selection.has(key) ? "picked" : ""}`}
      data-testid={key} onClick={() => app.go("runs", r.id)}>
      <td class="box-cell"><Box label={`Select run ${r.id}`} name={`select-${r.id}`} checked={props.selection.has(key)}
        on_press={(range) => props.select(r, range)} /></td>
      <td class="num run-cell"><a class="run-link" href={`#/runs/${r.id}`} aria-current={on ? "true" : undefined}
        onKeyDown={(e) => line_keys(e, r, props.select)} onClick={(e) => e.stopPropagation()}>{r.id}</a>
        <span class="kind" title={kind.help} data-testid={`kind-${r.id}`}>
          {r.kind === "session" ? icons.live : icons.background}<span class="hidden-words">{kind.word}</span></span></td>
      <td class="name-cell">
        {r.label ? <b>{r.label}</b> : titled(r.scenario)}
        {r.note && <span class="kind" title={r.note}>{icons.note}<span class="hidden-words">Has a note</span></span>}
        {r.label && <small>{titled(r.scenario)}</small>}
        <small class="phone">{driver_word(r)}</small>
        {r.tags.map((tag) => <em class="label" key={tag}>{tag}</em>)}
      </td>
      <td class="no-phone" title={app.controller_label(r.controller)}>{driver_word(r)}</td>
      <td><Result run={r} /></td>
      <td class="r num wide">{r.seed}</td>
      <td class="r num">{fixed(r.time, 1)}</td>
      <td class="r num wide">{fixed(m?.path_length, 2)}</td>
      <td class="r num wide">{fixed(m?.min_clearance, 2)}</td>
      <td class="r num wide widest">{fixed(m?.intrusion, 2)}</td>
    </tr>
  );
}

function Result(props: { run: RunItem }): JSX.Element {
  const { run } = props;
  const word = result_word(run.result);
  const later = run.later && run.later.outcome !== run.outcome ? result_word(run.later.outcome).word : null;
  return (
    <>
      <span class={`tag tone-${word.tone}`}><i />{word.word}</span>
      {later && <small class="later">later {later.toLowerCase()}</small>}
    </>
  );
}

/** The line of a batch, and below it its newest runs while it is open. */
function Batch(props: LineProps & { opened: boolean; on_toggle: (batch: number) => void }): JSX.Element {
  const app = use_app();
  const { run: r, list } = props;
  const group = r.group!;
  const key = key_of(r);
  const path = props.opened ? query_of({ ...list.search, batch: r.batch }, kMembers) : null;
  const members = use_fetched<RunPage>(path, [], path === null ? null : kMembersMs).value?.items ?? []; // the list says what is wrong
  const toggle = () => props.on_toggle(group.first);
  return (
    <>
      <tr class={`batch ${props.selection.has(key) ? "picked" : ""}`} data-testid={key} onClick={toggle}>
        <td class="box-cell"><Box label={`Select batch ${group.first}`} name={`select-${key}`}
          checked={props.selection.has(key)} on_press={(range) => props.select(r, range)} /></td>
        <td class="num run-cell"><button class="run-link" aria-expanded={props.opened} data-testid={`open-${key}`}
          onKeyDown={(e) => line_keys(e, r, props.select)}
          onClick={(e) => {
            e.stopPropagation();
            toggle();
          }}>{group.first}–{group.last}</button></td>
        <td class="name-cell">{r.label || titled(r.scenario)}
          <span class="kind" title="Started together">{icons.batch}</span><small>{runs_words(group.runs)}</small></td>
        <td class="no-phone" title={app.controller_label(r.controller)}>{driver_word(r)}</td>
        <td><Results results={group.results} /></td>
        <td class="wide" /><td /><td class="wide" /><td class="wide" /><td class="wide widest" />
      </tr>
      {props.opened && members.map((run) => <Row {...props} key={run.id} run={run} member />)}
      {props.opened && group.runs > members.length && members.length > 0 && <tr class="member rest">
        <td /><td colSpan={9}><button class="text" data-testid={`all-${key}`}
          onClick={() => list.set_search({ batch: r.batch })}>Show all {runs_words(group.runs)} of this batch</button></td>
      </tr>}
    </>
  );
}

/** Runs of each result, in the result's colour. */
function Results(props: { results: Record<string, number> }): JSX.Element {
  return (
    <span class="results">
      {Object.entries(props.results).sort((a, b) => b[1] - a[1]).map(([result, count]) => {
        const { word, tone } = result_word(result);
        return <span key={result} class={`tag tone-${tone}`}><i />{count.toLocaleString("en")} {word.toLowerCase()}</span>;
      })}
    </span>
  );
}
