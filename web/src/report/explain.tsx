import { useId, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { Legend, Tab } from "../explain/panel";
import { RaysView } from "../explain/rays-view";
import { PixelSteps } from "../explain/stepper";
import { Tests } from "../explain/tests";
import { Tree } from "../explain/tree";
import { short } from "../ui/slider";
import { useStore } from "../viewer/store";
import { ReportedExplanation } from "./explained";
import { Quoted } from "./quoted";
import { Shell } from "./shell";
import type { ExplainReport } from "./types";

/** Report of `durer explain`: the picture, the rays in 3D, and the tree of terms. */
export function Explain({ report }: { report: ExplainReport }) {
  const store = useMemo(() => new ReportedExplanation(report), [report]);
  useStore(store);
  const [mode, setMode] = useState<"tree" | "steps">("tree");
  const { pixel } = store;
  if (!pixel) return null;
  const title = report.pixel ? `Pixel ${report.pixel.join(", ")}` : "A ray";
  const count = report.samples.length;
  return (
    <Shell command={`explain ${report.file}`} title={`${title} of ${report.file}`}>
      <main class="explained-pixel">
        <header class="pixel">
          <span class="chip large" style={{ background: `rgb(${pixel.bytes.join(" ")})` }} />
          <div>
            <h1>{title}</h1>
            <p>
              {pixel.color.map((x) => short(x)).join("  ")}
              {` · in eight bits ${pixel.bytes.join(" ")} (${report.transfer})`}
              {count > 1 && ` · the mean of ${count} samples`}
            </p>
          </div>
        </header>
        <div class="views">
          {report.picture && report.pixel && (
            <MarkedPicture picture={report.picture} size={report.size} pixel={report.pixel} />
          )}
          <RaysView store={store} />
          <Legend store={store} />
          <p class="hint">
            Drag to turn the view, scroll to zoom, or use the arrow keys, + and −. Click a ray or a term.
          </p>
        </div>
        <section class="why" aria-label="Explanation">
          {report.notes.map((note) => (
            <p key={note} class="notice">
              <Quoted sentence={note} />
            </p>
          ))}
          {count > 1 && <SampleChoice store={store} report={report} />}
          <div class="tabs" role="tablist" aria-label="Form of the explanation">
            <Tab name="Tree" on={mode === "tree"} choose={() => setMode("tree")} />
            <Tab name="Step by step" on={mode === "steps"} choose={() => setMode("steps")} />
          </div>
          {mode === "tree" ? (
            <Tree key={store.sample} store={store} />
          ) : (
            <div class="stepper">
              <PixelSteps store={store} />
            </div>
          )}
          {!store.hasTests && <NoTests report={report} sample={store.sample} />}
          {mode === "tree" && <Tests store={store} />}
        </section>
      </main>
    </Shell>
  );
}

/** The picture, with a circle around the pixel. */
function MarkedPicture({
  picture,
  size: [width, height],
  pixel: [x, y],
}: {
  picture: string;
  size: [number, number];
  pixel: [number, number];
}) {
  const frame = useRef<HTMLDivElement>(null);
  const [coarse, setCoarse] = useState(false);
  // Pixels that are shown larger than they are have sharp edges.
  useLayoutEffect(() => {
    setCoarse((frame.current?.clientWidth ?? 0) > 1.5 * width);
  }, [width]);
  return (
    <div class="marked-picture" ref={frame} style={{ maxWidth: `calc(38vh * ${width / height})` }}>
      <img src={picture} class={coarse ? "squares" : ""} alt={`The picture, with pixel ${x}, ${y} marked`} />
      <span
        class="mark"
        style={{ left: `${(100 * (x + 0.5)) / width}%`, top: `${(100 * (y + 0.5)) / height}%` }}
      />
    </div>
  );
}

/** Selects one of the samples of the pixel, by the number that `--sample` has. */
function SampleChoice({ store, report }: { store: ReportedExplanation; report: ExplainReport }) {
  const id = useId();
  const { sample } = store;
  const arrow = (sign: string, name: string, to: number) => (
    <button
      type="button"
      class="button icon"
      aria-label={name}
      disabled={!report.samples[to]}
      onClick={() => store.explain(0, 0, to)}
    >
      {sign}
    </button>
  );
  return (
    <div class="sample-choice">
      <label for={id}>Sample</label>
      <select
        id={id}
        class="button"
        value={sample}
        onChange={(event) => store.explain(0, 0, Number(event.currentTarget.value))}
      >
        {report.samples.map(({ explanation, of }, i) => {
          const elsewhere = of.join() === report.pixel?.join() ? "" : ` (pixel ${of.join(", ")})`;
          const value = explanation.tree?.value.map((x) => short(x)).join("  ") ?? "nothing";
          return (
            <option key={i} value={i}>
              {`${i}${elsewhere}, weight ${short(explanation.weight)}: ${value}`}
            </option>
          );
        })}
      </select>
      {arrow("←", "Previous sample", sample - 1)}
      {arrow("→", "Next sample", sample + 1)}
    </div>
  );
}

/** Says how to see the intersection tests of a sample for which the report has no room. */
function NoTests({ report, sample }: { report: ExplainReport; sample: number }) {
  if (report.samples[sample]?.explanation.tree === null) return null;
  return (
    <p class="hint">
      This file has no room for the objects that were tested in this sample. Write it again with{" "}
      <code>--sample {sample}</code> to see them.
    </p>
  );
}
