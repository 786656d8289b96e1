import { useEffect, useRef, useState } from "preact/hooks";
import type { Session } from "../../engine/engine";
import { type Eye, sub, type Vec } from "../../explain/space";
import type { CastResult } from "../../protocol";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene } from "../context";
import { Dot, Line, Name, Path } from "../draw";
import { Equation, Figure, Sym } from "../parts";
import { Point3 } from "../point";
import { RenderedImage } from "../rendered";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

/** Height of the hole. */
const high = 0.2;
const aims = Array.from({ length: 25 }, (_, i) => (i - 12) / 10);
const garden = `MaterialIndex 1 Sphere { center -0.9 -0.3 -3 radius 0.7 }
  MaterialIndex 2 Cone { base 0.9 -1 -3.6 top 0.9 1.3 -3.6 baseRadius 0.75 }
  MaterialIndex 3 Box { min 2 -1 -4.6 max 3 0.4 -3.8 }`;

/** Returns the results of intersecting several rays with all objects. */
function useCasts(session: Session, origin: Vec, targets: Vec[], key: string): CastResult[] {
  const [casts, setCasts] = useState<CastResult[]>([]);
  const latest = useRef(0);
  useEffect(() => {
    const number = ++latest.current;
    const one = (target: Vec) =>
      session.ask({ kind: "cast", origin, direction: sub(target, origin), t_max: null }, "cast");
    Promise.all(targets.map(one))
      .then((answers) => number === latest.current && setCasts(answers.map(({ cast }) => cast)))
      .catch(() => {});
  }, [session, key, JSON.stringify([origin, targets])]);
  return casts;
}

