/** Point or vector in world space. */
export type Vec = [number, number, number];

export const add = (a: Vec, b: Vec): Vec => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a: Vec, b: Vec): Vec => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const mul = (s: number, a: Vec): Vec => [s * a[0], s * a[1], s * a[2]];
export const dot = (a: Vec, b: Vec): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a: Vec, b: Vec): Vec => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
export const length = (a: Vec): number => Math.hypot(...a);
export const unit = (a: Vec): Vec => {
  const l = length(a);
  return l > 0 ? mul(1 / l, a) : a;
};
export const mix = (a: Vec, b: Vec, t: number): Vec => add(a, mul(t, sub(b, a)));

/** Projected point in page pixels, and its depth along the view direction. */
export interface ProjectedPoint {
  x: number;
  y: number;
  depth: number;
}

/** Viewpoint of a 3D drawing, which orbits a target. */
export interface Eye {
  target: Vec;
  distance: number;
  /** Rotation around the vertical axis, in radians. */
  yaw: number;
  /** Elevation above the horizon, in radians. */
  pitch: number;
  /** Field of view across the larger side, in degrees. */
  angle: number;
}

/** Position and axes of an eye in world space. */
export interface Frame {
  eye: Vec;
  forward: Vec;
  right: Vec;
  up: Vec;
  half: number;
}

export function frame({ target, distance, yaw, pitch, angle }: Eye): Frame {
  const back: Vec = [Math.sin(yaw) * Math.cos(pitch), Math.sin(pitch), Math.cos(yaw) * Math.cos(pitch)];
  const forward = mul(-1, back);
  const right = unit(cross(forward, [0, 1, 0]));
  const half = Math.tan((angle * Math.PI) / 360);
  return { eye: add(target, mul(distance, back)), forward, right, up: cross(right, forward), half };
}

const near = 1e-3;

/** Returns functions that project world space to a page of this size, like the library's perspective camera. */
export function projector(view: Frame, width: number, height: number) {
  const larger = Math.max(width, height) / 2;
  const local = (p: Vec): Vec => {
    const d = sub(p, view.eye);
    return [dot(d, view.right), dot(d, view.up), dot(d, view.forward)];
  };
  const page = ([x, y, z]: Vec): ProjectedPoint => ({
    x: width / 2 + (x / (z * view.half)) * larger,
    y: height / 2 - (y / (z * view.half)) * larger,
    depth: z,
  });
  return {
    width,
    /** Projects a point; `null` if it is behind the eye. */
    point(p: Vec): ProjectedPoint | null {
      const at = local(p);
      return at[2] > near ? page(at) : null;
    },
    /** Projects the part of a line that is in front of the eye. */
    line(a: Vec, b: Vec): [ProjectedPoint, ProjectedPoint] | null {
      let [p, q] = [local(a), local(b)];
      if (p[2] <= near && q[2] <= near) return null;
      if (p[2] <= near) p = mix(q, p, (q[2] - 2 * near) / (q[2] - p[2]));
      else if (q[2] <= near) q = mix(p, q, (p[2] - 2 * near) / (p[2] - q[2]));
      return [page(p), page(q)];
    },
    /** Returns the ray through a point of the page. */
    ray(x: number, y: number): { origin: Vec; direction: Vec } {
      const right = ((x - width / 2) / larger) * view.half;
      const up = ((height / 2 - y) / larger) * view.half;
      const direction = unit(add(view.forward, add(mul(right, view.right), mul(up, view.up))));
      return { origin: view.eye, direction };
    },
  };
}

/** Projection of world space to a page; see `projector`. */
export type Projector = ReturnType<typeof projector>;

/** Returns an eye that frames all points. */
export function frameEye(points: Vec[], yaw: number, pitch: number, angle = 34): Eye {
  if (points.length === 0) return { target: [0, 0, 0], distance: 5, yaw, pitch, angle };
  const least: Vec = [0, 1, 2].map((i) => Math.min(...points.map((p) => p[i] ?? 0))) as Vec;
  const most: Vec = [0, 1, 2].map((i) => Math.max(...points.map((p) => p[i] ?? 0))) as Vec;
  const radius = Math.max(1e-3, length(sub(most, least)) / 2);
  const distance = (1.15 * radius) / Math.sin((angle * Math.PI) / 360);
  return { target: mix(least, most, 0.5), distance, yaw, pitch, angle };
}

/** Returns the eye after a drag over the page has orbited it. */
export function orbit(eye: Eye, right: number, up: number): Eye {
  const limit = Math.PI / 2 - 0.02;
  return { ...eye, yaw: eye.yaw - right, pitch: Math.min(limit, Math.max(-limit, eye.pitch + up)) };
}
