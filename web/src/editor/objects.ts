import type { SceneItem } from "../protocol";
import { toOffsets } from "./offsets";

/** Returns the index of the object whose statement contains a position in the text. */
export function objectAt(text: string, objects: SceneItem[], position: number): number | null {
  const at = toOffsets(text);
  let found: { index: number; start: number } | null = null;
  objects.forEach(({ place }, index) => {
    if (!place) return;
    const start = at(place.start);
    const inside = start <= position && !isClosed(text.slice(start, position));
    if (inside && (found === null || start >= found.start)) found = { index, start };
  });
  return (found as { index: number } | null)?.index ?? null;
}

/** Returns true if a text closes the first block that it opens. */
function isClosed(text: string): boolean {
  let depth = 0;
  for (const letter of text) {
    if (letter === "{") depth++;
    else if (letter === "}" && --depth <= 0) return true;
  }
  return false;
}
