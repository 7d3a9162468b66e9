// web/src/edit/import.ts: opens the world of files that a person chooses or drops onto the page.
import type { App } from "../app";
import { ScenarioDocument } from "../contract";
import * as rest from "../link/rest";
import { read_people, world_of_people } from "./people_file";
import { GivenFile, read_worlds, stem, text_of } from "./world_file";

/** The scenario whose robot, scanner, controller and parameters drive among recorded people. */
const kAmongPeople = "people";
const kMostBytes = 1 << 20; // of a request to the server

/** Opens the world in `files`. @return the worlds to choose from, if they hold several */
export async function import_files(app: App, files: FileList): Promise<ScenarioDocument[] | null> {
  try {
    const worlds = await worlds_in(await given(files));
    if (worlds.length > 1) return worlds;
    await open_world(app, worlds[0]);
  } catch (error) {
    app.toast("bad", error instanceof Error ? error.message : String(error));
  }
  return null;
}

/** Keeps `world` under a name that is not taken, so that an import replaces nothing, and opens it. */
export async function open_world(app: App, world: ScenarioDocument): Promise<void> {
  await app.fetch_lists(); // others save worlds too
  const name = free_name(app, world.name);
  const document = { ...world, name };
  const size = JSON.stringify(document).length;
  if (size > kMostBytes) {
    app.toast("bad", `"${world.title ?? name}" is a world of ${(size / kMostBytes).toFixed(1)} MB; the page can send 1 MB. `
      + "Put its scenario into the folder of serve --scenarios: tautline crowd makes one of recorded people.");
    return;
  }
  const saved = await app.attempt(rest.put(`/scenarios/${name}`, document));
  if (saved === null) return;
  await app.fetch_lists();
  await app.editor.load({ scenario: name });
}

async function worlds_in(files: GivenFile[]): Promise<ScenarioDocument[]> {
  const people = files.find((f) => /\.(txt|csv)$/i.test(f.name));
  if (!people || files.length > 1) return read_worlds(files);
  const walkers = read_people(text_of(people), people.name);
  const robot = await rest.get<ScenarioDocument>(`/scenarios/${kAmongPeople}`);
  return [{ ...world_of_people(walkers, people.name, robot), name: stem(people.name) }];
}

async function given(files: FileList): Promise<GivenFile[]> {
  return Promise.all([...files].map(async (f) => ({ name: f.name, bytes: new Uint8Array(await f.arrayBuffer()) })));
}

function free_name(app: App, name: string): string {
  const taken = (n: string) => app.ui.value.scenarios.some((s) => s.name === n);
  let fresh = name;
  for (let i = 2; taken(fresh); ++i) fresh = `${name.slice(0, 60)}_${i}`;
  return fresh;
}
