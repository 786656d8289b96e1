import { useState } from "preact/hooks";
import { fixed, Slider } from "../../ui/slider";
import { useCast, useScene } from "../context";
import { Handle } from "../draw";
import { Choice, Equation, Figure, Mistake, Sym } from "../parts";
import { PlaneArrow, PlaneName, Plot, type Scale } from "../plot";
import type { Topic } from "../topic";

type Point = [number, number];

/** Scene of the plane w = 1, which lines through the origin intersect. */
const scene = `PerspectiveCamera { center 0 0 9 direction 0 0 -1 up 0 1 0 angle 40 }
Group { Plane { normal 0 1 0 offset 1 } }
`;

function HomogeneousFigure() {
  const [[x, w], setPoint] = useState<Point>([1.6, 2]);
  const [shift, setShift] = useState(0);
  const [undivided, setUndivided] = useState(false);
  const session = useScene(scene);
  const moved: Point = [x + shift * w, w];
  // The line through the origin is a ray, and w = 1 a plane: t is 1 / w.
  const cast = useCast(session, [0, 0, 0], w < 0 ? [-moved[0], -w, 0] : [moved[0], w, 0], scene);
  const met = cast?.hit?.point[0] ?? null;
  const shown = undivided ? moved[0] : met;
  return (
    <Figure
      ready={cast !== null}
      stage={
        <Plot reach={[4.8, 2.7]} middle={[0, 1.2]} label="Points with a weight w, and the line w = 1">
          {(scale) => (
            <>
              <Axes scale={scale} />
              {met !== null && <Through scale={scale} at={met} />}
              {shift !== 0 && (
                <PlaneArrow scale={scale} from={[x, w]} to={moved} color="var(--ray-scattered)" width={3} />
              )}
              <PlaneArrow scale={scale} from={[0, 0]} to={moved} color="var(--ray-camera)" width={4} />
              <PlaneName scale={scale} at={moved} color="var(--ray-camera)" dy={-16}>
                ({fixed(moved[0])}, {fixed(w)})
              </PlaneName>
              {shown !== null && (
                <>
                  <circle
                    cx={scale.x(shown)}
                    cy={scale.y(1)}
                    r={9}
                    fill={
                      undivided && Math.abs(shown - (met ?? shown)) > 1e-6
                        ? "var(--ray-shadowed)"
                        : "var(--ray-lit)"
                    }
                  />
                  <PlaneName scale={scale} at={[shown, 1]} color="var(--ink)" dy={34}>
                    {fixed(shown)}
                  </PlaneName>
                </>
              )}
              <Handle
                x={scale.x(x)}
                y={scale.y(w)}
                color="var(--ray-camera)"
                label="The point with its weight"
                drag={(px, py) => {
                  const [nx, nw] = scale.back(px, py);
                  setPoint([clamp(nx, 4.4), Math.abs(nw) < 0.05 ? 0 : Math.max(-1.2, Math.min(3.7, nw))]);
                }}
              />
            </>
          )}
        </Plot>
      }
      controls={
        <>
          <Slider
            label="move by"
            value={shift}
            min={-2}
            max={2}
            step={0.01}
            text={fixed(shift)}
            change={setShift}
          />
          <Choice
            label="Weight"
            value={w === 1 ? "point" : w === 0 ? "direction" : "other"}
            values={[
              ["point", "Point: w = 1"],
              ["direction", "Direction: w = 0"],
            ]}
            change={(kind) => setPoint([x, kind === "point" ? 1 : 0])}
          />
          <Mistake name="forget to divide" on={undivided} change={setUndivided} />
        </>
      }
    >
      <Equation
        numbers={
          met === null ? (
            "w = 0: the line is parallel to w = 1 and never meets it. It is a direction"
          ) : (
            <>
              {fixed(moved[0])} / {fixed(w)} = <b>{fixed(met, 3)}</b>
            </>
          )
        }
      >
        (<Sym>x</Sym>, <Sym>w</Sym>) represents <Sym>x</Sym> / <Sym>w</Sym>
      </Equation>
      <Equation
        numbers={
          <>
            {fixed(x)} + {fixed(shift)} · {fixed(w)} = <b>{fixed(moved[0], 3)}</b>
          </>
        }
      >
        translated by <Sym>s</Sym>: <Sym>x</Sym>′ = <Sym>x</Sym> + <Sym>s</Sym> <Sym>w</Sym>
      </Equation>
    </Figure>
  );
}

function clamp(x: number, most: number): number {
  return Math.max(-most, Math.min(most, x));
}

function Axes({ scale }: { scale: Scale }) {
  const line = (from: Point, to: Point, color: string, width: number) => (
    <line
      x1={scale.x(from[0])}
      y1={scale.y(from[1])}
      x2={scale.x(to[0])}
      y2={scale.y(to[1])}
      stroke={color}
      stroke-width={width}
    />
  );
  return (
    <>
      {line([-9, 0], [9, 0], "var(--line)", 2)}
      {line([0, -3], [0, 6], "var(--line)", 2)}
      {line([-9, 1], [9, 1], "var(--ink)", 3)}
      <PlaneName scale={scale} at={[-4.7, 1]} dx={4}>
        w = 1
      </PlaneName>
      <PlaneName scale={scale} at={[0, 3.7]} dx={10} dy={18}>
        w
      </PlaneName>
      <PlaneName scale={scale} at={[4.5, 0]} dx={0} dy={-10}>
        x
      </PlaneName>
    </>
  );
}

/** Draws the line through the origin and a point of w = 1. All its points represent the same position. */
function Through({ scale, at }: { scale: Scale; at: number }) {
  return (
    <line
      x1={scale.x(-4 * at)}
      y1={scale.y(-4)}
      x2={scale.x(6 * at)}
      y2={scale.y(6)}
      stroke="var(--ray-camera)"
      stroke-width={1.5}
      stroke-dasharray="6 6"
    />
  );
}

export const homogeneous: Topic = {
  id: "homogeneous",
  title: "Homogeneous coordinates",
  lead: "With one more coordinate per point, a translation is also a product with a matrix.",
  text: [
    "Each point gets a weight w. All points on a line through the origin represent the same position: the one where the line meets w = 1, which is x divided by w. Drag the point along its line, and the position stays the same.",
    "A matrix can now translate: it adds s times w to x. A point with w = 1 moves by s. A direction has w = 0 and does not change, because a direction has no position. In the figure, the translation is a shear of the plane of x and w.",
    "Perspective projection is the same division, with the distance from the eye as w.",
  ],
  Figure: HomogeneousFigure,
  questions: [
    {
      ask: "Which position does (3, 1.5) represent, and which (−3, −1.5)?",
      answer: "Both represent 2: they lie on the same line through the origin.",
    },
    {
      ask: "Why does a ray’s direction have w = 0?",
      answer:
        "A direction is the difference of two points, so their weights of 1 cancel. A translation therefore changes only the ray’s origin.",
    },
    {
      ask: "What happens to the position when w approaches 0?",
      answer: "It goes to infinity: the line becomes parallel to w = 1.",
    },
  ],
};
