import { useState } from "preact/hooks";
import { flatten } from "../../explain/segments";
import { add, dot, type Eye, mul, sub, unit, type Vec } from "../../explain/space";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene, useTrace } from "../context";
import { Arrow, Dot, Line, Name } from "../draw";
import { Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { Point3 } from "../point";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

function MirrorFigure() {
  const background = usePageBackground();
  const [bounces, setBounces] = useState(2);
  const [wrong, setWrong] = useState(false);
  const [from, setFrom] = useState<Vec>([-3.2, 0.55, 2.3]);
  const [aim, setAim] = useState<Vec>([-0.586, 0.07, 0.889]);
  const text = sceneText({
    background,
    ambient: "0.3 0.3 0.31",
    materials: [materialPresets.stone, materialPresets.mirror, materialPresets.clay, materialPresets.sky],
    group: `MaterialIndex 0 Disc { center 0 -1 0 normal 0 1 0 radius 3.8 }
      MaterialIndex 1 Sphere { center -0.9 -0.05 0 radius 0.95 }
      MaterialIndex 1 Sphere { center 1.25 -0.2 0.3 radius 0.8 }
      MaterialIndex 2 Box { min -0.5 -1 -2.6 max 0.5 0.6 -1.8 }
      MaterialIndex 3 Sphere { center 0.2 -0.65 1.7 radius 0.35 }`,
  });
  const options = [{ name: "bounces", value: String(bounces) }];
  const session = useScene(text, options);
  const probe = useScene(text, [...options, { name: "samples", value: "1" }]);
  const [eye, setEye] = useState<Eye>({
    target: [-0.5, -0.1, 0],
    distance: 12,
    yaw: 0.25,
    pitch: 0.42,
    angle: 38,
  });
  const direction = unit(sub(aim, from));
  const pixel = useTrace(probe, from, direction, `${text} ${bounces}`);
  const rays = flatten(pixel?.tree).filter(
    ({ term }) => term.segment && term.segment.role !== "lit" && term.segment.role !== "shadowed",
  );
  const first = rays.find(({ term }) => term.segment?.role === "reflected")?.term ?? null;
  const row = first?.rows.find((known) => known.name === "r") ?? null;
  const end = rays[0]?.term.segment?.to ?? aim;
  const n = first ? (rays[0]?.term.normal?.[1] ?? null) : null;
  const wrongRay = n && sub(direction, mul(dot(direction, n), n));
  return (
    <Figure
      stage={
        <Stage session={session} eye={eye} setEye={setEye} label="A ray that is reflected several times">
          {(view) => (
            <>
              {rays.map(({ path, term }, i) => (
                <Line
                  key={path}
                  view={view}
                  from={term.segment?.from ?? from}
                  to={term.segment?.to ?? from}
                  color={`var(--ray-${term.segment?.role ?? "camera"})`}
                  width={Math.max(1.6, 4 - 0.7 * i)}
                  dashed={term.segment?.escapes ?? false}
                  arrow
                />
              ))}
              {rays.map(({ path, term }) => {
                if (!term.normal) return null;
                const [at, n] = term.normal;
                return (
                  <g key={path}>
                    <Arrow view={view} from={at} dir={n} length={0.55} color="var(--normal)" width={2.5} />
                    <Dot view={view} at={at} color="var(--ink)" radius={5} />
                  </g>
                );
              })}
              {wrong && wrongRay && first?.segment && (
                <Arrow
                  view={view}
                  from={first.segment.from}
                  dir={unit(wrongRay)}
                  length={1.6}
                  color="var(--ray-shadowed)"
                  width={4}
                  dashed
                />
              )}
              {first?.segment && (
                <Name view={view} at={add(first.segment.from, [0, 0.1, 0])} dy={-26}>
                  P
                </Name>
              )}
              <Point3
                view={view}
                at={end}
                color="var(--ray-camera)"
                label="Target of the ray"
                move={setAim}
              />
              <Point3 view={view} at={from} color="var(--ink)" label="The eye" move={setFrom} />
              <Name view={view} at={from} dx={-8} dy={-20}>
                o
              </Name>
            </>
          )}
        </Stage>
      }
      controls={
        <>
          <Slider
            label="levels"
            value={bounces}
            min={0}
            max={8}
            step={1}
            text={String(bounces)}
            change={setBounces}
          />
          <Mistake name="forget the factor 2" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          row ? (
            <>
              {row.numbers} = <b>{row.result}</b>
              {wrong && wrongRay && (
                <Wrong>({wrongRay.map((x) => fixed(x, 3)).join(", ")}): the ray stays on the surface</Wrong>
              )}
            </>
          ) : (
            "this ray hits no mirror, or the maximum depth is reached"
          )
        }
      >
        <Sym vector color="var(--ray-reflected)">
          r
        </Sym>{" "}
        = <Sym vector>d</Sym> − 2 (<Sym vector>d</Sym> ·{" "}
        <Sym vector color="var(--normal)">
          n
        </Sym>
        ){" "}
        <Sym vector color="var(--normal)">
          n
        </Sym>
      </Equation>
      <Equation
        numbers={
          <>
            <b>{rays.length}</b> {rays.length === 1 ? "ray" : "rays"}; colour{" "}
            {pixel?.color.map((x) => fixed(x, 3)).join(", ") ?? "–"}
          </>
        }
      >
        <Sym>L</Sym>(ray) = local light + <Sym>k</Sym>
        <sub>r</sub> <Sym>L</Sym>(mirrored ray)
      </Equation>
    </Figure>
  );
}

export const mirror: Topic = {
  id: "mirror",
  title: "Mirrors and recursion",
  lead: "A mirror reflects the ray. The reflected ray is traced by the same function, one level deeper.",
  text: [
    "A mirror flips the component of the direction along the normal and keeps the rest. The reflected ray is traced like any other, and its radiance is multiplied by the mirror’s colour.",
    "Two mirrors can reflect a ray forever. So the depth is limited, and rays whose contribution is too small are not traced. Raise the number of levels and watch the mirrors fill.",
  ],
  Figure: MirrorFigure,
  questions: [
    {
      ask: "What do mirrors show at level 0?",
      answer: "No reflections: only their diffuse colour and highlights, which are nearly black here.",
    },
    {
      ask: "A mirror has the colour 0.8. What is the throughput of a ray after three mirrors?",
      answer: "0.8³ = 0.512.",
    },
  ],
};
