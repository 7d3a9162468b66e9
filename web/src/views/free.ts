// web/src/views/free.ts: the part of the scene that no tool and no card covers.
import { App } from "../app";
import { Insets } from "../draw/view";
import { robot_pose } from "../state/scene";

const kGap = 10;        // [px] at least about the fitted world
const kScaleBar = 42;   // [px] below it
const kLow = 220;       // [px] a lower scene gives the world the room beside the scale bar
const kValuesRoom = 64; // [px] kept for the value box, so that the picture rests when it opens
const kCardsRoom = 128; // [px] kept for a sentence that grows, and the notes beside it
const kEdge = 8;        // [px] nearer to a border a robot counts as out of sight
const kOver = ".tools, .values, .layers, .explain, .preview, .notes > *, .badge";

interface Cover { of: Element; box: DOMRect }

/** What lies over the scene. On a small screen most of it lies beside. */
function covers(scene: HTMLElement): Cover[] {
  const { left, top, right, bottom } = scene.getBoundingClientRect();
  return [...document.querySelectorAll(kOver)].map((of) => ({ of, box: of.getBoundingClientRect() })).filter(({ box }) =>
    box.width > 0 && box.left < right && box.right > left && box.top < bottom && box.bottom > top);
}

/** The margins beside which the fitted world lies. */
export function free_insets(scene: HTMLElement): Insets {
  const { left, top, right, bottom } = scene.getBoundingClientRect();
  const insets = { left: kGap, top: kGap, right: kGap, bottom: bottom - top < kLow ? kGap : kScaleBar };
  for (const { of, box } of covers(scene)) {
    if (of.matches(".tools")) insets.left = Math.max(insets.left, box.right - left + kGap);
    else if (of.matches(".layers")) insets.right = Math.max(insets.right, right - box.left + kGap);
    else if (of.matches(".values, .badge")) insets.top = Math.max(insets.top, box.bottom - top + kGap);
    else {
      insets.top = Math.max(insets.top, kValuesRoom + kGap);
      insets.bottom = Math.max(insets.bottom, kCardsRoom, bottom - box.top + kGap);
    }
  }
  return insets;
}

/** Whether the robot or its goal is out of sight. */
export function is_lost(app: App, scene: HTMLElement): boolean {
  const { left, top } = scene.getBoundingClientRect();
  const over = covers(scene);
  return [robot_pose(app.scene), app.editor.shown_goal].some((place) => {
    if (!place) return false;
    const { x, y } = app.view.to_screen(place);
    const outside = x < kEdge || y < kEdge || x > app.view.width - kEdge || y > app.view.height - kEdge;
    return outside || over.some(({ box }) =>
      x + left > box.left && x + left < box.right && y + top > box.top && y + top < box.bottom);
  });
}
