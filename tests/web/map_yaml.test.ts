// tests/web/map_yaml.test.ts: the maps in tests/maps, which the page takes and refuses as the server does.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { read_pgm, world_of_map } from "../../web/src/edit/map_file";
import { read_map_info } from "../../web/src/edit/map_yaml";
import { text_of } from "../../web/src/edit/world_file";

/** Description, picture, and words of the refusal; none: it shows the room of the first one. */
type Line = [yaml: string, picture: string, says: string];

const folder = join(process.env.TAUTLINE_TESTS!, "maps");
const table = JSON.parse(readFileSync(join(folder, "table.json"), "utf8")) as Line[];
const read = (name: string) => readFileSync(join(folder, name));
const world_of = ([yaml, picture]: Line) => {
  const info = read_map_info(text_of({ name: yaml, bytes: read(yaml) }), yaml);
  const { start, obstacles } = world_of_map(read_pgm(read(picture), picture), info, "map");
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
