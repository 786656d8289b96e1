import type { CSSProperties } from "preact";
import { useEffect, useId, useLayoutEffect, useRef, useState } from "preact/hooks";
import { Slider } from "../ui/slider";
import { type Pixels, usePixels } from "./pixels";
import type { ComparisonReport, RegionReport } from "./types";
import { Wipe } from "./wipe";

const modes = [
  ["slider", "Slider"],
  ["blink", "Blink"],
  ["reference", "Reference"],
  ["picture", "Picture"],
  ["heat", "Heat map"],
  ["difference", "Difference"],
] as const;
/** Ways to compare two pictures. */
type Mode = (typeof modes)[number][0];

const zooms = ["fit", "1", "2", "4", "8", "16"] as const;

/** The two pictures of a pair in the same place, compared in one of several ways. */
export function Stage({ shown, region }: { shown: ComparisonReport; region: RegionReport | null }) {
  const { width, height, pictures } = shown;
  const [mode, setMode] = useState<Mode>("slider");
  const [split, setSplit] = useState(0.5);
  const [zoom, setZoom] = useState<(typeof zooms)[number]>("fit");
  const [gain, setGain] = useState(4);
  const [visible, setVisible] = useState(true);
  const [at, setAt] = useState<[number, number] | null>(null);
  const [room, setRoom] = useState(0);
  const scroll = useRef<HTMLDivElement>(null);
  const box = useRef<HTMLSpanElement>(null);
  const values = usePixels([pictures.reference, pictures.picture]);
  const id = useId();

  useLayoutEffect(() => {
    if (!scroll.current) return;
    const observer = new ResizeObserver(([entry]) => setRoom(entry?.contentRect.width ?? 0));
    setRoom(scroll.current.clientWidth);
    observer.observe(scroll.current);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    setVisible(true);
    if (mode !== "blink") return;
    const timer = setInterval(() => setVisible((on) => !on), 500);
    return () => clearInterval(timer);
  }, [mode]);
  useEffect(() => {
    const key = (event: KeyboardEvent) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (event.target instanceof Element && event.target.closest("select, input")) return;
      const chosen = modes[Number(event.key) - 1];
      if (chosen) setMode(chosen[0]);
    };
    window.addEventListener("keydown", key);
    return () => window.removeEventListener("keydown", key);
  }, []);
  useEffect(() => box.current?.scrollIntoView({ block: "nearest", inline: "nearest" }), [region]);

  // Small pictures are enlarged by a whole number, large ones are reduced to the room.
  const fit = room < width ? room / width : Math.min(8, Math.max(1, Math.floor(room / width)));
  const scale = zoom === "fit" ? fit : Number(zoom);
  const legends: Record<Mode, string> = {
    slider: "Left of the line the reference, right of it the picture.",
    blink: visible ? "Picture" : "Reference",
    reference: "",
    picture: "",
    heat: "FLIP error: black is 0, light yellow is 1.",
    difference: `Absolute difference, ${gain} times as bright.`,
  };
  const hidden = mode === "reference" || (mode === "blink" && !visible);
  const look: CSSProperties = {
    visibility: hidden ? "hidden" : "visible",
    mixBlendMode: mode === "difference" ? "difference" : "normal",
  };
  const percent = (value: number, all: number) => `${(100 * value) / all}%`;
  return (
    <div class="stage-of-pair">
      <div class="tools">
        <div class="choice" role="group" aria-label="Way to compare">
          {modes.map(([name, text], i) => (
            <button
              key={name}
              type="button"
              class="button"
              data-mode={name}
              title={`Key ${i + 1}`}
              aria-pressed={mode === name}
              onClick={() => setMode(name)}
            >
              {text}
            </button>
          ))}
        </div>
        <label for={id} class="zoom-choice">
          zoom{" "}
          <select
            id={id}
            class="button"
            value={zoom}
            onChange={(event) => setZoom(event.currentTarget.value as typeof zoom)}
          >
            {zooms.map((value) => (
              <option key={value} value={value}>
                {value === "fit" ? "fit" : `${value} ×`}
              </option>
            ))}
          </select>
        </label>
        {mode === "difference" && (
          <Slider label="gain" value={gain} min={1} max={32} step={1} text={`${gain} ×`} change={setGain} />
        )}
      </div>
      <div class="scroll" ref={scroll}>
        <Wipe
          under={pictures.reference}
          over={mode === "heat" ? pictures.heat : pictures.picture}
          labels={["reference", mode === "heat" ? "heat map" : "picture"]}
          label="Reference and picture"
          split={split}
          change={setSplit}
          on={mode === "slider"}
          look={look}
          frame={{
            width: `${width * scale}px`,
            height: `${height * scale}px`,
            filter: mode === "difference" ? `brightness(${gain})` : "none",
          }}
          point={(x, y) =>
            setAt([Math.min(width - 1, Math.floor(x * width)), Math.min(height - 1, Math.floor(y * height))])
          }
        >
          {region && (
            <span
              ref={box}
              class="box"
              style={{
                left: percent(region.x, width),
                top: percent(region.y, height),
                width: percent(region.width, width),
                height: percent(region.height, height),
              }}
            />
          )}
        </Wipe>
      </div>
      <p class="below">
        <span class="legend-text">{legends[mode]}</span>
        <output>{at ? describe(at, values) : "Point at a pixel to see its values."}</output>
      </p>
    </div>
  );
}

/** Returns the values of both pictures at a pixel. */
function describe([x, y]: [number, number], [reference, picture]: (Pixels | null)[]): string {
  const values = [reference?.at(x, y), picture?.at(x, y)];
  if (!values[0] || !values[1]) return `pixel ${x},${y}`;
  return `pixel ${x},${y}: reference ${values[0].join(" ")}, picture ${values[1].join(" ")}`;
}
