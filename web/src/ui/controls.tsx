// web/src/ui/controls.tsx: the small controls the views share.
import { ComponentChildren, JSX } from "preact";
import { useEffect, useId, useRef, useState } from "preact/hooks";
import { Choice, ParameterInfo } from "../contract";
import { fixed, sentence_of } from "../words";
import { icons } from "./icons";
import { Named } from "./tip";

/** The picked value until the server has answered; then the value that the server holds. */
function use_picked(value: string, busy: boolean): [string, (picked: string) => void] {
  const [picked, set_picked] = useState<string | null>(null);
  const was_busy = useRef(false);
  useEffect(() => {
    if (was_busy.current && !busy) set_picked(null);
    was_busy.current = busy;
  }, [busy]);
  useEffect(() => set_picked(null), [value]);
  return [picked ?? value, set_picked];
}

interface PickProps {
  label: string; name: string; choices: Choice[]; value: string; disabled?: boolean;
  on_pick: (name: string) => void;
}

/** A row of radio buttons. */
export function Segments(props: PickProps): JSX.Element {
  const [value, set_picked] = use_picked(props.value, props.disabled ?? false);
  return (
    <div class="segments" role="radiogroup" aria-label={props.label} data-testid={props.name}>
      {props.choices.map((c) => (
        <label key={c.name} class={c.name === value ? "on" : ""} title={c.help}>
          <input type="radio" name={props.name} value={c.name} checked={c.name === value}
            disabled={props.disabled} onChange={() => {
              set_picked(c.name);
              props.on_pick(c.name);
            }} />
          <span>{c.label}</span>
        </label>
      ))}
    </div>
  );
}

export interface Tab { name: string; label: string; body: () => JSX.Element }

/** Tabs by the ARIA pattern: one stop of the Tab key, arrows between them. Only the shown body exists. */
export function Tabs(props: { label: string; tabs: Tab[]; shown: string; on_pick: (name: string) => void }): JSX.Element {
  const { tabs } = props;
  const shown = tabs.find((t) => t.name === props.shown) ?? tabs[0];
  const id = useId();
  const list = useRef<HTMLDivElement>(null);
  const key = (e: KeyboardEvent) => {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
    if (!by) return;
    const next = (tabs.indexOf(shown) + by + tabs.length) % tabs.length;
    props.on_pick(tabs[next].name);
    list.current?.querySelectorAll("button")[next].focus();
    e.preventDefault();
    e.stopPropagation(); // the arrows move no selection
  };
  return (
    <>
      <div class="tabs" role="tablist" aria-label={props.label} ref={list} onKeyDown={key}>
        {tabs.map((t) => (
          <button key={t.name} role="tab" id={`${id}-${t.name}`} aria-selected={t === shown} aria-controls={`${id}-body`}
            tabIndex={t === shown ? 0 : -1} data-testid={`tab-${t.name}`} onClick={() => props.on_pick(t.name)}>{t.label}</button>
        ))}
      </div>
      <div class="tab-body" role="tabpanel" id={`${id}-body`} aria-labelledby={`${id}-${shown.name}`}>{shown.body()}</div>
    </>
  );
}

export function Pick(props: PickProps & { class?: string }): JSX.Element {
  const [value, set_picked] = use_picked(props.value, props.disabled ?? false);
  return (
    <span class={`pick ${props.class ?? ""}`}>
      <select aria-label={props.label} data-testid={props.name} value={value}
        disabled={props.disabled} onChange={(e) => {
          set_picked(e.currentTarget.value);
          props.on_pick(e.currentTarget.value);
        }}>
        {props.choices.map((c) => <option key={c.name} value={c.name}>{c.label}</option>)}
      </select>
      {icons.down}
    </span>
  );
}

/** "Repulsion K_r" with the part after the underscore as a subscript. */
export function Subscripted(props: { text: string }): JSX.Element {
  const parts = props.text.split(/_(\w+)/);
  return <>{parts.map((p, i) => (i % 2 === 1 ? <sub key={i}>{p}</sub> : p))}</>;
}

/** Digits after the point that show a step of this size. */
function digits_of(step: number): number {
  return step >= 1 ? 0 : Math.min(4, Math.max(1, Math.ceil(-Math.log10(step) - 1e-9)));
}

const kSendMs = 120;

