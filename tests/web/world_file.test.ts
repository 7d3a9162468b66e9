// tests/web/world_file.test.ts: worlds from files, and maps to files.
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_world } from "../../web/src/edit/empty_world";
import { map_of_world, read_pgm, world_of_map } from "../../web/src/edit/map_file";
import { read_map_info } from "../../web/src/edit/map_yaml";
import { name_of, read_worlds } from "../../web/src/edit/world_file";
import { new_box, new_cylinder, new_wall, new_walker } from "../../web/src/edit/edits";
import { covers, obstacle_from_json } from "../../web/src/obstacle";

const bytes = (text: string): Uint8Array => new TextEncoder().encode(text);
const file = (name: string, text: string) => ({ name, bytes: bytes(text) });
const kYaml = "image: a.pgm\nresolution: 0.5 # m\norigin: [-1.0, -2.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

test("a name is made of a title", () => {
  assert.equal(name_of(" My room, 2nd floor! "), "my_room_2nd_floor");
  assert.equal(name_of("???"), "");
});

test("a map becomes one box per rectangle of occupied cells, at its place in the world", () => {
  // 6 x 5 cells: a wall along the top, a block of 2 x 2 at the lower right, one unknown cell
  const grey = ["0 0 0 0 0 0", "254 254 254 254 254 254", "254 254 254 254 254 254", "205 254 254 254 0 0", "254 254 254 254 0 0"];
  const picture = read_pgm(bytes(`P2\n# made by hand\n6 5\n255\n${grey.join("\n")}\n`), "a.pgm");
  const info = read_map_info(kYaml, "a.yaml");
  assert.equal(info.resolution, 0.5);
  const fine = { ...info, resolution: 1 };
  const world = world_of_map(picture, fine, "a");
  const boxes = world.obstacles!.map((o) => [o.x, o.y, o.length, o.width]);
  assert.deepEqual(boxes, [[2, 2.5, 6, 1], [4, -1, 2, 2]]);
  assert.deepEqual(world.start, { x: 1.5, y: 0.5, heading: 0 }, "clear of the unknown cell too");
  assert.throws(() => world_of_map({ ...picture, grey: picture.grey.map(() => 0) }, fine, "a"), /no free place/);
});

test("a binary map of 16 bits is read, and a torn one is refused", () => {
  const head = bytes("P5 2 1 65535\n");
  const both = new Uint8Array([...head, 0xff, 0xff, 0, 1]);
  assert.deepEqual([...read_pgm(both, "a.pgm").grey], [65535, 1]);
  assert.throws(() => read_pgm(both.subarray(0, both.length - 1), "a.pgm"), /ends too early/);
  assert.throws(() => read_pgm(bytes("P6 1 1 255\n"), "b.pgm"), /b.pgm is no PGM/);
  assert.throws(() => read_pgm(bytes("P5 0 1 255\n"), "b.pgm"), /whole numbers above 0/);
  assert.throws(() => read_pgm(bytes("P2 2 2 255\n0 0 0\n"), "b.pgm"), /b.pgm ends too early/);
  assert.throws(() => read_pgm(bytes("P2 2 1 255\n0 grey\n"), "b.pgm"), /whole number up to 255, not "grey"/);
});

test("a map that cannot be used says which field is wrong", () => {
  assert.throws(() => read_map_info("origin: [0, 0, 0]", "m.yaml"), /m.yaml: resolution is missing/);
  assert.throws(() => read_map_info("resolution: 0.05", "m.yaml"), /origin is missing/);
  assert.throws(() => read_map_info("resolution: 0.05\norigin: [0, 0, 1]", "m.yaml"), /turned/);
  assert.throws(() => read_worlds([file("m.pgm", "P5")]), /two files/);
  const yaml = file("m.yaml", kYaml.replace("a.pgm", "maps/a.pgm"));
  const picture = "P2\n4 4\n255\n0 0 0 0 254 254 254 254 254 254 254 254 254 254 254 254\n";
  assert.throws(() => read_worlds([file("b.pgm", picture), yaml]), /^Error: m.yaml: its image is a.pgm, not b.pgm.$/);
  assert.equal(read_worlds([file("b.pgm", "P5"), file("a.pgm", picture), yaml])[0].name, "a", "of two pictures it takes its own");
});

