import { useState } from "preact/hooks";
import { fixed } from "../../ui/slider";
import { numberOf, useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { PlaneArrow, PlaneName, Plot, type Scale, WrongHit } from "../plot";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];
const center: Point = [1.1, 0];

function SphereFigure() {
  const [origin, setOrigin] = useState<Point>([-3.4, 0.3]);
  const [tip, setTip] = useState<Point>([-2, 0.45]);
  const [radius, setRadius] = useState(1.35);
  const [wrong, setWrong] = useState(false);
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.clay],
    group: `MaterialIndex 0 Sphere { center ${center[0]} ${center[1]} 0 radius ${radius} }`,
  });
  const session = useScene(text);
  const d: Point = [tip[0] - origin[0], tip[1] - origin[1]];
  const cast = useCast(session, [...origin, 0], [...d, 0], text);
  const [a, b, c, delta, t1, t2] = ["a", "b", "c", "Δ", "t₁", "t₂"].map((name) => numberOf(cast, 0, name));
  const roots = [t1, t2].filter((t) => t != null);
  const first = cast?.hit?.t ?? null;
  const wrongRoots = b == null || c == null ? [] : rootsFor(1, b, c);
  const at = (t: number): Point => [origin[0] + t * d[0], origin[1] + t * d[1]];
  return (
    <Figure
      ready={cast !== null}
      stage={
        <div class="stacked">
          <Plot reach={[4.8, 1.95]} aspect={2.4} label="A ray and a sphere in a plane that contains the ray">
            {(scale) => (
              <>
                <circle
                  cx={scale.x(center[0])}
                  cy={scale.y(center[1])}
                  r={radius * scale.unit}
                  fill="var(--solid)"
                  fill-opacity={0.14}
                  stroke="var(--ink)"
                  stroke-width={3}
                />
                <line
                  x1={scale.x(at(-9)[0])}
                  y1={scale.y(at(-9)[1])}
                  x2={scale.x(at(9)[0])}
                  y2={scale.y(at(9)[1])}
                  stroke="var(--ray-camera)"
                  stroke-width={1.5}
                  stroke-dasharray="6 6"
                />
                <PlaneArrow scale={scale} from={origin} to={tip} color="var(--ray-camera)" width={4} />
                <PlaneName scale={scale} at={origin} dy={-18}>
                  o
                </PlaneName>
                <PlaneName scale={scale} at={tip} color="var(--ray-camera)" dy={28}>
                  d
                </PlaneName>
                <PlaneName scale={scale} at={center} dx={-4} dy={-16}>
                  c
                </PlaneName>
                <circle cx={scale.x(center[0])} cy={scale.y(center[1])} r={4} fill="var(--ink)" />
                {roots.map((t, i) => {
                  const color =
                    t === first || Math.abs(t - (first ?? Number.NaN)) < 1e-5
                      ? "var(--ray-lit)"
                      : "var(--soft)";
                  return (
                    <g key={i}>
                      <circle cx={scale.x(at(t)[0])} cy={scale.y(at(t)[1])} r={8} fill={color} />
                      <PlaneName scale={scale} at={at(t)} color={color} dx={i === 0 ? -28 : 12} dy={-16}>
                        {i === 0 ? "t₁" : "t₂"}
                      </PlaneName>
                    </g>
                  );
                })}
                {wrong &&
                  wrongRoots.map((t, i) => <WrongHit key={i} scale={scale} at={at(t)} name={fixed(t)} />)}
                <Handle
                  x={scale.x(center[0] + radius * Math.SQRT1_2)}
                  y={scale.y(center[1] + radius * Math.SQRT1_2)}
                  color="var(--ink)"
                  label="The radius"
                  drag={(x, y) => {
                    const [px, py] = scale.back(x, y);
                    setRadius(Math.min(1.8, Math.max(0.3, Math.hypot(px - center[0], py - center[1]))));
                  }}
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
            )}
          </Plot>
          {a != null && b != null && c != null && (
            <Plot
              reach={[5, 1]}
              middle={[3, 0]}
              aspect={5}
              label="The parabola a t² + b t + c, which is 0 at the hits"
            >
              {(scale) => <Parabola scale={scale} abc={[a, b, c]} roots={roots} first={first} />}
            </Plot>
          )}
        </div>
      }
      controls={<Mistake name="a = 1, although d is not of length 1" on={wrong} change={setWrong} />}
    >
      <Equation
        numbers={
          <>
            {factor(b)}² − 4 · {fixed(a ?? Number.NaN)} · {factor(c)} = <b>{fixed(delta ?? Number.NaN, 3)}</b>
            {delta != null && delta < 0
              ? ": no hit"
              : roots.every((t) => t < 0)
                ? ": both behind"
                : first === t2
                  ? ": the origin is inside"
                  : ": two hits"}
          </>
        }
      >
        <Sym>Δ</Sym> = <Sym>b</Sym>² − 4 <Sym>a</Sym> <Sym>c</Sym>
      </Equation>
      <Equation
        numbers={
          <>
            {roots.length === 2 ? (
              <>
                <b>{fixed(roots[0] ?? 0, 3)}</b> and <b>{fixed(roots[1] ?? 0, 3)}</b>
              </>
            ) : (
              "no real root: the line misses the sphere"
            )}
            {wrong && (
              <Wrong>
                {wrongRoots.map((t) => fixed(t, 3)).join(" and ") || "no root"}: not on the sphere
              </Wrong>
            )}
          </>
        }
      >
        <Sym>t</Sym> = (−<Sym>b</Sym> ± √<Sym>Δ</Sym>) / 2<Sym>a</Sym>
      </Equation>
      <Equation
        numbers={
          <>
            a = <b>{fixed(a ?? Number.NaN)}</b>, b = <b>{fixed(b ?? Number.NaN)}</b>, c ={" "}
            <b>{fixed(c ?? Number.NaN)}</b>
          </>
        }
      >
        <Sym>a</Sym> = <Sym vector>d</Sym>·<Sym vector>d</Sym>, <Sym>b</Sym> = 2 <Sym vector>d</Sym>·(
        <Sym vector>o</Sym>−<Sym vector>c</Sym>), <Sym>c</Sym> = |<Sym vector>o</Sym>−<Sym vector>c</Sym>|² −{" "}
        <Sym>r</Sym>²
      </Equation>
    </Figure>
  );
}

