import { expect, test } from "vitest";
import { droppedFiles, plan } from "../src/viewer/upload";

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
