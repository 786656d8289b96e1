import { useEffect, useMemo, useState } from "preact/hooks";
import { hasServer } from "./engine/connect";
import type { Engine } from "./engine/engine";
import { type OwnScene, OwnSceneContext } from "./lecture/context";
import { Lecture } from "./lecture/lecture";
import { lesson } from "./lecture/lesson";
import type { Topic } from "./lecture/topic";
import { topics } from "./lecture/topics";
import { ThemeButton } from "./ui/theme";
import { FileMenu } from "./viewer/file-menu";
import { firstScene, openLink } from "./viewer/link";
import { Store, useStore } from "./viewer/store";
import { Viewer } from "./viewer/viewer";

/** Page that the address selects, and its topic. */
type Page = { name: "viewer" | "lecture" | "lesson"; topic: string };

function page(): Page {
  const [name, topic] = location.hash.replace(/^#\/?/, "").split("/");
  return { name: name === "lecture" || name === "lesson" ? name : "viewer", topic: topic ?? "" };
}

/** The whole page: the viewer, the lecture and a teacher's lesson, which share one engine. */
export function App({ engine }: { engine: Engine }) {
  const store = useMemo(() => new Store(engine.session({ shared: true })), [engine]);
  const [at, setAt] = useState<Page>(page);
  const [lost, setLost] = useState<string | null>(null);
  const [steps, setSteps] = useState<Topic[]>([]);
  useStore(store);

  useEffect(() => {
    engine.onLost(setLost);
    const follow = () => setAt(page());
    window.addEventListener("hashchange", follow);
    begin(store).then((text) => setSteps(text === null ? [] : lesson(text)));
    return () => window.removeEventListener("hashchange", follow);
  }, [engine, store]);

  const pages: [Page["name"], string][] = [
    ["viewer", "Viewer"],
    ["lecture", "Lecture"],
  ];
  if (steps.length > 0) pages.unshift(["lesson", "Lesson"]);
  return (
    <div class="app">
      <header class="bar">
        <span class="name">Dürer</span>
        <nav class="tabs" aria-label="Pages">
          {pages.map(([name, title]) => (
            <a key={name} class="tab" href={`#/${name}`} aria-current={at.name === name ? "page" : undefined}>
              {title}
            </a>
          ))}
        </nav>
        <FileName store={store} />
        <span class="space" />
        {at.name === "viewer" && <FileMenu store={store} />}
        <ThemeButton />
      </header>
      {lost && <p class="notice">{lost}. Start it again and reload the page.</p>}
      {at.name === "viewer" ? (
        <Viewer store={store} />
      ) : (
        <OwnSceneContext.Provider value={own(store)}>
          <Lecture
            engine={engine}
            name={at.name}
            topics={at.name === "lesson" ? steps : topics}
            topic={at.topic}
          />
        </OwnSceneContext.Provider>
      )}
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

/** Returns the viewer's scene, for the lecture's chapter "Your own scene". */
function own({ opened, text }: Store): OwnScene {
  if (!opened) return { title: "whitted.txt", name: "whitted.txt", text: firstScene };
  if (opened.text !== null) return { title: opened.name, name: opened.name, text };
  return { title: opened.name, name: "", text: null };
}

/** Opens the scene in the address, or the server's scene. Returns the server's lesson, if any. */
async function begin(store: Store): Promise<string | null> {
  const linked = await openLink(location.hash);
  const lesson = hasServer() ? (await store.session.ask({ kind: "lesson" }, "lesson")).text : null;
  if (linked) store.open("linked.txt", linked);
  else if (hasServer() && lesson === null) store.open("", null);
  else store.open("whitted.txt", firstScene);
  return lesson;
}
