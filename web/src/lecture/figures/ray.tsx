import { useState } from "preact/hooks";
import { add, type Eye, length, mul, sub, type Vec } from "../../explain/space";
import { fixed, Slider } from "../../ui/slider";
import { useCast, usePageBackground, useScene } from "../context";
import { Arrow, Dot, Line, Name } from "../draw";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Switch, Sym } from "../parts";
import { Point3 } from "../point";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

/** Size of the picture with the mistake. */
const [width, height] = [240, 180];

function RayFigure() {
  const background = usePageBackground();
  const text = sceneText({
    background,
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky],
    group: `MaterialIndex 0 Disc { center 0.6 -1.2 0 normal 0 1 0 radius 3.4 }
      MaterialIndex 1 Sphere { center 1.1 -0.2 0 radius 1 }
      MaterialIndex 2 Box { min 2.1 -1.2 -1.8 max 3.1 0.8 -0.8 }`,
  });
  const session = useScene(text);
  const [eye, setEye] = useState<Eye>({
    target: [0.25, -0.2, 0],
    distance: 11.5,
    yaw: 0.3,
    pitch: 0.3,
    angle: 38,
  });
  const [origin, setOrigin] = useState<Vec>([-3, 0.5, 0.4]);
  const [tip, setTip] = useState<Vec>([-2, 0.32, 0.3]);
  const [t, setT] = useState(2);
  const [normalised, setNormalised] = useState(false);
  const picture = useScene(text);
  const mistake = useFigureMistake(picture, "hits-behind", [width, height], [text]);
  const raw = sub(tip, origin);
  const direction = normalised ? mul(1 / Math.max(1e-6, length(raw)), raw) : raw;
  const cast = useCast(session, origin, direction, text);
  const point = add(origin, mul(t, direction));
  const hit = cast?.hit ?? null;
  return (
    <Figure
      ready={cast !== null}
      stage={
        <div class="beside">
          <Stage session={session} eye={eye} setEye={setEye} label="A ray in space, with a point on it">
            {(view) => (
              <>
                <Line
                  view={view}
                  from={origin}
                  to={add(origin, mul(8, direction))}
                  color="var(--ray-camera)"
                  width={1.5}
                  dashed
                />
                <Line
                  view={view}
                  from={origin}
                  to={add(origin, mul(-3, direction))}
                  color="var(--soft)"
                  width={1}
                  dashed
                />
                <Arrow view={view} from={origin} dir={direction} color="var(--ray-camera)" width={4} />
                {hit && <Dot view={view} at={hit.point} color="var(--ray-lit)" radius={6} />}
                <Dot view={view} at={point} color="var(--ray-shadowed)" radius={8} />
                <Name view={view} at={point} color="var(--ray-shadowed)">
                  P({fixed(t)})
                </Name>
                <Name view={view} at={tip} color="var(--ray-camera)" dy={26}>
                  d
                </Name>
                <Name view={view} at={origin} dx={-6} dy={-18}>
                  o
                </Name>
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
          {mistake.on && (
            <div class="inset below">
              <RenderedImage
                session={picture}
                width={width}
                height={height}
                label="The objects"
                mistaken={mistake.picture}
              />
            </div>
          )}
        </div>
      }
      controls={
        <>
          <Slider label="t" value={t} min={-2} max={6} step={0.01} text={fixed(t)} change={setT} />
          <Switch label="d of length 1" on={normalised} change={setNormalised} />
          <MistakeSwitch name="count hits behind the origin" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            = ({origin.map((x) => fixed(x)).join(", ")}) + <b>{fixed(t)}</b> (
            {direction.map((x) => fixed(x)).join(", ")}) = ({point.map((x) => fixed(x)).join(", ")})
          </>
        }
      >
        <Sym vector color="var(--ray-shadowed)">
          P
        </Sym>
        (<Sym>t</Sym>) = <Sym vector>o</Sym> + <Sym>t</Sym>{" "}
        <Sym vector color="var(--ray-camera)">
          d
        </Sym>
      </Equation>
      <Equation
        numbers={
          hit ? (
            <>
              the first hit lies at t = <b>{fixed(hit.t, 3)}</b>, at a distance of t |d| ={" "}
              <b>{fixed(hit.t * length(direction), 3)}</b>
            </>
          ) : (
            "this ray hits nothing"
          )
        }
      >
        <Sym>t</Sym> &gt; 0 in front, <Sym>t</Sym> &lt; 0 behind
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

export const ray: Topic = {
  id: "ray",
  title: "Rays",
  lead: "A ray has an origin and a direction. One number, t, selects a point on it.",
  text: [
    "Slide t: the point P moves along the line through o in the direction d. At t = 0 it is the origin; points with negative t are behind it and do not belong to the ray. The direction may have any length. t counts in lengths of d, so it is a distance only if d has length 1.",
    "To trace a ray means to find the smallest positive t at which its point lies on a surface.",
  ],
  Figure: RayFigure,
  questions: [
    {
      ask: "You make d twice as long. What happens to t at the hit?",
      answer:
        "It is halved: the point stays the same, and t counts in lengths of d. Drag the end of d to see it.",
    },
    {
      ask: "Why is a hit with negative t not drawn?",
      answer: "It lies behind the origin: a camera would see objects behind itself.",
    },
  ],
};
