import type { SceneItem } from "../protocol";
import { toOffsets } from "./offsets";

/** Returns the index of the object whose statement contains a position in the text. */
export function objectAt(text: string, objects: SceneItem[], position: number): number | null {
  const at = toOffsets(text);
  let found: number | null = null;
  let innermost = -1;
  objects.forEach(({ place }, index) => {
    if (!place) return;
    const start = at(place.start);
    const isInside = start <= position && position <= at(place.block_end);
    // Nested objects start later than those around them.
    if (isInside && start >= innermost) [found, innermost] = [index, start];
  });
  return found;
}
