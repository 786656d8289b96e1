import { useState } from "preact/hooks";
import { add, dot, type Eye, length, mul, sub, unit, type Vec } from "../../explain/space";
import type { Term } from "../../protocol";
import { fixed, Slider } from "../../ui/slider";
import { useCast, usePageBackground, useScene, useTrace } from "../context";
import { Arrow, Dot, Handle, Name } from "../draw";
import { Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { Point3 } from "../point";
import { sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

function ShadingFigure() {
  const background = usePageBackground();
  const [lamp, setLamp] = useState<Vec>([-2.7, 1.5, 1.1]);
  const [toward, setToward] = useState<Vec>(unit([-0.12, 0.42, 0.9]));
  const [diffuse, setDiffuse] = useState(0.75);
  const [specular, setSpecular] = useState(0.5);
  const [exponent, setExponent] = useState(24);
  const [wrong, setWrong] = useState(false);
  const text = sceneText({
    background,
    ambient: "0.08 0.08 0.09",
    lights: `PointLight { position ${lamp.join(" ")} color 1 0.98 0.95 }`,
    materials: [
      `diffuseColor ${diffuse} ${(diffuse * 0.42).toFixed(4)} ${(diffuse * 0.26).toFixed(4)} specularColor ${specular} ${specular} ${specular} exponent ${exponent}`,
    ],
    group: "MaterialIndex 0 Sphere { center 0 0 0 radius 1.35 }",
  });
  const session = useScene(text);
  const probe = useScene(text, [{ name: "samples", value: "1" }]);
  const [eye, setEye] = useState<Eye>({
    target: [-0.5, 0.3, 0],
    distance: 10.5,
    yaw: 0.1,
    pitch: 0.12,
    angle: 40,
  });
  const seenFrom: Vec = [
    eye.target[0] + eye.distance * Math.sin(eye.yaw) * Math.cos(eye.pitch),
    eye.target[1] + eye.distance * Math.sin(eye.pitch),
    eye.target[2] + eye.distance * Math.cos(eye.yaw) * Math.cos(eye.pitch),
  ];
  const point = mul(1.35, toward);
  const cast = useCast(session, mul(4, point), mul(-1, toward), text);
  const n: Vec = cast?.hit?.normal ?? toward;
  const away = sub(lamp, point);
  const l = unit(away);
  const v = unit(sub(seenFrom, point));
  const h = unit(add(l, v));
  const account = useTrace(probe, seenFrom, unit(sub(point, seenFrom)), text);
  const light = find(account?.tree ?? null, (term) => term.rows.some((row) => row.name === "l"));
  const nl = number(light, "n · l");
  const nh = number(light, "n · h");
  const power = number(light, "power");
  return (
    <Figure
      ready={cast !== null}
      stage={
        <Stage
          session={session}
          eye={eye}
          setEye={setEye}
          label="A ball lit by a point light, with the vectors at a point"
        >
          {(view) => {
            const projected = view.point(point);
            return (
              <>
                <Arrow
                  view={view}
                  from={point}
                  dir={l}
                  color={wrong ? "var(--ray-shadowed)" : "var(--ray-scattered)"}
                  length={wrong ? length(away) : 1.25}
                  width={3.5}
                />
                <Name view={view} at={add(point, mul(1.25, l))} color="var(--ray-scattered)">
                  l
                </Name>
                <Arrow view={view} from={point} dir={n} color="var(--ink)" length={1.25} width={3.5} />
                <Name view={view} at={add(point, mul(1.25, n))}>
                  n
                </Name>
                <Arrow
                  view={view}
                  from={point}
                  dir={h}
                  color="var(--ray-reflected)"
                  length={1.1}
                  width={3.5}
                />
                <Name view={view} at={add(point, mul(1.1, h))} color="var(--ray-reflected)" dy={22}>
                  h
                </Name>
                <Dot view={view} at={lamp} color="var(--ray-scattered)" radius={11} />
                <Point3 view={view} at={lamp} color="var(--ray-scattered)" label="The light" move={setLamp} />
                {projected && (
                  <Handle
                    x={projected.x}
                    y={projected.y}
                    color="var(--ray-camera)"
                    label="The point"
                    drag={(x, y) => {
                      const { origin, direction } = view.ray(x, y);
                      const b =
                        origin[0] * direction[0] + origin[1] * direction[1] + origin[2] * direction[2];
                      const c = origin.reduce((sum, x) => sum + x * x, 0) - 1.35 * 1.35;
                      const root = Math.sqrt(Math.max(0, b * b - c));
                      setToward(unit(add(origin, mul(-b - root, direction))));
                    }}
                  />
                )}
              </>
            );
          }}
        </Stage>
      }
      controls={
        <>
          <Slider
            label="diffuse"
            value={diffuse}
            min={0}
            max={1}
            step={0.01}
            text={fixed(diffuse)}
            change={setDiffuse}
          />
          <Slider
            label="specular"
            value={specular}
            min={0}
            max={1}
            step={0.01}
            text={fixed(specular)}
            change={setSpecular}
          />
          <Slider
            label="exponent"
            value={exponent}
            min={1}
            max={200}
            step={1}
            text={String(exponent)}
            change={setExponent}
          />
          <Mistake name="l not of length 1" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          nl == null ? (
            "the light is behind the surface"
          ) : (
            <>
              {fixed(diffuse)} · max(0, <b>{fixed(nl, 3)}</b>) = <b>{fixed(diffuse * nl, 3)}</b>
              {wrong && (
                <Wrong>
                  {fixed(diffuse)} · {fixed(dot(n, away), 3)} = {fixed(diffuse * dot(n, away), 3)}: brighter,
                  the farther the light
                </Wrong>
              )}
            </>
          )
        }
      >
        <Sym>L</Sym> = <Sym>k</Sym>
        <sub>d</sub> max(0, <Sym vector>n</Sym> ·{" "}
        <Sym vector color="var(--ray-scattered)">
          l
        </Sym>
        )
      </Equation>
      <Equation
        numbers={
          nh == null ? (
            "–"
          ) : (
            <>
              {fixed(specular)} · <b>{fixed(nh, 3)}</b>
              <sup>{exponent}</sup> = <b>{fixed(specular * (power ?? 0), 3)}</b>
            </>
          )
        }
      >
        + <Sym>k</Sym>
        <sub>s</sub> max(0, <Sym vector>n</Sym> ·{" "}
        <Sym vector color="var(--ray-reflected)">
          h
        </Sym>
        )<sup>exponent</sup>
      </Equation>
    </Figure>
  );
}

function find(term: Term | null, wanted: (term: Term) => boolean): Term | null {
  if (!term) return null;
  if (wanted(term)) return term;
  for (const child of term.terms) {
    const found = find(child, wanted);
    if (found) return found;
  }
  return null;
}

function number(light: Term | null, name: string): number | null {
  const term = find(light, (inner) => inner.rows.some((row) => row.name === name));
  return term?.rows.find((row) => row.name === name)?.value ?? null;
}

export const shading: Topic = {
  id: "shading",
  title: "Diffuse light and highlights",
  lead: "The brightness of a point depends on three vectors: the normal, the direction to the light, and the direction to the eye.",
  text: [
    "A matte surface scatters light evenly. The light that it receives is proportional to the cosine between its normal n and the direction to the light l: a beam at a grazing angle is spread over more of the surface.",
    "A highlight appears where the surface roughly reflects the light towards the eye. Blinn's model uses the vector h halfway between the directions to the light and to the eye; the highlight is bright where the normal is close to h. The exponent controls how close it must be.",
  ],
  Figure: ShadingFigure,
  questions: [
    {
      ask: "You move around the ball. Which of the two terms changes?",
      answer: "The highlight: it depends on the eye. The diffuse term does not.",
    },
    {
      ask: "Why is max(0, n · l) needed?",
      answer: "Beyond the terminator the cosine is negative: without max the light would darken the surface.",
    },
  ],
};
