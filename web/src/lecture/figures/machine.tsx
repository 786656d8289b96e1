import { useEffect, useMemo, useState } from "preact/hooks";
import { add, cross, dot, type Eye, mul, type Projector, sub, unit, type Vec } from "../../explain/space";
import { fixed, Slider, short } from "../../ui/slider";
import { useCast, usePageBackground, useScene } from "../context";
import { Dot, Handle, Line, Name, Path } from "../draw";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Sym } from "../parts";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

const columns = 32;
const rows = 24;
/** Position of the nail in the wall that holds the string, which is the eye. */
const nail: Vec = [-5.2, 1.15, 0.4];
const aim: Vec = unit(sub([1.4, 0.15, 0], nail));
const angle = 44;
const reach = 2.6;
const right = unit(cross(aim, [0, 1, 0]));
const up = cross(right, aim);
const half = reach * Math.tan((angle * Math.PI) / 360);

/** Returns a point of the image plane; the larger side ranges from -1 to 1. */
function onPicture(x: number, y: number): Vec {
  return add(add(nail, mul(reach, aim)), add(mul(x * half, right), mul(y * half, up)));
}

function corner(column: number, row: number): Vec {
  return onPicture((2 * column) / columns - 1, (rows - 2 * row) / columns);
}

function MachineFigure() {
  const background = usePageBackground();
  const text = sceneText({
    background,
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky, materialPresets.sand],
    group: `MaterialIndex 0 Disc { center 1.6 -1 0 normal 0 1 0 radius 2.9 }
      MaterialIndex 1 Sphere { center 1.2 0 0.1 radius 1 }
      MaterialIndex 2 Box { min 2.2 -1 -1.7 max 3.4 0.9 -0.5 }
      MaterialIndex 3 Cone { base 1.9 -1 1.5 top 1.9 0.7 1.5 baseRadius 0.62 }`,
  });
  const stage = useScene(text);
  const drawn = useScene(text, [{ name: "samples", value: "1" }]);
  const [eye, setEye] = useState<Eye>({
    target: [-0.75, -0.05, 0],
    distance: 12.5,
    yaw: 0.42,
    pitch: 0.26,
    angle: 42,
  });
  const [colors, setColors] = useState<Uint8Array | null>(null);
  const [at, setAt] = useState(9 * columns + 14);
  const [plays, setPlays] = useState(true);

  useEffect(() => {
    const look = () => {
      drawn.send({ kind: "size", width: columns, height: rows });
      drawn.send({ kind: "look", center: nail, direction: aim, up: [0, 1, 0], angle, moving: false });
    };
    return drawn.on((event, bytes) => {
      if (event.kind === "scene") look();
      if (event.kind === "picture" && event.head.hash && event.head.width === columns)
        setColors(bytes.slice());
    });
  }, [drawn]);
  useEffect(() => {
    if (!plays) return;
    const timer = setInterval(() => setAt((i) => (i + 1) % (columns * rows)), 45);
    return () => clearInterval(timer);
  }, [plays]);

  const mistake = useFigureMistake(drawn, "farthest-object", [columns, rows], [colors]);

  const [column, row] = [at % columns, Math.floor(at / columns)];
  const pixel = onPicture((2 * (column + 0.5)) / columns - 1, (rows - 2 * (row + 0.5)) / columns);
  const direction = useMemo(() => unit(sub(pixel, nail)), [at]);
  const cast = useCast(stage, nail, direction, text);
  const hit = cast?.hit ?? null;
  const end = hit ? hit.point : add(nail, mul(9.5, direction));

  const drag = (view: Projector) => (x: number, y: number) => {
    const ray = view.ray(x, y);
    const t = dot(sub(onPicture(0, 0), ray.origin), aim) / dot(ray.direction, aim);
    const offset = sub(add(ray.origin, mul(t, ray.direction)), onPicture(0, 0));
    const c = Math.floor(((dot(offset, right) / half + 1) * columns) / 2);
    const r = Math.floor((rows - (dot(offset, up) / half) * columns) / 2);
    setPlays(false);
    setAt(Math.min(rows - 1, Math.max(0, r)) * columns + Math.min(columns - 1, Math.max(0, c)));
  };

  return (
    <Figure
      ready={cast !== null}
      stage={
        <Stage
          session={stage}
          eye={eye}
          setEye={setEye}
          label="The machine: a string from a nail through a frame to an object"
        >
          {(view) => (
            <>
              <Canvas view={view} colors={mistake.picture?.pixels ?? colors} upTo={at} />
              <Line view={view} from={nail} to={end} color="var(--ray-camera)" width={2.5} />
              {hit && <Dot view={view} at={end} color="var(--ray-camera)" radius={6} />}
              <Dot view={view} at={nail} color="var(--ink)" radius={6} />
              <Name view={view} at={nail} dy={-14} dx={-10}>
                o
              </Name>
              {hit && (
                <Name view={view} at={end}>
                  P
                </Name>
              )}
              <PixelHandle view={view} at={pixel} drag={drag(view)} />
            </>
          )}
        </Stage>
      }
      controls={
        <>
          <button type="button" class="button strong" onClick={() => setPlays(!plays)}>
            {plays ? "Pause" : "Draw"}
          </button>
          <Slider
            label="pixel"
            value={at}
            min={0}
            max={columns * rows - 1}
            step={1}
            text={`${column}, ${row}`}
            change={(value) => {
              setPlays(false);
              setAt(value);
            }}
          />
          <MistakeSwitch name="keep the farthest hit" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          hit ? (
            <>
              = ({nail.map((x) => short(x)).join(", ")}) + <b>{fixed(hit.t, 3)}</b> (
              {direction.map((x) => fixed(x, 3)).join(", ")})
            </>
          ) : (
            "this string hits nothing: the pixel gets the background"
          )
        }
      >
        <Sym vector>P</Sym> = <Sym vector>o</Sym> + <Sym>t</Sym> <Sym vector>d</Sym>
      </Equation>
      <Equation numbers={`pixel ${at + 1} of ${columns * rows}: one ray each`}>
        for each pixel a ray, for each ray the closest object
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

/** Draws the frame, and all pixels drawn so far. */
function Canvas({ view, colors, upTo }: { view: Projector; colors: Uint8Array | null; upTo: number }) {
  const grid = useMemo(() => {
    const points: (ReturnType<Projector["point"]> | null)[][] = [];
    for (let r = 0; r <= rows; r++)
      points.push(Array.from({ length: columns + 1 }, (_, c) => view.point(corner(c, r))));
    return points;
  }, [view]);
  const pixels = [];
  for (let i = 0; colors && i <= upTo; i++) {
    const [c, r] = [i % columns, Math.floor(i / columns)];
    const around = [grid[r]?.[c], grid[r]?.[c + 1], grid[r + 1]?.[c + 1], grid[r + 1]?.[c]];
    if (around.some((p) => !p)) continue;
    const color = `rgb(${colors[4 * i]} ${colors[4 * i + 1]} ${colors[4 * i + 2]})`;
    pixels.push(
      <polygon
        key={i}
        points={around.map((p) => `${p?.x},${p?.y}`).join(" ")}
        fill={color}
        stroke={color}
        stroke-width={0.6}
      />,
    );
  }
  const frame = [corner(0, 0), corner(columns, 0), corner(columns, rows), corner(0, rows)];
  return (
    <g>
      <Path
        view={view}
        points={frame}
        color="var(--ink)"
        width={2.5}
        fill="var(--paper)"
        opacity={0.35}
        closed
      />
      {pixels}
      <Path view={view} points={frame} color="var(--ink)" width={2.5} closed />
    </g>
  );
}

function PixelHandle({ view, at, drag }: { view: Projector; at: Vec; drag(x: number, y: number): void }) {
  const projected = view.point(at);
  return (
    projected && (
      <Handle x={projected.x} y={projected.y} color="var(--ray-camera)" label="The pixel" drag={drag} />
    )
  );
}

export const machine: Topic = {
  id: "machine",
  title: "Dürer’s machine",
  lead: "A string runs from a nail through a frame to an object: a dot is drawn where the string crosses the frame.",
  text: [
    "In 1525 Albrecht Dürer published a way to draw a lute without any skill. A nail in the wall is the eye. A string runs from it to a point of the lute; where it crosses the frame, a dot is drawn on the paper. Point by point, the picture appears, in perfect perspective.",
    "A ray tracer works in the opposite direction. It chooses a pixel of the image instead of a point of the object, traces a ray through it, and finds the closest hit. This program draws the image in the frame above, with one ray per pixel.",
  ],
  Figure: MachineFigure,
  questions: [
    {
      ask: "What changes if the frame is farther from the nail?",
      answer:
        "Seen from the nail, it covers less: the field of view becomes narrower, and objects appear larger on the same paper.",
    },
    {
      ask: "Two objects lie on one string. Which of them is drawn?",
      answer: "The one with the smallest t in front of the nail: the string cannot pass through it.",
    },
  ],
};
