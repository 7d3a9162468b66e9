// web/src/ui/run_sheet.ts: the style of lists of runs, which Runs and Experiments bring along.
import css from "../style/runs.css?text";
import { adopt } from "./sheet";

adopt(css);
