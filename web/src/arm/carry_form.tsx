// web/src/arm/carry_form.tsx: drives the base straight to a goal with the arm as it is.
import { JSX } from "preact";
import { useState } from "preact/hooks";
import { use_app } from "../app";
import { degrees, radians } from "../geometry";
import { NumberField } from "../ui/controls";
import { ArmDesk, carry_goal_of } from "./desk";

interface Typed { x: number | null; y: number | null; heading: number | null }

export function CarryForm(props: { desk: ArmDesk }): JSX.Element {
  const app = use_app();
  const { desk } = props;
  const [typed, set_typed] = useState<Partial<Typed>>({});
  const [carries, set_carries] = useState(desk.carries);
  const goal = carry_goal_of(app.scene);
  const values: Typed = {
    x: goal?.x ?? null, y: goal?.y ?? null, heading: goal?.heading == null ? null : Math.round(degrees(goal.heading)), ...typed,
  };
  const type = (change: Partial<Typed>) => set_typed({ ...typed, ...change });
  const { x, y, heading } = values;
  return (
    <section aria-label="Carry">
      <h2>Carry</h2>
      <form class="arm-form" noValidate onSubmit={(e) => {
        e.preventDefault();
        if (x === null || y === null) {
          app.toast("warn", "A goal to carry to needs both x and y.");
          return;
        }
        void desk.send_carry({ x, y, heading: heading === null ? null : radians(heading) });
        set_typed({});
      }}>
        <NumberField label="x" unit="m" name="carry-x" value={x} on_change={(x) => type({ x })} />
        <NumberField label="y" unit="m" name="carry-y" value={y} on_change={(y) => type({ y })} />
        <NumberField label="heading" unit="°" name="carry-heading" value={heading} step={5} empty="any" on_change={(heading) => type({ heading })} />
        <p class="help">The base drives straight there with the arm as it is. The arm yields to what is in its way.</p>
        {!app.on_hardware && <label class="check"><input type="checkbox" checked={carries} data-testid="carry-goals"
          onChange={(e) => {
            desk.carries = e.currentTarget.checked;
            set_carries(desk.carries);
          }} /><span>Carry to goals that are set in the scene</span></label>}
        <div class="acts"><button type="submit" class="small primary" data-testid="carry-go">Carry there</button></div>
      </form>
    </section>
  );
}
