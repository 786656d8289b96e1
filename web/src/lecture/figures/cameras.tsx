import { useState } from "preact/hooks";
import { add, type Eye, mul, type Vec } from "../../explain/space";
import type { CameraRay } from "../../protocol";
import { fixed, Slider } from "../../ui/slider";
import { useAnswer, usePageBackground, useScene } from "../context";
import { Dot, Line } from "../draw";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Choice, Equation, Figure, Sym } from "../parts";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

/** Kind of camera that the figure can show. */
interface CameraKind {
  id: string;
  name: string;
  /** Returns the camera's block in the scene language, with the value of its slider. */
  statement(value: number): string;
  field: string;
  range: [number, number, number];
  unit: string;
  /** Width and height of its image in pixels. */
  size: [number, number];
  /** How the rays of its pixels are chosen, for the figure's caption. */
  rule: string;
}

const pose = "center 0 0.6 0 direction 0 0 -1 up 0 1 0";
const kinds = [
  {
    id: "fisheye",
    name: "Fisheye",
    statement: (angle) => `FisheyeCamera { ${pose} angle ${angle} projection equidistant }`,
    field: "angle",
    range: [60, 180, 360],
    unit: "°",
    size: [240, 240],
    rule: "The distance from the image’s centre is proportional to the angle to the axis, so half of all directions fit on a disc. Outside the disc there are no rays.",
  },
  {
    id: "cylindrical",
    name: "Cylindrical",
    statement: (angle) => `CylindricalCamera { ${pose} angle ${angle} verticalAngle 70 }`,
    field: "angle",
    range: [60, 240, 360],
    unit: "°",
    size: [420, 160],
    rule: "The image is wrapped around the eye as a cylinder: x is an angle, y a height. Vertical lines stay straight.",
  },
  {
    id: "equirectangular",
    name: "Equirectangular",
    statement: () => `EquirectangularCamera { ${pose} }`,
    field: "",
    range: [0, 0, 0],
    unit: "",
    size: [400, 200],
    rule: "x is the longitude and y the latitude, so the image contains all directions, like a map of the world. Directions above and below the eye are stretched.",
  },
  {
    id: "stereo",
    name: "Two eyes",
    statement: (separation) =>
      `StereoCamera { center 0 0.6 3 direction 0 0 -1 up 0 1 0 angle 60 separation ${separation} convergence 5 method offAxis eyes sideBySide }`,
    field: "separation",
    range: [0, 0.5, 1.6],
    unit: "",
    size: [400, 200],
    rule: "Two cameras side by side. Points at the convergence distance are at the same position in both images.",
  },
  {
    id: "lens",
    name: "Lens",
    statement: (aperture) =>
      `ThinLensCamera { center 0 0.6 4 direction 0 0 -1 up 0 1 0 angle 50 aperture ${aperture} focusDistance 7 }`,
    field: "aperture",
    range: [0, 0.6, 1.5],
    unit: "",
    size: [320, 240],
    rule: "Rays start from all points of the lens and meet in the plane of focus, where objects are sharp. The figure draws only the rays through the centre of the lens.",
  },
  {
    id: "push-broom",
    name: "Push broom",
    statement: (angle) =>
      `PushBroomCamera { start -5 0.6 2 end 5 0.6 2 direction 0 0 -1 up 0 1 0 angle ${angle} aspect 2.4 }`,
    field: "angle",
    range: [20, 50, 110],
    unit: "°",
    size: [420, 175],
    rule: "The eye moves while the image is recorded column by column, as in a scanner or a satellite. Horizontally, objects do not shrink with distance.",
  },
  {
    id: "parabolic",
    name: "Mirror ball",
    statement: (angle) => `ParabolicCamera { center 0 0.6 0 direction 0 1 0 up 0 0 -1 angle ${angle} }`,
    field: "angle",
    range: [90, 210, 300],
    unit: "°",
    size: [240, 240],
    rule: "A mirror in the shape of a paraboloid, seen from far above. It preserves angles: small circles remain circles.",
  },
] as const satisfies readonly CameraKind[];
type Id = (typeof kinds)[number]["id"];

/** Returns objects all around the eye, so that every camera sees some of them. */
function around(): string {
  const all: string[] = ["MaterialIndex 0 Disc { center 0 -0.8 0 normal 0 1 0 radius 7 }"];
  for (let i = 0; i < 12; i++) {
    const angle = (Math.PI * i) / 6;
    const [x, z] = [5 * Math.sin(angle), -5 * Math.cos(angle)].map((c) => c.toFixed(3));
    const shape =
      i % 2 === 0
        ? `Sphere { center ${x} 0 ${z} radius 0.8 }`
        : `Cylinder { base ${x} -0.8 ${z} top ${x} 1.9 ${z} radius 0.45 }`;
    all.push(`MaterialIndex ${1 + (i % 4)} ${shape}`);
  }
  return all.join("\n");
}
const things = around();

