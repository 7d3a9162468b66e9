// web/src/views/terrain.tsx: the card of the ground: its profile ahead with the verdict, the horizon, and the turn rates
// that do not turn the robot over. Each part is shown only where the robot has the sense.
import { JSX } from "preact";
import css from "../style/terrain.css?text";
import { degrees } from "../geometry";
import { SceneState } from "../state/scene";
import { Ahead, Band, LineAcross, ground_ahead, line_across, predicted_stand, turn_band } from "../state/terrain";
import { adopt } from "../ui/sheet";
import { fixed } from "../words";

adopt(css);

export function Terrain(props: { scene: SceneState }): JSX.Element {
  const { scene } = props;
  const [ahead, line, band] = [ground_ahead(scene), line_across(scene), turn_band(scene)];
  return (
    <section class="terrain" aria-label="Ground and tilt" data-testid="terrain">
      {ahead && <Profile ahead={ahead} />}
      {line && <Across line={line} />}
      {scene.inclination && <Horizon scene={scene} stands={scene.inclination} />}
      {band && <Turns band={band} />}
    </section>
  );
}

const signed = (angle: number, digits = 1): string => `${angle > 0 ? "+" : ""}${fixed(degrees(angle), digits)}°`;
const within = (v: number, least: number, most: number): number => Math.max(least, Math.min(most, v));

// The profile, in units of its drawing: the robot at the left, the floor, and the ground ahead. Heights are drawn larger
// than they are, so that a step of a centimetre is seen; the numbers are exact.
const kFloor = 38, kNose = 44, kEnd = 240;
const kMetre = 90;        // of the way to the edge
const kFarthest = 1.2;    // [m]
const kRise = 220;        // of a metre of height
const kSteepest = 32;     // [degrees] as drawn

/** The line of the ground from the nose on. */
function profile_path({ kind, height, slope, width, distance }: Ahead): string {
  const x = kNose + kMetre * within(distance ?? 0.5, 0.06, kFarthest);
  const rise = within(kRise * Math.abs(height ?? 0.04), 7, 24);
  const angle = within(degrees(Math.abs(slope ?? 0.2)) * 1.4, 7, kSteepest);
  const climb = within((kEnd - x) * Math.tan((angle * Math.PI) / 180), 0, kFloor - 6);
  const reach = climb / Math.tan((angle * Math.PI) / 180);
  switch (kind) {
    case "step up": return `M0 ${kFloor}H${x}v${-rise}H${kEnd}`;
    case "step down": return `M0 ${kFloor}H${x}v${rise * 0.7}H${kEnd}`;
    case "slope up": return `M0 ${kFloor}H${x}l${reach} ${-climb}H${kEnd}`;
    case "slope down": return `M0 ${kFloor}H${x}L${kEnd} ${within(kFloor + climb, kFloor, 60)}`;
    case "trench": {
      const gap = within(kMetre * 2 * (width ?? 0.1), 8, 70);
      return `M0 ${kFloor}H${x}V58h${gap}V${kFloor}H${kEnd}`;
    }
    case "flat": return `M0 ${kFloor}H${kEnd}`;
    default: return `M0 ${kFloor}H${kNose + 30}`; // not known beyond
  }
}

const kCalm = ["flat", "pending"];

function Profile(props: { ahead: Ahead }): JSX.Element {
  const { ahead } = props;
  const { kind, words, distance, confidence } = ahead;
  const path = profile_path(ahead);
  const known = kind !== "unknown" && kind !== "pending";
  const far = known && kind !== "flat" && distance !== null ? `${fixed(distance, 2)} m ahead` : "";
  const sure = confidence === null ? "" : `${fixed(100 * within(confidence, 0, 1), 0)} % sure`;
  return (
    <figure class="profile" data-kind={kind}>
      <svg viewBox="0 0 240 62" preserveAspectRatio="xMinYMid" role="img"
        aria-label={`Profile of the ground ahead: ${[words, far].filter(Boolean).join(", ")}`}>
        <path class="earth" d={`${path}V62H0Z`} />
        {!known && <path class="unseen" d={`M${kNose + 30} ${kFloor}H${kEnd}`} />}
        <path class="top" d={path} />
        <path class="hull" d={`M6 ${kFloor - 5}v-11h28l6 6v5z`} />
        <circle class="wheel" cx="13" cy={kFloor - 4} r="4" /><circle class="wheel" cx="31" cy={kFloor - 4} r="4" />
        {!known && <text x="150" y="24">?</text>}
      </svg>
      <figcaption>
        <b class={kCalm.includes(kind) ? "" : "met"} data-testid="terrain-verdict">{words}</b>
        <span class="num">{[far, sure].filter(Boolean).join(", ")}</span>
      </figcaption>
    </figure>
  );
}

