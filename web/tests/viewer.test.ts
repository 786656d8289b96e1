import { describe, expect, it } from "vitest";
import { edges, lines } from "../src/explain/edges";
import { describeRow } from "../src/explain/scan";
import { hex, linear } from "../src/viewer/color";
import { formatValues } from "../src/viewer/pixel-numbers";
import { crc, zip } from "../src/viewer/zip";
import { clampZoom, cropForZoom, partOf, whole, zoomBy } from "../src/viewer/zoom";

describe("a zoom", () => {
  it("keeps the point below the pointer, and never leaves the picture", () => {
    const at = { x: 0.3, y: 0.6 };
    const once = zoomBy(whole, 4, at, 100);
    expect(once.magnification).toBe(4);
    // The point below the pointer keeps its position in the frame.
    expect((at.x - once.x) * once.magnification).toBeCloseTo(at.x - 0.5, 12);
    expect((at.y - once.y) * once.magnification).toBeCloseTo(at.y - 0.5, 12);
    expect(zoomBy(once, 0.01, { x: 0, y: 0 }, 100)).toEqual(whole);
    expect(zoomBy(whole, 1000, at, 32).magnification).toBe(32);
    expect(clampZoom({ x: -3, y: 9, magnification: 4 }, 100)).toEqual({
      x: 0.125,
      y: 0.875,
      magnification: 4,
    });
  });

  it("renders what is seen, and all of it until much less is seen", () => {
    expect(cropForZoom(whole, 640, 480)).toBeNull();
    expect(cropForZoom({ x: 0.5, y: 0.5, magnification: 4 }, 640, 480)).toEqual([240, 180, 160, 120]);
    expect(partOf({ x: 0.998, y: 0.002, magnification: 64 }, 100, 50)).toEqual([99, 0, 1, 1]);
    expect(partOf(whole, 1, 1)).toEqual([0, 0, 1, 1]);
  });
});

describe("numbers of pixels", () => {
  it("are one where all three are the same", () => {
    expect(formatValues([0.5, 0.25, 1])).toEqual(["0.5", "0.25", "1"]);
    expect(formatValues([4.2567, 4.2567, 4.2567])).toEqual(["4.26"]);
    expect(formatValues([null, null, null])).toEqual(["∞"]);
  });
});

describe("boxes", () => {
  it("have twelve edges between corners that differ along one axis", () => {
    expect(edges.length).toBe(12);
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [i & 1, (i >> 1) & 1, i >> 2]);
    for (const [a, b] of lines([{ level: 0, corners }])) {
      expect(a.reduce((sum, x, i) => sum + Math.abs(x - (b[i] ?? 0)), 0)).toBe(1);
    }
  });
});

describe("colours of materials", () => {
  it("go to eight bits and back", () => {
    for (const color of ["#000000", "#ffffff", "#b3661f", "#01027f"]) expect(hex(linear(color))).toBe(color);
    expect(hex([2, -1, 0.5])).toBe("#ff00bc");
  });
});

describe("an archive", () => {
  it("has the checksum of the standard and all names and bytes", () => {
    expect(crc(new TextEncoder().encode("123456789"))).toBe(0xcbf43926);
    const files = [
      { name: "scene.txt", bytes: new TextEncoder().encode("Group { }") },
      { name: "scene/mesh.ply", bytes: Uint8Array.of(1, 2, 3) },
    ];
    const bytes = zip(files);
    const view = new DataView(bytes.buffer);
    const end = bytes.length - 22;
    expect(view.getUint32(end, true)).toBe(0x06054b50);
    expect(view.getUint16(end + 10, true)).toBe(2);
    const directory = view.getUint32(end + 16, true);
    expect(view.getUint32(directory, true)).toBe(0x02014b50);
    expect(directory + view.getUint32(end + 12, true)).toBe(end);
    // The second file begins behind the first.
    const second = directory + 46 + "scene.txt".length;
    const at = view.getUint32(second + 42, true);
    expect(view.getUint32(at, true)).toBe(0x04034b50);
    expect([...bytes.subarray(at + 30 + "scene/mesh.ply".length, directory)]).toEqual([1, 2, 3]);
  });
});

describe("a row of the picture", () => {
  it("counts its rays and hits", () => {
    const hit = { origin: [0, 0, 0], direction: [0, 0, -1], t: 2, object: 0 } as const;
    const rays = [null, { ...hit, t: null, object: null }, hit, hit] as never;
    expect(describeRow(7, rays)).toBe("row 7: 3 rays, 2 hit something, 1 the background");
  });
});
