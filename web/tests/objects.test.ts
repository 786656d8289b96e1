import { expect, test } from "vitest";
import { objectAt } from "../src/editor/objects";

const text =
  "# é\nGroup {\n  Sphere { center 0 0 0 radius 1 }\n  Transform { Scale 2 2 2\n    Box { min 0 0 0 max 1 1 1 } }\n}\n";
const bytes = (length: number) => new TextEncoder().encode(text.slice(0, length)).length;
const objects = ["Sphere", "Box"].map((name) => {
  const from = text.indexOf(name);
  const start = bytes(from);
  const block_end = bytes(text.indexOf("}", from) + 1);
  return { name, place: { line: 1, column: 1, start, end: start + name.length, block_end } };
});

test("the object at the cursor is the one whose block contains it", () => {
  expect(objectAt(text, objects, text.indexOf("radius"))).toBe(0);
  expect(objectAt(text, objects, text.indexOf("max"))).toBe(1);
  expect(objectAt(text, objects, text.indexOf("Box"))).toBe(1);
  // The position behind the closing brace belongs to the object.
  expect(objectAt(text, objects, text.indexOf("1 }") + 3)).toBe(0);
});

test("outside of all objects there is none", () => {
  expect(objectAt(text, objects, 2)).toBe(null);
  expect(objectAt(text, objects, text.indexOf("Transform"))).toBe(null);
  expect(objectAt(text, objects, text.indexOf("1 1 1 }") + 8)).toBe(null);
  expect(objectAt(text, objects, text.length)).toBe(null);
});

test("of nested objects, the innermost one is found", () => {
  const nested = "Union { Sphere { radius 1 } Box { max 1 1 1 } }";
  const item = (name: string, block_end: number) => {
    const start = nested.indexOf(name);
    return { name, place: { line: 1, column: 1, start, end: start + name.length, block_end } };
  };
  const all = [item("Union", nested.length), item("Sphere", nested.indexOf("}") + 1)];
  expect(objectAt(nested, all, nested.indexOf("radius"))).toBe(1);
  expect(objectAt(nested, all, nested.indexOf("max"))).toBe(0);
});
