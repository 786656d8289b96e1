import { expect, test } from "vitest";
import { objectAt } from "../src/editor/objects";

const text =
  "# é\nGroup {\n  Sphere { center 0 0 0 radius 1 }\n  Transform { Scale 2 2 2\n    Box { min 0 0 0 max 1 1 1 } }\n}\n";
const bytes = (word: string) => new TextEncoder().encode(text.slice(0, text.indexOf(word))).length;
const objects = ["Sphere", "Box"].map((name) => {
  const start = bytes(name);
  return { name, place: { line: 1, column: 1, start, end: start + name.length } };
});

test("the object at the cursor is the one whose block contains it", () => {
  expect(objectAt(text, objects, text.indexOf("radius"))).toBe(0);
  expect(objectAt(text, objects, text.indexOf("max"))).toBe(1);
  expect(objectAt(text, objects, text.indexOf("Box"))).toBe(1);
  expect(objectAt(text, objects, text.indexOf("1 }") + 3)).toBe(0);
});

test("outside of all objects there is none", () => {
  expect(objectAt(text, objects, 2)).toBe(null);
  expect(objectAt(text, objects, text.indexOf("Transform"))).toBe(null);
  expect(objectAt(text, objects, text.length)).toBe(null);
});
