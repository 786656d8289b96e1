import type { CameraState, PixelExplanation, Segment, SegmentKind, Term } from "../protocol";
import type { Vec } from "./space";
import { add, mul } from "./space";

/** Term of a pixel's colour with its path in the tree, such as `0.2.1`. */
export interface TermWithPath {
  path: string;
  term: Term;
}

/** Returns all terms of a tree in depth-first order. */
export function flatten(term: Term | null | undefined, path = "0"): TermWithPath[] {
  if (!term) return [];
  return [{ path, term }, ...term.terms.flatMap((child, i) => flatten(child, `${path}.${i}`))];
}

/** Returns the segments of a tree, each with the path of its term. */
export function segments(pixel: PixelExplanation | null): { path: string; segment: Segment; term: Term }[] {
  return flatten(pixel?.tree).flatMap(({ path, term }) =>
    term.segment ? [{ path, segment: term.segment, term }] : [],
  );
}

/** Returns the term at a path such as `0.2.1` in the tree of a pixel. */
export function termAt(pixel: PixelExplanation | null, path: string): Term | null {
  let term = pixel?.tree ?? null;
  for (const step of path.split(".").slice(1)) term = term?.terms[Number(step)] ?? null;
  return term;
}

/** Names of the kinds of rays, for legends. */
export const roles: Record<SegmentKind, string> = {
  camera: "camera ray",
  reflected: "mirrored ray",
  transmitted: "transmitted ray",
  scattered: "scattered ray",
  lit: "shadow ray, unoccluded",
  shadowed: "shadow ray, occluded",
};

/** Returns the points that the view should contain: hits, the camera, and nearby lights. */
export function points(pixel: PixelExplanation | null, camera: CameraState | null): Vec[] {
  const all: Vec[] = camera ? [camera.eye] : [];
  for (const { segment } of segments(pixel)) {
    all.push(segment.from);
    // Skip distant lights, which would make everything else small.
    if (!segment.escapes && segment.role !== "lit") all.push(segment.to);
  }
  return all;
}

/** Returns the edges of a camera's view pyramid up to a distance. */
export function frustum(camera: CameraState, aspect: number, reach: number): [Vec, Vec][] {
  const [x, y] = aspect >= 1 ? [1, 1 / aspect] : [aspect, 1];
  const corner = (sx: number, sy: number): Vec => {
    const across = add(
      mul(sx * x * camera.half_width, camera.right),
      mul(sy * y * camera.half_width, camera.up),
    );
    return add(camera.eye, mul(reach, add(camera.forward, across)));
  };
  const corners = [corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
  const lines: [Vec, Vec][] = [];
  corners.forEach((c, i) => {
    lines.push([camera.eye, c], [c, corners[(i + 1) % 4] as Vec]);
  });
  return lines;
}
