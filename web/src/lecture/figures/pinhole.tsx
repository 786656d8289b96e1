import { useState } from "preact/hooks";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Sym } from "../parts";
import { PlaneArrow, PlaneName, Plot, type Scale } from "../plot";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];

function PinholeFigure() {
  const [hole, setHole] = useState(0.05);
  const [film, setFilm] = useState(1);
  const [top, setTop] = useState<Point>([2.6, 1.1]);
  const [width, height] = [360, 300];
  // The film is 1 high and wide: the angle narrows as its distance grows.
  const angle = (2 * Math.atan(0.5 / film) * 180) / Math.PI;
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky, materialPresets.sand],
    group: `MaterialIndex 0 Disc { center 0 -0.6 -4 normal 0 1 0 radius 4.6 }
      MaterialIndex 1 Sphere { center -0.75 0 -2.4 radius 0.6 }
      MaterialIndex 2 Sphere { center 0.5 0 -4.2 radius 0.6 }
      MaterialIndex 3 Sphere { center 2.1 0 -6.4 radius 0.6 }`,
  }).replace(
    /^.*\n/,
    `PinholeCamera { center 0 0.25 1 direction 0 -0.06 -1 up 0 1 0 angle ${angle} hole ${hole} filmDistance ${film} }\n`,
  );
  const session = useScene(text, [{ name: "samples", value: "48" }]);
  // This is small, because a blurred picture needs many samples.
  const mistake = useFigureMistake(session, "turned", [0.4 * width, 0.4 * height], [text]);
  const [z, h] = top;
  const image = (-h * film) / z;
  const blur = hole * (1 + film / z);
  return (
    <Figure
      stage={
        <div class="halves">
          <RenderedImage
            session={session}
            width={width}
            height={height}
            label="Three balls of equal size, seen through the hole"
            mistaken={mistake.picture}
          />
          <Plot
            reach={[2.95, 1.9]}
            middle={[1.05, 0]}
            aspect={width / height}
            label="The camera from the side: object, hole and film"
          >
            {(scale) => (
              <>
                <Box scale={scale} film={film} hole={hole} />
                {[hole / 2, -hole / 2].map((edge) => (
                  <Beam key={edge} scale={scale} top={top} edge={edge} film={film} />
                ))}
                <PlaneArrow scale={scale} from={[z, 0]} to={top} color="var(--ray-camera)" width={5} />
                <PlaneArrow
                  scale={scale}
                  from={[-film, 0]}
                  to={[-film, image]}
                  color="var(--ray-shadowed)"
                  width={5}
                />
                <line
                  x1={scale.x(-film)}
                  x2={scale.x(-film)}
                  y1={scale.y(image - blur / 2)}
                  y2={scale.y(image + blur / 2)}
                  stroke="var(--ray-scattered)"
                  stroke-width={7}
                />
                <PlaneName scale={scale} at={[z, h / 2]} color="var(--ray-camera)">
                  h
                </PlaneName>
                <PlaneName scale={scale} at={[-film, image / 2]} color="var(--ray-shadowed)" dx={14}>
                  h′
                </PlaneName>
                <Handle
                  x={scale.x(z)}
                  y={scale.y(h)}
                  color="var(--ray-camera)"
                  label="Top of the object"
                  drag={(x, y) => {
                    const [px, py] = scale.back(x, y);
                    setTop([Math.min(3.8, Math.max(0.5, px)), Math.min(1.7, Math.max(-1.7, py))]);
                  }}
                />
              </>
            )}
          </Plot>
        </div>
      }
      controls={
        <>
          <Slider
            label="hole"
            value={hole}
            min={0}
            max={0.5}
            step={0.005}
            text={fixed(hole, 3)}
            change={setHole}
          />
          <Slider
            label="film distance"
            value={film}
            min={0.4}
            max={1.6}
            step={0.01}
            text={fixed(film)}
            change={setFilm}
          />
          <MistakeSwitch name="forget the minus sign" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            −{fixed(h)} · {fixed(film)} / {fixed(z)} = <b>{fixed(image, 3)}</b>
          </>
        }
      >
        <Sym color="var(--ray-shadowed)">h</Sym>′ = −<Sym color="var(--ray-camera)">h</Sym> <Sym>f</Sym> /{" "}
        <Sym>z</Sym>
      </Equation>
      <Equation
        numbers={
          <>
            {fixed(hole, 3)} · (1 + {fixed(film)} / {fixed(z)}) = <b>{fixed(blur, 3)}</b>
          </>
        }
      >
        <Sym color="var(--ray-scattered)">blur</Sym> = <Sym>hole</Sym> (1 + <Sym>f</Sym> / <Sym>z</Sym>)
      </Equation>
      <Equation
        numbers={
          <>
            2 atan(0.5 / {fixed(film)}) = <b>{fixed(angle, 1)}°</b>
          </>
        }
      >
        <Sym>angle</Sym> = 2 atan(<Sym>half film</Sym> / <Sym>f</Sym>)
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

/** Draws the camera obscura: walls, the film, and the wall with the hole. */
function Box({ scale, film, hole }: { scale: Scale; film: number; hole: number }) {
  const gap = Math.max(hole / 2, 0.004);
  const [back, front, up] = [scale.x(-film), scale.x(0), 1.35];
  const wall = { stroke: "var(--ink)", "stroke-width": 4, "stroke-linecap": "round" } as const;
  return (
    <g>
      <rect
        x={back}
        y={scale.y(up)}
        width={front - back}
        height={scale.y(-up) - scale.y(up)}
        fill="var(--solid)"
        fill-opacity={0.14}
      />
      <polyline
        points={`${front},${scale.y(gap)} ${front},${scale.y(up)} ${back},${scale.y(up)} ${back},${scale.y(-up)} ${front},${scale.y(-up)} ${front},${scale.y(-gap)}`}
        fill="none"
        {...wall}
      />
      <line
        x1={scale.x(-2.2)}
        x2={scale.width}
        y1={scale.y(0)}
        y2={scale.y(0)}
        stroke="var(--line)"
        stroke-width={2}
      />
    </g>
  );
}

/** Draws a ray from the top of the object through one edge of the hole. */
function Beam({ scale, top: [z, h], edge, film }: { scale: Scale; top: Point; edge: number; film: number }) {
  const end: Point = [-film, edge + ((edge - h) * film) / z];
  return (
    <line
      x1={scale.x(z)}
      y1={scale.y(h)}
      x2={scale.x(end[0])}
      y2={scale.y(end[1])}
      stroke="var(--ray-camera)"
      stroke-width={1.8}
    />
  );
}

export const pinhole: Topic = {
  id: "pinhole",
  title: "The pinhole",
  lead: "A dark room with a hole in its wall: each point outside illuminates one spot, and the image is inverted.",
  text: [
    "Light from a point passes through the hole straight to the film. Two similar triangles meet in the hole, so the ratio of the image size to the object size is that of the film distance to the object distance: the image is inverted, and far objects appear small.",
    "A real hole has a size. Rays from one point pass through it at different places and illuminate a patch instead of a spot. A smaller hole gives a sharper image, but a darker one in a real camera. A ray tracer can use a hole of size 0.",
  ],
  Figure: PinholeFigure,
  questions: [
    {
      ask: "Which objects are more blurred, near or far ones?",
      answer: "Near ones: the patch is the hole times 1 + f / z, and f / z grows towards the camera.",
    },
    {
      ask: "Why do ray tracers put the image plane in front of the eye, and not behind it?",
      answer:
        "The triangles are the same. In front of the eye, the image is upright, without a negative sign.",
    },
  ],
};
