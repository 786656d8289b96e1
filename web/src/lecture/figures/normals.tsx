import { useState } from "preact/hooks";
import { fixed, Slider } from "../../ui/slider";
import { useCast, usePageBackground, useScene } from "../context";
import { Handle } from "../draw";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Sym } from "../parts";
import { PlaneArrow, PlaneName, Plot } from "../plot";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import type { Topic } from "../topic";

type Point = [number, number];

/** Size of the rendered picture. */
const [width, height] = [240, 180];

function NormalsFigure() {
  const [shear, setShear] = useState(0.8);
  const [squash, setSquash] = useState(0.7);
  const [turn, setTurn] = useState(62);
  // The matrix, by rows: x' = x + shear y, y' = squash y.
  const text = sceneText({
    background: usePageBackground(),
    materials: [materialPresets.clay],
    group: `MaterialIndex 0 Transform { Matrix { 1 ${shear} 0 0  0 ${squash} 0 0  0 0 1 0  0 0 0 1 } Sphere { center 0 0 0 radius 1.4 } }`,
  });
  const session = useScene(text);
  const mistake = useFigureMistake(session, "normals-moved", [width, height], [text]);
  const angle = (turn * Math.PI) / 180;
  const own: Point = [Math.cos(angle), Math.sin(angle)];
  const map = ([x, y]: Point): Point => [x + shear * y, squash * y];
  const point = map([1.4 * own[0], 1.4 * own[1]]);
  const tangent = unit(map([-own[1], own[0]]));
  const wrong = unit(map(own));
  const outward: Point = [point[0] * 4, point[1] * 4];
  const cast = useCast(session, [...outward, 0], [-outward[0], -outward[1], 0], text);
  const right: Point = cast?.hit ? [cast.hit.normal[0], cast.hit.normal[1]] : [0, 1];
  const [good, bad] = [dot(right, tangent), dot(wrong, tangent)];
  const end = (v: Point, s = 1.15): Point => [point[0] + s * v[0], point[1] + s * v[1]];
  const outline = Array.from({ length: 97 }, (_, i) =>
    map([1.4 * Math.cos((i * Math.PI) / 48), 1.4 * Math.sin((i * Math.PI) / 48)]),
  );
  return (
    <Figure
      ready={cast !== null}
      stage={
        <div class="beside">
          <Plot reach={[4.4, 2.45]} label="A sheared circle with a tangent and two normals">
            {(scale) => (
              <>
                <polygon
                  points={outline.map(([x, y]) => `${scale.x(x)},${scale.y(y)}`).join(" ")}
                  fill="var(--solid)"
                  fill-opacity={0.14}
                  stroke="var(--ink)"
                  stroke-width={3}
                />
                <PlaneArrow
                  scale={scale}
                  from={end(tangent, -1.6)}
                  to={end(tangent, 1.6)}
                  color="var(--ray-camera)"
                  width={2.5}
                />
                <PlaneName scale={scale} at={end(tangent, 1.6)} color="var(--ray-camera)">
                  M t
                </PlaneName>
                <PlaneArrow scale={scale} from={point} to={end(wrong)} color="var(--ray-shadowed)" dashed />
                <PlaneName scale={scale} at={end(wrong)} color="var(--ray-shadowed)">
                  M n
                </PlaneName>
                <PlaneArrow scale={scale} from={point} to={end(right)} color="var(--ray-lit)" width={4} />
                <PlaneName scale={scale} at={end(right)} color="var(--ray-lit)" dx={-40} dy={-20}>
                  M⁻ᵀ n
                </PlaneName>
                <Handle
                  x={scale.x(point[0])}
                  y={scale.y(point[1])}
                  color="var(--ink)"
                  label="The point"
                  drag={(x, y) => {
                    const [px, py] = scale.back(x, y);
                    const [ux, uy] = [px - (shear * py) / squash, py / squash];
                    setTurn(((Math.atan2(uy, ux) * 180) / Math.PI + 360) % 360);
                  }}
                />
              </>
            )}
          </Plot>
          <div class="inset below low">
            <RenderedImage
              session={session}
              width={width}
              height={height}
              label="The sheared ball"
              mistaken={mistake.picture}
            />
          </div>
        </div>
      }
      controls={
        <>
          <Slider
            label="shear"
            value={shear}
            min={-1.5}
            max={1.5}
            step={0.01}
            text={fixed(shear)}
            change={setShear}
          />
          <Slider
            label="squash"
            value={squash}
            min={0.3}
            max={1.5}
            step={0.01}
            text={fixed(squash)}
            change={setSquash}
          />
          <MistakeSwitch name="transform normals by M" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            ({fixed(right[0], 3)}, {fixed(right[1], 3)}) · ({fixed(tangent[0], 3)}, {fixed(tangent[1], 3)}) ={" "}
            <b>{fixed(good, 3)}</b>
          </>
        }
      >
        (<Sym color="var(--ray-lit)">M</Sym>⁻ᵀ <Sym vector>n</Sym>) · (<Sym>M</Sym> <Sym vector>t</Sym>) = 0:
        upright
      </Equation>
      <Equation
        numbers={
          <>
            <b style={Math.abs(bad) > 0.005 ? { color: "var(--error)" } : {}}>{fixed(bad, 3)}</b>,{" "}
            {fixed((Math.acos(Math.max(-1, Math.min(1, bad))) * 180) / Math.PI, 1)}° from the tangent
          </>
        }
      >
        (<Sym color="var(--ray-shadowed)">M</Sym> <Sym vector>n</Sym>) · (<Sym>M</Sym> <Sym vector>t</Sym>) ≠
        0: the usual mistake
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

function unit([x, y]: Point): Point {
  const length = Math.hypot(x, y);
  return [x / length, y / length];
}

function dot(a: Point, b: Point): number {
  return a[0] * b[0] + a[1] * b[1];
}

export const normals: Topic = {
  id: "normals",
  title: "Normals",
  lead: "Tangents transform by the matrix itself, normals by its inverse transpose.",
  text: [
    "A tangent is the difference of two points of the surface, so it transforms by the matrix itself. A normal is perpendicular to all tangents, and a shear that is applied to it tilts it. Under the transpose of the inverse it stays perpendicular: n · t = nᵀ M⁻¹ M t = (M⁻ᵀ n) · (M t).",
    "The green normal is the one that the ray tracer found at the hit; the red one is transformed like a tangent.",
  ],
  Figure: NormalsFigure,
  questions: [
    {
      ask: "For which matrices do both normals agree?",
      answer:
        "For rotations and uniform scales: their inverse transpose is the matrix itself, up to a factor. Set shear to 0 and squash to 1.",
    },
    {
      ask: "Where on the ellipse do they agree for other matrices?",
      answer: "At the principal axes of the stretch: without shear, at the top, the bottom and the sides.",
    },
  ],
};
