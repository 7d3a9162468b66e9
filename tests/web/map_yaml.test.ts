// tests/web/map_yaml.test.ts: the maps in tests/maps, which the page takes and refuses as the server does.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { read_worlds } from "../../web/src/edit/world_file";

/** Description, picture, and words of the refusal; none: it shows the room of the first one. */
type Line = [yaml: string, picture: string, says: string];

const folder = join(process.env.TAUTLINE_TESTS!, "maps");
const table = JSON.parse(readFileSync(join(folder, "table.json"), "utf8")) as Line[];
const given = (name: string) => ({ name, bytes: readFileSync(join(folder, name)) });
const world_of = ([yaml, picture]: Line) => {
  const [{ start, obstacles }] = read_worlds([given(yaml), given(picture)]);
  return { start, obstacles };
};

test("maps that are written differently show one room, and bad ones are refused with the server's words", () => {
  const room = world_of(table[0]);
  assert.equal(room.obstacles!.length, 3);
  for (const line of table) {
    const name = line.slice(0, 2).join(" with ");
    if (line[2] === "") assert.deepEqual(world_of(line), room, name);
    else assert.throws(() => world_of(line), (error: Error) => error.message.includes(line[2]) || assert.fail(`${name}: ${error.message}`), name);
  }
});
