import { useState } from "preact/hooks";
import { fixed } from "../../ui/slider";
import { numberOf, useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { PlaneArrow, PlaneName, Plot, WrongHit } from "../plot";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];

function PlaneFigure() {
  const [origin, setOrigin] = useState<Point>([-3.2, 1.9]);
  const [tip, setTip] = useState<Point>([-1.9, 1.2]);
  const [foot, setFoot] = useState<Point>([0.4, -0.9]);
  const [turn, setTurn] = useState(1.35);
  const [wrong, setWrong] = useState(false);
  const n: Point = [Math.cos(turn), Math.sin(turn)];
  const offset = n[0] * foot[0] + n[1] * foot[1];
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.stone],
    group: `MaterialIndex 0 Plane { normal ${n[0]} ${n[1]} 0 offset ${offset} }`,
  });
  const session = useScene(text);
  const d: Point = [tip[0] - origin[0], tip[1] - origin[1]];
  const cast = useCast(session, [...origin, 0], [...d, 0], text);
  const [no, nd, t] = ["n · o", "n · d", "t"].map((name) => numberOf(cast, 0, name));
  const shown = t != null && Math.abs(t) < 60;
  const hit: Point = shown ? [origin[0] + t * d[0], origin[1] + t * d[1]] : origin;
  const forward = shown && t > 0;
  const wrongT = no == null || nd == null ? null : (-offset - no) / nd;
  const along = (s: number): Point => [foot[0] - n[1] * s, foot[1] + n[0] * s];
  return (
    <Figure
      ready={cast !== null}
      stage={
        <Plot reach={[4.8, 2.7]} label="A ray and a plane, seen from the side">
          {(scale) => {
            const ends = [along(-12), along(12)] as const;
            return (
              <>
                <polygon
                  points={[
                    along(-12),
                    along(12),
                    ...[along(12), along(-12)].map(([x, y]) => [x - 9 * n[0], y - 9 * n[1]] as Point),
                  ]
                    .map(([x, y]) => `${scale.x(x)},${scale.y(y)}`)
                    .join(" ")}
                  fill="var(--solid)"
                  fill-opacity={0.14}
                />
                <line
                  x1={scale.x(ends[0][0])}
                  y1={scale.y(ends[0][1])}
                  x2={scale.x(ends[1][0])}
                  y2={scale.y(ends[1][1])}
                  stroke="var(--ink)"
                  stroke-width={3}
                />
                <PlaneArrow
                  scale={scale}
                  from={foot}
                  to={[foot[0] + n[0], foot[1] + n[1]]}
                  color="var(--normal)"
                />
                <PlaneName scale={scale} at={[foot[0] + n[0], foot[1] + n[1]]} color="var(--normal)">
                  n
                </PlaneName>
                {shown && (
                  <line
                    x1={scale.x(origin[0])}
                    y1={scale.y(origin[1])}
                    x2={scale.x(hit[0])}
                    y2={scale.y(hit[1])}
                    stroke={forward ? "var(--ray-camera)" : "var(--ray-shadowed)"}
                    stroke-width={2}
                    stroke-dasharray={forward ? undefined : "6 6"}
                  />
                )}
                <PlaneArrow scale={scale} from={origin} to={tip} color="var(--ray-camera)" width={4} />
                <PlaneName scale={scale} at={origin} dy={-18}>
                  o
                </PlaneName>
                <PlaneName scale={scale} at={tip} color="var(--ray-camera)" dy={28}>
                  d
                </PlaneName>
                {shown && (
                  <>
                    <circle
                      cx={scale.x(hit[0])}
                      cy={scale.y(hit[1])}
                      r={8}
                      fill={forward ? "var(--ray-lit)" : "var(--ray-shadowed)"}
                    />
                    <PlaneName
                      scale={scale}
                      at={hit}
                      color={forward ? "var(--ray-lit)" : "var(--ray-shadowed)"}
                      dy={32}
                    >
                      t = {fixed(t)}
                    </PlaneName>
                  </>
                )}
                {wrong && wrongT !== null && Math.abs(wrongT) < 60 && (
                  <WrongHit
                    scale={scale}
                    at={[origin[0] + wrongT * d[0], origin[1] + wrongT * d[1]]}
                    name={`t = ${fixed(wrongT)}`}
                  />
                )}
                <Handle
                  x={scale.x(foot[0] + n[0])}
                  y={scale.y(foot[1] + n[1])}
                  color="var(--normal)"
                  label="Tip of the normal"
                  drag={(x, y) => {
                    const [px, py] = scale.back(x, y);
                    setTurn(Math.atan2(py - foot[1], px - foot[0]));
                  }}
                />
                <Handle
                  x={scale.x(foot[0])}
                  y={scale.y(foot[1])}
                  color="var(--ink)"
                  label="The plane"
                  drag={(x, y) => setFoot(scale.back(x, y))}
                />
                <Handle
                  x={scale.x(tip[0])}
                  y={scale.y(tip[1])}
                  color="var(--ray-camera)"
                  label="End of the direction"
                  drag={(x, y) => setTip(scale.back(x, y))}
                />
                <Handle
                  x={scale.x(origin[0])}
                  y={scale.y(origin[1])}
                  color="var(--ray-camera)"
                  label="Origin of the ray"
                  drag={(x, y) => {
                    const to = scale.back(x, y);
                    setTip([tip[0] + to[0] - origin[0], tip[1] + to[1] - origin[1]]);
                    setOrigin(to);
                  }}
                />
              </>
            );
          }}
        </Plot>
      }
      controls={<Mistake name="n · p + offset = 0" on={wrong} change={setWrong} />}
    >
      <Equation
        numbers={
          t == null ? (
            "n · d = 0: the ray is parallel to the plane"
          ) : (
            <>
              ({fixed(offset)} − {sign(no)}) / {sign(nd)} = <b>{fixed(t, 3)}</b>
              {t < 0 && " < 0: behind the origin, no hit"}
              {wrong && wrongT !== null && (
                <Wrong>
                  ({fixed(-offset)} − {sign(no)}) / {sign(nd)} = {fixed(wrongT, 3)}: not on the plane
                </Wrong>
              )}
            </>
          )
        }
      >
        <Sym>t</Sym> = (<Sym>offset</Sym> − <Sym vector>n</Sym> · <Sym vector>o</Sym>) / (<Sym vector>n</Sym>{" "}
        · <Sym vector>d</Sym>)
      </Equation>
      <Equation
        numbers={
          <>
            n · o = <b>{fixed(no ?? Number.NaN, 3)}</b>, n · d = <b>{fixed(nd ?? Number.NaN, 3)}</b>
          </>
        }
      >
        <Sym vector>n</Sym> · (<Sym vector>o</Sym> + <Sym>t</Sym> <Sym vector>d</Sym>) = <Sym>offset</Sym>
      </Equation>
    </Figure>
  );
}

function sign(x: number | null | undefined): string {
  const text = fixed(x ?? Number.NaN, 3);
  return text.startsWith("−") ? `(${text})` : text;
}

export const plane: Topic = {
  id: "plane",
  title: "Plane",
  lead: "Insert the ray into the equation of the plane and solve for t: one division.",
  text: [
    "All points of a plane have the same dot product with its normal: n · p = offset. A point of the ray is o + t d; in the equation, only t is unknown.",
    "Rotate the ray until it is parallel to the plane: n · d approaches 0, and t goes to infinity. Rotate it further, and t is negative: the line meets the plane behind the origin.",
  ],
  Figure: PlaneFigure,
  questions: [
    {
      ask: "What is the sign of n · d if the ray comes from the front?",
      answer: "Negative: the ray points against the normal.",
    },
    {
      ask: "May the length of n differ from 1?",
      answer: "Yes. Then n · o, n · d and the offset scale by that length, and t does not change.",
    },
  ],
};
