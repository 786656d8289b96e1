import { useRef, useState } from "preact/hooks";
import { gallery } from "./gallery";
import { linkOf } from "./link";
import { type Store, useStore } from "./store";
import { uploadFiles } from "./upload";

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
        onChange={(event) => {
          const files = [...(event.currentTarget.files ?? [])];
          uploadFiles(
            store,
            files.map((file) => ({ path: file.name, file })),
          );
        }}
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
