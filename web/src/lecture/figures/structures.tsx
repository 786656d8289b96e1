import { useState } from "preact/hooks";
import { Boxes } from "../../explain/edges";
import { add, type Eye, length, mul, sub, type Vec } from "../../explain/space";
import type { Structure, Traversal, TraversalStep } from "../../protocol";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene, useWalk } from "../context";
import { Arrow, Dot, Line, Name } from "../draw";
import { Choice, Equation, Figure, Sym } from "../parts";
import { Point3 } from "../point";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

/** Returns balls scattered in a slab, denser to the right. */
function balls(): string {
  const all: string[] = [];
  for (let i = 0; i < 96; i++) {
    const [a, b, c] = [0.754877, 0.56984, 0.819173].map((step) => (step * (i + 1)) % 1) as Vec;
    const x = 7.4 * Math.sqrt(a) - 4;
    all.push(
      `MaterialIndex ${i % 3} Sphere { center ${x.toFixed(3)} ${(3.2 * b - 1.6).toFixed(3)} ${(1.4 * c - 0.7).toFixed(3)} radius 0.13 }`,
    );
  }
  return all.join("\n");
}
const group = balls();

const structures = [
  ["nothing", "Every object"],
  ["grid", "Grid"],
  ["tree", "Tree of boxes"],
] as const satisfies readonly (readonly [Structure, string])[];

function StructuresFigure() {
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.clay, materialPresets.sky, materialPresets.sand],
    group,
  });
  const session = useScene(text);
  const [eye, setEye] = useState<Eye>({ target: [0, 0, 0], distance: 13, yaw: 0.3, pitch: 0.28, angle: 42 });
  const [structure, setStructure] = useState<Structure>("tree");
  const [origin, setOrigin] = useState<Vec>([-5.2, 0.9, 0]);
  const [tip, setTip] = useState<Vec>([-4.2, 0.72, 0]);
  const [step, setStep] = useState(1);
  const direction = sub(tip, origin);
  const walk = useWalk(session, { structure, origin, direction, t_max: null, any: false }, text);
  const counted = structures.map(([name]) =>
    useWalk(session, { structure: name, origin, direction, t_max: null, any: false }, text),
  );
  const at = walk ? Math.round(step * (walk.steps.length - 1)) : 0;
  const now = walk?.steps[at] ?? null;
  const end = now?.closest ?? null;
  return (
    <Figure
      ready={walk !== null}
      stage={
        <Stage
          session={session}
          eye={eye}
          setEye={setEye}
          label="A ray among many balls, and the boxes that it visits"
        >
          {(view) => (
            <>
              {walk && <Boxes view={view} boxes={walk.boxes} color="var(--solid)" opacity={0.3} />}
              {walk && structure !== "nothing" && (
                <Boxes
                  view={view}
                  boxes={walk.steps.slice(0, at).flatMap(cube)}
                  color="var(--ray-reflected)"
                  opacity={0.65}
                  width={1.6}
                />
              )}
              {now && (
                <Boxes view={view} boxes={cube(now)} color="var(--ray-shadowed)" opacity={1} width={3} />
              )}
              <Line
                view={view}
                from={origin}
                to={add(origin, mul(end ?? 11 / Math.max(1e-3, length(direction)), direction))}
                color="var(--ray-camera)"
                width={2.5}
              />
              <Arrow view={view} from={origin} dir={direction} color="var(--ray-camera)" width={4} />
              {end !== null && (
                <>
                  <Dot view={view} at={add(origin, mul(end, direction))} color="var(--ray-lit)" radius={7} />
                  <Name view={view} at={add(origin, mul(end, direction))} color="var(--ray-lit)">
                    t = {fixed(end)}
                  </Name>
                </>
              )}
              <Point3
                view={view}
                at={tip}
                color="var(--ray-camera)"
                label="End of the direction"
                move={setTip}
              />
              <Point3
                view={view}
                at={origin}
                color="var(--ink)"
                label="Origin of the ray"
                move={(to) => {
                  setTip(add(tip, sub(to, origin)));
                  setOrigin(to);
                }}
              />
            </>
          )}
        </Stage>
      }
      controls={
        <>
          <Choice
            label="Structure"
            value={structure}
            values={structures}
            change={(next) => setStructure(next)}
          />
          <Slider
            label="step"
            value={step}
            min={0}
            max={1}
            step={0.001}
            text={walk ? `${at + 1} of ${walk.steps.length}` : "…"}
            change={setStep}
          />
        </>
      }
    >
      <Equation numbers={words(now)}>
        {structure === "nothing"
          ? "all objects, one after the other"
          : structure === "grid"
            ? "from cell to cell along the ray, until a hit lies inside the current cell"
            : "into a box only if the ray enters it before the closest hit"}
      </Equation>
      <Equation
        numbers={structures.map(([name, title], i) => (
          <span key={name}>
            {i > 0 && " · "}
            {title}: <b>{counted[i]?.tests ?? "…"}</b>
            {(counted[i]?.visits ?? 0) > 0 &&
              ` and ${counted[i]?.visits} ${name === "grid" ? "cells" : "nodes"}`}
          </span>
        ))}
      >
        tests of <Sym>{walk?.objects ?? 96}</Sym> objects
      </Equation>
    </Figure>
  );
}

function words(step: TraversalStep | null): string {
  if (!step) return "…";
  const hits = step.tests.filter((test) => test.t !== null).length;
  const tested = step.tests.length === 1 ? "1 object tested" : `${step.tests.length} objects tested`;
  if (step.tests.length === 0)
    return step.level === 0 && step.bounds
      ? "no objects to test here"
      : `a box on level ${step.level}: the boxes inside it are tested`;
  return `${tested}, ${hits} hit; closest t = ${step.closest === null ? "∞" : fixed(step.closest, 3)}`;
}

/** Returns the box of a step as a list with at most one element. */
function cube(step: TraversalStep): Traversal["boxes"] {
  if (!step.bounds) return [];
  const [low, high] = step.bounds;
  const corners: number[] = [];
  for (let i = 0; i < 8; i++) {
    corners.push((i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]);
  }
  return [{ level: step.level, corners }];
}

export const structure: Topic = {
  id: "structures",
  title: "Grid and tree",
  lead: "Most objects are far from the ray. Boxes exclude them before they are tested.",
  text: [
    "Without an acceleration structure, each ray is tested against every object: a million objects mean a million tests per ray. A grid divides space into equal cells, and stores which objects overlap each cell. The ray goes from cell to cell, and stops as soon as a hit lies inside the current cell.",
    "A tree of boxes groups nearby objects in a box, nearby boxes in a larger box, and so on. If the ray misses a box, it misses everything inside. If the ray enters a box behind the closest hit, the box can be skipped too. In Dürer’s tree, a box contains up to eight smaller boxes, because the processor can test eight at once.",
  ],
  Figure: StructuresFigure,
  questions: [
    {
      ask: "Where does the grid waste time?",
      answer:
        "In empty cells, and in cells that contain many objects: all cells have the same size, whatever is inside.",
    },
    {
      ask: "Why is the box that the ray enters first visited first?",
      answer:
        "A hit inside it is likely to be in front of the other boxes, which then need not be visited at all.",
    },
    {
      ask: "An object overlaps three cells of the grid. How often is it tested?",
      answer: "Up to three times, once in each cell that the ray visits. In the tree, it is in only one box.",
    },
  ],
};
