import { useState } from "preact/hooks";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene } from "../context";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Sym } from "../parts";
import { PlaneName, Plot } from "../plot";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

const [width, height] = [480, 400];
/** Half the visible width at the front sphere. */
const half = 1.9;
const things: { x: number; z: number; r: number; color: string }[] = [
  { x: -0.9, z: 0, r: 0.7, color: "#b7663f" },
  { x: 0.35, z: -2.6, r: 0.7, color: "#4c79a8" },
  { x: 1.35, z: -5.2, r: 0.7, color: "#c8a45a" },
];

function ProjectionFigure() {
  const background = usePageBackground();
  const [angle, setAngle] = useState(60);
  const parallel = angle <= 1;
  const distance = half / Math.tan((Math.max(angle, 1) * Math.PI) / 360);
  const scene = sceneText({
    background,
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky, materialPresets.sand],
    group: `MaterialIndex 0 Box { min -3 -0.8 -6.4 max 3 -0.7 1 }
      ${things.map(({ x, z, r }, i) => `MaterialIndex ${i + 1} Sphere { center ${x} 0 ${z} radius ${r} }`).join("\n")}`,
  });
  const camera = parallel
    ? `OrthographicCamera { center 0 0.55 12 direction 0 -0.02 -1 up 0 1 0 size ${2 * half} }`
    : `PerspectiveCamera { center 0 0.55 ${distance} direction 0 ${-0.35 / Math.max(distance, 6)} -1 up 0 1 0 angle ${angle} }`;
  const text = scene.replace(/^.*\n/, `${camera}\n`);
  const session = useScene(text, [{ name: "samples", value: "4" }]);
  const name = parallel ? "size" : "angle-inverted";
  const mistake = useFigureMistake(session, name, [width / 2, height / 2], [text]);
  return (
    <Figure
      stage={
        <div class="halves">
          <RenderedImage
            session={session}
            width={width}
            height={height}
            label="The image: three spheres of equal size, one behind the other"
            mistaken={mistake.picture}
          />
          <Plot reach={[4.4, 5]} middle={[0, 1.4]} aspect={width / height} label="The rays from above">
            {(scale) => (
              <>
                {[-1, -0.5, 0, 0.5, 1].map((x) => {
                  const top = -7;
                  const start: [number, number] = parallel ? [x * half, 3] : [0, distance];
                  const spread = parallel ? x * half : (x * half * (distance - top)) / distance;
                  return (
                    <line
                      key={x}
                      x1={scale.x(start[0])}
                      y1={scale.y(-start[1])}
                      x2={scale.x(spread)}
                      y2={scale.y(-top)}
                      stroke="var(--ray-camera)"
                      stroke-width={2}
                    />
                  );
                })}
                {things.map(({ x, z, r, color }) => (
                  <circle key={z} cx={scale.x(x)} cy={scale.y(-z)} r={r * scale.unit} fill={color} />
                ))}
                <line
                  x1={scale.x(-half)}
                  x2={scale.x(half)}
                  y1={scale.y(0)}
                  y2={scale.y(0)}
                  stroke="var(--ink)"
                  stroke-width={3}
                />
                {!parallel && distance < 3.5 && (
                  <>
                    <circle cx={scale.x(0)} cy={scale.y(-distance)} r={6} fill="var(--ink)" />
                    <PlaneName scale={scale} at={[0, -distance]}>
                      eye
                    </PlaneName>
                  </>
                )}
              </>
            )}
          </Plot>
        </div>
      }
      controls={
        <>
          <Slider
            label="angle"
            value={angle}
            min={1}
            max={110}
            step={1}
            text={parallel ? "parallel" : `${angle}°`}
            change={setAngle}
          />
          <MistakeSwitch
            name={parallel ? "size without the half" : "forget the reciprocal"}
            mistake={mistake}
          />
        </>
      }
    >
      <Equation
        numbers={
          parallel ? (
            "all rays are parallel: size is independent of distance"
          ) : (
            <>
              {fixed(half, 1)} / tan {angle / 2}° = <b>{fixed(distance, 2)}</b>
            </>
          )
        }
      >
        <Sym>distance</Sym> = <Sym>half width</Sym> / tan(<Sym>angle</Sym> / 2)
      </Equation>
      <Equation numbers={parallel ? <b>1 : 1</b> : <b>1 : {fixed((distance + 5.2) / distance, 2)}</b>}>
        the sphere in front appears larger than the last
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

export const projection: Topic = {
  id: "projection",
  title: "Perspective and orthographic projection",
  lead: "Move back and narrow the angle at the same time: perspective turns into a parallel projection.",
  text: [
    "The three spheres have equal size. From nearby, the rays diverge from the eye, and far objects appear small. The slider narrows the angle and moves the eye back so that the first sphere keeps its size: film makers call this a dolly zoom.",
    "At the end, all rays are parallel. This is the orthographic camera: lengths can be measured in its images, and objects do not shrink with distance.",
  ],
  Figure: ProjectionFigure,
  questions: [
    {
      ask: "Why do faces look odd in photographs taken from very close?",
      answer:
        "In proportion, the nose is much nearer than the ears. The distance is the cause, not the lens.",
    },
    {
      ask: "Where is the eye of an orthographic camera?",
      answer: "Infinitely far away: each pixel has its own ray origin.",
    },
  ],
};
