import { useEffect, useState } from "preact/hooks";
import { Editor } from "../editor/editor";
import { Findings } from "../editor/findings";
import { Explain } from "../explain/panel";
import { Mistakes } from "./mistakes";
import { Model } from "./model";
import { Picture } from "./picture";
import { Settings } from "./settings";
import { Status } from "./status";
import { type Store, useStore } from "./store";
import { droppedFiles, uploadFiles } from "./upload";

/** Panel beside the image, or below it in narrow windows, where the text is one of the panels. */
type Side = "explain" | "settings" | "mistakes" | "text";

/** The viewer: panes with the scene's text, its image, and the explanation of a pixel. */
export function Viewer({ store }: { store: Store }) {
  useStore(store);
  const [side, setSide] = useState<Side>("explain");

  useEffect(() => {
    const over = (event: DragEvent) => event.preventDefault();
    const drop = async (event: DragEvent) => {
      event.preventDefault();
      uploadFiles(store, await droppedFiles(event.dataTransfer?.items ?? []));
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
    if (store.explanations > 0) setSide("explain");
  }, [store, store.explanations]);

  return (
    <main class="viewer" data-side={side}>
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
      <div class="pane-head switcher tabs" role="tablist" aria-label="Panel">
        <PaneTab name="Explain" on={side === "explain"} choose={() => setSide("explain")} />
        <PaneTab name="Camera and render" on={side === "settings"} choose={() => setSide("settings")} />
        <PaneTab
          name="Mistakes"
          label="Common mistakes"
          on={side === "mistakes"}
          choose={() => setSide("mistakes")}
        />
        <PaneTab name="Scene" on={side === "text"} choose={() => setSide("text")} />
      </div>
      <section class="pane why" aria-label="Explanation and settings">
        {side === "settings" ? (
          <Settings store={store} />
        ) : side === "mistakes" ? (
          <Mistakes store={store} />
        ) : (
          <div class="scrolls">
            <Explain store={store} />
          </div>
        )}
      </section>
    </main>
  );
}

function PaneTab({
  name,
  label = name,
  on,
  choose,
}: {
  name: string;
  /** Name for screen readers, if there is no room for it. */
  label?: string;
  on: boolean;
  choose(): void;
}) {
  return (
    <button type="button" role="tab" class="tab" aria-label={label} aria-selected={on} onClick={choose}>
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
    <div class="tabs" role="tablist" aria-label="Pictures" onWheel={scrollSideways}>
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

/** Lets a mouse wheel scroll a row of tabs. */
function scrollSideways(event: WheelEvent & { currentTarget: Element }) {
  event.currentTarget.scrollLeft += event.deltaY;
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
