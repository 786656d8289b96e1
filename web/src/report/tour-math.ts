import { add, cross, dot, length, mul, sub, unit, type Vec } from "../explain/space";
import type { TourPhotograph } from "./types";

/** Viewpoint in a tour. */
export interface TourEye {
  center: Vec;
  /** Right, down and forward directions. */
  rows: [Vec, Vec, Vec];
  /** Focal length, relative to the longer side of the window. */
  focal: number;
}

/** Point on the page, and its depth. */
export type Projected = [x: number, y: number, depth: number];

/** Corners of a photograph in space. */
export type Corners = [Vec, Vec, Vec, Vec];

/** Returns the median of numbers; 0 if there are none. */
export function median(values: number[]): number {
  return [...values].sort((a, b) => a - b)[values.length >> 1] ?? 0;
}

/** Returns the axes of a viewpoint that looks at a target. */
export function lookFrom(center: Vec, target: Vec): [Vec, Vec, Vec] {
  const forward = unit(sub(target, center));
  const right = unit(cross(forward, [0, 1, 0]));
  return [right, cross(forward, right), forward];
}

/** Returns the viewpoint of a photograph, with which it fits into a window. */
export function eyeOf(
  { center, rotation, focal, size }: TourPhotograph,
  [width, height]: [number, number],
): TourEye {
  const scale = Math.min(width / size[0], height / size[1]);
  return { center, rows: rotation, focal: (scale * focal) / Math.max(width, height) };
}

/** Returns a function that projects points to a window. */
export function tourProjector(eye: TourEye, width: number, height: number): (p: Vec) => Projected {
  const size = eye.focal * Math.max(width, height);
  return (p) => {
    const d = sub(p, eye.center);
    const [x, y, z] = [dot(eye.rows[0], d), dot(eye.rows[1], d), dot(eye.rows[2], d)];
    return [width / 2 + (size * x) / z, height / 2 + (size * y) / z, z];
  };
}

/** Returns the tip and the corners of the pyramid that shows a camera. */
export function pyramid({ center, corners }: TourPhotograph): { tip: Vec; ends: Vec[] } {
  return { tip: center, ends: corners.map((corner) => add(center, mul(0.12, sub(corner, center)))) };
}

/** Returns a view of all photographs in a window: moves away from the middle until all are visible,
 * or to a limit.
 */
export function overview(
  photographs: TourPhotograph[],
  middle: Vec,
  reach: number,
  [width, height]: [number, number],
): TourEye {
  const mean = photographs.reduce<Vec>(
    (sum, p) => add(sum, mul(1 / photographs.length, p.center)),
    [0, 0, 0],
  );
  const from = sub(mean, middle);
  // If the photographs look in all directions, there is no preferred side.
  const toward: Vec = length(from) > 0.2 * reach ? from : [0, 0, reach];
  const focal = 0.9;
  for (let far = 1.3; ; far *= 1.1) {
    const center = add(add(middle, mul(far, toward)), mul(0.35 * far * reach, [0, 1, 0]));
    const rows = lookFrom(center, middle);
    const eye = { center, rows, focal };
    const project = tourProjector(eye, width, height);
    const isShown = (p: Vec) => {
      const [x, y, z] = project(p);
      return z > 0 && Math.abs(x / width - 0.5) < 0.46 && Math.abs(y / height - 0.5) < 0.46;
    };
    const all = photographs.flatMap((photo) => {
      const { tip, ends } = pyramid(photo);
      return [tip, ...ends];
    });
    if (far > 9 || all.every(isShown)) return eye;
  }
}

type Quaternion = [number, number, number, number];

function toQuaternion([a, b, c]: [Vec, Vec, Vec]): Quaternion {
  const traces = [
    1 + a[0] + b[1] + c[2],
    1 + a[0] - b[1] - c[2],
    1 - a[0] + b[1] - c[2],
    1 - a[0] - b[1] + c[2],
  ];
  const largest = Math.max(...traces);
  const [x, y, z] = [c[1] - b[2], a[2] - c[0], b[0] - a[1]];
  const [xy, xz, yz] = [b[0] + a[1], a[2] + c[0], c[1] + b[2]];
  const candidates: Quaternion[] = [
    [largest, x, y, z],
    [x, largest, xy, xz],
    [y, xy, largest, yz],
    [z, xz, yz, largest],
  ];
  const scale = 0.5 / Math.sqrt(largest);
  return (candidates[traces.indexOf(largest)] ?? [1, 0, 0, 0]).map((v) => v * scale) as Quaternion;
}

function toRows([w, x, y, z]: Quaternion): [Vec, Vec, Vec] {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
}

/** Returns a viewpoint on the way from one to another, from 0 to 1. */
export function between(a: TourEye, b: TourEye, t: number): TourEye {
  const p = toQuaternion(a.rows);
  let q = toQuaternion(b.rows);
  if (p.reduce((sum, v, i) => sum + v * (q[i] ?? 0), 0) < 0) q = q.map((v) => -v) as Quaternion;
  const mixed = p.map((v, i) => v + t * ((q[i] ?? 0) - v));
  const n = Math.hypot(...mixed);
  return {
    center: add(a.center, mul(t, sub(b.center, a.center))),
    rows: toRows(mixed.map((v) => v / n) as Quaternion),
    focal: a.focal + t * (b.focal - a.focal),
  };
}

