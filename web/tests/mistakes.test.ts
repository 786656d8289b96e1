import { readdirSync, readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { byTopic, describeChange, matches, reducedSize } from "../src/mistakes/choices";
import type { MistakeChoice } from "../src/protocol";

function mistake(name: string, topic: string, wrong = ""): MistakeChoice {
  return { name, description: `${name} is wrong`, right: "a + b", wrong, topic, values: [0] };
}

describe("mistakes", () => {
  const all = [
    mistake("no-shadows", "shadows", "(nothing)"),
    mistake("mirrored", "rays", "x / 2"),
    mistake("new", "voxels"),
    mistake("shadows-short", "shadows"),
  ];

  it("are grouped in the order of the lecture", () => {
    expect(byTopic(all).map(({ title, mistakes }) => [title, mistakes.map(({ name }) => name)])).toEqual([
      ["Camera and rays", ["mirrored"]],
      ["Shadows", ["no-shadows", "shadows-short"]],
      ["Voxels", ["new"]],
    ]);
  });

  it("are found by words of their description, code and topic", () => {
    const found = (query: string) => all.filter((known) => matches(known, query)).map(({ name }) => name);
    expect(found("")).toHaveLength(4);
    expect(found("Shadows short")).toEqual(["shadows-short"]);
    expect(found("x / 2")).toEqual(["mirrored"]);
    expect(found("camera")).toEqual(["mirrored"]);
    expect(found("camera shadows")).toEqual([]);
  });

  it("tell how much of a picture differs", () => {
    expect([0, 0.0004, 0.0124, 0.5, 1].map(describeChange)).toEqual([
      "No pixel differs in this scene",
      "Less than 0.1 % of the pixels differ",
      "1.2 % of the pixels differ",
      "50 % of the pixels differ",
      "100 % of the pixels differ",
    ]);
  });

  it("are rendered at a reduced size of the same shape", () => {
    expect(reducedSize([1920, 1080], 240)).toEqual([240, 135]);
    expect(reducedSize([100, 200], 240)).toEqual([100, 200]);
    expect(reducedSize([4000, 1], 240)).toEqual([240, 1]);
  });
});

describe("mistakes of the lecture", () => {
  const root = new URL("../../", import.meta.url);
  const read = (folder: string) =>
    readdirSync(new URL(folder, root))
      .map((name) => readFileSync(new URL(`${folder}${name}`, root), "utf8"))
      .join("\n");
  const rows = new Set(
    [...read("crates/durer-teach/src/mistakes/table/").matchAll(/\brow\(\s*"([^"]+)"/g)].map(
      ([, name]) => name,
    ),
  );
  const figures = read("web/src/lecture/figures/");

  it("are rows of the library's table", () => {
    const used = [
      ...figures.matchAll(/useFigureMistake\(\s*\w+,\s*"([^"]+)"/g),
      ...figures.matchAll(/mistake: \["([^"]+)"/g),
      ...figures.matchAll(/const name = parallel \? "([^"]+)"/g),
      ...figures.matchAll(/const name = parallel \? "[^"]+" : "([^"]+)"/g),
    ].map(([, name]) => name);
    expect(used.length).toBeGreaterThan(8);
    for (const name of used) expect(rows.has(name), name).toBe(true);
  });
});
