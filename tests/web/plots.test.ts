// tests/web/plots.test.ts: signals, pieces of time, thinned lines, pointers on a plot, and the SVG that
// has the drawing of the canvas.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Context } from "../../web/src/draw/marks";
import { Palette } from "../../web/src/draw/palette";
import { View } from "../../web/src/draw/view";
import { Chart, draw_chart, field_of, ticks, value_range } from "../../web/src/plots/chart";
import { PlotGestures } from "../../web/src/plots/gestures";
import { legend_rows, scene_picture, sheet_picture } from "../../web/src/plots/pictures";
import { file_name } from "../../web/src/plots/save";
import { choice_of, panned, shown_span, zoomed } from "../../web/src/plots/span";
import { SvgContext } from "../../web/src/plots/svg";
import { points_of } from "../../web/src/plots/thin";
import { chart_of, plots_with, value_words, whole_of } from "../../web/src/plots/traces";
import { decode_frame } from "../../web/src/link/frame";
import { Legends } from "../../web/src/link/legend";
import { Columns } from "../../web/src/state/columns";
import { fold_frame, new_scene } from "../../web/src/state/scene";
import { is_shown, plots_of, signals_of, signals_of_all } from "../../web/src/state/measures";
import { kFrameSignals } from "../../web/src/state/signals";
import { FrameSpec, frame_bytes } from "./wire";

const palette = new Proxy({}, { get: (_, name) => (name === "font" ? "sans-serif" : `#${String(name)}`) }) as Palette;
const frame = (spec: FrameSpec) => decode_frame(frame_bytes(spec), new Legends());

/** A run of `count` ticks, 0.1 s each. */
function run(count: number, more: (tick: number) => Partial<FrameSpec> = () => ({})): Columns {
  const columns = new Columns();
  for (let tick = 0; tick < count; ++tick) columns.push(frame({ tick, stamp: tick / 10, ...more(tick) }));
  return columns;
}

test("every signal says its unit and meaning, and no two have one column", () => {
  assert.equal(new Set(kFrameSignals.map((s) => s.name)).size, kFrameSignals.length);
  for (const s of kFrameSignals) {
    assert.ok(s.label.length > 0 && s.meaning.length > 10 && s.group !== "" && s.plot !== "", s.name);
    assert.ok(s.least[0] <= 0 && s.least[1] > s.least[0], s.name);
  }
});

test("columns hold the commanded and the executed twist, the truth, and what needs the frame before", () => {
  const columns = run(3, (tick) => ({
    command: [0.3, -0.5], twist: [0.25, -0.125], pose: [tick, 0, 0], truth: [tick + 0.5, 0, 0, 0.75, false], goal: [3, 4, null],
    ...(tick === 1 ? { ranges: [1000, 1000], scan_stamp: 0.0625 } : {}), hold: tick === 2 ? "stale_scan" : undefined,
  }));
  const at = (name: string) => [...columns.get(name)].map((v) => Math.round(v * 1e4) / 1e4);
  assert.deepEqual([at("v"), at("omega")], [[0.3, 0.3, 0.3], [-0.5, -0.5, -0.5]]);
  assert.deepEqual([at("odometry.v"), at("odometry.omega")], [[0.25, 0.25, 0.25], [-0.125, -0.125, -0.125]]);
  assert.deepEqual(at("odometry.error"), [0.5, 0.5, 0.5]);
  assert.deepEqual(at("truth.obstacle_distance"), [0.75, 0.75, 0.75]);
  assert.deepEqual(at("goal.distance"), [5, 4.4721, 4.1231]);
  assert.deepEqual(at("period"), [NaN, 0.1, 0.1]);
  assert.deepEqual(at("scan.age"), [NaN, 0.0375, 0.1375]);
  assert.deepEqual(at("held"), [0, 0, 1]);
  assert.equal(columns.has("gyro.rate"), false, "the robot has no gyro, so none is offered");
  assert.ok(!signals_of(columns).some((s) => s.name === "gyro.rate"));
});

