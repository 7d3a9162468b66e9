// web/src/teleop/who_drives.tsx: who has the controls, how they change hands, and how good the driver's link is.
import { JSX } from "preact";
import { useEffect, useState } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { Driving } from "../contract";
import { keep_lease_key } from "../link/lease_key";
import { may } from "../people";
import { use_me } from "../ui/guard";
import { sentence_of } from "../words";
import { OperatorLink, link_words } from "./operator_link";

interface Answer { you: number; key?: string; driving: Driving }

export function WhoDrives(props: { link: OperatorLink; on_loss: () => void }): JSX.Element | null {
  const app = use_app();
  const { session, link: status } = use_ui("session", "link");
  const me = use_me();
  const [you, set_you] = useState<number | null>(null);
  const driving = session?.driving ?? null;
  const driver = driving?.driver ?? null;
  const mine = driver !== null && driver.client === you;

  const act = (body: object) =>
    app.link.call<Answer>("/lease", body).then((answer) => {
      set_you(answer.you);
      keep_lease_key(answer.key ?? "");
    });
  const ask = (body: object) => act(body).catch((error) => app.toast("warn", sentence_of(error)));
  useEffect(() => {
    if (status.phase === "open") void act({}).catch(() => undefined); // a server of before knows no lease
    else set_you(null);
  }, [status.phase]);
  useEffect(() => {
    if (mine) void act({}).catch(() => undefined); // handed over by the last driver: the key comes now
    else keep_lease_key("");
    if (driver !== null && !mine) props.on_loss();
  }, [mine, driver?.client]);

  if (!driving || !may(me, "operator")) return null;
  const asks = driving.asking.some((a) => a.client === you);
  const quality = link_words(props.link.round_trip);
  const dropped = driving.dropped.late + driving.dropped.out_of_order + driving.dropped.unreadable;
  return (
    <div class="who-drives" data-testid="who-drives">
      <p role="status">
        <b>{driver === null ? "The controls are free" : mine ? "You have the controls" : `${driver.name} has the controls`}</b>
        {mine && driving.asking.map((a) => <span key={a.client}> {a.name} asks for them.</span>)}
        {asks && <span> You have asked for them.</span>}
      </p>
      <div class="who-acts">
        {driver === null && <button class="ghost" onClick={() => ask({ action: "take" })}>Take the controls</button>}
        {mine && driving.asking.map((a) => (
          <button class="ghost" key={a.client} onClick={() => ask({ action: "give", to: a.client })}>Hand over to {a.name}</button>
        ))}
        {mine && <button class="ghost" onClick={() => ask({ action: "release" })}>Give them back</button>}
        {driver !== null && !mine && !asks && <button class="ghost" onClick={() => ask({ action: "ask" })}>Ask for them</button>}
        {driver !== null && !mine && driver.silent && (
          <button class="ghost" onClick={() => ask({ action: "take" })}>Take over</button>
        )}
        {driver !== null && !mine && !driver.silent && may(me, "admin") && (
          <button class="ghost danger" onClick={() => ask({ action: "take", force: true })}>Take by force</button>
        )}
      </div>
      <p class={`link-quality ${quality.tone === "ok" ? "quiet" : quality.tone}`} data-testid="link-quality">
        Link: {quality.word}{dropped > 0 && `. ${dropped} of its sticks came too late`}.
      </p>
    </div>
  );
}
