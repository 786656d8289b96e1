import { useState } from "preact/hooks";
import { fixed, Slider } from "../../ui/slider";
import { numberOf, useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { Equation, Figure, Mistake, Sym } from "../parts";
import { PlaneArrow, PlaneName, Plot, type Scale } from "../plot";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];

function TransformFigure() {
  const [stretch, setStretch] = useState(1.9);
  const [turn, setTurn] = useState(28);
  const [move, setMove] = useState(0.8);
  const [origin, setOrigin] = useState<Point>([-2.6, 1.3]);
  const [tip, setTip] = useState<Point>([-1.5, 0.85]);
  const [wrong, setWrong] = useState(false);
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.clay],
    group: `MaterialIndex 0 Transform { Translate ${move} 0 0 ZRotate ${turn} Scale ${stretch} 1 1 Sphere { center 0 0 0 radius 1 } }`,
  });
  const session = useScene(text);
  const d: Point = [tip[0] - origin[0], tip[1] - origin[1]];
  const cast = useCast(session, [...origin, 0], [...d, 0], text);
  const [cos, sin] = [Math.cos((turn * Math.PI) / 180), Math.sin((turn * Math.PI) / 180)];
  const forward = ([x, y]: Point): Point => [cos * stretch * x - sin * y + move, sin * stretch * x + cos * y];
  const vector = ([x, y]: Point): Point => [(cos * x + sin * y) / stretch, -sin * x + cos * y];
  const back = ([x, y]: Point): Point => vector([x - move, y]);
  const rows = cast?.tests[0]?.rows ?? [];
  const [localOrigin, localDirection] = [back(origin), vector(d)];
  const size = Math.hypot(...localDirection);
  const t = cast?.hit?.t ?? null;
  // The common mistake: the direction is normalised in object space, but its t is used in world
  // space.
  const used = t == null ? null : wrong ? t * size : t;
  const on = (o: Point, v: Point, s: number): Point => [o[0] + s * v[0], o[1] + s * v[1]];
  return (
    <Figure
      ready={cast !== null}
      stage={
        <div class="halves">
          <Plot reach={[3.6, 2.9]} aspect={1.22} label="World space: the ellipse, and the ray as it is">
            {(scale) => (
              <>
                <Title scale={scale}>world</Title>
                <Shape scale={scale} points={circle(forward)} />
                <Rays
                  scale={scale}
                  origin={origin}
                  tip={tip}
                  end={used == null ? null : on(origin, d, used)}
                  wrong={wrong}
                  t={used}
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
          <Plot
            reach={[3.6, 2.9]}
            aspect={1.22}
            label="Object space: the unit sphere, and the ray transformed by the inverse"
          >
            {(scale) => (
              <>
                <Title scale={scale}>object</Title>
                <Shape scale={scale} points={circle((p) => p)} />
                <Rays
                  scale={scale}
                  origin={localOrigin}
                  tip={on(localOrigin, localDirection, wrong ? 1 / size : 1)}
                  end={t == null ? null : on(localOrigin, localDirection, t)}
                  wrong={false}
                  t={t == null ? null : wrong ? t * size : t}
                />
              </>
            )}
          </Plot>
        </div>
      }
      controls={
        <>
          <Slider
            label="stretch"
            value={stretch}
            min={0.4}
            max={2.4}
            step={0.01}
            text={fixed(stretch)}
            change={setStretch}
          />
          <Slider label="turn" value={turn} min={-90} max={90} step={1} text={`${turn}°`} change={setTurn} />
          <Slider
            label="move"
            value={move}
            min={-1.5}
            max={1.5}
            step={0.01}
            text={fixed(move)}
            change={setMove}
          />
          <Mistake name="normalise M⁻¹ d" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation numbers={<b>{rows.find((row) => row.name === "o")?.result ?? "–"}</b>}>
        <Sym vector>o</Sym>′ = <Sym>M</Sym>⁻¹ <Sym vector>o</Sym>
      </Equation>
      <Equation numbers={<b>{rows.find((row) => row.name === "d")?.result ?? "–"}</b>}>
        <Sym vector>d</Sym>′ = <Sym>M</Sym>⁻¹ <Sym vector>d</Sym>
      </Equation>
      <Equation
        numbers={
          t == null ? (
            "the ray misses the object"
          ) : (
            <>
              t₁ = {fixed(numberOf(cast, 0, "t₁") ?? Number.NaN, 3)} in object space,{" "}
              <b style={wrong ? { color: "var(--error)" } : {}}>{fixed(used ?? Number.NaN, 3)}</b> used in the
              world
              {wrong && ": off the surface"}
            </>
          )
        }
      >
        <Sym>t</Sym>′ = <Sym>t</Sym>, unless <Sym vector>d</Sym>′ is normalised
      </Equation>
    </Figure>
  );
}

function circle(map: (p: Point) => Point): Point[] {
  return Array.from({ length: 73 }, (_, i) =>
    map([Math.cos((i * Math.PI) / 36), Math.sin((i * Math.PI) / 36)]),
  );
}

function Title({ scale, children }: { scale: Scale; children: string }) {
  return (
    <text class="name small" x={14} y={scale.height - 14} fill="var(--soft)">
      {children} space
    </text>
  );
}

function Shape({ scale, points }: { scale: Scale; points: Point[] }) {
  const text = points.map(([x, y]) => `${scale.x(x)},${scale.y(y)}`).join(" ");
  return (
    <polygon points={text} fill="var(--solid)" fill-opacity={0.14} stroke="var(--ink)" stroke-width={3} />
  );
}

function Rays({
  scale,
  origin,
  tip,
  end,
  wrong,
  t,
}: {
  scale: Scale;
  origin: Point;
  tip: Point;
  end: Point | null;
  wrong: boolean;
  t: number | null;
}) {
  const far: Point = [origin[0] + 9 * (tip[0] - origin[0]), origin[1] + 9 * (tip[1] - origin[1])];
  const color = wrong ? "var(--error)" : "var(--ray-lit)";
  return (
    <>
      <PlaneArrow
        scale={scale}
        from={origin}
        to={far}
        color="var(--ray-camera)"
        width={1.5}
        dashed
        head={false}
      />
      <PlaneArrow scale={scale} from={origin} to={tip} color="var(--ray-camera)" width={4} />
      <circle cx={scale.x(origin[0])} cy={scale.y(origin[1])} r={5} fill="var(--ray-camera)" />
      {end && (
        <>
          <circle cx={scale.x(end[0])} cy={scale.y(end[1])} r={8} fill={color} />
          <PlaneName scale={scale} at={end} color={color} dy={-16}>
            t = {fixed(t ?? Number.NaN)}
          </PlaneName>
        </>
      )}
    </>
  );
}

export const transform: Topic = {
  id: "transform",
  title: "Transforms",
  lead: "Do not transform the object: transform the ray by the inverse and intersect it in object space.",
  text: [
    "A scaled, rotated and translated ellipse is hard to intersect. The unit sphere is easy. So the origin and the direction of the ray are transformed by the inverse of the matrix, and the ray is intersected with the sphere in the space in which the object was written.",
    "Do not normalise the direction there. Then t means the same in both spaces, and hits of different objects can be compared.",
  ],
  Figure: TransformFigure,
  questions: [
    {
      ask: "Why does the translation not apply to a direction?",
      answer:
        "A direction is the difference of two points: the translation of both cancels. In homogeneous coordinates its w is 0.",
    },
    {
      ask: "What goes wrong if M⁻¹ d is normalised?",
      answer:
        "t has different units for each object. Points land off the surfaces, and the order of hits is wrong. Try the switch.",
    },
  ],
};
