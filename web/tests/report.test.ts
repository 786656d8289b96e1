import { describe, expect, it } from "vitest";
import { add, cross, dot, length, sub, unit, type Vec } from "../src/explain/space";
import type { CastResult, Term } from "../src/protocol";
import { digits, equationParts, groups, readReport, verdictCounts } from "../src/report/data";
import { ReportedExplanation } from "../src/report/explained";
import {
  best,
  between,
  eyeOf,
  homography,
  lookFrom,
  moves,
  overview,
  pyramid,
  shared,
  tourProjector,
} from "../src/report/tour-math";
import type { ExplainReport, PairReport, TourPhotograph } from "../src/report/types";

describe("the data of a report", () => {
  it("are read, whatever names they contain", () => {
    const name = "</script><!--<b>&\u2028'\"\\";
    const text = JSON.stringify({ kind: "lesson", scene: name, steps: [], pictures: {}, own_scene: null });
    const report = readReport(text.replaceAll("<", "\\u003c"));
    expect(report.kind === "lesson" && report.scene).toBe(name);
  });

  it("are refused if they are something else", () => {
    for (const text of ["null", "3", "{}", '{"kind":"other"}'])
      expect(() => readReport(text)).toThrow("no report");
    expect(() => readReport("")).toThrow();
  });
});

function pair(student: string | null, name: string, verdict: string, mistake: string | null): PairReport {
  return {
    title: `${student}/${name}`,
    name,
    student,
    verdict,
    mistake,
    error: null,
    causes: [],
    note: null,
    comparison: null,
  };
}

describe("a class", () => {
  const pairs = [
    pair("ada", "a", "different", "no shadows"),
    pair("bob", "a", "different", "no shadows"),
    pair("eve", "a", "same", null),
    pair("ada", "b", "different", "no shadows"),
    pair("bob", "b", "different", "no mirrors"),
    pair("eve", "b", "different", "no mirrors"),
    pair("max", "b", "different", "no mirrors"),
    pair(null, "c", "missing", "no shadows"),
  ];

  it("has groups of students with the same mistake in the same picture", () => {
    expect(groups(pairs)).toEqual([
      { name: "b", mistake: "no mirrors", students: ["bob", "eve", "max"] },
      { name: "a", mistake: "no shadows", students: ["ada", "bob"] },
    ]);
  });

  it("has counts of its verdicts", () => {
    expect(verdictCounts(pairs)).toBe("6 different, 1 same, 1 missing");
  });
});

describe("numbers and equations", () => {
  it("show what is missing as a dash", () => {
    expect([digits(1.23456, 2), digits(0, 1), digits(null, 3), digits(undefined, 3)]).toEqual([
      "1.23",
      "0.0",
      "–",
      "–",
    ]);
  });

  it("have subscripts and superscripts", () => {
    expect(equationParts("k_d x^s + a_1")).toEqual([
      { kind: "text", text: "k" },
      { kind: "sub", text: "d" },
      { kind: "text", text: " x" },
      { kind: "sup", text: "s" },
      { kind: "text", text: " + a" },
      { kind: "sub", text: "1" },
    ]);
    expect(equationParts("a ^ b")).toEqual([{ kind: "text", text: "a ^ b" }]);
  });
});

function term(title: string, ray: Term["ray"], terms: Term[] = []): Term {
  return {
    title,
    rows: [],
    value: [1, 1, 1],
    adds: [1, 1, 1],
    share: 1,
    swatch: [255, 255, 255],
    place: null,
    segment: null,
    normal: null,
    ray,
    t_max: null,
    object: null,
    origins: [],
    terms,
  };
}

describe("an explanation in a report", () => {
  const ray: Term["ray"] = [
    [0, 0, 0],
    [0, 0, 1],
  ];
  const sample = (name: string, paths: string[]) => ({
    explanation: { tree: term(name, ray, [term("light", ray), term("ambient", null)]) },
    of: [3, 4],
    casts: paths.map((path) => ({ path, cast: { left_out: path.length } as CastResult })),
  });
  const report = {
    sample: 1,
    samples: [sample("first", []), sample("second", ["0", "0.0"])],
    scene: { outlines: [], lights: [], camera: null },
    size: [4, 2],
  } as unknown as ExplainReport;

  it("begins with the chosen sample, and shows others", async () => {
    const view = new ReportedExplanation(report);
    let changes = 0;
    view.subscribe(() => changes++);
    expect([view.sample, view.pixel?.tree?.title, view.hasTests, view.aspect]).toEqual([
      1,
      "second",
      true,
      2,
    ]);
    view.explain(0, 0, 0);
    expect([view.sample, view.pixel?.tree?.title, view.hasTests]).toEqual([0, "first", false]);
    view.explain(0, 0, 7);
    expect([view.sample, changes]).toEqual([0, 1]);
    expect(await view.castOf("0")).toBeNull();
  });

  it("shows the tests of the selected ray, and keeps them for a term without a ray", () => {
    const view = new ReportedExplanation(report);
    expect(view.cast?.left_out).toBe(1);
    view.choose("0.0");
    expect([view.chosen, view.cast?.left_out]).toEqual(["0.0", 3]);
    view.choose("0.1");
    expect([view.chosen, view.cast?.left_out]).toEqual(["0.1", 3]);
  });
});

