import { useContext, useState } from "preact/hooks";
import { reducedSize } from "../../mistakes/choices";
import type { PictureInfo, Setting } from "../../protocol";
import { OwnSceneContext, useSceneFile } from "../context";
import { ExplainedImage } from "../explained";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Choice, Equation, Figure, Sym } from "../parts";
import type { Topic } from "../topic";

interface Step {
  id: string;
  name: string;
  picture: string;
  options: readonly (readonly [string, string])[];
  words: string;
  /** Name of a common mistake and its label, if the step's picture shows colours. */
  mistake?: readonly [string, string];
}

/** Steps of the lecture for any scene: the image that is shown, and the render options. */
const steps = [
  {
    id: "depth",
    name: "Rays and t",
    picture: "depth",
    options: [],
    words: "one ray per pixel, and the smallest t of all objects",
  },
  {
    id: "normals",
    name: "Normals",
    picture: "normals",
    options: [],
    words: "the normal at the hit point, as a colour",
  },
  {
    id: "light",
    name: "Light",
    picture: "color",
    options: [
      ["bounces", "0"],
      ["shadows", "off"],
    ],
    words: "the light of all lights, without testing for occlusion",
    mistake: ["no-cosine", "forget the cosine"],
  },
  {
    id: "shadows",
    name: "Shadows",
    picture: "color",
    options: [
      ["bounces", "0"],
      ["shadows", "on"],
    ],
    words: "a shadow ray to each light",
    mistake: ["shadows-endless", "shadow rays do not end at the light"],
  },
  {
    id: "first",
    name: "One reflection",
    picture: "color",
    options: [
      ["bounces", "1"],
      ["shadows", "on"],
    ],
    words: "mirrored and transmitted rays, once",
    mistake: ["mirror-along", "forget the factor 2 of the mirrored direction"],
  },
  {
    id: "all",
    name: "All",
    picture: "color",
    options: [],
    words: "all options as the scene sets them",
    mistake: ["secondary-unshadowed", "no shadow rays in mirrors and behind glass"],
  },
] as const satisfies readonly Step[];
type Id = (typeof steps)[number]["id"];

function OwnFigure() {
  const own = useContext(OwnSceneContext);
  const [id, setId] = useState<Id>("depth");
  const [head, setHead] = useState<PictureInfo | null>(null);
  const step: Step = steps.find((known) => known.id === id) ?? steps[0];
  const options: Setting[] = step.options.map(([name, value]) => ({ name, value }));
  const { session, size, refused } = useSceneFile(own, options, step.picture);
  const [width, height] = size;
  const [name = null, label = ""] = step.mistake ?? [];
  const mistake = useFigureMistake(session, name, reducedSize(size, 240), [id, own.text, head?.hash]);
  return (
    <Figure
      stage={
        <ExplainedImage
          session={session}
          width={width}
          height={height}
          label={`Your scene: ${step.name}`}
          scene={`${id} ${own.text ?? ""}`}
          mistaken={mistake.picture}
          onResult={setHead}
        />
      }
      controls={
        <>
          <Choice
            label="Step"
            value={id}
            values={steps.map((known) => [known.id, known.name] as const)}
            change={(next) => setId(next)}
          />
          {step.mistake && <MistakeSwitch name={label} mistake={mistake} />}
        </>
      }
    >
      <Equation
        numbers={
          head ? (
            <>
              {own.title}: {width} × {height} pixels, <b>{(head.rays / 1e3).toFixed(0)}</b> thousand rays
            </>
          ) : (
            (refused ?? "…")
          )
        }
      >
        {step.words}
      </Equation>
      <Equation numbers="click a pixel, or select it with the arrow keys">
        <Sym>pixel</Sym> = Σ of the terms beside the image
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

export const own: Topic = {
  id: "own",
  title: "Your own scene",
  lead: "The steps of the lecture for the scene that is open, from one ray per pixel to the finished image.",
  text: [
    "This is the scene that is open in the viewer, with all edits. Change it there, or drop another file onto that page, and the steps change with it.",
    "Go through the steps and watch one pixel: each step adds terms to its colour. Only the shadow step also removes some: the light that is occluded.",
  ],
  Figure: OwnFigure,
  questions: [
    {
      ask: "Which step traces the most rays, and why?",
      answer:
        "Shadows need one ray per hit and light. Mirrors and glass need more rays the larger they are in the image, because the hit of each secondary ray is shaded again.",
    },
    {
      ask: "Your image is black. Which step would you look at first?",
      answer:
        "The rays: if t is the same everywhere, nothing is hit. If t and the normals look right, the light is the cause.",
    },
  ],
};
