// web/src/views/toasts.tsx: messages that disappear again, and sentences for screen readers.
import { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { use_app, use_ui } from "../app";
import { use_pulse } from "../state/store";
import { icons } from "../ui/icons";
import { state_word } from "../words";

export function Toasts(): JSX.Element {
  const app = use_app();
  const { toasts } = use_ui("toasts");
  return (
    <div class="toasts" role="status" aria-live="polite" data-testid="toasts">
      {toasts.map((t) => (
        <div key={t.id} class={`toast tone-${t.tone}`}>
          <span>{t.text}</span>
          {t.count > 1 && <b class="num" aria-label={`${t.count} times`} role="img">×{t.count}</b>}
          {t.undo && <button class="ghost" data-testid="toast-undo" onClick={() => {
            app.dismiss(t.id);
            t.undo!();
          }}>Undo</button>}
          <button class="icon" aria-label="Dismiss" onClick={() => app.dismiss(t.id)}>{icons.close}</button>
        </div>
      ))}
    </div>
  );
}

/** Tells screen readers the app's sentences and changes of state. */
export function Spoken(): JSX.Element {
  const app = use_app();
  const { spoken } = use_ui("spoken");
  use_pulse(500);
  const { session, link } = app.ui.value;
  const word = state_word(app.scene.frame, session, link.phase === "open").word;
  const last = useRef(word);
  useEffect(() => {
    if (last.current !== word) app.say(`${word}. ${app.scene.words?.what ?? ""}`);
    last.current = word;
  }, [word]);
  return <div class="spoken" aria-live="polite">{spoken}</div>;
}
