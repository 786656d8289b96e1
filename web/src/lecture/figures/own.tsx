import { useContext, useState } from "preact/hooks";
import type { PictureHead, Setting } from "../../protocol";
import { OwnSceneContext, useOpened } from "../context";
import { Explained } from "../explained";
import { Choice, Equation, Figure, Sym } from "../parts";
import type { Topic } from "../topic";

/** The steps of the lecture over any scene: the picture that is shown, and options of the job. */
const steps = [
  {
    id: "depth",
    name: "Rays and t",
    picture: "depth",
    options: [],
    words: "one ray a pixel, and the least t of all objects",
  },
  {
    id: "normals",
    name: "Normals",
    picture: "normals",
    options: [],
    words: "the normal in the point of the hit, as a colour",
  },
  {
    id: "light",
    name: "Light",
    picture: "color",
    options: [
      ["bounces", "0"],
      ["shadows", "off"],
    ],
    words: "the light of all lamps, without asking what stands before them",
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
  },
  {
    id: "first",
    name: "One mirror",
    picture: "color",
    options: [
      ["bounces", "1"],
      ["shadows", "on"],
    ],
    words: "mirrored and transmitted rays, once",
  },
  { id: "all", name: "All", picture: "color", options: [], words: "as the scene wants it" },
] as const;
type Id = (typeof steps)[number]["id"];

function OwnFigure() {
  const own = useContext(OwnSceneContext);
  const [id, setId] = useState<Id>("depth");
  const [head, setHead] = useState<PictureHead | null>(null);
  const step = steps.find((known) => known.id === id) ?? steps[0];
  const options: Setting[] = step.options.map(([name, value]) => ({ name, value }));
  const { session, size, refused } = useOpened(own, options, step.picture);
  const [width, height] = size;
  return (
    <Figure
      stage={
        <Explained
          session={session}
          width={width}
          height={height}
          label={`Your scene: ${step.name}`}
          scene={`${id} ${own.text ?? ""}`}
          told={setHead}
        />
      }
      controls={
        <Choice
          label="Step"
          value={id}
          values={steps.map((known) => [known.id, known.name] as const)}
          change={(next) => setId(next)}
        />
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
      <Equation numbers="click a pixel, or move with the arrow keys">
        <Sym>pixel</Sym> = Σ of the terms beside
      </Equation>
    </Figure>
  );
}

export const own: Topic = {
  id: "own",
  title: "Your own scene",
  lead: "The same steps over the scene that is open: from one ray a pixel to the finished picture.",
  text: [
    "This is the scene that is open in the viewer, as it stands there now. Change it, or drop another file on that page, and the steps follow.",
    "Go through the steps and keep an eye on one pixel: each step adds terms to its colour, and takes none of the earlier ones away, but for the light that a shadow hides.",
  ],
  Figure: OwnFigure,
  questions: [
    {
      ask: "Which step takes the most rays, and why?",
      answer:
        "Shadows take one ray for each hit and light. Mirrors and glass take more the more of the picture they fill: each of their rays is shaded again.",
    },
    {
      ask: "Your picture is black. At which step would you look first?",
      answer:
        "At the rays: if t is the same everywhere, nothing is hit. If t and the normals are fine, it is the light.",
    },
  ],
};
