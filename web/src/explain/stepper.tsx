import { useEffect, useState } from "preact/hooks";
import type { CastResult } from "../protocol";
import { Choice } from "../ui/choice";
import { short } from "../ui/slider";
import type { Store } from "../viewer/store";
import { Code, Player } from "./code";
import { Scan } from "./scan";
import { flatten } from "./segments";
import { type Step, steps } from "./steps";
import type { ExplainView } from "./view";

/** Maximum number of rays that the step-by-step view follows. */
const most = 24;

const scopes = [
  ["pixel", "This pixel"],
  ["row", "Its row"],
  ["picture", "The entire image"],
] as const;
/** What the step-by-step view covers: one pixel, its row, or the entire image. */
type Scope = (typeof scopes)[number][0];

/** Shows the algorithm step by step, for one pixel, its row, or the entire image. */
export function Stepper({ store }: { store: Store }) {
  const [scope, setScope] = useState<Scope>("pixel");
  return (
    <section class="stepper" aria-label="Step by step">
      <Choice label="Steps for" value={scope} values={scopes} change={(next) => setScope(next)} />
      {scope === "pixel" ? <PixelSteps store={store} /> : <Scan key={scope} store={store} scope={scope} />}
    </section>
  );
}

/** Shows the steps of the algorithm for one pixel. */
export function PixelSteps({ store }: { store: ExplainView }) {
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
    <>
      <Player at={at} count={all.length} plays={plays} go={go} play={setPlays} unit="Step" />
      <p class="sentence" aria-live="polite">
        {step.description}
      </p>
      <p class="closest">closest = {step.closest === undefined ? "–" : short(step.closest)}</p>
      <Code line={step.line} />
    </>
  );
}

/** Intersects each ray of the pixel with all objects. */
async function load(store: ExplainView): Promise<Step[]> {
  const { pixel } = store;
  if (!pixel?.tree) return [];
  const rays = flatten(pixel.tree).filter(({ term }) => {
    const role = term.segment?.role;
    return role && role !== "lit" && role !== "shadowed" && term.ray;
  });
  const casts = new Map<string, CastResult>();
  for (const { path } of rays.slice(0, most)) {
    const cast = await store.castOf(path);
    if (cast) casts.set(path, cast);
  }
  return steps(pixel, casts);
}
