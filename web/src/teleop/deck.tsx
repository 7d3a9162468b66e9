// web/src/teleop/deck.tsx: the deck of a driver: the stick with its force, and the speeds with their reasons. Also of a
// stored run, where nobody holds the stick.
import { ComponentChildren, JSX } from "preact";
import css from "../style/teleop.css?text";
import { draw_sectors, draw_wall_words, draw_ways_ahead } from "../draw/driven";
import { draw_for_driver } from "../draw/scene";
import { force_of, full_stick, measure } from "../state/driven";
import { SceneState } from "../state/scene";
import { adopt } from "../ui/sheet";
import { DrawnStick } from "./drawn_stick";
import { Stick } from "./seat";
import { Speeds } from "./speeds";

adopt(css);
draw_for_driver({ draw_sectors, draw_ways_ahead, draw_wall_words });

const kMiddle: Stick = { forward: 0, turn: 0 };

/** `wish`: the stick in the driver's own hand; without one the stick of the scene is shown. */
export function Deck(props: {
  scene: SceneState; wish?: Stick | null; hold?: ((stick: Stick | null) => void) | null; barred?: boolean;
  children?: ComponentChildren;
}): JSX.Element {
  const { scene } = props;
  const full = full_stick(scene);
  const stick = props.wish ?? scene.stick ?? kMiddle;
  const share = (name: string, of: number) => {
    const value = measure(scene, name);
    return value === null ? null : value / of;
  };
  return (
    <section class="deck" aria-label="Driving by hand" data-testid="deck">
      <DrawnStick stick={stick} force={force_of(scene)} room={share("teleop.v_sprs", full.v)}
        wall_turn={share("teleop.w_d", full.omega)} hold={props.hold ?? null} barred={props.barred} />
      {props.children}
      <Speeds scene={scene} stick={stick} />
    </section>
  );
}

const kModes: Record<string, string> = { guarded: "Guarded", wall: "Wall", elastic: "Elastic", raw: "Raw" };

/** The deck of a stored run at the shown instant. */
export function ReplayDeck(props: { scene: SceneState }): JSX.Element {
  const { stick } = props.scene;
  return (
    <Deck scene={props.scene}>
      <p class="quiet driven-mode" data-testid="driven-mode">
        {stick ? `Driven by hand, mode ${kModes[stick.mode] ?? stick.mode}` : "Nobody drives by hand now"}
      </p>
    </Deck>
  );
}
