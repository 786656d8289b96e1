import { useState } from "preact/hooks";
import { add, type Eye, length, mul, sub, unit, type Vec } from "../../explain/space";
import type { Traversal } from "../../protocol";
import { fixed, Slider, short } from "../../ui/slider";
import { useCast, usePageBackground, useScene, useWalk } from "../context";
import { Dot, Line, Name } from "../draw";
import { Equation, Figure, Mistake, Sym } from "../parts";
import { Point3 } from "../point";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

function ShadowFigure() {
  const background = usePageBackground();
  const [lamp, setLamp] = useState<Vec>([-1.7, 2.3, 0.7]);
  const [point, setPoint] = useState<Vec>([1.5, -1, -0.4]);
  const [radius, setRadius] = useState(0.75);
  const [wrong, setWrong] = useState(false);
  const text = sceneText({
    background,
    ambient: "0.16 0.16 0.18",
    lights: `PointLight { position ${lamp.join(" ")} color 0.85 0.84 0.8 }`,
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky],
    group: `MaterialIndex 0 Disc { center 0 -1 0 normal 0 1 0 radius 3.6 }
      MaterialIndex 1 Sphere { center 0 0.1 0 radius ${radius} }
      MaterialIndex 2 Box { min 1.2 -1 -2.2 max 2.2 -0.2 -1.4 }`,
  });
  const session = useScene(text);
  const [eye, setEye] = useState<Eye>({
    target: [0, 0.55, 0],
    distance: 12.5,
    yaw: 0.35,
    pitch: 0.34,
    angle: 40,
  });
  const away = sub(lamp, point);
  const distance = length(away);
  const l = unit(away);
  // Slightly above the floor, like the origin of a shadow ray.
  const start = add(point, [0, 1e-4, 0]);
  const cast = useCast(session, start, l, text);
  const hits = (cast?.tests ?? []).filter(
    ({ t, object }) => t != null && t > 0 && (wrong || t < distance) && object !== 0,
  );
  // With the vector to the light as direction, the light is at t = 1.
  const segment = { structure: "nothing", origin: start, direction: away, t_max: wrong ? null : 1 } as const;
  const any = useWalk(session, { ...segment, any: true }, text);
  const closest = useWalk(session, { ...segment, any: false }, text);
  const blocker = hits.toSorted((a, b) => (a.t ?? 0) - (b.t ?? 0))[0] ?? null;
  const t = blocker?.t ?? null;
  const color = blocker ? "var(--ray-shadowed)" : "var(--ray-lit)";
  return (
    <Figure
      ready={cast !== null}
      stage={
        <Stage
          session={session}
          eye={eye}
          setEye={setEye}
          label="A shadow ray from a point of the floor to the light"
        >
          {(view) => (
            <>
              <Line
                view={view}
                from={point}
                to={t == null ? lamp : add(point, mul(t, l))}
                color={color}
                width={3.5}
              />
              {t != null && (
                <>
                  <Line view={view} from={add(point, mul(t, l))} to={lamp} color={color} width={1.5} dashed />
                  <Dot view={view} at={add(point, mul(t, l))} color={color} radius={7} />
                  <Name view={view} at={add(point, mul(t, l))} color={color}>
                    t = {fixed(t)}
                  </Name>
                </>
              )}
              <Name view={view} at={point} dy={30}>
                P
              </Name>
              <Name view={view} at={lamp} color="var(--ray-scattered)" dx={18}>
                light
              </Name>
              <Point3 view={view} at={lamp} color="var(--ray-scattered)" label="The light" move={setLamp} />
              <Point3
                view={view}
                at={point}
                color={color}
                label="The point on the floor"
                plane={[0, 1, 0]}
                move={([x, , z]) => {
                  const out = Math.max(1, Math.hypot(x, z) / 3.5);
                  setPoint([x / out, -1, z / out]);
                }}
              />
            </>
          )}
        </Stage>
      }
      controls={
        <>
          <Slider
            label="size of the ball"
            value={radius}
            min={0.2}
            max={1.1}
            step={0.01}
            text={fixed(radius)}
            change={setRadius}
          />
          <Mistake name="forget where the light is" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          blocker ? (
            <>
              <b>{fixed(t ?? 0, 3)}</b> {(t ?? 0) < distance ? "<" : ">"} {fixed(distance, 3)}:{" "}
              {(t ?? 0) < distance
                ? "the light is occluded"
                : "taken for a shadow, but it is behind the light"}
            </>
          ) : (
            <>
              no hit with t &lt; {wrong ? "∞" : fixed(distance, 3)}: the light is visible
              {wrong && ". Drag it between P and the ball"}
            </>
          )
        }
      >
        shadow where a hit has 0 &lt; <Sym>t</Sym> &lt; |<Sym vector>light</Sym> − <Sym vector>P</Sym>|
      </Equation>
      <Equation
        numbers={
          <>
            any hit: <b>{counted(any)}</b>, closest hit: <b>{counted(closest)}</b> (
            {cast?.tests
              .map((test) => `${test.name.split(" ")[0]} ${test.t == null ? "–" : short(test.t, 3)}`)
              .join(", ")}
            )
          </>
        }
      >
        any hit will do: the closest is not needed
      </Equation>
    </Figure>
  );
}

/** Returns the number of objects that a ray was tested against, in words. */
function counted(walk: Traversal | null): string {
  if (!walk) return "…";
  return walk.tests === 1 ? "1 test" : `${walk.tests} tests`;
}

export const shadow: Topic = {
  id: "shadow",
  title: "Shadows",
  lead: "A light illuminates a point if a ray from the point to the light hits nothing in between.",
  text: [
    "The shadow ray starts at the point and ends at the light. If it hits something in between, the light is occluded and contributes nothing. Objects behind the light do not matter: the ray ends there.",
    "Drag the point across the edge of the shadow. Drag the light below the ball’s center and watch the shadow grow longer.",
  ],
  Figure: ShadowFigure,
  questions: [
    {
      ask: "Why may the search stop at any hit, even if it is not the closest?",
      answer: "Any hit occludes the light. This makes shadow rays cheaper than camera rays.",
    },
    {
      ask: "Which hit must the shadow ray ignore?",
      answer:
        "The hit at its own origin: because of rounding the surface would shadow itself, in speckles. This program moves the origin off the surface by a bound on its error.",
    },
    {
      ask: "Why does this shadow have a sharp edge?",
      answer: "The light is a point. An area light is partly visible along the edge: a penumbra.",
    },
  ],
};
