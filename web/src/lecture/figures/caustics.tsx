import { useState } from "preact/hooks";
import box from "../../../../scenes/caustic.txt?raw";
import type { PictureInfo } from "../../protocol";
import { Slider } from "../../ui/slider";
import { usePixel, useScene } from "../context";
import { Choice, Equation, Figure, Sym } from "../parts";
import { PixelPicker } from "../picked";
import { RenderedImage } from "../rendered";
import type { Topic } from "../topic";

const [width, height] = [360, 288];
type Way = "path" | "photons";

function CausticsFigure() {
  const [way, setWay] = useState<Way>("photons");
  const [power, setPower] = useState(10);
  const [radius, setRadius] = useState(0.05);
  const [step, setStep] = useState(3);
  const [head, setHead] = useState<PictureInfo | null>(null);
  const [place, setPlace] = useState({ x: 0.78, y: 0.935 });
  const pixel = { x: Math.floor(place.x * width), y: Math.floor(place.y * height) };
  const photons = Math.round(10 ** (2 + power / 5));
  const samples = 2 ** step;
  const options = [
    { name: "integrator", value: way },
    { name: "samples", value: String(samples) },
  ];
  if (way === "photons")
    options.push(
      { name: "photons", value: String(photons) },
      { name: "photon-radius", value: String(radius) },
    );
  const session = useScene(box, options);
  const account = usePixel(session, pixel.x, pixel.y, JSON.stringify(options));
  const gathered = account?.tree?.terms.find((term) => term.title.startsWith("Caustic of"));
  const found = gathered?.rows.find((row) => row.name === "photons")?.value ?? null;
  return (
    <Figure
      stage={
        <div class="square">
          <PixelPicker place={place} pick={setPlace}>
            <RenderedImage
              session={session}
              width={width}
              height={height}
              label="A mirror ball and a glass ball under a lamp; click for the photons of a pixel"
              onResult={setHead}
            />
          </PixelPicker>
        </div>
      }
      controls={
        <>
          <Choice
            label="How light is found"
            value={way}
            values={[
              ["photons", "Photons from the lamp"],
              ["path", "Paths from the eye only"],
            ]}
            change={(value) => setWay(value)}
          />
          <Slider
            label="samples"
            value={step}
            min={0}
            max={8}
            step={1}
            text={String(samples)}
            change={setStep}
          />
          {way === "photons" && (
            <>
              <Slider
                label="photons"
                value={power}
                min={0}
                max={20}
                step={1}
                text={photons.toLocaleString("en")}
                change={setPower}
              />
              <Slider
                label="radius"
                value={radius}
                min={0.01}
                max={0.3}
                step={0.005}
                text={radius.toFixed(3)}
                change={setRadius}
              />
            </>
          )}
        </>
      }
    >
      <Equation
        numbers={
          found === null ? (
            "click the bright spot below the glass"
          ) : (
            <>
              <b>{found}</b> of {photons.toLocaleString("en")} photons within{" "}
              {gathered?.rows.find((row) => row.name === "radius")?.result} of this point
            </>
          )
        }
      >
        <Sym>L</Sym> ≈ Σ <Sym>f</Sym> <Sym>Φ</Sym>
        <sub>i</sub> / (π <Sym>r</Sym>²)
      </Equation>
      <Equation
        numbers={
          head ? (
            <>
              <b>{head.samples}</b> of {samples} samples, {(head.rays / 1e6).toFixed(1)} million rays
              {head.noise !== null && `, error ${head.noise.toFixed(3)}`}
            </>
          ) : (
            "…"
          )
        }
      >
        {way === "photons" ? "lamp → glass → floor ← eye" : "eye → floor → glass → lamp, by chance"}
      </Equation>
    </Figure>
  );
}

export const caustics: Topic = {
  id: "caustics",
  title: "Caustics by photons",
  lead: "Glass focuses light to bright spots. They are hard to find from the eye, but easy to find from the lamp.",
  text: [
    "A path from the eye that hits the floor would have to continue in exactly a direction that the glass refracts to the lamp. That rarely happens by chance, and when it does, the path has so much weight that the image is full of bright dots. A shadow ray towards the lamp does not help either, because the glass is in its way.",
    "So photons are sent from the lamp first. Those that were reflected by a mirror or refracted by glass are stored where they land. The brightness of a point then follows from the density of the photons around it, counted in a small disc. A large disc gives a smooth but blurred result, a small one a sharp but noisy result. Dürer makes the disc smaller with every sample.",
  ],
  Figure: CausticsFigure,
  questions: [
    {
      ask: "You double the radius. How many photons are found, and how does the brightness change?",
      answer:
        "About four times as many, on four times the area: the brightness stays the same, and its noise is halved.",
    },
    {
      ask: "Which light in this image does not come from photons?",
      answer:
        "Light that comes from the lamp or the walls without passing glass or mirrors: paths find it easily.",
    },
  ],
};
