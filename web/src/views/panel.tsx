// web/src/views/panel.tsx: the right panel of Drive: four figures, and tabs: the robot with controller,
// filter, physics and gains; the world; the signals.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Catalog, ParameterInfo, SessionState } from "../contract";
import { Figure, figure_words, kLive, shown_clearance } from "../figures";
import { goal_distance, senses_ground } from "../state/scene";
import { use_pulse, use_store } from "../state/store";
import { Pick, Segments, Slider, Tab, Tabs } from "../ui/controls";
import { Guard } from "../ui/guard";
import { icons } from "../ui/icons";
import { lazy } from "../ui/lazy";
import { Named } from "../ui/tip";
import { fixed, frame_word, state_word, titled } from "../words";

// Fetched with their tabs.
const Signals = lazy(async () => {
  const { Signals: Plots } = await import("./signals");
  return () => {
    const { rewind } = use_app();
    use_pulse(100);
    return <Plots time={rewind.time} seek={(t) => rewind.seek(t)} />;
  };
});
const Terrain = lazy(async () => (await import("./terrain")).Terrain);
const ArmTab = lazy(async () => (await import("../arm/part")).ArmTab);
const World = lazy(async () => (await import("./world")).World);

export function Figures(): JSX.Element {
  const app = use_app();
  use_pulse(100);
  const { session, looking } = use_ui("session", "looking");
  const open = use_store(app.ui, (u) => u.link.phase === "open");
  const f = app.shown.frame;
  const state = looking ? frame_word(f) : state_word(f, session, open);
  const drives = session?.robot.drives ?? true;
  const clearance = shown_clearance(app.shown, session?.source === "simulation");
  return <>
    <div class="stats" role="group" aria-label="Figures">
      <Stat of={clearance} value={clearance.value} beyond={clearance.beyond} name="clearance" />
      <Stat of={kLive.speed} value={f?.twist.v} name="speed" />
      {drives
        ? <Stat of={kLive.to_goal} value={goal_distance(app.shown)} name="to-goal" />
        : <Stat of={kLive.scans} value={f && f.tick + 1} name="scans" />}
      <div class="stat">
        <small><Named label={kLive.state.label} meaning={kLive.state.meaning} /></small>
        <b class={`word tone-${state.tone}`} data-testid="state">{state.word}</b>
      </div>
    </div>
    {senses_ground(app.shown) && <Terrain scene={app.shown} />}
  </>;
}

function Stat(props: { of: Figure; value: number | null | undefined; beyond?: boolean; name: string }): JSX.Element {
  const { label, unit, digits } = props.of;
  return (
    <div class="stat">
      <small><Named label={label} meaning={figure_words(props.of)} /></small>
      <b data-testid={`figure-${props.name}`}>{props.beyond && "> "}{fixed(props.value, digits)}{unit && <u>{unit}</u>}</b>
    </div>
  );
}

const Arm: Tab = { name: "arm", label: "Arm", body: () => <ArmTab /> };
/** The tabs of the panel, in their order; another one is one more entry. */
const kTabs: Tab[] = [
  { name: "robot", label: "Robot", body: () => <Robot /> },
  { name: "world", label: "World", body: () => <Guard need="operator"><World /></Guard> },
  { name: "signals", label: "Signals", body: () => <Signals /> },
];

/** The panel below the figures; on a phone it is a sheet. */
export function Tuning(): JSX.Element {
  const app = use_app();
  const { tab, session } = use_ui("tab", "session");
  return <Tabs label="Panel" tabs={session?.robot.arm ? [Arm, ...kTabs] : kTabs} shown={tab} on_pick={(tab) => app.ui.set({ tab })} />;
}

/** The plots share their cursor with the scene. */

function Robot(): JSX.Element {
  const { session, catalog } = use_ui("session", "catalog");
  if (!session || !catalog) {
    return <p class="quiet">Controllers and gains appear here once the server has been reached.</p>;
  }
  return (
    <>
      <Guard need="operator">
        {session.robot.drives && session.source === "simulation" && <RobotPick session={session} />}
        <Choices session={session} catalog={catalog} />
        {session.robot.drives && <Gains session={session} catalog={catalog} />}
      </Guard>
    </>
  );
}

