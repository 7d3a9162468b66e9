// web/src/views/layer_panel.tsx: legend and layers in one panel: each colour's meaning and switch.
import { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { layer_groups } from "../state/layer_groups";
import { LayerKey } from "../state/layers";
import { drawing } from "../state/meter";
import { SceneState } from "../state/scene";
import { use_pulse } from "../state/store";
import css from "../style/layers.css?text";
import { icons } from "../ui/icons";
import { adopt } from "../ui/sheet";
import "../ui/swatch";
import "../ui/switch";

adopt(css);

/** Everything that is drawn, with its swatch, label and switch. */
export function LayerPanel(props: { scene: SceneState; compared?: boolean; on_close: () => void }): JSX.Element {
  const app = use_app();
  const { hidden, force_scale: times } = use_ui("hidden", "force_scale");
  use_pulse(500); // a controller's layers come with its frames
  useEffect(() => {
    app.view.target = null; // only now the scene has less room
    app.redraw();
  }, []);
  const groups = layer_groups(props.scene, props.compared);
  const next = { 1: 2, 2: 5, 5: 1 }[times] ?? 1;
  return (
    <section class="layers card" aria-label="Layers" data-testid="layer-panel" onKeyDown={(e) => {
      if (e.key === "Escape") props.on_close();
    }}>
      <header>
        <h2>Layers</h2>
        <button class="icon" aria-label="Close" onClick={props.on_close}>{icons.close}</button>
      </header>
      <div class="layer-groups">
        {groups.map((group) => (
          <div role="group" aria-label={group.title} key={group.title}>
            <h3>{group.title}{group.title === "Forces" && <>, <button class="text scale-button" data-testid="force-scale"
              title="A force is a displacement in metres; this enlarges its arrow"
              onClick={() => app.ui.set({ force_scale: next })}>drawn ×{times}</button></>}</h3>
            {group.keys.map((key) => <LayerRow key={key.name} of={key} on={!hidden.has(key.name)} />)}
          </div>
        ))}
        <p class="draw-time" data-testid="draw-time">A frame is drawn in {drawing.words() ?? "–"}.</p>
      </div>
    </section>
  );
}

/** Enter switches the layer; Space is Stop, as everywhere. What is always drawn has no switch. */
function LayerRow(props: { of: LayerKey; on: boolean }): JSX.Element {
  const app = use_app();
  const { name, label, token, kind, style, always } = props.of;
  const swatch = <i class={`swatch c-${token} is-${kind} ${style}`} />;
  if (always) return <div class="layer always">{swatch}<span>{label}</span></div>;
  return (
    <button class="layer" role="switch" aria-checked={props.on} data-testid={`layer-${name}`}
      onClick={() => app.toggle_layer(name)}>
      {swatch}
      <span>{label}</span>
      <i class="switch" />
    </button>
  );
}