test("the clearance before the first scan is not known", () => {
  const columns = run(2, (tick) => (tick === 1 ? { clearance: 0.5, ranges: [1000, 1000], scan_stamp: 0.1 } : {}));
  assert.deepEqual([...columns.get("clearance")], [NaN, 0.5]);
});

test("measures and channels are signals; what shares thing and unit shares a plot", () => {
  const columns = new Columns();
  columns.channels = [{ name: "battery.voltage", kind: "voltage", unit: "V", values: 1 }];
  columns.push(frame({
    tick: 0, measures: [["strip.left", "m", 0.5], ["strip.right", "m", 0.25], ["strip.side", "", 1], ["own.thing", "m", 2]],
    readings: [[0, [24.5]]],
  }));
  const signals = signals_of(columns);
  const find = (name: string) => signals.find((s) => s.name === name)!;
  assert.deepEqual([find("strip.left").label, find("strip.left").unit], ["External force, left", "m"]);
  assert.match(find("strip.left").meaning, /Eq\. 7/);
  assert.deepEqual([find("battery.voltage").unit, find("battery.voltage").meaning], ["V", "Channel of the robot: voltage"]);
  assert.equal(find("own.thing").label, "Thing");
  const plots = plots_of(signals.filter((s) => s.name.startsWith("strip.") || s.name === "v" || s.name === "odometry.v"));
  assert.deepEqual(plots.map((p) => [p.title, p.unit, p.signals.map((s) => s.name)]), [
    ["Speed", "m/s", ["v", "odometry.v"]], ["Strip", "m", ["strip.left", "strip.right"]], ["Strip: side", "", ["strip.side"]]]);
  assert.deepEqual([is_shown(find("v"), {}), is_shown(find("v"), { v: false }), is_shown(find("x"), {}), is_shown(find("x"), { x: true })],
    [true, false, false, true]);
  assert.equal(signals_of_all([columns, columns]).length, signals.length);
});

test("a piece of time is zoomed about an instant, panned, and kept within the run", () => {
  const whole = { from: 0, to: 100 };
  assert.deepEqual(shown_span(null, whole, Infinity), whole);
  assert.deepEqual(shown_span(null, whole, 20), { from: 80, to: 100 });
  assert.deepEqual(shown_span(null, { from: 0, to: 5 }, 20), { from: 0, to: 20 }, "a young run fills the plot from the left");
  assert.deepEqual(shown_span({ from: 10, to: 20 }, whole, 20), { from: 10, to: 20 });
  const half = zoomed(whole, 25, 0.5, whole);
  assert.deepEqual(half, { from: 12.5, to: 62.5 }, "what lies under the pointer stays there");
  assert.deepEqual(zoomed(half, 12.5, 10, whole), whole);
  const least = zoomed(whole, 50, 1e-9, whole);
  assert.ok(Math.abs(least.to - least.from - 0.05) < 1e-9);
  assert.deepEqual(panned(half, 1000, whole), { from: 50, to: 100 });
  assert.deepEqual(panned(half, -1000, whole), { from: 0, to: 50 });
  assert.equal(choice_of(whole, whole, false), null);
  assert.deepEqual(choice_of(half, whole, false), half);
  assert.deepEqual(choice_of({ from: 60, to: 100 }, whole, true), { last: 40 }, "a live run is followed");
  assert.deepEqual(choice_of(half, whole, true), half, "a piece of the past stands still");
});