function Choices(props: { session: SessionState; catalog: Catalog }): JSX.Element {
  const app = use_app();
  const { session, catalog } = props;
  const loading = use_store(app.ui, (u) => u.loading) !== null;
  const controller = catalog.controllers.find((c) => c.name === session.controller);
  return (
    <section>
      {session.robot.drives && <>
        <h2>Controller</h2>
        <Pick label="Controller" name="controller" choices={catalog.controllers}
          value={session.controller} disabled={loading} class="wide-pick"
          on_pick={(controller) => void app.editor.load({ controller })} />
        {controller?.help && <p class="help">{controller.help}</p>}
      </>}
      {!session.robot.drives && <h2>Filter</h2>}
      <Segments label="Filter" name="filter" choices={catalog.filters} value={session.filter}
        disabled={loading} on_pick={(filter) => void app.editor.load({ filter })} />
      {session.robot.drives && session.source === "simulation" &&
        <Segments label="Physics" name="physics" choices={catalog.physics} value={session.physics}
          disabled={loading} on_pick={(physics) => void app.editor.load({ physics })} />}
    </section>
  );
}

/** The robot models. One that cannot be read is listed with the reason, not as a choice. */
function RobotPick(props: { session: SessionState }): JSX.Element | null {
  const app = use_app();
  const loading = use_store(app.ui, (u) => u.loading) !== null;
  const { robots } = use_ui("robots");
  const name = props.session.robot.name;
  if (robots.length === 0) return null;
  const choices = robots.filter((r) => r.usable).map((r) => ({ name: r.name, label: r.title }));
  const known = choices.some((c) => c.name === name);
  const help = robots.find((r) => r.name === name && r.usable)?.description;
  return (
    <section>
      <h2>Robot</h2>
      <Pick label="Robot" name="robot" choices={known ? choices : [{ name, label: titled(name) }, ...choices]}
        value={name} disabled={loading} class="wide-pick" on_pick={(robot) => void app.editor.load({ robot })} />
      {help && <p class="help">{help}</p>}
      {robots.filter((r) => !r.usable).map((r) => <p key={r.name} class="help bad" role="note">{r.description}</p>)}
    </section>
  );
}

const kShown = 4; // gains at first; a button shows the others

/** The parameters that controller `name` reads: its own, then the common ones. */
function read_by(catalog: Catalog, name: string): ParameterInfo[] {
  const own = catalog.controllers.find((c) => c.name === name)?.parameters ?? [];
  return [...own, ...catalog.common_parameters].map((key) => catalog.parameters.find((p) => p.name === key))
    .filter((p) => p !== undefined);
}

function Gains(props: { session: SessionState; catalog: Catalog }): JSX.Element {
  const { session, catalog } = props;
  const all = read_by(catalog, session.controller);
  const first = all.slice(0, kShown);
  const rest = all.slice(kShown);
  const [more, set_more] = useState(false);
  return (
    <section>
      <h2>Gains</h2>
      {first.map((p) => <Gain key={p.name} info={p} session={session} />)}
      {rest.length > 0 &&
        <button class="text more" aria-expanded={more} data-testid="more-gains"
          onClick={() => set_more(!more)}>{more ? "Fewer" : `${rest.length} more`}{icons.down}</button>}
      {more && rest.map((p) => <Gain key={p.name} info={p} session={session} />)}
    </section>
  );
}

function Gain(props: { info: ParameterInfo; session: SessionState }): JSX.Element {
  const app = use_app();
  const { info, session } = props;
  const own = session.scenario.parameters as Record<string, number> | undefined;
  return (
    <Slider info={info} value={session.parameters[info.name] ?? info.initial}
      usual={own?.[info.name] ?? info.initial}
      on_set={async (value) => {
        app.go_live();
        const held = await app.attempt(app.link.set_parameter(info.name, value));
        const now = app.ui.value.session;
        if (now && held !== null) {
          app.ui.set({ session: { ...now, parameters: { ...now.parameters, [info.name]: held } } });
        }
      }} />
  );
}
