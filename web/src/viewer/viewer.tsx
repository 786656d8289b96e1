import { useEffect, useState } from "preact/hooks";
import { Editor } from "../editor/editor";
import { Findings } from "../editor/findings";
import { Explain } from "../explain/panel";
import { uploadFiles } from "./file-menu";
import { Model } from "./model";
import { Picture } from "./picture";
import { Settings } from "./settings";
import { Status } from "./status";
import { type Store, useStore } from "./store";

type Side = "explain" | "settings";

/** The viewer: panes with the scene's text, its image, and the explanation of a pixel. */
export function Viewer({ store }: { store: Store }) {
  useStore(store);
  const [side, setSide] = useState<Side>("explain");
  const [pane, setPane] = useState<"text" | "why">("why");

  useEffect(() => {
    const over = (event: DragEvent) => event.preventDefault();
    const drop = (event: DragEvent) => {
      event.preventDefault();
      uploadFiles(store, [...(event.dataTransfer?.files ?? [])]);
    };
    window.addEventListener("dragover", over);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragover", over);
      window.removeEventListener("drop", drop);
    };
  }, [store]);

  useEffect(() => {
    store.session.send({ kind: "pause", pause: false });
    return () => store.session.send({ kind: "pause", pause: true });
  }, [store]);

  useEffect(() => {
    if (store.pixel) setSide("explain");
  }, [store.pixel]);

  return (
    <main class="viewer" data-pane={pane}>
      <section class="pane text" aria-label="Scene">
        <DiskNotice store={store} />
        {store.opened?.text === null ? (
          <Model store={store} />
        ) : (
          <div class="scrolls">
            <Editor store={store} />
          </div>
        )}
        <Findings store={store} />
      </section>
      <section class="pane view" aria-label="Image">
        <div class="pane-head">
          <PictureTabs store={store} />
        </div>
        <Picture store={store} />
        <Status store={store} />
      </section>
      <div class="switcher tabs" role="tablist" aria-label="Panes">
        <PaneTab name="Explain" on={pane === "why"} choose={() => setPane("why")} />
        <PaneTab name="Scene" on={pane === "text"} choose={() => setPane("text")} />
      </div>
      <section class="pane why" aria-label="Explanation and settings">
        <div class="pane-head tabs" role="tablist" aria-label="Panel">
          <PaneTab name="Explain" on={side === "explain"} choose={() => setSide("explain")} />
          <PaneTab name="Camera and render" on={side === "settings"} choose={() => setSide("settings")} />
        </div>
        {side === "explain" ? (
          <div class="scrolls">
            <Explain store={store} />
          </div>
        ) : (
          <Settings store={store} />
        )}
      </section>
    </main>
  );
}

function PaneTab({ name, on, choose }: { name: string; on: boolean; choose(): void }) {
  return (
    <button type="button" role="tab" class="tab" aria-selected={on} onClick={choose}>
      {name}
    </button>
  );
}

const names: Record<string, string> = {
  color: "Colour",
  depth: "Distance",
  normals: "Normals",
  "geometric-normals": "Geometric normals",
  uv: "u, v",
};

function PictureTabs({ store }: { store: Store }) {
  return (
    <div class="tabs" role="tablist" aria-label="Pictures">
      {store.opened?.pictures.map(({ name, doc }) => (
        <button
          key={name}
          type="button"
          role="tab"
          class="tab"
          title={doc}
          aria-selected={store.picture === name}
          onClick={() => store.show(name)}
        >
          {names[name] ?? name.replace("-", " ").replace(/^./, (letter) => letter.toUpperCase())}
        </button>
      ))}
    </div>
  );
}

function DiskNotice({ store }: { store: Store }) {
  if (store.diskText !== null) {
    const text = store.diskText;
    return (
      <div class="notice" role="alert">
        The file changed on disk.
        <button type="button" class="button" onClick={() => store.takeDisk(text)}>
          Reload
        </button>
        <button type="button" class="button plain" onClick={() => store.keepEdits()}>
          Keep this text
        </button>
      </div>
    );
  }
  if (!store.conflict) return null;
  return (
    <div class="notice" role="alert">
      Another program changed the file since it was read.
      <button type="button" class="button" onClick={() => store.save(true)}>
        Overwrite
      </button>
      <button type="button" class="button plain" onClick={() => store.open("", null)}>
        Reload
      </button>
    </div>
  );
}
