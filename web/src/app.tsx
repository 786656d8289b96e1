import type { ComponentProps } from "preact";
import { useEffect, useMemo, useState } from "preact/hooks";
import { hasServer } from "./engine/connect";
import type { Engine } from "./engine/engine";
import type { OwnScene } from "./lecture/context";
import type { LecturePage } from "./lecture/lecture-page";
import { ThemeButton } from "./ui/theme";
import { FileMenu } from "./viewer/file-menu";
import { firstScene, linkedFiles, openLink } from "./viewer/link";
import { Store, useStore } from "./viewer/store";
import { openFiles } from "./viewer/upload";
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
  const [refused, setRefused] = useState<string | null>(null);
  const [lesson, setLesson] = useState<string | null>(null);
  useStore(store);

  useEffect(() => {
    engine.onLost(setLost);
    const linked = () =>
      openLinked(store).catch((error: unknown) => {
        setRefused(error instanceof Error ? error.message : String(error));
        return false;
      });
    const follow = () => {
      setAt(page());
      setRefused(null);
      linked();
    };
    window.addEventListener("hashchange", follow);
    linked()
      .then((linked) => begin(store, linked))
      .then(setLesson);
    return () => window.removeEventListener("hashchange", follow);
  }, [engine, store]);

  const pages: [Page["name"], string][] = [
    ["viewer", "Viewer"],
    ["lecture", "Lecture"],
  ];
  if (lesson?.trim()) pages.unshift(["lesson", "Lesson"]);
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
      {refused && (
        <p class="notice" role="alert">
          Cannot open the link: {refused}
        </p>
      )}
      {lost && <p class="notice">{lost}. Start it again and reload the page.</p>}
      {at.name === "viewer" && <Viewer store={store} />}
      {(at.name === "lecture" || (at.name === "lesson" && lesson !== null)) && (
        <LazyLecture
          engine={engine}
          name={at.name}
          lesson={at.name === "lesson" ? lesson : null}
          topic={at.topic}
          scene={own(store)}
        />
      )}
    </div>
  );
}

/** The lecture. Its code is loaded when it is first shown, so that it does not delay the viewer. */
function LazyLecture(props: ComponentProps<typeof LecturePage>) {
  const [Page, setPage] = useState<typeof LecturePage | null>(null);
  useEffect(() => {
    import("./lecture/lecture-page").then((loaded) => setPage(() => loaded.LecturePage));
  }, []);
  return Page && <Page {...props} />;
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

/** Opens the scene that the address contains or names. Returns false if there is none, and throws an error if a file
 * cannot be fetched.
 */
async function openLinked(store: Store): Promise<boolean> {
  const text = await openLink(location.hash);
  if (text !== null) {
    store.open("linked.txt", text);
    return true;
  }
  const paths = linkedFiles(location.hash);
  if (!paths) return false;
  await openFiles(store, paths);
  return true;
}

/** Opens the server's scene or the first example if the address has none. Returns the server's lesson, if any. */
async function begin(store: Store, linked: boolean): Promise<string | null> {
  const lesson = hasServer() ? (await store.session.ask({ kind: "lesson" }, "lesson")).text : null;
  if (linked) return lesson;
  if (hasServer() && lesson === null) store.open("", null);
  else store.open("whitted.txt", firstScene);
  return lesson;
}
