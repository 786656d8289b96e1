import { useState } from "preact/hooks";
import { fixed } from "../../ui/slider";
import { useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { Choice, Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { PlaneArrow, PlaneName, Plot, type Scale, WrongHit } from "../plot";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];
type Operation = "Merge" | "Intersection" | "Difference";
type Interval = [number, number];
const radii = [1.25, 1] as const;
const colors = ["var(--ray-camera)", "var(--ray-scattered)"] as const;

/** Returns the interval of t in which a line is inside a circle; `null` if there is none. */
function interval(origin: Point, d: Point, center: Point, radius: number): Interval | null {
  const o: Point = [origin[0] - center[0], origin[1] - center[1]];
  const [a, b, c] = [d[0] ** 2 + d[1] ** 2, o[0] * d[0] + o[1] * d[1], o[0] ** 2 + o[1] ** 2 - radius ** 2];
  const root = b * b - a * c;
  return root < 0 ? null : [(-b - Math.sqrt(root)) / a, (-b + Math.sqrt(root)) / a];
}

/** Returns the intervals of t inside the combined solid, in order. */
export function combined(operation: Operation, a: Interval | null, b: Interval | null): Interval[] {
  const ends = [...(a ?? []), ...(b ?? [])].sort((x, y) => x - y);
  const within = (t: number, i: Interval | null) => i !== null && t > i[0] && t < i[1];
  const all: Interval[] = [];
  ends.forEach((start, i) => {
    const end = ends[i + 1];
    if (end === undefined || end - start < 1e-9) return;
    const middle = (start + end) / 2;
    const [inA, inB] = [within(middle, a), within(middle, b)];
    const keeps = { Merge: inA || inB, Intersection: inA && inB, Difference: inA && !inB }[operation];
    const last = all.at(-1);
    if (keeps && last && Math.abs(last[1] - start) < 1e-9) last[1] = end;
    else if (keeps) all.push([start, end]);
  });
  return all;
}

function SolidsFigure() {
  const [operation, setOperation] = useState<Operation>("Difference");
  const [centers, setCenters] = useState<[Point, Point]>([
    [0.45, 0.6],
    [-0.9, 0.3],
  ]);
  const [wrong, setWrong] = useState(false);
  const [origin, setOrigin] = useState<Point>([-3.4, 0.25]);
  const [tip, setTip] = useState<Point>([-2.4, 0.32]);
  const d: Point = [tip[0] - origin[0], tip[1] - origin[1]];
  const balls = centers.map(([x, y], i) => `Sphere { center ${x} ${y} 0 radius ${radii[i]} }`).join(" ");
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.clay],
    group: `MaterialIndex 0 ${operation} { ${balls} }`,
  });
  const session = useScene(text);
  const cast = useCast(session, [...origin, 0], [...d, 0], text);
  const [a, b] = centers.map((center, i) => interval(origin, d, center, radii[i] ?? 1)) as [
    Interval | null,
    Interval | null,
  ];
  const result = combined(operation, a, b);
  const t = cast?.hit?.t ?? null;
  const wrongT = Math.min(...[...(a ?? []), ...(b ?? [])].filter((end) => end > 0));
  const at = (s: number): Point => [origin[0] + s * d[0], origin[1] + s * d[1]];
  return (
    <Figure
      ready={cast !== null}
      stage={
        <Plot
          reach={[4.4, 2.6]}
          middle={[0, -0.25]}
          label="Two spheres, a ray, and the intervals of t inside each"
        >
          {(scale) => (
            <>
              {centers.map((center, i) => (
                <circle
                  key={i}
                  cx={scale.x(center[0])}
                  cy={scale.y(center[1])}
                  r={(radii[i] ?? 1) * scale.unit}
                  fill={colors[i]}
                  fill-opacity={0.12}
                  stroke={colors[i]}
                  stroke-width={2.5}
                  stroke-dasharray={operation === "Difference" && i === 1 ? "7 7" : undefined}
                />
              ))}
              <PlaneArrow
                scale={scale}
                from={at(-0.4)}
                to={at(9)}
                color="var(--soft)"
                width={1.5}
                dashed
                head={false}
              />
              {result.map(([start, end]) => (
                <PlaneArrow
                  key={start}
                  scale={scale}
                  from={at(start)}
                  to={at(end)}
                  color="var(--ray-lit)"
                  width={8}
                  head={false}
                />
              ))}
              <PlaneArrow scale={scale} from={origin} to={tip} color="var(--ink)" width={4} />
              {t !== null && (
                <>
                  <circle cx={scale.x(at(t)[0])} cy={scale.y(at(t)[1])} r={9} fill="var(--ray-shadowed)" />
                  <PlaneName scale={scale} at={at(t)} color="var(--ray-shadowed)" dy={-20}>
                    t = {fixed(t)}
                  </PlaneName>
                </>
              )}
              {wrong && Number.isFinite(wrongT) && (
                <WrongHit scale={scale} at={at(wrongT)} name={`t = ${fixed(wrongT)}`} />
              )}
              <Bars scale={scale} rows={[a ? [a] : [], b ? [b] : [], result]} />
              {centers.map((center, i) => (
                <Handle
                  key={i}
                  x={scale.x(center[0])}
                  y={scale.y(center[1])}
                  color={colors[i] ?? ""}
                  label={i === 0 ? "Sphere A" : "Sphere B"}
                  drag={(x, y) => setCenters(centers.with(i, scale.back(x, y)) as [Point, Point])}
                />
              ))}
              <Handle
                x={scale.x(tip[0])}
                y={scale.y(tip[1])}
                color="var(--ink)"
                label="End of the direction"
                drag={(x, y) => setTip(scale.back(x, y))}
              />
              <Handle
                x={scale.x(origin[0])}
                y={scale.y(origin[1])}
                color="var(--ink)"
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
      }
      controls={
        <>
          <Choice
            label="Operation"
            value={operation}
            values={[
              ["Merge", "A ∪ B"],
              ["Intersection", "A ∩ B"],
              ["Difference", "A − B"],
            ]}
            change={(value) => setOperation(value)}
          />
          <Mistake name="take the closest hit of A and B" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            A: {spelled(a ? [a] : [])}, B: {spelled(b ? [b] : [])}, together <b>{spelled(result)}</b>
          </>
        }
      >
        in for <Sym>t</Sym> of the intervals of{" "}
        {operation === "Merge" ? "A or B" : operation === "Intersection" ? "A and B" : "A and not B"}
      </Equation>
      <Equation
        numbers={
          <>
            {t === null ? "the ray misses the solid" : "the solid is hit at "}
            {t !== null && <b>{fixed(t, 3)}</b>}
            {wrong && Number.isFinite(wrongT) && Math.abs(wrongT - (t ?? 0)) > 1e-4 && (
              <Wrong>{fixed(wrongT, 3)}: not on the solid</Wrong>
            )}
          </>
        }
      >
        the hit is the first end with <Sym>t</Sym> &gt; 0
      </Equation>
    </Figure>
  );
}

function spelled(intervals: Interval[]): string {
  return intervals.length === 0 ? "∅" : intervals.map(([a, b]) => `[${fixed(a)}, ${fixed(b)}]`).join(" ∪ ");
}

/** Draws the intervals as bars along an axis of t. */
function Bars({ scale, rows }: { scale: Scale; rows: Interval[][] }) {
  const names = ["A", "B", "="];
  const paints = [...colors, "var(--ray-lit)"];
  const x = (t: number) => scale.x(-3.4 + t);
  return (
    <>
      {rows.map((intervals, i) => {
        const y = scale.y(-1.55) + i * 0.42 * scale.unit;
        return (
          <g key={names[i]}>
            <line x1={x(0)} x2={x(7)} y1={y} y2={y} stroke="var(--line)" stroke-width={2} />
            <text class="name small" x={x(0) - 22} y={y + 5}>
              {names[i]}
            </text>
            {intervals.map(([a, b]) => (
              <line
                key={a}
                x1={x(Math.max(0, a))}
                x2={x(Math.min(7, Math.max(0, b)))}
                y1={y}
                y2={y}
                stroke={paints[i]}
                stroke-width={10}
              />
            ))}
          </g>
        );
      })}
    </>
  );
}

export const solids: Topic = {
  id: "solids",
  title: "Solids",
  lead: "A ray is inside a ball for an interval of t. Solids combine such intervals by set operations.",
  text: [
    "The ray enters and leaves each part at two values of t. To combine two parts, visit all these values in order along the ray and keep track of the parts that the ray is inside. The solid begins where the operation becomes true.",
    "In a difference, the surface of B inside A becomes a surface of the solid: its normal is flipped.",
  ],
  Figure: SolidsFigure,
  questions: [
    {
      ask: "Why is the closest hit of each part not enough?",
      answer:
        "In A − B the ray may enter A inside B: then the solid begins where the ray leaves B, at its second hit.",
    },
    {
      ask: "How many intervals can A − B have with two balls?",
      answer: "Two: B may cut a piece out of the middle of A’s interval.",
    },
  ],
};
