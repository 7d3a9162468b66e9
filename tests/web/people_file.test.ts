// tests/web/people_file.test.ts: recordings of people as worlds, and people who come and go in what is drawn.
import assert from "node:assert/strict";
import { test } from "node:test";
import { empty_bounds } from "../../web/src/geometry";
import { handles_of } from "../../web/src/edit/handles";
import { read_people, world_of_people } from "../../web/src/edit/people_file";
import { text_of } from "../../web/src/edit/world_file";
import { include_obstacle, obstacle_from_json, obstacle_to_json, present, topmost } from "../../web/src/obstacle";
import { fold_session, new_scene, show_frame } from "../../web/src/state/scene";

const kRobot = { name: "people", title: "People in a hall", controller: "strip_moving", robot: "jackal", waypoints: [{ x: 1, y: 1 }] };
/** Two far aside who make a square of 10 x 6 m, from frame 100 on. */
const kSquare = "100 a 0 0\n2600 a 0 0\n100 b 10 6\n2600 b 10 6\n";
const world_of = (text: string) => world_of_people(read_people(text, "square.txt"), "square.txt", kRobot);

test("the lines become people who walk at their times, the robot crosses their square", () => {
  const world = world_of(`${kSquare}225\t7.0\t9.87654\t3\r\n\n250,7.0,8.5,3.00049\n300 8 1 1\n`);
  assert.equal(world.title, "People of square");
  assert.deepEqual([world.start, world.goal], [{ x: 0.5, y: 3, heading: 0 }, { x: 9.5, y: 3 }]);
  assert.equal(world.controller, "strip_moving");
  assert.equal(world.waypoints, undefined, "of the other world");
  assert.equal(world.obstacles!.length, 3, "one seen once is never there");
  assert.deepEqual(world.obstacles![2], { id: 3, type: "cylinder", x: 9.877, y: 3, radius: 0.25, height: 1.7,
    path: { period: 105, comes_and_goes: true, keys: [[5, 9.877, 3], [6, 8.5, 3]] } });
});

test("somebody beside the robot at the beginning is left out, and somebody who comes there later is not", () => {
  assert.equal(world_of(`${kSquare}100 w 1.5 3\n200 w 5 3\n`).obstacles!.length, 2);
  assert.equal(world_of(`${kSquare}110 w 1.5 3\n200 w 5 3\n`).obstacles!.length, 3);
});

test("a repeated line counts once, and a byte order mark not at all", () => {
  const bytes = new TextEncoder().encode("\uFEFF0 1 2 3\r\n10 1 3 3\r\n0 1 2.0 3\r\n10 1 3 3\r\n");
  const [one] = read_people(text_of({ name: "square.txt", bytes }), "square.txt");
  assert.deepEqual(one, { id: "1", keys: [[0, 2, 3], [0.4, 3, 3]] });
});

test("a file that holds no such lines says where", () => {
  const fault = (text: string, why: RegExp) => assert.throws(() => world_of(text), why, text);
  fault("0 1 2 3\n0 2 3\n", /square.txt, line 2: 3 words instead/);
  fault("zero 1 2 3\n", /line 1: "zero" is no number of a frame/);
  for (const word of ["nan", "1e300", "3x", "0x10", "Infinity", "--1", "1e5"]) fault(`\n0 1 2 ${word}\n`, /line 2: "2 .*" is no place in metres/);
  fault("0 1 2 3\n5 1 2 3\n0 1 4 5\n", /square.txt, line 3: person 1 is at another place in frame 0 than in line 1/);
  fault("", /square.txt holds nobody/);
  fault(" \n\n", /holds nobody/);
  fault("0 1 0 0\n0 2 5 5\n", /nobody in it walks/);
  fault("0 1 0 0\n10 1 1 1\n", /stay within 1.0 x 1.0 m; a crossing needs 2 m/);
  fault(Array.from({ length: 2001 }, (_, i) => `0 ${i} ${i} 9\n10 ${i} ${i} 20\n`).join(""), /holds 2001 people; a world holds 2000/);
  fault(`${kSquare}1e9 7 5 5\n`, /square.txt lasts 39999996 s, from frame 100 to frame 1000000000 of person 7; a world holds 999995 s/);
  fault(`${kSquare}200 7 5 5\n200.01 7 5 6\n`, /square.txt: frames 200 and 200.01 of person 7 fall on one millisecond/);
  const long = Array.from({ length: 10_001 }, (_, i) => `${i} 7 5 5\n`).join("");
  fault(kSquare + long, /square.txt: person 7 is in 10001 frames; a world holds 10000 of one person/);
});

const kPerson = { id: 1, type: "cylinder" as const, x: 4, y: 3, radius: 0.25, path: { period: 20, comes_and_goes: true, keys: [[2, 4, 3], [6, 8, 5]] as [number, number, number][] } };
const frame = (tick: number, moved: object[]) => ({
  tick, t: tick / 10, moved, layers: [], measures: [], requests: [], sweeps: [], sonar: [], infrared: [], readings: [], goals_ahead: [], goal: null,
  pose: { x: 0, y: 0, heading: 0 }, twist: { v: 0, omega: 0 }, command: { v: 0, omega: 0 }, truth: null, words: null, arm: null,
} as never);

test("one who comes and goes is there in the frames that tell of it, and nowhere else", () => {
  const scene = new_scene();
  const box = { id: 2, type: "box" as const, x: 0, y: 0, length: 1, width: 1 };
  fold_session(scene, { obstacles: [kPerson, box] } as never);
  const there = () => present(scene.obstacles).map((o) => o.id);
  assert.deepEqual(there(), [2], "away until a frame tells of it");
  show_frame(scene, frame(1, []));
  assert.deepEqual(there(), [2]);
  show_frame(scene, frame(30, [{ id: 1, pose: { x: 5, y: 3.5, heading: 0 } }]));
  assert.deepEqual(there(), [1, 2]);
  assert.equal(topmost(scene.obstacles, { x: 5, y: 3.5 }, 0)?.id, 1);
  show_frame(scene, frame(70, []));
  assert.deepEqual(there(), [2]);
  assert.equal(topmost(scene.obstacles, { x: 5, y: 3.5 }, 0), null, "nobody to pick");
  assert.equal(scene.obstacles.length, 2, "it stays in the world");
});

test("a fitted view holds the whole way, the JSON keeps it, and no handle bends it", () => {
  const person = obstacle_from_json(kPerson);
  const bounds = empty_bounds();
  include_obstacle(bounds, person);
  assert.deepEqual(bounds, { min_x: 3.75, min_y: 2.75, max_x: 8.25, max_y: 5.25 });
  assert.deepEqual(obstacle_to_json(person).path, kPerson.path);
  assert.deepEqual(handles_of(person), []);
});
