import type { Motion } from "../protocol";

/** Merges consecutive motions of the same kind. */
export function mergeMotions(motions: Motion[]): Motion[] {
  const all: Motion[] = [];
  for (const motion of motions) {
    const last = all.at(-1);
    if (last?.kind === "dolly" && motion.kind === "dolly") last.factor *= motion.factor;
    else if (
      (last?.kind === "orbit" || last?.kind === "pan" || last?.kind === "turn") &&
      motion.kind === last.kind
    ) {
      last.right += motion.right;
      last.up += motion.up;
    } else all.push({ ...motion });
  }
  return all;
}
