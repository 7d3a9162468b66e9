// web/src/state/ui.ts: the state of the page that its views show, as it begins.
import { Catalog, RobotItem, ScenarioItem, SessionState } from "../contract";
import { Selection } from "../draw/scene";
import { Camera } from "../draw/view";
import { Tool } from "../edit/gestures";
import { Goal } from "../link/frame";
import { LinkStatus } from "../link/live";
import { ViewName } from "../link/route";
import { StopState } from "../stopper";
import { kept_step } from "./first_steps";
import { stored_hidden, stored_open } from "./layers";
import { Theme, stored_theme, stored_three, stored_tool } from "./remembered";
import { Toast } from "./toasts";

/** A goal for real hardware that is not sent yet; drawn dashed. */
export interface Preview {
  goal: Goal;
  further: boolean;        // appended to the goals that the robot has
  trouble: string | null;  // why the robot may not reach it
}

export interface UiState {
  link: LinkStatus;
  locked: boolean;     // the server asks for its token
  gone: string | null; // why there is no session to show
  session: SessionState | null;
  catalog: Catalog | null;
  scenarios: ScenarioItem[];
  robots: RobotItem[];
  toasts: Toast[];
  spoken: string;     // the sentence that a screen reader reads next
  view: ViewName;
  looking: boolean;   // back, at an earlier instant of the live run
  run: number | null; // opened in the Runs view
  experiment: string | null; // opened in the Experiments view
  compare: readonly number[]; // runs beside the open one
  place: { time: number | null; camera: Camera | null }; // of the address as it was opened
  theme: Theme;
  tool: Tool;
  selection: Selection;
  three: boolean;
  follow: boolean;
  snap: boolean;      // drawings are pulled to corners and to the grid
  appending: boolean; // the goal tool adds goals
  force_scale: number;
  hidden: ReadonlySet<string>; // names of the layers that are switched off
  layers: boolean;             // the layer panel is open
  shortcuts: boolean;
  sheet: boolean;
  tab: string; // of the right panel; "": its first
  loading: string | null;
  stop: StopState;
  preview: Preview | null;
  step: number;         // of the first steps
  views: boolean;       // the menu of a small height is open
  undo: string | null;
  redo: string | null;
}

export function first_ui(): UiState {
  return {
    link: { phase: "connecting", retry_at: 0, rate: 0, latency: null },
    locked: false, gone: null, session: null, catalog: null, scenarios: [], robots: [], toasts: [], spoken: "",
    view: "drive", looking: false, run: null, experiment: null, compare: [], place: { time: null, camera: null },
    theme: stored_theme(), tool: stored_tool(), selection: null, three: stored_three(), follow: false,
    snap: true, appending: false, force_scale: 1, hidden: stored_hidden(), layers: stored_open(), shortcuts: false,
    sheet: false, tab: "", loading: null,
    stop: { phase: "none", since: 0 }, preview: null, step: kept_step(), views: false, undo: null, redo: null,
  };
}
