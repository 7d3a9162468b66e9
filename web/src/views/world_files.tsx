// web/src/views/world_files.tsx: saves the world, opens, copies and deletes one's own, imports and exports.
import { JSX } from "preact";
import { useRef, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { ScenarioDocument } from "../contract";
import { empty_world } from "../edit/empty_world";
import { import_files } from "../edit/import";
import { map_of_world } from "../edit/map_file";
import { name_of } from "../edit/world_file";
import * as rest from "../link/rest";
import { session_path } from "../link/session";
import { download } from "../ui/download";
import { Dialog, Pick, Problem, use_problem } from "../ui/controls";
import { icons } from "../ui/icons";
import { WhichWorld } from "./which_world";

export function WorldFiles(): JSX.Element {
  const app = use_app();
  const { session, scenarios } = use_ui("session", "scenarios");
  const scenario = session!.scenario;
  const own = scenarios.some((s) => s.name === scenario.name && !s.builtin);
  const title = own ? scenario.title ?? scenario.name : `My ${(scenario.title ?? scenario.name).toLowerCase()}`;
  const [typed, set_typed] = useState<{ of: string; name: string } | null>(null);
  const [problem, run] = use_problem();
  const [opening, set_opening] = useState(false);
  const [asking, set_asking] = useState(false);
  const wanted = typed?.of === scenario.name ? typed.name : title; // a name that was typed for another world is forgotten
  const name = name_of(wanted);

  const save = (sure: boolean) => run(async () => {
    set_asking(false); // a refusal stands below the name
    if (name === "") throw new Error("A world needs a name with a letter from a to z or a digit.");
    await app.fetch_lists(); // others save worlds too
    const taken = app.ui.value.scenarios.some((s) => s.name === name && name !== scenario.name && !s.builtin);
    if (taken && !sure) {
      set_asking(true);
      return;
    }
    await rest.post(session_path("/scenario"), { name, title: wanted.trim() });
    set_typed(null);
    await app.fetch_lists();
    app.toast("info", `Saved as "${wanted.trim()}".`);
  });
  return (
    <section>
      <h2>This world{session!.edited && <small class="quiet" data-testid="edited"> changed, not saved</small>}</h2>
      <form class="save" onSubmit={(e) => {
        e.preventDefault();
        void save(false);
      }}>
        <input type="text" value={wanted} maxLength={64} aria-label="Name of the world" data-testid="world-name"
          onInput={(e) => set_typed({ of: scenario.name, name: e.currentTarget.value })} />
        <button type="submit" class="small primary" data-testid="world-save">{own && name === scenario.name ? "Save" : "Save as"}</button>
      </form>
      <Problem text={problem} name="world-problem" />
      <div class="acts">
        <button class="ghost" data-testid="world-new" onClick={() => void app.editor.new_world(empty_world(scenario))}>New</button>
        <button class="ghost" data-testid="world-open" onClick={() => {
          void app.fetch_lists();
          set_opening(true);
        }}>Open</button>
        <Import />
        <Export />
      </div>
      {opening && <Open on_close={() => set_opening(false)} />}
      {asking && <Dialog title={`Replace "${wanted.trim()}"?`} name="replace-dialog" on_close={() => set_asking(false)}>
        <p>There is a world of this name. Saving replaces it.</p>
        <div class="facts-acts">
          <button class="small primary" data-testid="replace-yes" onClick={() => void save(true)}>Replace it</button>
          <button class="ghost" onClick={() => set_asking(false)}>Keep it</button>
        </div>
      </Dialog>}
    </section>
  );
}

/** All worlds by name; one's own can be copied and deleted. */
function Open(props: { on_close: () => void }): JSX.Element {
  const app = use_app();
  const { scenarios } = use_ui("scenarios");
  const [problem, run] = use_problem();
  const worlds = scenarios.filter((s) => s.kind === "world").sort((a, b) => Number(a.builtin) - Number(b.builtin));
  const copy = (name: string) => run(async () => {
    const document = await rest.get<ScenarioDocument>(`/scenarios/${name}`);
    let fresh = `${name}_copy`.slice(0, 64);
    for (let i = 2; scenarios.some((s) => s.name === fresh); ++i) fresh = `${name.slice(0, 55)}_copy_${i}`;
    await rest.put(`/scenarios/${fresh}`, { ...document, name: fresh, title: `${document.title ?? name}, copy` });
    await app.fetch_lists();
  });
  const remove = (name: string) => run(async () => {
    const document = await rest.get<ScenarioDocument>(`/scenarios/${name}`);
    await rest.remove(`/scenarios/${name}`);
    await app.fetch_lists();
    app.toast("info", `Deleted "${document.title ?? name}".`, () => void run(async () => {
      await rest.put(`/scenarios/${name}`, document);
      await app.fetch_lists();
    }));
  });
  return (
    <Dialog title="Worlds" name="worlds-dialog" on_close={props.on_close}>
      <Problem text={problem} />
      <ul class="worlds">
        {worlds.map((s) => (
          <li key={s.name}>
            <button class="place" data-testid={`open-${s.name}`} onClick={() => {
              props.on_close();
              void app.editor.load({ scenario: s.name });
            }}><span>{s.title}<small>{s.builtin ? "built in" : s.name}</small></span></button>
            <button class="icon" aria-label={`Duplicate ${s.title}`} title="Duplicate" data-testid={`copy-${s.name}`}
              onClick={() => void copy(s.name)}>{icons.copy}</button>
            {!s.builtin && <button class="icon" aria-label={`Delete ${s.title}`} title="Delete" data-testid={`delete-${s.name}`}
              onClick={() => void remove(s.name)}>{icons.trash}</button>}
          </li>
        ))}
      </ul>
    </Dialog>
  );
}

function Import(): JSX.Element {
  const app = use_app();
  const input = useRef<HTMLInputElement>(null);
  const [several, set_several] = useState<ScenarioDocument[] | null>(null);
  return (
    <>
      <button class="ghost" data-testid="world-import" title="A scenario or BARN file (.json), a map (.pgm and .yaml), or recorded people (.txt)"
        onClick={() => input.current?.click()}>Import</button>
      <input ref={input} type="file" multiple hidden accept=".json,.pgm,.yaml,.yml,.txt,.csv" aria-label="Files of a world" data-testid="world-files"
        onChange={(e) => {
          const { files } = e.currentTarget;
          if (files && files.length > 0) void import_files(app, files).then(set_several);
          e.currentTarget.value = "";
        }} />
      {several && <WhichWorld worlds={several} on_close={() => set_several(null)} />}
    </>
  );
}

function Export(): JSX.Element {
  const app = use_app();
  const { session } = use_ui("session");
  const name = session!.scenario.name;
  const scenario = async () => {
    const world = await app.attempt(rest.get<ScenarioDocument>(session_path("/scenario")));
    if (world) download(new Blob([JSON.stringify(world, null, 2), "\n"]), `${name}.json`);
  };
  const map = () => {
    try {
      const { pgm, yaml } = map_of_world(app.scene.obstacles, name);
      download(new Blob([pgm as BlobPart]), `${name}.pgm`);
      download(new Blob([yaml]), `${name}.yaml`);
    } catch (error) {
      app.toast("warn", error instanceof Error ? error.message : String(error));
    }
  };
  return (
    <Pick label="Export" name="world-export" value="" choices={[{ name: "", label: "Export" },
      { name: "json", label: "Scenario (.json)" }, { name: "map", label: "Map (.pgm, .yaml)" }]}
      on_pick={(kind) => (kind === "json" ? void scenario() : kind === "map" && map())} />
  );
}
