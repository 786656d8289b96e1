import type { ComponentChildren } from "preact";
import { useEffect, useId, useState } from "preact/hooks";
import type { Session } from "../engine/engine";
import { byTopic, describeChange, matches, reducedSize } from "../mistakes/choices";
import { MistakenCanvas, type MistakenPicture, useMistaken } from "../mistakes/mistaken";
import type { MistakeChoice } from "../protocol";
import { short } from "../ui/slider";
import { type Store, useStore } from "./store";

/** Maximum size of the compared pictures in pixels. */
const most = 180;

/** Panel with common mistakes of student programs, and what they do to the open scene. */
export function Mistakes({ store }: { store: Store }) {
  useStore(store);
  const [all, setAll] = useState<MistakeChoice[]>([]);
  const [query, setQuery] = useState("");
  const [chosen, setChosen] = useState<string | null>(null);
  const id = useId();
  const { contents, head } = store;
  // The values of some mistakes are the scene's lights, and its dialect determines the formulas.
  const key = contents && `${contents.dialect} ${contents.lights.length}`;
  useEffect(() => {
    if (key === null) return;
    let isLatest = true;
    store.session
      .ask({ kind: "mistakes" }, "mistakes")
      .then(({ mistakes }) => isLatest && setAll(mistakes))
      .catch(() => {});
    return () => {
      isLatest = false;
    };
  }, [store, key]);
  const found = all.filter((mistake) => matches(mistake, query));
  const full: [number, number] = head ? [head.full_width, head.full_height] : (contents?.job.size ?? [1, 1]);
  const size = reducedSize(full, most);
  const changes = [contents, store.camera, store.options];
  const right = useMistaken(
    store.session,
    chosen === null ? null : { name: null, value: null, size },
    changes,
  ).picture;
  const isSearch = query.trim() !== "";
  return (
    <div class="scrolls mistakes">
      <section class="search" aria-label="Common mistakes">
        <h3>Common mistakes</h3>
        <p class="soft intro">
          What this scene looks like if a program makes one of the usual mistakes. All pictures are rendered
          with Whitted’s method.
        </p>
        <label for={id} class="visually-hidden">
          Search mistakes
        </label>
        <input
          id={id}
          type="search"
          placeholder="Search: shadow, N.L, sqrt …"
          value={query}
          onInput={(event) => setQuery(event.currentTarget.value)}
        />
        <p class="soft" role="status">
          {isSearch ? `${found.length} of ${all.length} mistakes` : `${all.length} mistakes`}
        </p>
      </section>
      {byTopic(found).map(({ topic, title, mistakes }) => (
        <Topic key={topic} title={title} count={mistakes.length} isSearch={isSearch}>
          {mistakes.map((mistake) => (
            <li key={mistake.name}>
              <button
                type="button"
                class="mistake"
                aria-expanded={chosen === mistake.name}
                onClick={() => setChosen(chosen === mistake.name ? null : mistake.name)}
              >
                {mistake.description}
              </button>
              {chosen === mistake.name && (
                <Comparison session={store.session} {...{ mistake, right, size, changes }} />
              )}
            </li>
          ))}
        </Topic>
      ))}
    </div>
  );
}

/** Mistakes of a topic, which are folded until they are searched for. */
function Topic({
  title,
  count,
  isSearch,
  children,
}: {
  title: string;
  count: number;
  isSearch: boolean;
  children: ComponentChildren;
}) {
  const [isOpen, setOpen] = useState(false);
  const isShown = isSearch || isOpen;
  return (
    <section class="topic" aria-label={title}>
      <h4>
        <button type="button" aria-expanded={isShown} disabled={isSearch} onClick={() => setOpen(!isOpen)}>
          <span aria-hidden="true">{isShown ? "▾" : "▸"}</span> {title} <span class="soft">{count}</span>
        </button>
      </h4>
      {isShown && <ul>{children}</ul>}
    </section>
  );
}

interface ComparisonProps {
  session: Session;
  mistake: MistakeChoice;
  /** The correct picture. */
  right: MistakenPicture | null;
  size: [number, number];
  changes: unknown[];
}

/** Right and wrong picture and code of a mistake. */
function Comparison({ session, mistake, right, size, changes }: ComparisonProps) {
  const [value, setValue] = useState<number | null>(null);
  const { picture, refused } = useMistaken(session, { name: mistake.name, value, size }, changes);
  const first = mistake.values[0] ?? 0;
  // The text for the selected value.
  const shown = picture?.mistake ?? mistake;
  return (
    <div class="comparison">
      <div class="pair">
        <Rendered title="Right" picture={right} size={size} />
        <Rendered title="With the mistake" picture={picture} size={size} />
      </div>
      <p role="status">
        {refused ?? (picture ? <strong>{describeChange(picture.changed)}</strong> : "rendering …")}
      </p>
      {mistake.values.length > 1 && (
        <ValueField values={mistake.values} value={value ?? first} change={setValue} />
      )}
      {shown.description !== mistake.description && <p>{shown.description}</p>}
      <div class="pair">
        <Code title="Right" text={shown.right} />
        <Code title="Wrong" text={shown.wrong} />
      </div>
    </div>
  );
}

function Rendered({
  title,
  picture,
  size: [width, height],
}: {
  title: string;
  picture: MistakenPicture | null;
  size: [number, number];
}) {
  return (
    <figure>
      <div class="place" style={{ aspectRatio: `${width} / ${height}` }}>
        {picture && <MistakenCanvas picture={picture} label={`The scene, ${title.toLowerCase()}`} />}
      </div>
      <figcaption>{title}</figcaption>
    </figure>
  );
}

function ValueField({
  values,
  value,
  change,
}: {
  values: number[];
  value: number;
  change(value: number): void;
}) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>Value</label>
      <select id={id} value={value} onChange={(event) => change(Number(event.currentTarget.value))}>
        {values.map((known) => (
          <option key={known} value={known}>
            {short(known)}
          </option>
        ))}
      </select>
    </div>
  );
}

function Code({ title, text }: { title: string; text: string }) {
  return (
    <div>
      <h4>{title}</h4>
      <pre>
        <code>{text}</code>
      </pre>
    </div>
  );
}
