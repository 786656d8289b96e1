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

/** Returns true if a text closes the first block that it opens, and continues on another line. */
function isClosed(text: string): boolean {
  let depth = 0;
  for (let i = 0; i < text.length; i++) {
    if (text[i] === "{") depth++;
    else if (text[i] === "}" && --depth <= 0) return text.includes("\n", i);
  }
  return false;
}