test("a thinned line keeps every peak and every gap", () => {
  const columns = run(1000, (tick) => ({ command: [tick === 501 ? 9 : tick === 777 ? -9 : 0.1, 0] }));
  const span = { from: 0, to: 100 };
  const all = points_of(columns, "v", span, 2000);
  assert.equal(all.y.length, 1000);
  const thin = points_of(columns, "v", span, 100);
  assert.ok(thin.y.length <= 100);
  const at = (value: number) => thin.x[[...Array.from(thin.y)].indexOf(value)];
  assert.deepEqual([at(9), at(-9)].map((t) => t.toFixed(1)), ["50.1", "77.7"], "at their own instants");
  assert.deepEqual(Array.from(thin.x), [...Array.from(thin.x)].sort((a, b) => a - b));
  assert.ok(Array.from(points_of(columns, "gyro.rate", span, 100).y).every(Number.isNaN));
  const part = points_of(columns, "v", { from: 10.05, to: 10.25 }, 100);
  assert.deepEqual(Array.from(part.x).map((t) => t.toFixed(1)), ["10.0", "10.1", "10.2", "10.3"], "one row beyond each edge");
});

test("values at the cursor are the row's own; behind the end of a run there is none", () => {
  const long = { label: "1", columns: run(20, (tick) => ({ command: [tick / 10, 0] })) };
  const short = { label: "2", columns: run(5, (tick) => ({ command: [tick, 0] })) };
  const [plot] = plots_with(signals_of(long.columns).filter((s) => s.name === "v"), [long, short]);
  assert.equal(plot.title, "Speed, m/s");
  assert.deepEqual(plot.traces.map((t) => [t.label, t.colour]), [["1: Commanded speed", "accent"], ["2: Commanded speed", "elastic"]]);
  assert.deepEqual(plot.traces.map((t) => value_words(t, 0.35)), ["0.30 m/s", "3.00 m/s"]);
  assert.deepEqual(plot.traces.map((t) => value_words(t, 1.5)), ["1.50 m/s", "–"]);
  assert.deepEqual(plot.traces.map((t) => value_words(t, null)), ["1.90 m/s", "4.00 m/s"]);
  assert.deepEqual(whole_of([long, short]), { from: 0, to: 1.9 });
  const chart = chart_of(plot, { from: 0, to: 1.9 }, 100);
  assert.deepEqual(chart.lines.map((l) => l.points.x.length), [20, 5], "each run has its own instants");
});

test("axes have round numbers", () => {
  assert.deepEqual(ticks(0, 85, 6), { values: [0, 20, 40, 60, 80], digits: 0 });
  assert.deepEqual(ticks(-0.2, 0.2, 2).values.map((v) => v.toFixed(1)), ["-0.2", "0.0", "0.2"]);
  assert.equal(ticks(12.31, 12.36, 5).digits, 2);
  assert.deepEqual(ticks(1, 1, 5).values, []);
  const chart: Chart = { least: [0, 1], lines: [{ label: "a", colour: "ok", dash: [], points: { x: [0, 1, 2], y: [0.5, NaN, 7] } }] };
  assert.equal(value_range(chart, { from: 0, to: 1 })[1], 1.06, "values outside the piece of time do not count");
  assert.ok(value_range(chart, { from: 0, to: 2 })[1] > 7);
});

