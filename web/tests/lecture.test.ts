import { describe, expect, it } from "vitest";
import { code, steps } from "../src/explain/steps";
import { combined } from "../src/lecture/figures/solids";
import { topics } from "../src/lecture/topics";
import type { CastResult, PixelExplanation, Term, Verdict } from "../src/protocol";
import { fixed, short } from "../src/ui/slider";

describe("solids", () => {
  it("are the Boolean of their parts at every point of the ray", () => {
    const parts: [number, number][] = [
      [-1, 2],
      [0.5, 4],
      [2.5, 3],
      [-3, 5],
    ];
    for (const a of [...parts, null]) {
      for (const b of [...parts, null]) {
        for (const operation of ["Merge", "Intersection", "Difference"] as const) {
          const all = combined(operation, a, b);
          for (let t = -3.9; t < 6; t += 0.2) {
            const [inA, inB] = [a, b].map((i) => i !== null && t > i[0] && t < i[1]);
            const wanted = { Merge: inA || inB, Intersection: inA && inB, Difference: inA && !inB }[
              operation
            ];
            expect(all.some(([start, end]) => t > start && t < end)).toBe(wanted);
          }
        }
      }
    }
  });
});

describe("topics", () => {
  it("have addresses of their own, a figure, words and questions", () => {
    expect(new Set(topics.map((topic) => topic.id)).size).toBe(topics.length);
    for (const topic of topics) {
      expect(topic.text.length, topic.id).toBeGreaterThan(0);
      expect(topic.questions.length, topic.id).toBeGreaterThan(1);
    }
  });
});

describe("numbers", () => {
  it("are short and have a true minus sign", () => {
    expect([short(-0.123456), short(0), short(1e9), short(Number.POSITIVE_INFINITY)]).toEqual([
      "−0.1235",
      "0",
      "1000000000",
      "∞",
    ]);
    expect([fixed(-0.001), fixed(-1.5, 1), fixed(Number.NaN)]).toEqual(["0.00", "−1.5", "–"]);
  });
});

function term(title: string, role: string | null, terms: Term[] = []): Term {
  const segment = role === null ? null : { role, from: [0, 0, 0], to: [0, 0, 1], escapes: false };
  return {
    title,
    rows: [],
    value: [1, 1, 1],
    adds: [1, 1, 1],
    share: 1,
    swatch: [255, 255, 255],
    place: null,
    segment,
    normal: null,
    ray: null,
    t_max: null,
    object: null,
    origins: [],
    terms,
  } as Term;
}

function cast(...tests: [Verdict, number | null][]): CastResult {
  const all = tests.map(([verdict, t], object) => ({
    object,
    name: `thing ${object}`,
    place: null,
    verdict,
    why: "",
    t,
    rows: [],
  }));
  return { origin: [0, 0, 0], direction: [0, 0, 1], tests: all, left_out: 0, hit: null };
}

describe("step by step", () => {
  const tree = term("Camera ray", "camera", [
    term("Ambient light", null),
    term("Lamp", "lit"),
    term("Mirrored and transmitted", null, [term("Mirrored ray", "reflected", [term("Background", null)])]),
  ]);
  const pixel = { x: 1, y: 2, at: [1.5, 2.5], bytes: [1, 2, 3], tree } as unknown as PixelExplanation;
  const casts = new Map([["0", cast(["farther", 5], ["missed", null], ["closest", 2], ["farther", 3])]]);
  const all = steps(pixel, casts);

  it("lets `closest` only shrink while objects are asked", () => {
    const closest = all
      .filter((step) => step.path === "0" && (step.line === 6 || step.line === 7))
      .map((step) => step.closest);
    expect(closest).toEqual([5, 5, 2, 2]);
  });

  it("follows each ray into the next, by lines of the code", () => {
    expect(all.every((step) => code[step.line] !== undefined)).toBe(true);
    expect(all.filter((step) => step.line === 3).map((step) => step.description)).toEqual([
      "Camera ray",
      "Mirrored ray",
    ]);
    expect(all.some((step) => step.line === 8)).toBe(true);
  });
});
