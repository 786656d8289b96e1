import type { Store } from "./store";

/** File with its path in the dropped folder. */
export interface Upload {
  path: string;
  file: File;
}

const scenes = /\.(txt|json|gltf|glb|obj|ply|stl|pbrt|xml|3mf|rad|oct)$/i;

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
  const folder = main ? main.path.slice(0, main.path.lastIndexOf("/") + 1) : "";
  const within = ({ path, file }: Upload) => ({
    path: path.startsWith(folder) ? path.slice(folder.length) : path,
    file,
  });
  return {
    main: main && within(main),
    others: uploads.filter((upload) => upload !== main).map(within),
  };
}

/** Uploads files, and opens the scene or model among them. It can refer to the other files. */
export async function uploadFiles(store: Store, uploads: Upload[]) {
  const { main, others } = plan(uploads);
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
