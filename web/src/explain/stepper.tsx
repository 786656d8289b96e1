import { useEffect, useState } from "preact/hooks";
import type { CastAccount } from "../protocol";
import { short } from "../ui/slider";
import type { Store } from "../viewer/store";
import { flat } from "./segments";
import { code, type Step, steps } from "./steps";

/** Maximum number of rays in the step-by-step view. */
const most = 24;

/** Step-by-step run of the algorithm for one pixel. */
export function Stepper({ store }: { store: Store }) {
  const [all, setAll] = useState<Step[]>([]);
  const [at, setAt] = useState(0);
  const [plays, setPlays] = useState(false);
  const { pixel } = store;

  useEffect(() => {
    let current = true;
    setAt(0);
    setPlays(false);
    load(store).then((loaded) => current && setAll(loaded));
    return () => {
      current = false;
    };
  }, [pixel]);

  useEffect(() => {
    const step = all[at];
    if (step) store.hover(step.path);
  }, [all, at]);
  useEffect(() => () => store.hover(null), []);

  useEffect(() => {
    if (!plays) return;
    const timer = setInterval(() => setAt((i) => Math.min(i + 1, all.length - 1)), 900);
    return () => clearInterval(timer);
  }, [plays, all]);
  useEffect(() => {
    if (at >= all.length - 1) setPlays(false);
  }, [at, all]);

  const step = all[at];
  if (!step) return <p class="hint">Click a pixel first.</p>;
  const go = (to: number) => setAt(Math.min(all.length - 1, Math.max(0, to)));
  return (
    <section class="stepper" aria-label="Step by step">
      <div class="row">
        <button type="button" class="button" onClick={() => go(at - 1)} disabled={at === 0}>
          Back
        </button>
        <button
          type="button"
          class="button strong"
          onClick={() => go(at + 1)}
          disabled={at === all.length - 1}
        >
          Next
        </button>
        <button type="button" class="button" aria-pressed={plays} onClick={() => setPlays(!plays)}>
          {plays ? "Pause" : "Play"}
        </button>
        <input
          type="range"
          aria-label="Step"
          min={0}
          max={all.length - 1}
          step={1}
          value={at}
          onInput={(event) => go(event.currentTarget.valueAsNumber)}
        />
        <span class="count">
          {at + 1} of {all.length}
        </span>
      </div>
      <p class="sentence" aria-live="polite">
        {step.words}
      </p>
      <p class="closest">closest = {step.closest === undefined ? "–" : short(step.closest)}</p>
      <ol class="code">
        {code.map((line, i) => (
          <li
            key={line}
            class={i === step.line ? "now" : ""}
            aria-current={i === step.line ? "step" : undefined}
          >
            {line}
          </li>
        ))}
      </ol>
    </section>
  );
}

/** Intersects each ray of the pixel with all objects. */
async function load(store: Store): Promise<Step[]> {
  const { pixel, session } = store;
  if (!pixel?.tree) return [];
  const rays = flat(pixel.tree).filter(({ term }) => {
    const role = term.segment?.role;
    return role && role !== "lit" && role !== "shadowed" && term.ray;
  });
  const casts = new Map<string, CastAccount>();
  for (const { path, term } of rays.slice(0, most)) {
    const [origin, direction] = term.ray ?? [
      [0, 0, 0],
      [0, 0, 1],
    ];
    const { cast } = await session.ask({ kind: "cast", origin, direction, t_max: term.t_max }, "cast");
    casts.set(path, cast);
  }
  return steps(pixel, casts);
}
