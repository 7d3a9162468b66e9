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
  teleop: line(<><circle cx="10" cy="10" r="7" /><circle cx="10" cy="10" r="2.4" /></>),
  drive: line(<path d="M3 15c4 0 4-9 7-9s3 9 7 9" />),
  runs: line(<path d="M4 5h12M4 10h12M4 15h8" />),
  experiments: line(<path d="M4 16v-5M8 16V6M12 16v-8M16 16V4" />),
  system: line(<><rect x="4" y="4" width="12" height="12" rx="2" /><path d="M8 8h4v4H8z" /></>),
  tune: line(<><path d="M4 6h6M14 6h2M4 14h2M10 14h6" /><circle cx="12" cy="6" r="1.8" />
    <circle cx="8" cy="14" r="1.8" /></>),
  menu: line(<path d="M3 5h14M3 10h14M3 15h14" />),
  pan: line(<path d="M10 3v14M3 10h14M8 5l2-2 2 2M8 15l2 2 2-2M5 8l-2 2 2 2M15 8l2 2-2 2" />),
  goal: line(<path d="M6 17V4l9 3-9 4" />),
  cylinder: line(<circle cx="10" cy="10" r="6" />),
  box: line(<rect x="4" y="4" width="12" height="12" />),
  ground: line(<path d="M2 14h3l6-6h7M11 14h1M15 14h3M12 14v3h3v-3" />),
  pose: line(<><circle cx="10" cy="11" r="5" /><path d="M10 11V6M10 2v2M10 18v1M2 11h2M16 11h2" /></>),
  start: line(<><circle cx="10" cy="10" r="6.5" /><path d="M8.5 7.5 13 10l-4.5 2.5z" /></>),
  wall: line(<><path d="M5 15 15 5" /><circle cx="4" cy="16" r="1.6" /><circle cx="16" cy="4" r="1.6" /></>),
  polygon: line(<path d="M10 3l7 5-2.7 8.5H5.7L3 8z" />),
  mover: line(<><circle cx="13.5" cy="6.5" r="2.6" /><path d="M11 9 8.5 12M7 13.5 6 15M4.5 16.5h.1M16 9v2" /></>),
  copy: line(<><rect x="7" y="7" width="9" height="9" rx="1.5" /><path d="M13 7V4.5A1.5 1.5 0 0 0 11.5 3h-7A1.5 1.5 0 0 0 3 4.5v7A1.5 1.5 0 0 0 4.5 13H7" /></>),
  up: line(<path d="m5 12 5-5 5 5" />),
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
  check: line(<path d="m4 11 4 4 8-10" />),
  warning: line(<path d="M10 3 2.5 16.5h15zM10 8v4M10 14.4v.2" />),
  stop: solid(<rect x="5" y="5" width="10" height="10" rx="1" />),
  step: solid(<path d="M5 4l8 6-8 6zM14 4h2v12h-2z" />),
  back_step: solid(<path d="M15 4l-8 6 8 6zM4 4h2v12H4z" />),
  trash: line(<path d="M4 6h12M8 6V4h4v2M6 6l1 11h6l1-11M9 9v5M11 9v5" />),
  down: line(<path d="m5 8 5 5 5-5" />),
  compare: line(<><circle cx="7.5" cy="10" r="4.5" /><circle cx="12.5" cy="10" r="4.5" /></>),
  zoom_in: line(<><circle cx="9" cy="9" r="5.5" /><path d="m13 13 4 4M9 6.5v5M6.5 9h5" /></>),
  zoom_out: line(<><circle cx="9" cy="9" r="5.5" /><path d="m13 13 4 4M6.5 9h5" /></>),
  whole: line(<path d="M3 4v12M17 4v12M6 10h8M8.5 7.5 6 10l2.5 2.5M11.5 7.5 14 10l-2.5 2.5" />),
  live: line(<><circle cx="10" cy="10" r="2" fill="currentColor" /><path d="M6 14a6 6 0 0 1 0-8M14 6a6 6 0 0 1 0 8" /></>),
  background: line(<><path d="M4 5h12v8H4zM8 16h4" /></>),
  batch: line(<path d="M4 7h9v9H4zM7 7V4h9v9h-3" />),
  edit: line(<path d="M4 16l1-4 8-8 3 3-8 8zM11 6l3 3" />),
  note: line(<path d="M5 3h10v14H5zM8 7h4M8 10h4" />),
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
