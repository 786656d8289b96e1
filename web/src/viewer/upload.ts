import type { Store } from "./store";

/** File with its path in the dropped folder. */
export interface Upload {
  path: string;
  file: File;
}

const scenes = /\.(txt|json|gltf|glb|obj|ply|stl|off|pbrt|xml|dae|3mf|rad|oct|usd[acz]?)$/i;

/** Returns the files that were dropped, including those in dropped folders. */
export async function droppedFiles(items: Iterable<DataTransferItem>): Promise<Upload[]> {
  // Entries can only be read before the first `await`.
  const entries = [...items].flatMap((item) => item.webkitGetAsEntry?.() ?? []);
  return (await Promise.all(entries.map((entry) => filesIn(entry, "")))).flat();
}

async function filesIn(entry: FileSystemEntry, folder: string): Promise<Upload[]> {
  const path = folder + entry.name;
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) =>
      (entry as FileSystemFileEntry).file(resolve, reject),
    );
    return [{ path, file }];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const inside: Upload[] = [];
  // A reader returns a limited number of entries at a time.
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) =>
      reader.readEntries(resolve, reject),
    );
    if (some.length === 0) return inside;
    inside.push(...(await Promise.all(some.map((below) => filesIn(below, `${path}/`)))).flat());
  }
}

/** Returns the scene or model among files, the one in the fewest folders, and all files with their names in it. */
export function plan(uploads: Upload[]): { main: Upload | null; others: Upload[] } {
  const depth = ({ path }: Upload) => path.split("/").length;
  const candidates = uploads.filter(({ path }) => scenes.test(path));
  const least = Math.min(...candidates.map(depth));
  const main = candidates.findLast((upload) => depth(upload) === least) ?? null;
  const within = inFolderOf(main?.path ?? "");
  return {
    main: main && within(main),
    others: uploads.filter((upload) => upload !== main).map(within),
  };
}

/** Returns a function that makes the paths of files relative to the folder of a scene. */
function inFolderOf(scene: string) {
  const folder = scene.slice(0, scene.lastIndexOf("/") + 1);
  return ({ path, file }: Upload): Upload => ({
    path: path.startsWith(folder) ? path.slice(folder.length) : path,
    file,
  });
}

/** Uploads files, and opens the scene or model among them. It can refer to the other files. */
export async function uploadFiles(store: Store, uploads: Upload[]) {
  const { main, others } = plan(uploads);
  await give(store, main, others);
}

/** Fetches files by their paths relative to the page, and opens the first. It can refer to the others. */
export async function openFiles(store: Store, paths: string[]) {
  const [first, ...rest] = await Promise.all(paths.map(fetchFile));
  if (!first) return;
  const within = inFolderOf(first.path);
  await give(store, within(first), rest.map(within));
}

async function fetchFile(path: string): Promise<Upload> {
  const url = new URL(path, location.href);
  if (url.origin !== location.origin) throw new Error(`${path}: only files of this site can be opened`);
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${path}: ${response.status} ${response.statusText}`);
  return { path, file: new File([await response.blob()], path) };
}

async function give(store: Store, main: Upload | null, others: Upload[]) {
  for (const { path, file } of others) {
    store.session.send({ kind: "give", name: path, base64: await base64(file), opens: false });
  }
  if (main) {
    store.session.send({ kind: "give", name: main.path, base64: await base64(main.file), opens: true });
  }
}

async function base64(file: File): Promise<string> {
  const url = await new Promise<string>((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(String(reader.result));
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(file);
  });
  return url.slice(url.indexOf(",") + 1);
}
