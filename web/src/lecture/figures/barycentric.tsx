import { useEffect, useRef, useState } from "preact/hooks";
import type { Session } from "../../engine/engine";
import { fixed } from "../../ui/slider";
import { draw } from "../../viewer/picture";
import { numberOf, useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { Choice, Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { PlaneName, Plot, type Scale } from "../plot";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];
const colors = ["var(--ray-shadowed)", "var(--ray-lit)", "var(--ray-camera)"] as const;
const names = ["α", "β", "γ"] as const;
const corner = ["a", "b", "c"] as const;
/** Texture coordinates of the corners. */
const uv: Point[] = [
  [0, 0],
  [1, 0],
  [0, 1],
];
const shown = [
  ["barycentric", "Colours"],
  ["areas", "Areas"],
  ["normals", "Normals"],
  ["uv", "u, v"],
] as const;
const reach: [number, number] = [4.2, 2.35];
const aspect = reach[0] / reach[1];

const options = [{ name: "samples", value: "1" }];

function BarycentricFigure() {
  const [corners, setCorners] = useState<[Point, Point, Point]>([
    [-2.5, -1.6],
    [2.7, -1.2],
    [0.3, 1.9],
  ]);
  const [point, setPoint] = useState<Point>([0.1, -0.3]);
  const [shows, setShows] = useState<(typeof shown)[number][0]>("barycentric");
  const [a, b, c] = corners;
  const scene = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.stone],
    group: `MaterialIndex 0 Triangle { ${corners.map(([x, y], i) => `vertex${i} ${x} ${y} 0`).join(" ")} }`,
  });
  const text = scene.replace(
    /^.*\n/,
    `OrthographicCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 size ${2 * reach[0]} }\n`,
  );
  const session = useScene(text, options);
  const meshText = text.replace(/Triangle \{.*\} \}/, "TriangleMesh { obj_file triangle.obj } }");
  const mesh = useScene(meshText, options, { name: "triangle.obj", text: obj(corners) });
  const interpolated = useCast(mesh, [...point, 4], [0, 0, -1], obj(corners))?.hit;
  const cast = useCast(session, [...point, 4], [0, 0, -1], text);
  const weights = names.map((name) => numberOf(cast, 0, name));
  const inside = weights.every((weight) => (weight ?? -1) >= 0);
  const [wrong, setWrong] = useState(false);
  const accepted = weights.slice(1).every((weight) => (weight ?? -1) >= 0);
  const beyond = (to: Point): Point => [a[0] + 8 * (to[0] - a[0]), a[1] + 8 * (to[1] - a[1])];
  return (
    <Figure
      ready={cast !== null}
      stage={
        <div class="layers">
          {shows !== "areas" && <Backdrop key={shows} session={mesh} picture={shows} />}
          <Plot reach={reach} aspect={aspect} label="A triangle and a point in its plane">
            {(scale) => (
              <>
                {shows === "areas" &&
                  [
                    [point, b, c],
                    [a, point, c],
                    [a, b, point],
                  ].map((part, i) => (
                    <polygon
                      key={i}
                      points={page(part as Point[], scale)}
                      fill={colors[i]}
                      fill-opacity={0.32}
                    />
                  ))}
                {wrong && (
                  <polygon
                    points={page([b, c, beyond(c), beyond(b)], scale)}
                    fill="var(--ray-shadowed)"
                    fill-opacity={0.18}
                  />
                )}
                <polygon
                  points={page(corners, scale)}
                  fill="none"
                  stroke="var(--ink)"
                  stroke-width={3}
                  stroke-linejoin="round"
                />
                {corners.map((at, i) => (
                  <line
                    key={i}
                    x1={scale.x(point[0])}
                    y1={scale.y(point[1])}
                    x2={scale.x(at[0])}
                    y2={scale.y(at[1])}
                    stroke={shows === "areas" ? "var(--ink)" : "var(--paper)"}
                    stroke-width={1.5}
                  />
                ))}
                {corners.map((at, i) => (
                  <g key={i}>
                    <PlaneName
                      scale={scale}
                      at={at}
                      dx={at[0] < 0 ? -34 : 18}
                      dy={at[1] > 0 ? -14 : 26}
                      color={colors[i] ?? ""}
                    >
                      {corner[i]}
                    </PlaneName>
                    <Handle
                      x={scale.x(at[0])}
                      y={scale.y(at[1])}
                      color={colors[i] ?? ""}
                      label={`Corner ${corner[i]}`}
                      drag={(x, y) => setCorners(corners.with(i, scale.back(x, y)) as [Point, Point, Point])}
                    />
                  </g>
                ))}
                <PlaneName scale={scale} at={point} dy={-20}>
                  P
                </PlaneName>
                <Handle
                  x={scale.x(point[0])}
                  y={scale.y(point[1])}
                  color="var(--ink)"
                  label="The point"
                  drag={(x, y) => setPoint(scale.back(x, y))}
                />
              </>
            )}
          </Plot>
        </div>
      }
      controls={
        <>
          <Choice label="Shown inside" value={shows} values={shown} change={(value) => setShows(value)} />
          <Mistake name="test only β and γ" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={names.map((name, i) => (
          <span key={name} style={{ color: colors[i] }}>
            {name} = <b style={{ color: colors[i] }}>{fixed(weights[i] ?? Number.NaN, 3)}</b>
            {i < 2 ? ", " : ""}
          </span>
        ))}
      >
        <Sym vector>P</Sym> = <Sym color={colors[0]}>α</Sym> <Sym vector>a</Sym> +{" "}
        <Sym color={colors[1]}>β</Sym> <Sym vector>b</Sym> + <Sym color={colors[2]}>γ</Sym>{" "}
        <Sym vector>c</Sym>
      </Equation>
      <Equation
        numbers={
          <>
            {inside
              ? "all are positive: P is inside"
              : `${names.filter((_, i) => (weights[i] ?? 0) < 0).join(" and ")} below 0: P is outside`}
            {wrong && (
              <Wrong>{accepted ? "accepted" : "rejected"}; hits are found in the red area, too</Wrong>
            )}
          </>
        }
      >
        <Sym>α</Sym> + <Sym>β</Sym> + <Sym>γ</Sym> = 1, inside where none is negative
      </Equation>
      <Equation
        numbers={
          <>
            D = <b>{fixed(numberOf(cast, 0, "D") ?? Number.NaN, 3)}</b>, t ={" "}
            <b>{fixed(numberOf(cast, 0, "t") ?? Number.NaN, 3)}</b>
          </>
        }
      >
        <Sym>β</Sym> = |−<Sym vector>d</Sym>, <Sym vector>o</Sym>−<Sym vector>a</Sym>, <Sym vector>c</Sym>−
        <Sym vector>a</Sym>| / <Sym>D</Sym> (Cramer)
      </Equation>
      <Equation
        numbers={
          interpolated ? (
            <>
              n = <b>({interpolated.shading_normal.map((x) => fixed(x)).join(", ")})</b>, (u, v) ={" "}
              <b>({interpolated.uv?.map((x) => fixed(x)).join(", ")})</b>
            </>
          ) : (
            "P is outside"
          )
        }
      >
        <Sym vector>n</Sym> = <Sym>α</Sym> <Sym vector>n</Sym>
        <sub>a</sub> + <Sym>β</Sym> <Sym vector>n</Sym>
        <sub>b</sub> + <Sym>γ</Sym> <Sym vector>n</Sym>
        <sub>c</sub>, of length 1
      </Equation>
    </Figure>
  );
}

