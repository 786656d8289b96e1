import { beforeAll, describe, expect, it } from "vitest";
import { linkedFiles, linkOf, openLink } from "../src/viewer/link";

beforeAll(() => {
  Object.assign(globalThis, { location: { href: "https://example.org/play/#/viewer" } });
});

describe("a link", () => {
  it("holds the whole scene", async () => {
    const text = "# Dürer\nSphere { center 0 0 0 radius 1 }\n".repeat(60);
    const link = await linkOf(text);
    expect(link.startsWith("https://example.org/play/#/scene/")).toBe(true);
    expect(link.length).toBeLessThan(300);
    expect(await openLink(new URL(link).hash)).toBe(text);
  });

  it("that is damaged opens nothing", async () => {
    expect(await openLink("#/scene/abc$")).toBeNull();
    expect(await openLink("#/scene/AAAA")).toBeNull();
    expect(await openLink("#/lecture")).toBeNull();
  });

  it("names files, the scene first", () => {
    expect(linkedFiles("#/open/scenes/shelf.txt,scenes/oak%2C%20old.png")).toEqual([
      "scenes/shelf.txt",
      "scenes/oak, old.png",
    ]);
    expect(linkedFiles("#/open/scenes/shelf.txt,")).toBeNull();
    expect(linkedFiles("#/open/%E0%A4%A")).toBeNull();
    expect(linkedFiles("#/scene/abc")).toBeNull();
  });
});
