// web/src/views/topbar.tsx: brand, scenario, source, link in words, theme, help, Stop and Release. At a small
// height the Drive view has it as the head of its column, with a menu for the views.
import { JSX } from "preact";
import { useEffect, useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { ScenarioItem } from "../contract";
import { use_listener, use_pulse } from "../state/store";
import { link_words, matches, source_word, titled } from "../words";
import { Guard } from "../ui/guard";
import { Brand, icons } from "../ui/icons";
import { StopButtons } from "./stop";
import { Watching } from "./watching";

export function TopBar(): JSX.Element {
  const app = use_app();
  const { session, theme, view, views } = use_ui("session", "theme", "view", "views");
  const source = source_word(session);
  const next = theme === "dark" ? "light" : "dark";
  return (
    <header class="topbar">
      {view !== "nowhere" && <h1 class="hidden-words">{titled(view)}</h1>}
      <button class="icon bar-button short" aria-label="Views" aria-expanded={views} data-testid="views"
        onClick={() => app.ui.set({ views: !views })}>{icons.menu}</button>
      <a class="brand" href="#/drive" aria-label="Tautline, to the Drive view">
        <Brand /><span class="wide">Tautline</span>
      </a>
      <Guard need="operator"><ScenarioMenu /></Guard>
      {source && <span class={`badge ${source.tone}`} data-testid="source">{source.word}</span>}
      <span class="space" />
      <Watching />
      <LinkWords />
      <button class="icon bar-button wide" aria-label={`Use the ${next} theme`} title={`${titled(next)} theme`}
        data-testid="theme" onClick={() => app.set_theme(next)}>{icons.theme}</button>
      <button class="icon bar-button" aria-label="Help and keys" title="Help and keys (?)" data-testid="help"
        onClick={() => app.ui.set({ shortcuts: true })}>{icons.help}</button>
      <StopButtons />
    </header>
  );
}

function LinkWords(): JSX.Element {
  const app = use_app();
  const { link } = use_ui("link");
  use_pulse(link.phase === "lost" ? 250 : 5000); // the seconds count down
  return (
    <span class={`link ${link.phase}`} data-testid="link">
      <i class="dot" /><span class="wide num">{link_words(link, performance.now())}</span>
      {link.phase === "lost" &&
        <button class="text wide" onClick={() => app.link.retry_now()}>Try now</button>}
    </span>
  );
}

/** The scenario's name, and a searchable list of all there are. */
function ScenarioMenu(): JSX.Element {
  const app = use_app();
  const { session, loading } = use_ui("session", "loading");
  const [open, set_open] = useState(false);
  const box = useRef<HTMLDivElement>(null);
  const button = useRef<HTMLButtonElement>(null);
  use_listener("pointerdown", (e) => {
    if (open && !box.current?.contains(e.target as Node)) set_open(false);
  });

  const close = () => {
    set_open(false);
    button.current?.focus();
  };
  const name = session?.scenario.name ?? "";
  const title = session?.scenario.title || titled(name);
  return (
    <div class="menu" ref={box}>
      <button ref={button} class="menu-button" aria-haspopup="listbox" aria-expanded={open}
        data-testid="scenario-menu" disabled={!session} data-scenario={name}
        onClick={() => {
          if (!open) void app.fetch_lists(); // somebody may have saved another world
          set_open(!open);
        }}>
        <span class="hidden-words">Scenario:</span>
        <span class="menu-name">{loading ? `Loading ${titled(loading)}` : titled(name) || "No scenario"}</span>
        {!loading && (session?.edited ? <small class="wide" title="The World tab saves it">changed, not saved</small>
          : title !== titled(name) && <small class="wide">{title}</small>)}
        {icons.down}
      </button>
      {open && <ScenarioList current={name} on_close={close} on_pick={(s) => {
        close();
        void app.editor.load({ scenario: s.name });
      }} />}
    </div>
  );
}

function ScenarioList(props: {
  current: string; on_pick: (item: ScenarioItem) => void; on_close: () => void;
}): JSX.Element {
  const { scenarios: all } = use_ui("scenarios");
  const [text, set_text] = useState("");
  const shown = all.filter((s) => matches(`${s.name} ${s.title} ${s.description}`, text));
  const [active, set_active] = useState(() =>
    Math.max(0, all.findIndex((s) => s.name === props.current)));
  const at = Math.min(active, shown.length - 1);
  const list = useRef<HTMLUListElement>(null);
  useEffect(() => {
    list.current?.querySelector(".active")?.scrollIntoView({ block: "nearest" });
  }, [at, text]);

  const key = (e: KeyboardEvent) => {
    const moves: Record<string, number> = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0,
      End: shown.length - 1 };
    if (e.key in moves) {
      set_active(Math.max(0, Math.min(shown.length - 1, moves[e.key])));
      e.preventDefault();
    } else if (e.key === "Enter" && shown[at]) {
      props.on_pick(shown[at]);
      e.preventDefault();
    } else if (e.key === "Escape" || e.key === "Tab") {
      props.on_close();
      e.preventDefault();
    }
    e.stopPropagation();
  };
  const worlds = shown.filter((s) => s.kind !== "log");
  const logs = shown.filter((s) => s.kind === "log");
  const option = (s: ScenarioItem) => {
    const index = shown.indexOf(s);
    return (
      <li key={s.name} id={`scenario-${s.name}`} role="option" aria-selected={s.name === props.current}
        class={index === at ? "active" : ""} data-testid={`scenario-${s.name}`}
        onClick={() => props.on_pick(s)} onPointerMove={() => set_active(index)}>
        <b>{titled(s.name)}</b><span>{s.title}</span>
      </li>
    );
  };
  return (
    <div class="menu-list">
      <input type="text" role="combobox" aria-expanded="true" aria-controls="scenario-list"
        aria-label="Find a scenario" placeholder="Find a scenario" autoComplete="off"
        aria-activedescendant={shown[at] ? `scenario-${shown[at].name}` : undefined}
        ref={(e) => e?.focus()} value={text} onKeyDown={key} onInput={(e) => {
          set_text(e.currentTarget.value);
          set_active(0);
        }} />
      <ul id="scenario-list" role="listbox" aria-label="Scenarios" ref={list}>
        {worlds.length > 0 && <li class="group" role="presentation">Worlds</li>}
        {worlds.map(option)}
        {logs.length > 0 && <li class="group" role="presentation">Recorded logs</li>}
        {logs.map(option)}
        {shown.length === 0 && <li class="group" role="presentation">
          {all.length === 0 ? "The scenarios are still loading." : "No scenario matches."}
        </li>}
      </ul>
    </div>
  );
}
