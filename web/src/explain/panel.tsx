import { useState } from "preact/hooks";
import { Slider, short } from "../ui/slider";
import { Switch } from "../ui/switch";
import { type Store, useStore } from "../viewer/store";
import { RaysView } from "./rays-view";
import { roles } from "./segments";
import { Stepper } from "./stepper";
import { Tests } from "./tests";
import { Tree } from "./tree";
import type { ExplainView } from "./view";

/** Panel that explains the colour of a pixel. */
export function Explain({ store }: { store: Store }) {
  useStore(store);
  const [mode, setMode] = useState<"tree" | "steps">("tree");
  const { pixel } = store;
  return (
    <div class="explain">
      <RaysView store={store} />
      <BoxLevels store={store} />
      {pixel ? (
        <>
          <Legend store={store} />
          <header class="pixel">
            <span class="chip large" style={{ background: `rgb(${pixel.bytes.join(" ")})` }} />
            <div>
              <strong>
                Pixel {pixel.x}, {pixel.y}
              </strong>
              <p>{pixel.color.map((x) => short(x)).join("  ")}</p>
            </div>
            <div class="tabs" role="tablist" aria-label="Form of the explanation">
              <Tab name="Tree" on={mode === "tree"} choose={() => setMode("tree")} />
              <Tab name="Step by step" on={mode === "steps"} choose={() => setMode("steps")} />
            </div>
          </header>
          {pixel.samples > 1 && <Samples store={store} />}
          {mode === "tree" ? (
            <>
              <Tree store={store} />
              <Tests store={store} />
            </>
          ) : (
            <Stepper store={store} />
          )}
        </>
      ) : (
        <div class="hint large">
          <p>
            <strong>Click a pixel</strong> to see its ray, what the ray hits, and every term of its colour.
          </p>
          <p>Drag to orbit, scroll to zoom, hold Shift to pan.</p>
          <p>In the text, Alt-drag a number to change it, and click a square to pick a colour.</p>
        </div>
      )}
    </div>
  );
}

/** Tab of a panel. */
export function Tab({ name, on, choose }: { name: string; on: boolean; choose(): void }) {
  return (
    <button type="button" role="tab" class="tab" aria-selected={on} onClick={choose}>
      {name}
    </button>
  );
}

/** Controls that show the bounding boxes of the trees in the view, level by level. */
function BoxLevels({ store }: { store: Store }) {
  const { boxes, boxLevel } = store;
  const most = boxes.at(-1)?.level ?? 0;
  const level = boxLevel === null ? null : Math.min(boxLevel, most);
  const count = boxes.filter((box) => box.level === level).length;
  return (
    <div class="boxes row">
      <Switch label="Boxes of the tree" on={level !== null} change={(on) => store.showBoxes(on ? 1 : null)} />
      {level !== null && most > 0 && (
        <Slider
          label="level"
          value={level}
          min={0}
          max={most}
          step={1}
          text={`${level}: ${count === 1 ? "1 box" : `${count} boxes`}`}
          change={(next) => store.showBoxes(next)}
        />
      )}
    </div>
  );
}

function Samples({ store }: { store: Store }) {
  const { pixel } = store;
  if (!pixel) return null;
  const go = (sample: number) => store.explain(pixel.x, pixel.y, sample);
  return (
    <div class="samples">
      <span>
        Sample {pixel.sample + 1} of {pixel.samples}, weight {short(pixel.weight)}
      </span>
      <button
        type="button"
        class="button icon plain"
        aria-label="Previous sample"
        disabled={pixel.sample === 0}
        onClick={() => go(pixel.sample - 1)}
      >
        ←
      </button>
      <button
        type="button"
        class="button icon plain"
        aria-label="Next sample"
        disabled={pixel.sample + 1 >= pixel.samples}
        onClick={() => go(pixel.sample + 1)}
      >
        →
      </button>
    </div>
  );
}

/** Colours of the rays in the view. */
export function Legend({ store }: { store: ExplainView }) {
  const there = new Set<string>();
  const walk = (term: NonNullable<typeof store.pixel>["tree"]) => {
    if (term?.segment) there.add(term.segment.role);
    term?.terms.forEach(walk);
  };
  walk(store.pixel?.tree ?? null);
  return (
    <ul class="legend" aria-label="Colours of the rays">
      {Object.entries(roles)
        .filter(([role]) => there.has(role))
        .map(([role, name]) => (
          <li key={role} style={{ "--color": `var(--ray-${role})` }}>
            {name}
          </li>
        ))}
    </ul>
  );
}
