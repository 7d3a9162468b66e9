// tests/web/route.test.ts: the address of the page is read and written.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Route, parse_route, print_route } from "../../web/src/link/route";

const drive: Route = { view: "drive", run: null, experiment: null, time: null, compare: [], camera: null };

test("an address holds run, time, comparison and camera, and is restored from it", () => {
  const place: Route = { view: "runs", run: 12, experiment: null, time: 27.4, compare: [9, 10], camera: { x: 1.25, y: -3, scale: 80.5 } };
  assert.equal(print_route(place), "#/runs/12?t=27.4&with=9,10&view=1.25,-3,80.5");
  assert.deepEqual(parse_route(print_route(place)), place);
  for (const route of [drive, { ...drive, view: "system" as const }, { ...drive, view: "runs" as const, run: 3 }]) {
    assert.deepEqual(parse_route(print_route(route)), route);
  }
  assert.equal(print_route({ view: "runs", run: 3, time: 0 }), "#/runs/3?t=0");
  const experiment = { ...drive, view: "experiments", experiment: "62acec565e51e123" } as Route;
  assert.equal(print_route(experiment), "#/experiments/62acec565e51e123");
  assert.deepEqual(parse_route(print_route(experiment)), experiment);
  assert.equal(parse_route("#/experiments/12").view, "nowhere");
  assert.deepEqual(parse_route("#/runs/3?with=9%2C10").compare, [9, 10], "as some programs write a comma");
});

test("what cannot be read of an address counts as not there", () => {
  for (const hash of ["", "#", "#/", "#/drive?t=3&with=2"]) assert.deepEqual(parse_route(hash), drive, hash);
  for (const hash of ["#/runs", "#/runs/?with=2"]) {
    assert.deepEqual(parse_route(hash), { ...drive, view: "runs" }, hash);
  }
  for (const hash of ["#/nowhere", "#/runs/x", "#/runs/-1", "#/runs/1e3", "#/drive/4"]) {
    assert.equal(parse_route(hash).view, "nowhere", hash);
  }
  const open = { ...drive, view: "runs", run: 4 };
  for (const query of ["t=", "t=-1", "t=x", "t=Infinity", "with=", "with=x,0", "with=4", "view=1,2", "view=1,2,0", "view=a,b,c", "view=1e300,1,10", "view=1,-1e6,10"]) {
    assert.deepEqual(parse_route(`#/runs/4?${query}`), open, query);
  }
  assert.deepEqual(parse_route("#/runs/4?with=9,9,4,8,7,6").compare, [9, 8, 7], "each once, three at most");
});
