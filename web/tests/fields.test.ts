import { describe, expect, it } from "vitest";
import type { FieldState, SceneNode } from "../src/protocol";
import { dragStep, fitted, hasSlider, isColor, isEditable, rangeOf } from "../src/viewer/field-range";
import { pathsTo } from "../src/viewer/nodes";

function field(parts: Partial<FieldState>): FieldState {
  return {
    name: "size",
    doc: "",
    values: [1],
    text: "",
    least: null,
    most: null,
    above_least: false,
    below_most: false,
    whole: false,
    choices: [],
    ...parts,
  };
}

describe("the range of a field", () => {
  it("contains the bounds only if they are values", () => {
    expect(rangeOf(field({ least: 0, most: 1 }))).toEqual({ min: 0, max: 1, step: 0.001 });
    const angle = field({ values: [34], least: 0, most: 180, above_least: true, below_most: true });
    expect(rangeOf(angle)).toEqual({ min: 0.5, max: 179.5, step: 0.1 });
    const dome = field({ values: [180], least: 0, most: 360, above_least: true });
    expect(rangeOf(dome)).toEqual({ min: 0.5, max: 360, step: 0.1 });
  });

  it("is infinite without a bound, and its inset follows the value", () => {
    expect(rangeOf(field({}))).toMatchObject({ min: -Infinity, max: Infinity });
    expect(rangeOf(field({ values: [2], least: 0, above_least: true })).min).toBeCloseTo(0.005);
    expect(rangeOf(field({ values: [2e-4], least: 0, above_least: true })).min).toBeCloseTo(5e-7);
  });

  it("steps by 1 for whole numbers", () => {
    const count = field({ values: [8], least: 1, most: 64, whole: true });
    expect(rangeOf(count)).toEqual({ min: 1, max: 64, step: 1 });
    expect([fitted(count, 7.6), fitted(count, 0.2), fitted(count, 99)]).toEqual([8, 1, 64]);
    expect(fitted(field({}), 7.6)).toBe(7.6);
    // Two steps of an arrow key.
    expect(2 * dragStep(count)).toBe(1);
  });
});

describe("the control of a field", () => {
  it("is a slider only for one number in a range that is not too wide", () => {
    expect(hasSlider(field({ least: 0, most: 1 }))).toBe(true);
    expect(hasSlider(field({ least: 0 }))).toBe(false);
    expect(hasSlider(field({ values: [0, 0, 1], least: 0, most: 1 }))).toBe(false);
    expect(hasSlider(field({ least: 0, most: 64, whole: true }))).toBe(true);
    expect(hasSlider(field({ least: 0, most: 4294967295, whole: true }))).toBe(false);
  });

  it("is for colours, words and numbers, but not for files", () => {
    expect(isColor(field({ name: "diffuseColor", values: [1, 0, 0] }))).toBe(true);
    expect(isColor(field({ name: "direction", values: [1, 0, 0] }))).toBe(false);
    expect(isEditable(field({ values: [], text: "sky.exr" }))).toBe(false);
    expect(isEditable(field({ values: [], text: "cross", choices: ["cross", "parallel"] }))).toBe(true);
  });
});

describe("the tree of a model", () => {
  const node = (object: number | null, nodes: SceneNode[] = []): SceneNode => ({
    name: "node",
    place: null,
    object,
    material: null,
    nodes,
  });
  const nodes = [node(0), node(null, [node(1), node(null, [node(2), node(3)])])];

  it("is opened down to an object", () => {
    expect(pathsTo(nodes, 0)).toEqual(["0"]);
    expect(pathsTo(nodes, 3)).toEqual(["1", "1.1", "1.1.1"]);
    expect(pathsTo(nodes, 4)).toEqual([]);
  });
});
