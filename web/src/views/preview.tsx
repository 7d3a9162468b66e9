// web/src/views/preview.tsx: the unsent goal for real hardware.
import { JSX } from "preact";
import { use_app, use_ui } from "../app";
import { SessionState } from "../contract";
import { fixed } from "../words";

/** The step that Go still needs; null when Go works. */
function not_yet(session: SessionState | null): string | null {
  if (!session?.hardware?.armed) return "Arm the motors first. Arming moves nothing by itself.";
  if (session.stop) return "Release Stop first. Releasing moves nothing by itself.";
  return null;
}

/** The robot drives only after Go is pressed. */
export function PreviewCard(): JSX.Element | null {
  const app = use_app();
  const { preview, session } = use_ui("preview", "session");
  if (!preview) return null;
  const { goal, further, trouble } = preview;
  const wait = not_yet(session);
  return (
    <div class="card preview" role="group" aria-label="A goal that is not sent yet" data-testid="preview">
      <p>
        <b>{further ? "A further goal" : "A goal"} at {fixed(goal.x, 2)}, {fixed(goal.y, 2)} m.</b>{" "}
        <span>The real robot drives when you press Go.</span>
      </p>
      {trouble && <p class="tone-warn words" role="alert" data-testid="preview-trouble">{trouble}</p>}
      {wait && <p class="tone-muted words" data-testid="preview-wait">{wait}</p>}
      <div class="acts">
        <button class="go" disabled={wait !== null} data-testid="go" onClick={() => void app.editor.go_there()}>Go</button>
        <button class="ghost" data-testid="preview-drop"
        onClick={() => app.editor.drop_preview()}>Discard</button>
      </div>
    </div>
  );
}
