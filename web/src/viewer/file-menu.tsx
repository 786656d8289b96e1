import { useRef, useState } from "preact/hooks";
import { gallery } from "./gallery";
import { linkOf } from "./link";
import { type Store, useStore } from "./store";

/** Controls that open, save and share scenes. */
export function FileMenu({ store }: { store: Store }) {
  useStore(store);
  const input = useRef<HTMLInputElement>(null);
  const [copied, setCopied] = useState(false);
  const copy = async () => {
    await navigator.clipboard.writeText(await linkOf(store.text));
    setCopied(true);
    setTimeout(() => setCopied(false), 1800);
  };
  return (
    <>
      <input
        ref={input}
        type="file"
        multiple
        hidden
        onChange={(event) => uploadFiles(store, [...(event.currentTarget.files ?? [])])}
      />
      <select
        class="button"
        aria-label="Examples"
        value=""
        onChange={(event) => {
          const scene = gallery.find(({ name }) => name === event.currentTarget.value);
          if (scene) store.open(scene.name, scene.text);
          event.currentTarget.value = "";
        }}
      >
        <option value="">Examples</option>
        {gallery.map(({ name }) => (
          <option key={name} value={name}>
            {name.replace(".txt", "").replaceAll("-", " ")}
          </option>
        ))}
      </select>
      <button type="button" class="button" onClick={() => input.current?.click()}>
        Open
      </button>
      {store.opened?.saves && (
        <button type="button" class="button" disabled={!store.edited} onClick={() => store.save(false)}>
          Save
        </button>
      )}
      {store.opened?.text != null && (
        <button type="button" class="button link" onClick={copy}>
          {copied ? "Link copied" : "Copy link"}
        </button>
      )}
    </>
  );
}

const scenes = /\.(txt|json|gltf|glb|obj|ply|stl|pbrt|xml|3mf|rad|oct)$/i;

/** Uploads files, and opens the last scene or model among them. It can refer to the other files. */
export async function uploadFiles(store: Store, files: File[]) {
  const main = files.findLast((file) => scenes.test(file.name));
  for (const file of files.filter((file) => file !== main)) {
    store.session.send({ kind: "give", name: file.name, base64: await base64(file), opens: false });
  }
  if (main) store.session.send({ kind: "give", name: main.name, base64: await base64(main), opens: true });
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
