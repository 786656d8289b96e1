import { useEffect, useRef, useState } from "preact/hooks";
import type { Engine } from "../engine/engine";
import { EngineContext } from "./context";
import { Question } from "./parts";
import type { Topic } from "./topic";

interface Props {
  /** Engine of the figures; `null` if no figure needs one. */
  engine: Engine | null;
  /** Name of the page in the address. */
  name: string;
  topics: Topic[];
  /** Id of the topic that is shown. */
  topic: string;
}

/** The lecture, as a book whose figures run the ray tracer, or as slides with the same content. */
export function Lecture({ engine, name, topics, topic }: Props) {
  const [presents, setPresents] = useState(false);
  /** True if a slide shows its questions. */
  const [asks, setAsks] = useState(false);
  const place = useRef<HTMLElement>(null);
  const contents = useRef<HTMLElement>(null);
  const at = Math.max(
    0,
    topics.findIndex((known) => known.id === topic),
  );
  const now = topics[at] ?? topics[0];
  const go = (to: number) => {
    const next = topics[to];
    if (next) location.hash = `#/${name}/${next.id}`;
  };

  useEffect(() => {
    place.current?.scrollTo({ top: 0 });
    setAsks(false);
    contents.current?.querySelector("[aria-current]")?.scrollIntoView({ block: "nearest", inline: "center" });
  }, [now]);
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      const within = (selector: string) =>
        event.target instanceof Element && event.target.closest(selector) !== null;
      if (event.ctrlKey || event.metaKey || event.altKey || event.shiftKey) return;
      const moves = within("input:not([type=checkbox]), .handle, .drags, select");
      if (event.key.startsWith("Arrow") && moves) return;
      if (event.key === "ArrowRight" || event.key === "PageDown") go(at + 1);
      else if (event.key === "ArrowLeft" || event.key === "PageUp") go(at - 1);
      else if (event.key === "p") present(!presents);
      else if (event.key === "q") setAsks((on) => !on);
      else if (event.key === "Escape") present(false);
      else return;
      event.preventDefault();
    };
    const left = () => {
      if (!document.fullscreenElement) setPresents(false);
    };
    window.addEventListener("keydown", key);
    document.addEventListener("fullscreenchange", left);
    return () => {
      window.removeEventListener("keydown", key);
      document.removeEventListener("fullscreenchange", left);
    };
  });
  const present = (on: boolean) => {
    setPresents(on);
    if (on) document.documentElement.requestFullscreen?.().catch(() => {});
    else if (document.fullscreenElement) document.exitFullscreen();
  };
  if (!now) return null;
  return (
    <EngineContext.Provider value={engine}>
      <div class={`lecture${presents ? " presents" : ""}${asks ? " asks" : ""}`}>
        <nav class="contents" aria-label="Topics" ref={contents}>
          <ol>
            {topics.map((known) => (
              <li key={known.id}>
                <a href={`#/${name}/${known.id}`} aria-current={known === now ? "page" : undefined}>
                  {known.title}
                </a>
              </li>
            ))}
          </ol>
        </nav>
        <main class="chapter" ref={place} tabIndex={-1}>
          <article>
            <header>
              <p class="number">
                {at + 1} of {topics.length}
              </p>
              <h1>{now.title}</h1>
              <p class="lead">{now.lead}</p>
            </header>
            <now.Figure key={now.id} />
            <div class="prose">
              {now.text.map((paragraph, i) =>
                typeof paragraph === "string" ? <p key={i}>{paragraph}</p> : paragraph,
              )}
            </div>
            {now.questions.length > 0 && (
              <section class="questions" aria-label="Questions">
                {now.questions.map(({ ask, answer }, i) => (
                  <Question key={`${now.id} ${i}`} ask={ask}>
                    {answer}
                  </Question>
                ))}
              </section>
            )}
            <footer class="turn">
              <button type="button" class="button" disabled={at === 0} onClick={() => go(at - 1)}>
                ← {topics[at - 1]?.title ?? ""}
              </button>
              {presents && now.questions.length > 0 && (
                <button type="button" class="button" aria-pressed={asks} onClick={() => setAsks(!asks)}>
                  Questions
                </button>
              )}
              <button type="button" class="button" aria-pressed={presents} onClick={() => present(!presents)}>
                {presents ? "Leave presentation" : "Present"}
              </button>
              <button
                type="button"
                class="button"
                disabled={at + 1 >= topics.length}
                onClick={() => go(at + 1)}
              >
                {topics[at + 1]?.title ?? ""} →
              </button>
            </footer>
          </article>
        </main>
      </div>
    </EngineContext.Provider>
  );
}