function CamerasFigure() {
  const background = usePageBackground();
  const [id, setId] = useState<Id>("fisheye");
  const kind: CameraKind = kinds.find((known) => known.id === id) ?? kinds[0];
  const [values, setValues] = useState<Partial<Record<Id, number>>>({});
  const value = values[id] ?? kind.range[1];
  const scene = sceneText({
    background,
    materials: [
      materialPresets.stone,
      materialPresets.clay,
      materialPresets.sky,
      materialPresets.sand,
      materialPresets.sage,
    ],
    group: things,
  });
  const text = scene.replace(/^.*\n/, `${kind.statement(value)}\n`);
  const outside = useScene(scene);
  const image = useScene(text, [{ name: "samples", value: "9" }]);
  const [eye, setEye] = useState<Eye>({
    target: [0, 0.2, 0],
    distance: 21,
    yaw: 0.55,
    pitch: 0.62,
    angle: 38,
  });
  const [width, height] = kind.size;
  const mistake = useFigureMistake(image, "transposed", [width / 2, Math.ceil(height / 2)], [text]);
  const columns = 15;
  const rows = Math.max(5, Math.round((columns * height) / width) | 1);
  const answer = useAnswer(image, { kind: "rays", columns, rows, row: null }, "rays", text);
  const there = (answer?.rays ?? []).filter((ray): ray is CameraRay => ray !== null);
  const originCount = new Set(there.map(({ origin }) => origin.map((c) => c.toFixed(4)).join(" "))).size;
  return (
    <Figure
      ready={answer !== null}
      stage={
        <div class="beside">
          <Stage session={outside} eye={eye} setEye={setEye} label={`The rays of the camera: ${kind.name}`}>
            {(view) => (
              <>
                {there.map(({ origin, direction, t }, i) => (
                  <Line
                    key={i}
                    view={view}
                    from={origin}
                    to={add(origin, mul(t ?? 6.5, direction as Vec))}
                    color={t === null ? "var(--soft)" : "var(--ray-camera)"}
                    width={1.2}
                  />
                ))}
                {there.map(({ origin, direction, t }, i) =>
                  t === null ? null : (
                    <Dot
                      key={i}
                      view={view}
                      at={add(origin, mul(t, direction as Vec))}
                      color="var(--ray-lit)"
                      radius={3}
                    />
                  ),
                )}
              </>
            )}
          </Stage>
          <div class="inset wide">
            <RenderedImage
              session={image}
              width={width}
              height={height}
              label={`What it sees: ${kind.name}`}
              mistaken={mistake.picture}
            />
          </div>
        </div>
      }
      controls={
        <>
          <Choice
            label="Camera"
            value={id}
            values={kinds.map((known) => [known.id, known.name] as const)}
            change={(next) => setId(next)}
          />
          {kind.field && (
            <Slider
              label={kind.field}
              value={value}
              min={kind.range[0]}
              max={kind.range[2]}
              step={kind.unit ? 1 : 0.01}
              text={`${fixed(value, kind.unit ? 0 : 2)}${kind.unit}`}
              change={(next) => setValues({ ...values, [id]: next })}
            />
          )}
          <MistakeSwitch name="swap x and y" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            of {columns} × {rows} pixels, <b>{there.length}</b> have a ray,{" "}
            <b>{there.filter((ray) => ray.t !== null).length}</b> hit something
          </>
        }
      >
        <Sym vector>ray</Sym>(<Sym>x</Sym>, <Sym>y</Sym>): {kind.name.toLowerCase()}
      </Equation>
      <Equation
        numbers={
          <>
            {originCount === 1 ? "all rays start at one eye point" : "they start at "}
            {originCount > 1 && <b>{originCount}</b>}
            {originCount > 1 && " points"}. {kind.rule}
          </>
        }
      >
        where its rays start
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

export const cameras: Topic = {
  id: "cameras",
  title: "Other cameras",
  lead: "A camera is a rule that assigns a ray to each pixel. Any such rule gives an image.",
  text: [
    "A ray tracer does not require a flat image plane, or rays that meet in one eye point. A fisheye sees in all directions, a scanner moves while it records, and a pair of eyes sees two images. Everything else stays the same: the objects, the lights and the shading.",
    "Rasterisers project triangles onto a plane, so they need tricks for such cameras. In a ray tracer, each takes only a few lines of code.",
  ],
  Figure: CamerasFigure,
  questions: [
    {
      ask: "Which of these cameras have no single eye point?",
      answer: "The push broom, the two eyes and the lens: their rays start at several points.",
    },
    {
      ask: "Why can a perspective camera not see half of all directions?",
      answer: "Its image plane would have to be infinitely wide: D = 1 / tan(90°) is 0.",
    },
  ],
};
