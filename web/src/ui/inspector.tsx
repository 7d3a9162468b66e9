// web/src/ui/inspector.tsx: the card of the thing under the mouse, under the crosshair, or tapped. It
// stands beside the thing and inside the scene; a screen reader hears it once for each thing.
import { JSX } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Selection } from "../draw/scene";
import type { Insets } from "../draw/view";
import { Card, card_of, card_words, thing_key } from "../edit/facts";
import { Eye, Shown, Thing, card_place, thing_at } from "../edit/inspect";
import { Point } from "../geometry";
import { SceneState } from "../state/scene";
import { use_pulse } from "../state/store";
import css from "../style/inspect.css?text";
import { Subscripted } from "./controls";
import type { Probe } from "./probe";
import { adopt } from "./sheet";

adopt(css);

const kRest = 400;       // [ms] until a thing is spoken
const kMargin = 8;       // [px] from the edge of the scene
const kRing = 9;         // [px] round a small thing
const kLargest = 90;     // [px] of a thing that its card does not cover

export interface InspectorProps {
  scene: () => SceneState;       // as it is drawn now: live, or the past
  probe: Probe;
  box: () => HTMLElement | null;  // of the scene
  eye: (px: Point, slack: number) => Eye | null;
  shown: () => Shown;
  insets: () => Insets;           // that cards and tools cover
  crosshair: () => Point | null;  // [px]
  resting: () => boolean;         // no tool and no drag is at work
  selection: () => Selection;     // its numbers stand in the value box
}

export function Inspector(props: InspectorProps): JSX.Element {
  use_pulse(100);
  const scene = props.scene();
  const find = (px: Point, slack: number) => {
    const eye = props.eye(px, slack);
    return eye && thing_at(scene, props.shown(), eye);
  };
  const crosshair = props.resting() ? props.crosshair() : null;
  const found = props.resting() ? props.probe.thing(crosshair, find) : null;
  const thing = found && !is_selected(found, props.selection()) ? found : null;
  const card = thing && card_of(scene, thing);
  const said = use_said(card && thing ? thing_key(thing) : "", () => (card ? card_words(card) : ""));
  return (
    <>
      {card && thing && <ThingCard card={card} name={thing_key(thing)} pointer={crosshair ?? props.probe.mouse} {...props} />}
      <div class="spoken" role="status" aria-live="polite" data-testid="inspect-said">{said}</div>
    </>
  );
}

function is_selected(thing: Thing, selection: Selection): boolean {
  if (thing.kind === "obstacle" || thing.kind === "ground") return selection?.kind === "obstacle" && selection.id === thing.id;
  return thing.kind === "goal" && thing.index === 0 && selection?.kind === "goal";
}

/** The words of a thing once it has rested; they stay while its numbers change. */
function use_said(key: string, words: () => string): string {
  const [said, set_said] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => set_said(words()), key ? kRest : 0);
    return () => clearTimeout(timer);
  }, [key]);
  return said;
}

interface CardProps extends InspectorProps { card: Card; name: string; pointer: Point | null }

function ThingCard(props: CardProps): JSX.Element {
  const { card } = props;
  const { title, note, rows, law } = card;
  const box = useRef<HTMLElement>(null);
  const ring = useRef<HTMLElement>(null);
  useLayoutEffect(() => place(props, box.current!, ring.current!));
  return (
    <>
      <i class="inspect-ring" ref={ring} aria-hidden="true" />
      <aside class="card inspect" ref={box} aria-label={title} data-testid="inspect" data-thing={props.name}>
        <h2>{title} {note && <small>{note}</small>}</h2>
        <dl>
          {rows.map((r) => (
            <div key={r.label} data-row={r.label}>
              <dt><Subscripted text={r.label} /></dt>
              <dd class={`num ${r.token ? `c-${r.token}` : ""}`}>{r.value}{r.unit === "°" ? "°" : r.unit && ` ${r.unit}`}</dd>
            </div>
          ))}
        </dl>
        {law && <p class="law" data-testid="inspect-law">
          <Subscripted text={law.law} />, {law.source}{law.numbers && <><br /><Subscripted text={law.numbers} /></>}
        </p>}
      </aside>
    </>
  );
}

/** Puts the card beside its thing, in the free part of the scene if that has room for it. */
function place(props: CardProps, card: HTMLElement, ring: HTMLElement): void {
  const scene = props.box();
  const { at, height, radius, long } = props.card;
  const eye = props.eye({ x: 0, y: 0 }, 0);
  const middle = eye?.to_screen(at, height);
  const px = long && props.pointer ? props.pointer : middle;
  const side = eye?.to_screen({ x: at.x + radius, y: at.y }, height);
  ring.hidden = !px || radius > 0;
  if (!scene || !px || !middle || !side) return;
  const r = Math.min(kLargest, Math.max(kRing, Math.hypot(side.x - middle.x, side.y - middle.y)));
  const size = { w: card.offsetWidth, h: card.offsetHeight };
  const [w, h] = [scene.clientWidth, scene.clientHeight];
  const inside = (i: Insets) => ({ left: i.left, top: i.top, right: w - i.right, bottom: h - i.bottom });
  const free = inside(props.insets());
  const fits = free.right - free.left >= size.w && free.bottom - free.top >= size.h;
  const room = fits ? free : inside({ left: kMargin, top: kMargin, right: kMargin, bottom: kMargin });
  const corner = card_place({ left: px.x - r, top: px.y - r, right: px.x + r, bottom: px.y + r }, size, room);
  card.style.transform = `translate(${Math.round(corner.x)}px, ${Math.round(corner.y)}px)`;
  ring.style.transform = `translate(${px.x}px, ${px.y}px)`;
}