test("a file that holds something else says so, in words", () => {
  const read = (text: string) => () => read_worlds([file("a.json", text)]);
  for (const text of ["[]", "[7]", "null", "7"]) assert.throws(read(text), /^Error: a.json holds no world/, text);
  for (const name of ["42", "null", "{}"]) assert.throws(read(`{"name":${name}}`), /a.json: name must be a text/, name);
  assert.throws(read('{"name":"carrier","hull":{"radius":0.3}}'), /^Error: a.json is a robot, not a world. Put it into the folder/);
  const barn = '{"start":[0,0,0],"goal":[1,1],"obstacles":[]}';
  assert.deepEqual(read_worlds([file("b.json", `{"worlds":[${barn},${barn}]}`)]).map((w) => w.name), ["barn-1", "barn-2"]);
  assert.deepEqual(read_worlds([file("a.json", "{}"), file("b.json", "{}")]).map((w) => w.name), ["a", "b"], "each of several files");
});

test("a world drawn as a map and read back stands where it stood", () => {
  const standing = [new_wall({ x: 0, y: 0 }, { x: 4, y: 0 }, 0.1), new_box(3, 2, 0.6, 0.4, 0.5), new_cylinder(1, 2, 0.3)];
  const { pgm, yaml } = map_of_world([...standing, new_walker([{ x: 9, y: 9 }, { x: 8, y: 9 }], 0.25, 1)], "room");
  const world = world_of_map(read_pgm(pgm, "room.pgm"), read_map_info(yaml, "room.yaml"), "room");
  const again = world.obstacles!.map(obstacle_from_json);
  const taken = (p: { x: number; y: number }) => again.some((o) => covers(o, p, 0));
  for (let x = -0.3; x < 4.3; x += 0.07) {
    for (let y = -0.3; y < 2.6; y += 0.07) {
      const p = { x, y };
      if (standing.some((o) => covers(o, p, -0.06))) assert.ok(taken(p), `free at ${x} ${y}`);
      if (!standing.some((o) => covers(o, p, 0.1))) assert.ok(!taken(p), `taken at ${x} ${y}`);
    }
  }
  assert.throws(() => map_of_world([], "room"), /no map to draw/);
});

test("a BARN file gives its worlds, also with moving cylinders", () => {
  const barn = { worlds: [{ id: 7, start: [0, 1, 1.57], goal: [0, 9], radius: 0.1, obstacles: [[1, 2],
    { radius: 0.5, period: 4, keys: [[0, 1, 1], [2, 3, 1]] }] }] };
  const [world] = read_worlds([file("w.json", JSON.stringify(barn))]);
  assert.equal(world.name, "barn-7");
  assert.deepEqual(world.obstacles![0], { id: 1, type: "cylinder", x: 1, y: 2, radius: 0.1 });
  assert.deepEqual(world.obstacles![1].path, { period: 4, keys: [[0, 1, 1], [2, 3, 1]] });
});

test("a file that holds no world says why", () => {
  const bad = (text: string) => () => read_worlds([file("x.json", text)]);
  assert.throws(bad("{"), /x.json is not JSON/);
  assert.throws(bad("3"), /holds no world/);
  assert.throws(bad('{"worlds":[]}'), /one world at least/);
  assert.throws(bad('{"worlds":[{"id":1,"start":[0,1],"goal":[0,9],"obstacles":[]}]}'), /world 1: start/);
  assert.throws(bad('{"worlds":[{"id":1,"start":[0,1,2],"goal":[0,9],"obstacles":[[1]]}]}'), /obstacle 1 must be/);
  assert.throws(() => read_worlds([file("x.txt", "")]), /Choose a scenario/);
  assert.deepEqual(read_worlds([file("My room.json", "{}")])[0].name, "my_room");
});

test("an empty world keeps the robot with its sensors", () => {
  const world = { name: "hall", obstacles: [{ type: "wall" }], controller: "strip", lasers: [{ beams: 541 }], gyro: false };
  const own = { name: "carrier", radius: 0.4 };
  const empty = empty_world({ ...world, robot: own } as never);
  assert.deepEqual([empty.robot, empty.lasers, empty.gyro, empty.controller], [own, [{ beams: 541 }], false, "strip"]);
  assert.equal(empty.obstacles, undefined);
  assert.equal("lasers" in empty_world({ ...world, robot: "jackal" } as never), false); // its own
});