/** Returns the real roots of a quadratic equation. */
function rootsFor(a: number, b: number, c: number): number[] {
  const root = Math.sqrt(b * b - 4 * a * c);
  return Number.isNaN(root) ? [] : [(-b - root) / (2 * a), (-b + root) / (2 * a)];
}

function factor(x: number | null | undefined): string {
  const text = fixed(x ?? Number.NaN);
  return text.startsWith("−") ? `(${text})` : text;
}

function Parabola({
  scale,
  abc: [a, b, c],
  roots,
  first,
}: {
  scale: Scale;
  abc: [number, number, number];
  roots: number[];
  first: number | null;
}) {
  // Normalise the depth of the parabola, except for rays that nearly touch the sphere.
  const steep = 1.15 * Math.max(0.4, Math.abs(b * b - 4 * a * c) / (4 * a));
  const points = [];
  for (let t = -2.5; t <= 8.5; t += 0.04)
    points.push(`${scale.x(t)},${scale.y((0.8 * (a * t * t + b * t + c)) / steep)}`);
  return (
    <>
      <line x1={0} x2={scale.width} y1={scale.y(0)} y2={scale.y(0)} stroke="var(--line)" stroke-width={2} />
      <line x1={scale.x(0)} x2={scale.x(0)} y1={0} y2={scale.height} stroke="var(--line)" stroke-width={2} />
      <polyline points={points.join(" ")} fill="none" stroke="var(--ray-reflected)" stroke-width={3} />
      {roots.map((t, i) => (
        <circle
          key={i}
          cx={scale.x(t)}
          cy={scale.y(0)}
          r={8}
          fill={Math.abs(t - (first ?? Number.NaN)) < 1e-5 ? "var(--ray-lit)" : "var(--soft)"}
        />
      ))}
      <text class="name" x={scale.width - 24} y={scale.y(0) - 10}>
        t
      </text>
      <text class="name" x={scale.x(0) + 8} y={22} fill="var(--ray-reflected)">
        a t² + b t + c
      </text>
    </>
  );
}

export const sphere: Topic = {
  id: "sphere",
  title: "Sphere",
  lead: "A line meets a sphere twice, once, or not at all: the discriminant decides.",
  text: [
    "Points of a sphere lie at distance r from its centre. Inserting the ray gives a quadratic equation in t. Its parabola below the figure is 0 where the line meets the sphere.",
    "Drag the ray past the sphere and watch the parabola rise above the line: the discriminant becomes negative. Drag the origin into the sphere: one root is negative, and the larger one is the hit.",
  ],
  Figure: SphereFigure,
  questions: [
    {
      ask: "When are both roots equal?",
      answer: "When the line touches the sphere: the discriminant is 0, and the parabola touches the line.",
    },
    { ask: "The origin is inside. Which root is the hit?", answer: "t₂: t₁ is negative, behind the origin." },
    {
      ask: "When is c negative?",
      answer: "When the origin is inside: its distance from the centre is less than r.",
    },
  ],
};
