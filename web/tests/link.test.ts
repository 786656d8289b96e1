import { beforeAll, describe, expect, it } from "vitest";
import { linkOf, openLink } from "../src/viewer/link";

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
});