/** Returns the CSS transform that maps a rectangle onto four points of the page (Heckbert, 1989).
 */
export function homography(corners: [number, number][], w: number, h: number): string {
  const [a, b, c, d] = corners as [[number, number], [number, number], [number, number], [number, number]];
  const e = [b[0] - c[0], b[1] - c[1]] as const;
  const f = [d[0] - c[0], d[1] - c[1]] as const;
  const s = [a[0] - b[0] + c[0] - d[0], a[1] - b[1] + c[1] - d[1]] as const;
  const n = e[0] * f[1] - f[0] * e[1];
  const g = (s[0] * f[1] - f[0] * s[1]) / n;
  const k = (e[0] * s[1] - s[0] * e[1]) / n;
  const column = (p: readonly [number, number], weight: number, size: number) => [
    (p[0] - a[0] + weight * p[0]) / size,
    (p[1] - a[1] + weight * p[1]) / size,
    0,
    weight / size,
  ];
  return `matrix3d(${[...column(b, g, w), ...column(d, k, h), 0, 0, 1, 0, a[0], a[1], 0, 1].join()})`;
}

/** Returns the corners of two photographs during the transition between them: on the plane nearest
 * to most of their common points, or else on a plane that faces both views (Photo Tourism, section
 * 5.2).
 */
export function shared(a: TourPhotograph, b: TourPhotograph, points: Vec[]): [Corners, Corners] | null {
  const set = new Set(a.points);
  let near = b.points.flatMap((p) => (set.has(p) ? [points[p] as Vec] : []));
  if (near.length < 8) return null;
  let mean: Vec = [0, 0, 0];
  let normal: Vec = [0.5, 0.6, 0.62];
  for (let round = 0; round < 4; round++) {
    const middle = near.reduce<Vec>((sum, p) => add(sum, mul(1 / near.length, p)), [0, 0, 0]);
    const row = (i: 0 | 1 | 2) =>
      near.reduce<Vec>((sum, p) => add(sum, mul(p[i] - middle[i], sub(p, middle))), [0, 0, 0]);
    const rows = [row(0), row(1), row(2)] as const;
    const trace = rows[0][0] + rows[1][1] + rows[2][2];
    // The eigenvector of the least eigenvalue of C is that of the largest of trace(C) I - C.
    for (let k = 0; k < 80; k++)
      normal = unit(
        sub(mul(trace, normal), [dot(rows[0], normal), dot(rows[1], normal), dot(rows[2], normal)]),
      );
    const across = normal;
    const off = (p: Vec) => Math.abs(dot(sub(p, middle), across));
    near = near.sort((p, q) => off(p) - off(q)).slice(0, Math.max(8, Math.ceil(0.8 * near.length)));
    mean = middle;
  }
  const on = (across: Vec): [Corners, Corners] | null => {
    const lists = [a, b].map(({ center, corners }) =>
      corners.map((corner) => {
        const ray = sub(corner, center);
        const t = dot(sub(mean, center), across) / dot(ray, across);
        return t > 0.2 && t < 5 ? add(center, mul(t, ray)) : null;
      }),
    );
    return lists.flat().every((corner) => corner) ? (lists as [Corners, Corners]) : null;
  };
  return on(normal) ?? on(unit(add(a.rotation[2], b.rotation[2])));
}

/** Score of a photograph as the next one, from its share of common points, its offset in the
 * current camera's axes, the ratio of their distances to the common points, and the current
 * distance.
 */
type Score = (share: number, offset: Vec, nearer: number, far: number) => number;

/** Ways to choose the next photograph. */
export const moves: Record<string, Score> = {
  "more like this": (share) => share,
  "from further left": (share, o, _, far) =>
    o[0] < -0.02 * far ? (share * -o[0]) / (length(o) + 0.05 * far) : 0,
  "from further right": (share, o, _, far) =>
    o[0] > 0.02 * far ? (share * o[0]) / (length(o) + 0.05 * far) : 0,
  closer: (share, _, nearer) => (nearer < 0.97 ? share * (1 - nearer) : 0),
  "farther away": (share, _, nearer) => (nearer > 1.03 ? share * (nearer - 1) : 0),
};

/** Returns the photograph with the largest positive score among those that share points with the
 * current one; -1 if there is none.
 */
export function best(photographs: TourPhotograph[], points: Vec[], current: number, score: Score): number {
  const mine = photographs[current];
  if (!mine) return -1;
  const set = new Set(mine.points);
  let [found, most] = [-1, 0];
  photographs.forEach((photo, i) => {
    const common = photo.points.filter((p) => set.has(p));
    if (i === current || common.length < 5) return;
    const share = common.length / Math.sqrt(mine.points.length * photo.points.length);
    const away = sub(photo.center, mine.center);
    const offset: Vec = [
      dot(mine.rotation[0], away),
      dot(mine.rotation[1], away),
      dot(mine.rotation[2], away),
    ];
    const far = (from: Vec) => median(common.map((p) => length(sub(points[p] as Vec, from))));
    const value = score(share, offset, far(photo.center) / far(mine.center), far(mine.center));
    if (value > most) [found, most] = [i, value];
  });
  return found;
}
