// web/src/ui/swatch.ts: the style of swatches, which several parts of the page bring along.
import css from "../style/swatch.css?text";
import { adopt } from "./sheet";

adopt(css);