/** Returns a mesh of one triangle, whose normals point outwards at its corners. */
function obj(corners: Point[]): string {
  const middle = [0, 1].map((i) => corners.reduce((sum, corner) => sum + (corner[i] ?? 0), 0) / 3);
  return [
    ...corners.map(([x, y]) => `v ${x} ${y} 0`),
    ...corners.map(([x, y]) => `vn ${0.5 * (x - (middle[0] ?? 0))} ${0.5 * (y - (middle[1] ?? 0))} 1`),
    ...uv.map(([u, v]) => `vt ${u} ${v}`),
    "f 1/1/1 2/2/2 3/3/3",
  ].join("\n");
}

/** Shows an image of the triangle in which an attribute of its corners is interpolated. */
function Backdrop({ session, picture }: { session: Session; picture: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    session.send({ kind: "size", width: 1000, height: Math.round(1000 / aspect) });
    session.send({ kind: "show", picture, stops: 0, tone: "none" });
    return session.on((event, bytes) => {
      if (event.kind !== "picture" || !canvas.current) return;
      // Pixels outside the triangle show the page.
      const pixels = bytes.slice();
      for (let i = 0; i < pixels.length; i += 4) {
        if (pixels[i] === 0 && pixels[i + 1] === 0 && pixels[i + 2] === 0) pixels[i + 3] = 0;
      }
      draw(canvas.current, event.head.width, event.head.height, pixels);
    });
  }, [session, picture]);
  return <canvas class="backdrop" ref={canvas} />;
}

function page(points: Point[], scale: Scale): string {
  return points.map(([x, y]) => `${scale.x(x)},${scale.y(y)}`).join(" ");
}

export const barycentric: Topic = {
  id: "triangle",
  title: "Triangle",
  lead: "Three weights give the position of a point in a triangle. They are areas, and they interpolate the attributes of the corners.",
  text: [
    "Every point of the plane is an affine combination of the three corners, with weights that sum to 1. Each weight is the area of the part opposite its corner, divided by the area of the triangle. Drag P across an edge: the weight of the opposite corner becomes negative.",
    "The same weights interpolate colours, normals and texture coordinates of the corners: this is how a mesh of flat triangles gets smooth shading.",
  ],
  Figure: BarycentricFigure,
  questions: [
    { ask: "Where are all three weights equal?", answer: "At the centroid: each is one third." },
    {
      ask: "Two neighbours share an edge. Why do interpolated values have no seam there?",
      answer: "On the edge the third weight is 0, and the other two depend only on the corners of the edge.",
    },
  ],
};
