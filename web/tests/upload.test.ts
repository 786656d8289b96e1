import { afterEach, expect, test, vi } from "vitest";
import type { Store } from "../src/viewer/store";
import { droppedFiles, openFiles, plan } from "../src/viewer/upload";

const file = (name: string) => ({
  isFile: true,
  name,
  file: (done: (file: File) => void) => done(new File([], name)),
});
function folder(name: string, ...inside: object[]) {
  const createReader = () => {
    let left = inside;
    return {
      readEntries(done: (some: object[]) => void) {
        done(left.slice(0, 1));
        left = left.slice(1);
      },
    };
  };
  return { isFile: false, name, createReader };
}
const items = (...entries: object[]) =>
  entries.map((entry) => ({ webkitGetAsEntry: () => entry })) as unknown as DataTransferItem[];

test("a dropped folder is read with its inner folders, and names are relative to the scene", async () => {
  const dropped = folder(
    "lamp",
    folder("maps", file("wood.png"), file("brass.png")),
    file("lamp.gltf"),
    file("lamp.bin"),
  );
  const uploads = await droppedFiles(items(dropped));
  expect(uploads.map(({ path }) => path)).toEqual([
    "lamp/maps/wood.png",
    "lamp/maps/brass.png",
    "lamp/lamp.gltf",
    "lamp/lamp.bin",
  ]);
  const { main, others } = plan(uploads);
  expect(main?.path).toBe("lamp.gltf");
  expect(others.map(({ path }) => path)).toEqual(["maps/wood.png", "maps/brass.png", "lamp.bin"]);
});

test("of several scenes, the last one in the fewest folders is opened", async () => {
  const uploads = await droppedFiles(items(file("a.txt"), file("b.obj"), folder("parts", file("c.ply"))));
  expect(plan(uploads).main?.path).toBe("b.obj");
  expect(plan([]).main).toBe(null);
});

afterEach(() => vi.unstubAllGlobals());

/** Records what is given to the session, as name, contents and whether it is opened. */
function recorder() {
  const given: [string, string, boolean][] = [];
  const send = (request: { name: string; base64: string; opens: boolean }) =>
    given.push([request.name, request.base64, request.opens]);
  return { given, store: { session: { send } } as unknown as Store };
}

test("the first file of a link is opened, and the others have names in its folder", async () => {
  vi.stubGlobal("location", new URL("https://example.org/play/#/open/x"));
  vi.stubGlobal("fetch", async (url: URL) => new Response(url.pathname));
  vi.stubGlobal(
    "FileReader",
    class {
      result = "";
      onload = () => {};
      async readAsDataURL(file: File) {
        this.result = `data:,${await file.text()}`;
        this.onload();
      }
    },
  );
  const { given, store } = recorder();
  await openFiles(store, ["scenes/shelf.txt", "scenes/maps/oak.png", "other.ply"]);
  expect(given).toEqual([
    ["maps/oak.png", "/play/scenes/maps/oak.png", false],
    ["other.ply", "/play/other.ply", false],
    ["shelf.txt", "/play/scenes/shelf.txt", true],
  ]);
});

test("a link to another site or to a missing file opens nothing", async () => {
  vi.stubGlobal("location", new URL("https://example.org/play/"));
  vi.stubGlobal("fetch", async () => new Response("", { status: 404, statusText: "Not Found" }));
  const { given, store } = recorder();
  await expect(openFiles(store, ["https://example.com/a.txt"])).rejects.toThrow("only files of this site");
  await expect(openFiles(store, ["//example.com/a.txt"])).rejects.toThrow("only files of this site");
  await expect(openFiles(store, ["a.txt", "b.ply"])).rejects.toThrow("a.txt: 404 Not Found");
  expect(given).toEqual([]);
});