/** The laser line as the camera sees it, across the way; heights as large as the way is wide. */
function Across(props: { line: LineAcross }): JSX.Element {
  const { points, ahead } = props.line;
  const half = Math.max(0.3, ...points.map((p) => Math.abs(p.y)));
  const tall = Math.max(0.1, ...points.map((p) => Math.abs(p.z)));
  const at = (p: { y: number; z: number }) => `${(120 - (112 * p.y) / half).toFixed(1)} ${(34 - (24 * p.z) / tall).toFixed(1)}`;
  const [verdict, met] = slope_words(props.line);
  const height = points.reduce((sum, p) => sum + p.z, 0) / points.length;
  const words = `${fixed(ahead, 2)} m ahead, ${fixed(height, 2)} m high`;
  return (
    <figure class="profile across">
      <svg viewBox="0 0 240 62" preserveAspectRatio="xMinYMid" role="img" aria-label={`Laser line across the way: ${verdict}, ${words}`}>
        <path class="level" d="M4 34H236" />
        <path class="earth" d={`M${points.map(at).join("L")}V62H${120 - (112 * points[0].y) / half}Z`} />
        <path class="top" d={`M${points.map(at).join("L")}`} />
      </svg>
      <figcaption><b class={met ? "met" : ""} data-testid="terrain-verdict">{verdict}</b><span class="num">{words}</span></figcaption>
    </figure>
  );
}

const kLevel = 2; // [degrees] below which ground is called flat, as between facets of a bank

/** The slope at the laser line in words, and whether it is one. */
function slope_words({ slope, roll }: LineAcross): [string, boolean] {
  if (slope === null || roll === null) return ["slope not known yet", false];
  const [up, lean] = [degrees(slope), degrees(roll)];
  const words = [
    ...(Math.abs(up) >= kLevel ? [`slope ${up > 0 ? "up" : "down"} ${fixed(Math.abs(up), 0)}°`] : []),
    ...(Math.abs(lean) >= kLevel ? [`${lean > 0 ? "left" : "right"} side up ${fixed(Math.abs(lean), 0)}°`] : []),
  ];
  return words.length > 0 ? [words.join(", "), true] : ["flat", false];
}

const kPerDegree = 1.1; // of the horizon's drawing, per degree of pitch
const kMostShift = 26;

/** What the robot sees as level: the horizon leans against its roll and rises as its nose goes down. */
function Horizon(props: { scene: SceneState; stands: { roll: number; pitch: number } }): JSX.Element {
  const { roll, pitch } = props.stands;
  const soon = predicted_stand(props.scene);
  const turn = (of: { roll: number; pitch: number }) => {
    const shift = within(-degrees(of.pitch) * kPerDegree, -kMostShift, kMostShift);
    return `rotate(${(-degrees(of.roll)).toFixed(2)} 32 32) translate(0 ${shift.toFixed(2)})`;
  };
  const margin = soon?.margin ?? null;
  return (
    <figure class="horizon">
      <svg viewBox="0 0 64 64" role="img"
        aria-label={`Horizon: roll ${fixed(degrees(roll), 1)} degrees, pitch ${fixed(degrees(pitch), 1)} degrees`}>
        <clipPath id="horizon-dial"><circle cx="32" cy="32" r="30" /></clipPath>
        <g clip-path="url(#horizon-dial)">
          <rect class="sky" width="64" height="64" />
          <path class="earth" transform={turn(props.stands)} d="M-40 32H104V140H-40Z" />
          <path class="top" transform={turn(props.stands)} d="M-40 32H104" />
          {soon && <path class="soon" transform={turn(soon)} d="M-40 32H104" />}
        </g>
        <circle class="rim" cx="32" cy="32" r="30" />
        <path class="self" d="M14 32h11l3 4M50 32H39l-3 4M32 31v2" />
      </svg>
      <figcaption>
        <span>Roll <b class="num" data-testid="terrain-roll">{signed(roll)}</b></span>
        <span>Pitch <b class="num" data-testid="terrain-pitch">{signed(pitch)}</b></span>
        {margin !== null && <span class={margin > 0 ? "" : "bad"}>
          Margin <b class="num" data-testid="terrain-margin">{signed(margin)}</b></span>}
      </figcaption>
    </figure>
  );
}

/** The free turn rates, left at the left, and in them the commanded one. */
function Turns(props: { band: Band }): JSX.Element {
  const { min, max, commanded, top } = props.band;
  const x = (omega: number) => 120 - 116 * within(omega / top, -1, 1);
  const free = max > min;
  const words = free ? `Free of turnover: ${fixed(min, 2)} to ${fixed(max, 2)} rad/s, commanded ${fixed(commanded, 2)}`
    : "No turn is free of turnover";
  return (
    <figure class="turns">
      <svg viewBox="0 0 240 22" role="img" aria-label={words} preserveAspectRatio="none">
        <path class="barred" d="M4 11H236" />
        {free && <path class="free" d={`M${x(max)} 11H${x(min)}`} />}
        <path class="zero" d="M120 4v14" />
        <path class="now" d={`M${x(commanded)} 2v18`} />
      </svg>
      <figcaption>
        <span>Left</span>
        <b class={`num ${free ? "" : "bad"}`} data-testid="terrain-band">
          {free ? <>{fixed(min, 2)} … {fixed(max, 2)}<u> rad/s</u></> : "no turn is free"}</b>
        <span>Right</span>
      </figcaption>
    </figure>
  );
}
