import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { differing } from "../src/lecture/figures/epsilon";
import { lesson, settings } from "../src/lecture/lesson";
import { blocks } from "../src/lecture/markdown";
import { topics } from "../src/lecture/topics";

const text = `# Balls
One sentence of **lead**.

More words,
on two lines.

![Sixty](balls.txt "samples=16 show=normals")
![](figure:sphere)

- one
- two, that
  goes on

1. first

\`\`\`
Sphere { }
\`\`\`

? Why is it round?
: Since all its points
  are as far from the middle.

## Second step
![Not closed](
`;

describe("a lesson in Markdown", () => {
  it("is read block by block", () => {
    const kinds = blocks(text).map((block) => block.kind);
    expect(kinds).toEqual([
      "heading",
      "paragraph",
      "paragraph",
      "figure",
      "figure",
      "list",
      "list",
      "code",
      "question",
      "heading",
      "paragraph",
    ]);
    expect(blocks(text)[2]).toEqual({ kind: "paragraph", text: "More words, on two lines." });
    expect(blocks(text)[3]).toEqual({
      kind: "figure",
      label: "Sixty",
      source: "balls.txt",
      options: "samples=16 show=normals",
    });
    expect(blocks(text)[5]).toEqual({ kind: "list", ordered: false, items: ["one", "two, that goes on"] });
    expect(blocks(text)[8]).toEqual({
      kind: "question",
      ask: "Why is it round?",
      answer: "Since all its points are as far from the middle.",
    });
  });

  it("has a step for each heading, and ends for any text", () => {
    const steps = lesson(text);
    expect(steps.map((step) => step.title)).toEqual(["Balls", "Second step"]);
    expect(steps[0]?.questions.length).toBe(1);
    expect(new Set(steps.map((step) => step.id)).size).toBe(2);
    for (const odd of ["", "![", "#", "? ", "- ", "```", "* a", "![a](b", "1.", "**", "\n\n", "# \n##\n"]) {
      expect(lesson(odd).length).toBeGreaterThanOrEqual(0);
    }
  });

  it("gives options by name and value", () => {
    expect(settings("samples=16 show=depth shadows")).toEqual([
      { name: "samples", value: "16" },
      { name: "show", value: "depth" },
      { name: "shadows", value: "true" },
    ]);
  });
});

describe("wrong pixels", () => {
  it("are those that differ visibly", () => {
    const a = Uint8Array.of(10, 10, 10, 255, 0, 0, 0, 255, 9, 9, 9, 0);
    const b = Uint8Array.of(12, 8, 10, 255, 0, 9, 0, 255, 9, 9, 9, 255);
    expect(differing(a, b)).toBe(1);
  });
});

describe("the documentation", () => {
  it("names all figures of the lecture", () => {
    const docs = readFileSync(new URL("../../docs/live.md", import.meta.url), "utf8");
    for (const topic of topics) expect(docs, topic.id).toContain(`\`${topic.id}\``);
  });
});