test("pointers: hover, click, a dragged span, a pinch, the wheel", () => {
  const said: string[] = [];
  const note = (name: string) => (...args: unknown[]) => void said.push(`${name} ${JSON.stringify(args)}`);
  // 100 px are one second.
  const gestures = new PlotGestures({
    time_at: (px) => px / 100, hover: note("hover"), band: note("band"), seek: note("seek"), show: note("show"),
    zoom: note("zoom"), pan: note("pan"),
  });
  const heard = () => said.splice(0);
  gestures.move(1, 50);
  assert.deepEqual(heard(), ["hover [0.5]"]);
  gestures.down(1, 100, false);
  gestures.move(1, 103);
  gestures.up(1, 103);
  assert.deepEqual(heard(), ["hover [1.03]", "band [null]", "seek [1.03]"], "a shaking hand clicks");
  gestures.down(1, 300, false);
  gestures.move(1, 100);
  gestures.up(1, 100);
  assert.deepEqual(heard(), ["hover [1]", 'band [{"from":1,"to":3}]', "band [null]", 'show [{"from":1,"to":3}]']);
  gestures.leave();
  assert.deepEqual(heard(), ["hover [null]"]);
  gestures.down(7, 100, true);
  gestures.move(7, 150);
  gestures.up(7, 150);
  assert.deepEqual(heard(), ["hover [1]", "hover [1.5]", "seek [1.5]"]);
  gestures.down(7, 100, true);
  gestures.down(8, 200, true);
  gestures.move(8, 300);
  gestures.up(8, 300);
  gestures.up(7, 100);
  assert.deepEqual(heard(), ["hover [1]", "zoom [1,0.5]"], "the instant below the resting finger stays");
  gestures.wheel(100, 0, -400);
  gestures.wheel(100, 50, 0);
  const [zoom, pan] = heard();
  assert.match(zoom, /^zoom \[1,0\.52/);
  assert.equal(pan, "pan [0.5]");
});

/** The SVG that `draw` makes, without its head. */
function svg(draw: (g: SvgContext) => void, title = "A title"): string {
  const g = new SvgContext(200, 100);
  draw(g);
  return g.file(title);
}

test("the SVG has the canvas's shapes, turned and moved as on the canvas", () => {
  const shapes = svg((g) => {
    g.save();
    g.translate(10, 20);
    g.rotate(Math.PI / 2);
    g.beginPath();
    g.moveTo(0, 0);
    g.lineTo(5, 0);
    g.strokeStyle = "#123456";
    g.lineWidth = 3;
    g.setLineDash([4, 2]);
    g.stroke();
    g.restore();
    g.fillStyle = "red";
    g.globalAlpha = 0.5;
    g.fillRect(1, 2, 3, 4);
  });
  assert.match(shapes, /<path d="M10 20L10 25" fill="none" stroke="#123456" stroke-width="3" stroke-dasharray="4 2"\/>/);
  assert.match(shapes, /<path d="M1 2L4 2L4 6L1 6Z" fill="red" fill-opacity="0.5"\/>/);
  assert.match(svg((g) => {
    g.beginPath();
    g.arc(50, 50, 10, 0, 2 * Math.PI);
    g.fill();
  }), /d="M60 50A10 10 0 0 1 40 50A10 10 0 0 1 60 50"/, "a whole circle has two halves");
  assert.match(svg((g) => {
    g.beginPath();
    g.arc(50, 50, 10, 0, -Math.PI / 2, true);
    g.stroke();
  }), /d="M60 50A10 10 0 0 0 50 40"/, "an arc may go backwards");
  assert.match(svg((g) => {
    g.beginPath();
    g.lineTo(1, 1);
    g.lineTo(2, 2);
    g.stroke();
  }), /d="M1 1L2 2"/, "a line begins where the first lineTo goes, as on a canvas");
});

test("the SVG escapes texts, clips, and says its title", () => {
  const file = svg((g) => {
    g.save();
    g.beginPath();
    g.rect(0, 0, 10, 10);
    g.clip();
    g.font = `600 12px "Some Font", sans-serif`;
    g.textAlign = "right";
    g.textBaseline = "middle";
    g.fillText("a < b & c", 5, 6); // in the middle of 12 px: 0.3 of them below lies the baseline
    g.restore();
    g.fillText("outside", 5, 6);
  }, "Run 1: <Case>");
  assert.match(file, /<title>Run 1: &lt;Case&gt;<\/title>/);
  assert.match(file, /<clipPath id="clip1"><path d="M0 0L10 0L10 10L0 10Z"\/><\/clipPath>/);
  assert.match(file, /<text x="5" y="9.6" font-family="&quot;Some Font&quot;, sans-serif" font-size="12" font-weight="600" text-anchor="end"[^>]*clip-path="url\(#clip1\)">a &lt; b &amp; c<\/text>/);
  assert.doesNotMatch(file.split("outside")[0].split("<text").at(-1)!, /clip-path/, "restore() ends the clip");
});

test("a chart draws its line where its values are, a gap as a gap", () => {
  const g = new SvgContext(200, 100);
  const box = { x: 0, y: 0, width: 200, height: 100 };
  const chart: Chart = { least: [0, 1], lines: [{ label: "a", colour: "ok", dash: [], points: { x: [0, 1, 2, 3, 4], y: [0, 1, NaN, 1, 0] } }] };
  draw_chart(g as unknown as Context, box, chart, { palette, span: { from: 0, to: 4 }, cursor: 2, band: null });
  const file = g.file("");
  const line = /<path d="([^"]*)" fill="none" stroke="#ok"/.exec(file)![1];
  const field = field_of(box);
  const points = [...line.matchAll(/([ML])([\d.]+) ([\d.]+)/g)].map((m) => [m[1], Number(m[2]), Number(m[3])] as const);
  assert.deepEqual(points.map((p) => p[0]), ["M", "L", "M", "L"], "the gap splits the line");
  assert.deepEqual(points.map((p) => Math.round(((p[1] - field.x) / field.width) * 4)), [0, 1, 3, 4]);
  assert.ok(Math.abs(points[0][2] - (field.y + field.height)) < 0.01, "0 lies at the foot");
  assert.ok(points[1][2] < points[0][2]);
  const cursor = field.x + field.width / 2;
  assert.ok(file.includes(`M${cursor} `), "the cursor stands at its instant");
});

