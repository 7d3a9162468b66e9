// web/src/ui/switch.ts: the style of lines with a switch, which several parts of the page bring along.
import css from "../style/switch.css?text";
import { adopt } from "./sheet";

adopt(css);
