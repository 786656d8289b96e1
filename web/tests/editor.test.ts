import { describe, expect, it } from "vitest";
import { blockAt } from "../src/editor/completion";
import { diagnostics } from "../src/editor/editor";
import { encoded, linear, numberAt, scrubbed } from "../src/editor/numbers";
import { toOffsets } from "../src/editor/offsets";
import type { Finding } from "../src/protocol";

describe("numbers in the text", () => {
  it("are found under the pointer, and not within words", () => {
    const line = "Sphere { center -0.75 1.85 1e-3 vertex0 2 }";
    expect(numberAt(line, line.indexOf("1.85") + 2)?.value).toBe(1.85);
    expect(numberAt(line, line.indexOf("-0.75") + 1)?.value).toBe(-0.75);
    expect(numberAt(line, line.indexOf("1e-3") + 3)?.value).toBe(0.001);
    expect(numberAt(line, line.indexOf("vertex0") + 7)).toBeNull();
    expect(numberAt(line, 3)).toBeNull();
  });

  it("change by steps that fit their size", () => {
    expect(scrubbed("34", 3)).toBe("37");
    expect(scrubbed("0.5", -10)).toBe("0.4");
    expect(scrubbed("1.85", 0)).toBe("1.85");
    expect(Number(scrubbed("0.125", 1))).toBeCloseTo(0.126, 9);
  });

  it("keep a colour through the picker", () => {
    for (const color of ["#000000", "#ffffff", "#c04a2f", "#102030"])
      expect(encoded(linear(color))).toBe(color);
  });
});

describe("places", () => {
  it("in bytes become places in a string", () => {
    const text = "# Dürer 🎨 x";
    const at = toOffsets(text);
    expect(at(new TextEncoder().encode("# Dürer ").length)).toBe("# Dürer ".length);
    expect(at(new TextEncoder().encode("# Dürer 🎨 ").length)).toBe("# Dürer 🎨 ".length);
    expect(at(10_000)).toBe(text.length);
  });

  it("know the block that they are in", () => {
    const text = "Group { Sphere { center 0 0 0 } MaterialIndex 1 Plane { ";
    expect(blockAt(text, text.length)).toBe("Plane");
    expect(blockAt(text, text.indexOf("MaterialIndex"))).toBe("Group");
    expect(blockAt(text, text.indexOf("0 0"))).toBe("Sphere");
    expect(blockAt("Camera", 3)).toBeNull();
  });
});

describe("findings", () => {
  const finding: Finding = {
    severity: "error",
    code: "unknown-word",
    message: "`Sphre` is no word",
    help: "did you mean `Sphere`?",
    effect: null,
    file: null,
    place: { line: 1, column: 9, start: 8, end: 13, block_end: 13 },
    fix: [],
  };

  it("are underlined, and the word that was meant is a click", () => {
    const [shown] = diagnostics([finding], "Group { Sphre { } }");
    expect(shown).toMatchObject({ from: 8, to: 13, severity: "error" });
    expect(shown?.actions?.[0]?.name).toBe("Write Sphere");
  });

  it("never reach beyond a text that has become shorter", () => {
    const [shown] = diagnostics([finding], "Group");
    expect(shown).toMatchObject({ from: 5, to: 5 });
  });
});