/** A gain. Moving it sends values at a steady pace; then it shows the server's value. */
export function Slider(props: {
  info: ParameterInfo; value: number; usual: number; on_set: (value: number) => Promise<unknown>;
}): JSX.Element {
  const { info } = props;
  const [held, set_held] = useState<number | null>(null);
  const sending = useRef({ at: 0, timer: 0, count: 0 });
  useEffect(() => () => clearTimeout(sending.current.timer), []);

  const send = (value: number) => {
    const s = sending.current;
    clearTimeout(s.timer);
    const go = () => {
      s.at = performance.now();
      const mine = ++s.count;
      const settle = () => {
        if (mine === s.count) set_held(null); // from now on the server's value is shown
      };
      void props.on_set(value).then(settle);
    };
    const wait = kSendMs - (performance.now() - s.at);
    if (wait <= 0) go();
    else s.timer = setTimeout(go, wait) as unknown as number;
  };
  const change = (value: number) => {
    set_held(value);
    send(value);
  };
  const value = held ?? props.value;
  const share = ((value - info.min) / (info.max - info.min)) * 100;
  const digits = digits_of(info.step);
  const id = `gain-${info.name}`;
  const changed = Math.abs(value - props.usual) > 1e-9;
  return (
    <div class="gain">
      <label for={id} data-tip={info.help}><Subscripted text={info.label} /></label>
      <button class="mini" data-testid={`reset-${info.name}`} aria-label={`Reset ${info.label} to ${fixed(props.usual, digits)}`}
        title={`Back to ${fixed(props.usual, digits)} ${info.unit}`} hidden={!changed}
        onClick={() => change(props.usual)}>{icons.reset}</button>
      <output for={id} class="num">{fixed(value, digits)}{info.unit && ` ${info.unit}`}</output>
      <span class="bound num" aria-hidden="true">{fixed(info.min, digits)}</span>
      <input id={id} data-testid={id} type="range" min={info.min} max={info.max} step={info.step}
        value={value} ref={(e) => e?.style.setProperty("--share", `${share}%`)}
        aria-valuetext={`${fixed(value, digits)} ${info.unit}`} aria-description={info.help}
        onInput={(e) => change(Number(e.currentTarget.value))} />
      <span class="bound r num" aria-hidden="true">{fixed(info.max, digits)}</span>
    </div>
  );
}

/** A number to type. While the field has the focus it shows the text as typed. An empty field is null. */
export function NumberField(props: {
  label: string; unit?: string; value: number | null; name: string; empty?: string; step?: number;
  min?: number; digits?: number; on_change: (value: number | null) => void;
}): JSX.Element {
  const [typed, set_typed] = useState<string | null>(null);
  const shown = typed ?? (props.value === null ? "" : String(Number(props.value.toFixed(props.digits ?? 2))));
  return (
    <label class="field">
      <span>{props.label}</span>
      <input class="num" type="number" step={props.step ?? 0.1} min={props.min} value={shown}
        placeholder={props.empty} data-testid={props.name} inputMode="decimal"
        onInput={(e) => {
          const text = e.currentTarget.value;
          set_typed(text);
          const value = text === "" ? null : Number(text);
          if (value === null || Number.isFinite(value)) props.on_change(value);
        }}
        onBlur={() => set_typed(null)} />
      {props.unit && <em>{props.unit}</em>}
    </label>
  );
}

/** A modal dialog: it holds the focus, and returns it when it closes. */
export function Dialog(props: {
  title: string; on_close: () => void; children: ComponentChildren; name: string;
}): JSX.Element {
  const box = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const dialog = box.current;
    if (dialog && !dialog.open) dialog.showModal();
    return () => dialog?.close();
  }, []);
  return (
    <dialog ref={box} class="dialog" aria-label={props.title}
      data-testid={props.name} onCancel={(e) => {
        e.preventDefault();
        props.on_close();
      }}
      onClick={(e) => {
        if (e.target === box.current) props.on_close();
      }}>
      <div class="dialog-body">
        <header>
          <h2>{props.title}</h2>
          <button class="icon" aria-label="Close" onClick={props.on_close}>{icons.close}</button>
        </header>
        {props.children}
      </div>
    </dialog>
  );
}

/** The sentence of the last failure, and a function that runs an action and keeps its failure. */
export function use_problem(): [string | null, (act: () => Promise<unknown>) => Promise<void>] {
  const [problem, set_problem] = useState<string | null>(null);
  return [problem, async (act) => {
    set_problem(null);
    await act().catch((error) => set_problem(sentence_of(error)));
  }];
}

export function Problem(props: { text: string | null; name?: string }): JSX.Element | null {
  return props.text === null ? null
    : <p class="problem" role="alert" data-testid={props.name}>{props.text}</p>;
}

/** A definition list of names and values; `meaning` explains a name. */
export function Facts(props: {
  rows: [string, ComponentChildren][]; meaning?: (name: string) => string | null;
}): JSX.Element {
  return (
    <dl class="facts-list">
      {props.rows.map(([name, value]) => (
        <div key={name}><dt><Named label={name} meaning={props.meaning?.(name) ?? null} /></dt><dd class="num">{value}</dd></div>
      ))}
    </dl>
  );
}
