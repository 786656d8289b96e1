import type { CastResult, PixelExplanation, Term } from "../protocol";
import { short } from "../ui/slider";
import { flatten } from "./segments";

/** Pseudocode of the algorithm. */
export const code = [
  "for each pixel (x, y)",
  "    ray ← camera(x, y)",
  "    color ← trace(ray)",
  "trace(ray):",
  "    closest ← ∞",
  "    for each object",
  "        t ← intersect(object, ray)",
  "        if 0 < t < closest: closest ← t",
  "    if closest = ∞: return background",
  "    color ← ambient",
  "    for each light",
  "        if the shadow ray is unoccluded: color += shade(light)",
  "    color += trace(mirrored ray) + trace(transmitted ray)",
  "    return color",
] as const;

/** Step of the algorithm for a pixel, as the step-by-step view shows it. */
export interface Step {
  /** Index of the current line of the pseudocode. */
  line: number;
  /** Description of the step, with its numbers. */
  description: string;
  /** Path in the tree of the term that the step computes. */
  path: string;
  /** Index of the object that is tested. */
  object?: number;
  /** Smallest t so far. */
  closest?: number;
}

/** Returns the steps of a pixel in the order of execution. */
export function steps(pixel: PixelExplanation, casts: Map<string, CastResult>): Step[] {
  const all: Step[] = [
    { line: 0, description: `pixel ${pixel.x}, ${pixel.y}`, path: "0" },
    {
      line: 1,
      description: `a ray through position (${short(pixel.at[0])}, ${short(pixel.at[1])})`,
      path: "0",
    },
  ];
  if (pixel.tree) trace(pixel.tree, "0", casts, all);
  all.push({
    line: 2,
    description: `the pixel has its colour: ${pixel.bytes.join(", ")} in eight bits`,
    path: "0",
  });
  return all;
}

function trace(term: Term, path: string, casts: Map<string, CastResult>, all: Step[]) {
  all.push({ line: 3, description: term.title, path });
  all.push({ line: 4, description: "nothing is hit yet", path, closest: Number.POSITIVE_INFINITY });
  let closest = Number.POSITIVE_INFINITY;
  for (const test of casts.get(path)?.tests ?? []) {
    const hit = (test.verdict === "closest" || test.verdict === "farther") && test.t !== null;
    if (!hit) {
      all.push({ line: 6, description: `${test.name}: ${test.why}`, path, object: test.object, closest });
      continue;
    }
    const t = test.t ?? closest;
    if (t < closest) {
      closest = t;
      all.push({
        line: 7,
        description: `${test.name}: t = ${short(t)} is the closest so far`,
        path,
        object: test.object,
        closest,
      });
    } else {
      const words = `${test.name}: t = ${short(t)} is beyond ${short(closest)}`;
      all.push({ line: 6, description: words, path, object: test.object, closest });
    }
  }
  const children = term.terms.map((child, i) => ({ child, path: `${path}.${i}` }));
  for (const { child, path: at } of children) {
    if (child.segment && child.segment.role !== "lit" && child.segment.role !== "shadowed") continue;
    all.push({ line: lineOf(child), description: describeTerm(child), path: at, closest });
  }
  for (const { child, path: at } of children) {
    for (const inner of flatten(child, at)) {
      const role = inner.term.segment?.role;
      if (!role || role === "lit" || role === "shadowed") continue;
      all.push({ line: 12, description: inner.term.title, path: inner.path, closest });
      trace(inner.term, inner.path, casts, all);
      break;
    }
  }
  all.push({
    line: 13,
    description: `returns ${term.value.map((x) => short(x, 3)).join(", ")}`,
    path,
    closest,
  });
}

function lineOf(term: Term): number {
  if (term.title === "Background") return 8;
  if (term.title === "Ambient light") return 9;
  if (term.segment) return 11;
  return term.terms.length > 0 ? 12 : 10;
}

function describeTerm(term: Term): string {
  if (term.segment?.role === "shadowed") return `${term.title}: contributes nothing`;
  return `${term.title} adds ${term.adds.map((x) => short(x, 3)).join(", ")}`;
}