/** Returns a photograph of points near the plane z = 0. */
function photograph(center: Vec, points: number[]): TourPhotograph {
  const rotation = lookFrom(center, [0, 0, 0]);
  const depth = length(center);
  const corner = (x: number, y: number): Vec =>
    add(
      center,
      [0, 1, 2].map(
        (i) => depth * ((rotation[2][i] ?? 0) + x * (rotation[0][i] ?? 0) + y * (rotation[1][i] ?? 0)),
      ) as Vec,
    );
  return {
    name: center.join(),
    picture: "",
    size: [400, 300],
    focal: 400,
    center,
    rotation,
    corners: [corner(-0.5, -0.375), corner(0.5, -0.375), corner(0.5, 0.375), corner(-0.5, 0.375)],
    points,
  };
}

describe("a tour", () => {
  const points: Vec[] = Array.from({ length: 60 }, (_, i) => [
    Math.sin(3.1 * i),
    Math.cos(1.7 * i),
    0.02 * Math.sin(5.3 * i),
  ]);
  const all = points.map((_, i) => i);
  const photographs = [-2, -1, 0, 1, 2].map((x) => photograph([x, 0.3, 6 - Math.abs(x)], all));
  const shapes: [number, number][] = [
    [1600, 700],
    [390, 500],
  ];

  it("begins with a view of all cameras, whatever the shape of the window", () => {
    for (const shape of shapes) {
      const project = tourProjector(overview(photographs, [0, 0, 0], 5, shape), ...shape);
      for (const photo of photographs) {
        for (const p of [pyramid(photo).tip, ...pyramid(photo).ends]) {
          const [x, y, depth] = project(p);
          expect(depth).toBeGreaterThan(0);
          expect([x > 0 && x < shape[0], y > 0 && y < shape[1]]).toEqual([true, true]);
        }
      }
    }
  });

  it("fits a photograph into the window", () => {
    const photo = photographs[1] as TourPhotograph;
    for (const [width, height] of shapes) {
      const project = tourProjector(eyeOf(photo, [width, height]), width, height);
      const [a, , c] = photo.corners.map(project);
      const scale = Math.min(width / 400, height / 300);
      expect((c?.[0] ?? 0) - (a?.[0] ?? 0)).toBeCloseTo(400 * scale, 6);
      expect(((c?.[1] ?? 0) + (a?.[1] ?? 0)) / 2).toBeCloseTo(height / 2, 6);
    }
  });

  it("moves from one viewpoint to another, and stays a rotation", () => {
    const [a, b] = [photographs[0], photographs[4]].map((photo) => eyeOf(photo as TourPhotograph, [16, 9]));
    if (!a || !b) throw new Error("two photographs");
    for (const [t, end] of [
      [0, a],
      [1, b],
    ] as const) {
      const eye = between(a, b, t);
      eye.rows.forEach((row, i) => {
        expect(length(sub(row, end.rows[i] ?? [0, 0, 0]))).toBeLessThan(1e-9);
      });
    }
    const [right, down, forward] = between(a, b, 0.4).rows;
    expect(length(sub(cross(right, down), forward))).toBeLessThan(1e-9);
  });

  it("shows two photographs on one plane during the way between them", () => {
    const both = shared(photographs[1] as TourPhotograph, photographs[3] as TourPhotograph, points);
    if (!both) throw new Error("no plane");
    const [[p, q, , s]] = both;
    const across = unit(cross(sub(q, p), sub(s, p)));
    for (const corner of both.flat()) expect(Math.abs(dot(sub(corner, p), across))).toBeLessThan(1e-6);
    expect(Math.abs(across[2])).toBeGreaterThan(0.99);
    expect(shared(photographs[0] as TourPhotograph, photograph([0, 0, 4], [1, 2]), points)).toBeNull();
  });

  it("maps the corners of a picture onto four points of the page", () => {
    const corners: [number, number][] = [
      [10, 20],
      [210, 5],
      [190, 160],
      [30, 120],
    ];
    const numbers = (/\((.*)\)/.exec(homography(corners, 40, 30))?.[1] ?? "").split(",").map(Number);
    const at = (x: number, y: number) => {
      const row = (i: number) => (numbers[i] ?? 0) * x + (numbers[4 + i] ?? 0) * y + (numbers[12 + i] ?? 0);
      return [row(0) / row(3), row(1) / row(3)];
    };
    [at(0, 0), at(40, 0), at(40, 30), at(0, 30)].forEach((found, i) => {
      expect(
        Math.hypot((found[0] ?? 0) - (corners[i]?.[0] ?? 0), (found[1] ?? 0) - (corners[i]?.[1] ?? 0)),
      ).toBeLessThan(1e-6);
    });
  });

  it("chooses the next photograph by its side and its distance", () => {
    const next = (name: string) => best(photographs, points, 2, moves[name] ?? (() => 0));
    expect(photographs[next("from further left")]?.center[0]).toBeLessThan(0);
    expect(photographs[next("from further right")]?.center[0]).toBeGreaterThan(0);
    expect([0, 4]).toContain(next("closer"));
    expect(next("farther away")).toBe(-1);
    expect(best(photographs, points, -1, () => 1)).toBe(-1);
  });
});
