import { useEffect, useMemo, useState } from "preact/hooks";
import { hasServer } from "./engine/connect";
import type { Engine } from "./engine/engine";
import { Lecture } from "./lecture/lecture";
import { ThemeButton } from "./ui/theme";
import { FileMenu } from "./viewer/file-menu";
import { firstScene, openLink } from "./viewer/link";
import { Store, useStore } from "./viewer/store";
import { Viewer } from "./viewer/viewer";

type Page = { name: "viewer" } | { name: "lecture"; topic: string };

function page(): Page {
  const [name, topic] = location.hash.replace(/^#\/?/, "").split("/");
  return name === "lecture" ? { name, topic: topic ?? "" } : { name: "viewer" };
}

/** The page: a viewer and a lecture over one engine. */
export function App({ engine }: { engine: Engine }) {
  const store = useMemo(() => new Store(engine.session()), [engine]);
  const [at, setAt] = useState<Page>(page);
  const [lost, setLost] = useState<string | null>(null);

  useEffect(() => {
    engine.onLost(setLost);
    const follow = () => setAt(page());
    window.addEventListener("hashchange", follow);
    begin(store);
    return () => window.removeEventListener("hashchange", follow);
  }, [engine, store]);

  return (
    <div class="app">
      <header class="bar">
        <span class="name">Dürer</span>
        <nav class="tabs" aria-label="Pages">
          <a class="tab" href="#/viewer" aria-current={at.name === "viewer" ? "page" : undefined}>
            Viewer
          </a>
          <a class="tab" href="#/lecture" aria-current={at.name === "lecture" ? "page" : undefined}>
            Lecture
          </a>
        </nav>
        <FileName store={store} />
        <span class="space" />
        {at.name === "viewer" && <FileMenu store={store} />}
        <ThemeButton />
      </header>
      {lost && <p class="notice">{lost}. Start it again and reload the page.</p>}
      {at.name === "viewer" ? <Viewer store={store} /> : <Lecture engine={engine} topic={at.topic} />}
    </div>
  );
}

function FileName({ store }: { store: Store }) {
  useStore(store);
  const { opened, edited } = store;
  return (
    <span class="file">{opened ? `${opened.name}${edited && opened.saves ? " · edited" : ""}` : ""}</span>
  );
}

async function begin(store: Store) {
  const linked = await openLink(location.hash);
  if (linked) store.open("linked.txt", linked);
  else if (hasServer()) store.open("", null);
  else store.open("whitted.txt", firstScene);
}