test("saved pictures have title, units, axes and legend", () => {
  const scene = new_scene();
  fold_frame(scene, frame({ tick: 0, stamp: 0, pose: [0, 0, 0] }));
  fold_frame(scene, frame({ tick: 40, stamp: 4, pose: [1, 1, 0], goal: [3, 3, null] }));
  const columns = run(50, (tick) => ({ command: [tick / 50, 0] }));
  const [plot] = plots_with(signals_of(columns).filter((s) => ["v", "odometry.v"].includes(s.name)), [{ label: "7", columns }]);
  const span = { from: 0, to: 4.9 };
  const sheet = sheet_picture({ title: "Run 7: Case 1", span, cursor: null, plots: [{ title: plot.title, chart: chart_of(plot, span, 500) }] });
  const part = {
    scene, view: Object.assign(new View(), { width: 400, height: 300, scale: 50 }),
    overlay: {
      selection: null, hovered: null, draft: {}, force_scale: 1, hidden: new Set(["scan"]), ghosts: [], future: false,
      insets: { left: 0, top: 0, right: 0, bottom: 22 },
    },
  };
  const whole = scene_picture(part, "Run 7: Case 1");
  for (const [picture, words] of [
    [sheet, ["Run 7: Case 1", "Speed, m/s", "Commanded speed", "Executed speed", "time, s", "0.5"]],
    [whole, ["Run 7: Case 1, at 4.00 s", "x, m", "y, m", "Filtered scan", "Travelled, by odometry"]],
  ] as const) {
    const g = new SvgContext(picture.width, picture.height);
    picture.draw(g as unknown as Context, palette);
    const file = g.file(picture.title);
    for (const word of words) assert.ok(file.includes(`>${word}</text>`), word);
    assert.ok(file.includes(`<title>${words[0]}</title>`));
    assert.doesNotMatch(file, /NaN|undefined/);
  }
  const g = new SvgContext(whole.width, whole.height);
  whole.draw(g as unknown as Context, palette);
  assert.ok(!g.file("").includes("Raw scan"), "a layer that is off is not in the legend");
});

test("a legend goes on in the next row; names of files are plain", () => {
  assert.deepEqual(legend_rows(["a", "b"], 400).map((p) => p.row), [0, 0]);
  assert.deepEqual(legend_rows(["a long label", "another long label", "c"], 200).map((p) => [p.row, p.x === 0]),
    [[0, true], [1, true], [2, true]]);
  assert.equal(file_name(12, "my world/two: a"), "run-12-my-world-two-a");
  assert.equal(file_name(null, "demo"), "session-demo");
});