function ObscuraFigure() {
  const background = usePageBackground();
  const [hole, setHole] = useState(0.3);
  const [depth, setDepth] = useState(2);
  const [point, setPoint] = useState<Vec>([0.9, 1.3, -3.6]);
  const room = `MaterialIndex 0 Difference {
      Box { min -2 -1 -0.03 max 2 1.7 0.03 }
      Cylinder { base 0 ${high} -1 top 0 ${high} 1 radius ${hole / 2} }
    }
    Rectangle { corner -2 -1 ${depth} edge0 0 2.7 0 edge1 4 0 0 }
    Rectangle { corner -2 -1 0 edge0 0 0 ${depth} edge1 4 0 0 }
    Rectangle { corner -4 -1 -6 edge0 0 0 6 edge1 8 0 0 }`;
  const materials = [materialPresets.stone, materialPresets.clay, materialPresets.sage, materialPresets.sky];
  const text = sceneText({ background, materials, group: `${room}\n${garden}` });
  const session = useScene(text);
  const [eye, setEye] = useState<Eye>({
    target: [0.3, 0.35, -2.3],
    distance: 16,
    yaw: 1.15,
    pitch: 0.3,
    angle: 38,
  });
  const targets = aims.map((aim): Vec => [0, high + (aim * hole) / 2, 0]);
  // The garden is omitted, because the point can lie inside one of its objects.
  const walls = useScene(sceneText({ background, materials, group: room }));
  const casts = useCasts(walls, point, targets, text);
  const passed = casts.filter((cast) => cast.hit?.object === 1);
  const heights = passed.map((cast) => cast.hit?.point[1] ?? 0);
  const spot = heights.length > 1 ? Math.max(...heights) - Math.min(...heights) : 0;
  const z = -point[2];
  // A camera with this hole and the wall as its film renders the image on the wall.
  const angle = (2 * Math.atan(1.35 / depth) * 180) / Math.PI;
  const film = useScene(
    sceneText({ background: "0.72 0.80 0.92", materials, group: garden }).replace(
      /^.*\n/,
      `PinholeCamera { center 0 ${high} 0 direction 0 0 -1 up 0 1 0 angle ${angle} hole ${hole} filmDistance ${depth} }\n`,
    ),
    [{ name: "samples", value: "36" }],
  );
  return (
    <Figure
      ready={casts.length > 0}
      stage={
        <div class="beside">
          <Stage
            session={session}
            eye={eye}
            setEye={setEye}
            label="A dark room with a hole in its wall, and a garden in front of it"
          >
            {(view) => (
              <>
                <Path
                  view={view}
                  points={[
                    [-2, -1, 0],
                    [-2, 1.7, 0],
                    [-2, 1.7, depth],
                    [-2, -1, depth],
                  ]}
                  color="var(--ink)"
                  width={1.5}
                  closed
                />
                <Path
                  view={view}
                  points={[
                    [-2, 1.7, 0],
                    [2, 1.7, 0],
                    [2, 1.7, depth],
                    [-2, 1.7, depth],
                  ]}
                  color="var(--ink)"
                  width={1.5}
                  closed
                />
                {casts.map((cast, i) => {
                  const passes = cast.hit?.object === 1;
                  const to = cast.hit?.point ?? targets[i] ?? point;
                  return (
                    <g key={aims[i]}>
                      <Line
                        view={view}
                        from={point}
                        to={to}
                        color={passes ? "var(--ray-camera)" : "var(--ray-shadowed)"}
                        width={passes ? 1.2 : 0.8}
                      />
                      <Dot
                        view={view}
                        at={to}
                        color={passes ? "var(--ray-lit)" : "var(--ray-shadowed)"}
                        radius={2.5}
                      />
                    </g>
                  );
                })}
                <Name view={view} at={[2, 1.7, depth]} dy={-10}>
                  wall
                </Name>
                <Point3
                  view={view}
                  at={point}
                  color="var(--ray-scattered)"
                  label="The point in the garden"
                  plane={[1, 0, 0]}
                  move={([x, y, z]) => setPoint([x, limit(y, 1.6), Math.max(-5.6, Math.min(-1, z))])}
                />
              </>
            )}
          </Stage>
          <div class="inset turned">
            <RenderedImage
              session={film}
              width={200}
              height={200}
              label="The image on the wall, upside down"
            />
          </div>
        </div>
      }
      controls={
        <>
          <Slider
            label="hole"
            value={hole}
            min={0.04}
            max={0.8}
            step={0.01}
            text={fixed(hole)}
            change={setHole}
          />
          <Slider
            label="depth of the room"
            value={depth}
            min={0.8}
            max={3}
            step={0.05}
            text={fixed(depth)}
            change={setDepth}
          />
        </>
      }
    >
      <Equation
        numbers={
          <>
            <b>{passed.length}</b> of {casts.length} rays from this point pass and illuminate a spot{" "}
            <b>{fixed(spot, 3)}</b> high
          </>
        }
      >
        <Sym color="var(--ray-lit)">spot</Sym> = <Sym>hole</Sym> (1 + <Sym>depth</Sym> / <Sym>z</Sym>) ={" "}
        {fixed(hole * (1 + depth / z), 3)}
      </Equation>
      <Equation
        numbers={
          <>
            π ({fixed(hole)} / 2)² / {fixed(depth)}² ={" "}
            <b>{fixed((Math.PI * hole * hole) / (4 * depth * depth), 4)}</b>
          </>
        }
      >
        brightness ∝ area of the <Sym>hole</Sym> / <Sym>depth</Sym>²
      </Equation>
    </Figure>
  );
}

function limit(x: number, most: number): number {
  return Math.max(-most, Math.min(most, x));
}

export const obscura: Topic = {
  id: "obscura",
  title: "Camera obscura",
  lead: "In a dark room with a small hole in one wall, the garden outside appears upside down on the opposite wall.",
  text: [
    "Each point of the garden sends light in all directions. Only the rays through the hole enter the room, and they illuminate one spot on the wall. The image is turned upside down, and left and right are swapped.",
    "A larger hole makes the image brighter, because more rays pass, but less sharp, because each point illuminates a larger spot with the shape of the hole. A deeper room makes the image larger and darker.",
    "Such rooms were known in Dürer’s time, and painters later traced the image on the wall. A photographic camera is the same room with a lens in the hole.",
  ],
  Figure: ObscuraFigure,
  questions: [
    {
      ask: "Below trees, sunlight forms round spots on the ground even if the gaps between the leaves are not round. Why?",
      answer: "Each gap acts as a pinhole, and the spot is an image of the sun, which is round.",
    },
    {
      ask: "You make the hole twice as wide. How much more light comes in, and how much larger is the spot?",
      answer:
        "Four times as much light, because of the hole’s area. The spot of each point becomes twice as wide, and the wall four times as bright.",
    },
  ],
};
