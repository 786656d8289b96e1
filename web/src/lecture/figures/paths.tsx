import { useState } from "preact/hooks";
import room from "../../../../scenes/cornell-box.txt?raw";
import type { PictureInfo } from "../../protocol";
import { Slider } from "../../ui/slider";
import { useScene } from "../context";
import { Choice, Equation, Figure, Sym } from "../parts";
import { RenderedImage } from "../rendered";
import type { Topic } from "../topic";

const counts = [1, 2, 4, 8, 16, 32, 64, 128, 256];
type Direct = "both" | "lights" | "bsdf";

function PathsFigure() {
  const [step, setStep] = useState(3);
  const [bounces, setBounces] = useState(4);
  const [direct, setDirect] = useState<Direct>("both");
  const [head, setHead] = useState<PictureInfo | null>(null);
  const samples = counts[step] ?? 1;
  const session = useScene(room, [
    { name: "integrator", value: "path" },
    { name: "samples", value: String(samples) },
    { name: "bounces", value: String(bounces) },
    { name: "direct", value: direct },
  ]);
  return (
    <Figure
      stage={
        <div class="square">
          <RenderedImage
            session={session}
            width={400}
            height={400}
            label="The path-traced Cornell box"
            onResult={setHead}
          />
        </div>
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
          <Slider
            label="bounces"
            value={bounces}
            min={0}
            max={12}
            step={1}
            text={String(bounces)}
            change={setBounces}
          />
          <Choice
            label="Sampling of the light"
            value={direct}
            values={[
              ["lights", "Light sampling"],
              ["bsdf", "BSDF sampling"],
              ["both", "Both (MIS)"],
            ]}
            change={(value) => setDirect(value)}
          />
        </>
      }
    >
      <Equation
        numbers={
          head ? (
            <>
              <b>{head.samples}</b> of {samples} samples per pixel, {(head.rays / 1e6).toFixed(1)} million
              rays
            </>
          ) : (
            "…"
          )
        }
      >
        <Sym>L</Sym> ≈ 1/<Sym>N</Sym> Σ <Sym>f</Sym>(<Sym>path</Sym>
        <sub>i</sub>) / <Sym>p</Sym>(<Sym>path</Sym>
        <sub>i</sub>)
      </Equation>
      <Equation
        numbers={
          <>
            error ∝ 1/√{samples} = <b>{(1 / Math.sqrt(samples)).toFixed(3)}</b>
          </>
        }
      >
        four times the samples, half the noise
      </Equation>
    </Figure>
  );
}

export const paths: Topic = {
  id: "paths",
  title: "Paths",
  lead: "Light arrives from all directions. A path tracer follows it backwards, one random direction after the other.",
  text: [
    "At each hit a direction is sampled at random, and the path continues until it hits a light or its throughput is too small. Each path is one estimate of the pixel’s radiance; their mean converges to it, and its noise falls with the square root of their number.",
    "With 0 bounces there is only direct light. With one bounce, the floor illuminates the ceiling, and the white boxes take on the red and green of the walls.",
  ],
  Figure: PathsFigure,
  questions: [
    {
      ask: "Why is the image so noisy with BSDF sampling alone?",
      answer: "The light is small: most paths never hit it, and the few that do carry all of the weight.",
    },
    { ask: "How many samples halve the noise?", answer: "Four times as many." },
  ],
};
