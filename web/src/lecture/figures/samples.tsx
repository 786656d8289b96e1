import { useState } from "preact/hooks";
import type { PictureInfo } from "../../protocol";
import { Slider } from "../../ui/slider";
import { usePageBackground, useScene } from "../context";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Choice, Equation, Figure, Sym } from "../parts";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

const [width, height] = [96, 54];
const counts = [1, 2, 4, 8, 16, 32, 64, 128];
const filters = [
  ["box", "Box"],
  ["tent", "Tent"],
  ["blackman-harris", "Blackman-Harris"],
  ["mitchell", "Mitchell"],
] as const;
type Filter = (typeof filters)[number][0];

function SamplesFigure() {
  const [step, setStep] = useState(0);
  const [filter, setFilter] = useState<Filter>("box");
  const [head, setHead] = useState<PictureInfo | null>(null);
  const samples = counts[step] ?? 1;
  const text = sceneText({
    background: usePageBackground(),
    materials: [
      materialPresets.clay,
      materialPresets.sky,
      "diffuseColor 0.85 0.84 0.8",
      "diffuseColor 0.12 0.12 0.13",
    ],
    group: `Transform { Translate 0 -1 0 Group {
        ${stripes()} } }
      MaterialIndex 0 Sphere { center -1 0.05 0 radius 1.05 }
      MaterialIndex 1 Box { min 0.5 -1 -1.2 max 2 1.1 -0.2 }`,
  }).replace(/^.*\n/, "PerspectiveCamera { center 0.5 1.2 6.5 direction -0.02 -0.2 -1 up 0 1 0 angle 38 }\n");
  const options = [{ name: "samples", value: String(samples) }];
  if (samples > 1) options.push({ name: "filter", value: filter });
  const session = useScene(text, options);
  const mistake = useFigureMistake(session, "pixel-corner", [width, height], [text, samples, filter]);
  return (
    <Figure
      stage={
        <RenderedImage
          session={session}
          width={width}
          height={height}
          squares
          label="An image with few pixels, each shown as a square"
          mistaken={mistake.picture}
          onResult={setHead}
        />
      }
      controls={
        <>
          <Slider
            label="samples"
            value={step}
            min={0}
            max={counts.length - 1}
            step={1}
            text={String(samples)}
            change={setStep}
          />
          <Choice label="Filter" value={filter} values={filters} change={(value) => setFilter(value)} />
          <MistakeSwitch name="rays through the corners of pixels" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            {width} × {height} pixels, <b>{samples}</b>{" "}
            {samples === 1 ? "ray through each center" : "rays through each"},{" "}
            {head ? `${(head.rays / 1e3).toFixed(0)} thousand rays in total` : "…"}
          </>
        }
      >
        <Sym>pixel</Sym> = Σ <Sym>w</Sym>
        <sub>i</sub> <Sym>L</Sym>(<Sym>x</Sym>
        <sub>i</sub>) / Σ <Sym>w</Sym>
        <sub>i</sub>
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

/** Returns a floor whose stripes become narrower than a pixel in the distance. */
function stripes(): string {
  const all = [];
  for (let i = -14; i < 14; i++) {
    all.push(
      `MaterialIndex ${i % 2 === 0 ? 2 : 3} Rectangle { corner ${i * 0.4} 0 -12 edge0 0 0 15 edge1 0.4 0 0 }`,
    );
  }
  return all.join("\n");
}

export const samples: Topic = {
  id: "samples",
  title: "Samples and filters",
  lead: "One ray through the center of a pixel samples one point. Several rays estimate the mean.",
  text: [
    "With one ray, an edge is either in a pixel or not: it becomes a staircase, and fine stripes turn into moiré patterns. More rays, spread over the pixel, average its area.",
    "A filter weights each ray by its distance from the pixel’s center. A box filter gives equal weights; wider filters look softer and hide staircases better.",
  ],
  Figure: SamplesFigure,
  questions: [
    {
      ask: "Which parts of the image improve most?",
      answer:
        "The edges, and the far stripes that are finer than a pixel. Inside uniform surfaces nothing changes.",
    },
    {
      ask: "How many grey levels can a pixel on an edge have with 4 samples and a box filter?",
      answer: "Five: 0, 1, 2, 3 or 4 of them hit the object.",
    },
  ],
};
