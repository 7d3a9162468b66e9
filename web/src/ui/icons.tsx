// web/src/ui/icons.tsx: the page's drawings, each on a 20 x 20 field in the text's colour.
import { ComponentChildren, JSX } from "preact";

function line(children: ComponentChildren): JSX.Element {
  return (
    <svg viewBox="0 0 20 20" fill="none" stroke="currentColor" stroke-width="1.7"
      stroke-linecap="round" stroke-linejoin="round" aria-hidden="true" focusable="false">
      {children}
    </svg>
  );
}
function solid(children: ComponentChildren): JSX.Element {
  return (
    <svg viewBox="0 0 20 20" fill="currentColor" aria-hidden="true" focusable="false">
      {children}
    </svg>
  );
}

export const icons = {
  drive: line(<path d="M3 15c4 0 4-9 7-9s3 9 7 9" />),
  runs: line(<path d="M4 5h12M4 10h12M4 15h8" />),
  system: line(<><rect x="4" y="4" width="12" height="12" rx="2" /><path d="M8 8h4v4H8z" /></>),
  tune: line(<><path d="M4 6h6M14 6h2M4 14h2M10 14h6" /><circle cx="12" cy="6" r="1.8" />
    <circle cx="8" cy="14" r="1.8" /></>),
  pan: line(<path d="M10 3v14M3 10h14M8 5l2-2 2 2M8 15l2 2 2-2M5 8l-2 2 2 2M15 8l2 2-2 2" />),
  goal: line(<path d="M6 17V4l9 3-9 4" />),
  cylinder: line(<circle cx="10" cy="10" r="6" />),
  box: line(<rect x="4" y="4" width="12" height="12" />),
  measure: line(<path d="M4 16 16 4M7 16H4v-3M13 4h3v3" />),
  layers: line(<path d="m10 3 7 4-7 4-7-4zM3 10.5l7 4 7-4M3 14l7 4 7-4" />),
  undo: line(<path d="M8 5 4 9l4 4M4 9h8a4 4 0 0 1 0 8h-2" />),
  redo: line(<path d="m12 5 4 4-4 4M16 9H8a4 4 0 0 0 0 8h2" />),
  fit: line(<path d="M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4" />),
  follow: line(<><circle cx="10" cy="10" r="2.5" /><path d="M10 2v4M10 14v4M2 10h4M14 10h4" /></>),
  reset: line(<path d="M4 10a6 6 0 1 0 2-4.5M4 3v4h4" />),
  close: line(<path d="m5 5 10 10M15 5 5 15" />),
  back: line(<path d="M12 4 6 10l6 6" />),
  theme: line(<><circle cx="10" cy="10" r="6.5" /><path d="M10 3.5a6.5 6.5 0 0 1 0 13z"
    fill="currentColor" /></>),
  help: line(<><circle cx="10" cy="10" r="7" /><path d="M8 8a2 2 0 1 1 2.7 1.9c-.5.2-.7.6-.7 1.1v.3M10 13.8v.1" /></>),
  play: solid(<path d="M6 4l10 6-10 6z" />),
  pause: solid(<><rect x="5" y="4" width="3.6" height="12" rx="1" />
    <rect x="11.4" y="4" width="3.6" height="12" rx="1" /></>),
  step: solid(<path d="M5 4l8 6-8 6zM14 4h2v12h-2z" />),
  back_step: solid(<path d="M15 4l-8 6 8 6zM4 4h2v12H4z" />),
  trash: line(<path d="M4 6h12M8 6V4h4v2M6 6l1 11h6l1-11M9 9v5M11 9v5" />),
  down: line(<path d="m5 8 5 5 5-5" />),
  compare: line(<><circle cx="7.5" cy="10" r="4.5" /><circle cx="12.5" cy="10" r="4.5" /></>),
  download: line(<path d="M10 3v9M6 9l4 4 4-4M4 17h12" />),
};

export function Brand(): JSX.Element {
  return (
    <svg viewBox="0 0 28 28" fill="none" aria-hidden="true" focusable="false" class="mark">
      <path d="M2 20C8 20 9 7 14 7s6 13 12 13" class="mark-strip" stroke-width="2.4"
        stroke-linecap="round" />
      <circle cx="14" cy="18" r="4.4" class="mark-obstacle" />
      <circle cx="2.6" cy="20" r="2.2" class="mark-start" />
      <circle cx="25.4" cy="20" r="2.2" class="mark-goal" />
    </svg>
  );
}
