import { describe, expect, it } from "vitest";
import { frame, frameEye, length, orbit, projector, sub, type Vec } from "../src/explain/space";
import { mergeMotions } from "../src/viewer/motion";

describe("an eye", () => {
  const eye = { target: [0.3, -0.2, 1] as Vec, distance: 6, yaw: 0.7, pitch: 0.4, angle: 40 };
  const view = projector(frame(eye), 800, 450);

  it("sees its target in the middle", () => {
    const seen = view.point(eye.target);
    expect(seen?.x).toBeCloseTo(400, 9);
    expect(seen?.y).toBeCloseTo(225, 9);
    expect(seen?.depth).toBeCloseTo(6, 9);
  });

  it("sends a ray back through the point that it sees", () => {
    const point: Vec = [1.1, 0.4, -0.7];
    const seen = view.point(point);
    const { origin, direction } = view.ray(seen?.x ?? 0, seen?.y ?? 0);
    const way = sub(point, origin);
    way.forEach((x, i) => {
      expect(x / length(way)).toBeCloseTo(direction[i] ?? 0, 9);
    });
  });

  it("shows no more of a line than what is before it", () => {
    const { eye: at, forward } = frame(eye);
    const behind: Vec = [at[0] - forward[0], at[1] - forward[1], at[2] - forward[2]];
    expect(view.point(behind)).toBeNull();
    const seen = view.line(behind, eye.target);
    expect(seen?.[0].depth).toBeGreaterThan(0);
    expect(seen?.[1].depth).toBeCloseTo(6, 9);
  });

  it("keeps its distance when it goes around, and never tips over", () => {
    let turned = eye;
    for (let i = 0; i < 100; i++) turned = orbit(turned, 0.3, 0.2);
    expect(turned.pitch).toBeLessThan(Math.PI / 2);
    expect(length(sub(frame(turned).eye, turned.target))).toBeCloseTo(6, 9);
  });

  it("is placed so that all points are seen", () => {
    const points: Vec[] = [
      [-3, 0, 0],
      [4, 1, -2],
      [0, 5, 2],
    ];
    const around = projector(frame(frameEye(points, 0.5, 0.3)), 600, 600);
    for (const point of points) {
      const seen = around.point(point);
      expect(seen && seen.x > 0 && seen.x < 600 && seen.y > 0 && seen.y < 600).toBe(true);
    }
  });
});

describe("motions", () => {
  it("of one kind are joined, in order", () => {
    const all = mergeMotions([
      { kind: "orbit", right: 1, up: 2 },
      { kind: "orbit", right: 0.5, up: -1 },
      { kind: "dolly", factor: 2 },
      { kind: "dolly", factor: 0.25 },
      { kind: "orbit", right: 1, up: 0 },
    ]);
    expect(all).toEqual([
      { kind: "orbit", right: 1.5, up: 1 },
      { kind: "dolly", factor: 0.5 },
      { kind: "orbit", right: 1, up: 0 },
    ]);
  });
});
