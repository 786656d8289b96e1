import { useEffect, useRef, useState } from "preact/hooks";
import { add, cross, type Eye, mul, unit, type Vec } from "../../explain/space";
import { fixed, Slider } from "../../ui/slider";
import { draw } from "../../viewer/picture";
import { usePageBackground, usePixel, useScene } from "../context";
import { Arrow, Dot, Line, Name, Path } from "../draw";
import { Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { materialPresets, sceneText } from "../scenes";
import { Stage } from "../stage";
import type { Topic } from "../topic";

const at: Vec = [-3.4, 0.7, 2.6];
const forward = unit([0.78, -0.16, -0.6]);
const right = unit(cross(forward, [0, 1, 0]));
const up = cross(right, forward);
const [width, height] = [160, 120];

function CameraFigure() {
  const background = usePageBackground();
  const text = sceneText({
    background,
    materials: [materialPresets.stone, materialPresets.clay, materialPresets.sky, materialPresets.sand],
    group: `MaterialIndex 0 Disc { center 1 -1 -0.6 normal 0 1 0 radius 3 }
      MaterialIndex 1 Sphere { center 0.7 -0.1 -0.4 radius 0.9 }
      MaterialIndex 2 Box { min 1.9 -1 -2 max 2.9 1.1 -1 }
      MaterialIndex 3 Cone { base 1.9 -1 0.9 top 1.9 0.5 0.9 baseRadius 0.55 }`,
  });
  const stage = useScene(text);
  const image = useScene(text, [{ name: "samples", value: "4" }]);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [eye, setEye] = useState<Eye>({
    target: [-0.3, 0.35, 0.6],
    distance: 12,
    yaw: 1.0,
    pitch: 0.42,
    angle: 40,
  });
  const [angle, setAngle] = useState(46);
  const [pixel, setPixel] = useState({ x: 96, y: 52 });
  const [wrong, setWrong] = useState(false);
  // Without the division by 2, the image plane lies where it would for twice the angle.
  const used = wrong ? Math.min(178, 2 * angle) : angle;
  const angleRef = useRef(used);
  angleRef.current = used;

  useEffect(() => {
    const look = (moving: boolean) =>
      image.send({
        kind: "look",
        center: at,
        direction: forward,
        up: [0, 1, 0],
        angle: angleRef.current,
        moving,
      });
    image.send({ kind: "size", width, height });
    look(false);
    return image.on((event, bytes) => {
      if (event.kind === "scene") look(false);
      if (event.kind === "picture" && canvas.current)
        draw(canvas.current, event.head.width, event.head.height, bytes);
    });
  }, [image, used]);

  const account = usePixel(image, pixel.x, pixel.y, `${used} ${text}`);
  const tree = account?.tree ?? null;
  const distance = 1 / Math.tan((used * Math.PI) / 360);
  const [x, y] = [(2 * (pixel.x + 0.5)) / width - 1, (height - 2 * (pixel.y + 0.5)) / width];
  const place = (px: number, py: number): Vec =>
    add(at, add(mul(distance, forward), add(mul(px, right), mul(py, up))));
  const corners = [place(-1, -0.75), place(1, -0.75), place(1, 0.75), place(-1, 0.75)];
  const end = tree?.segment?.to ?? place(3 * x, 3 * y);
  return (
    <Figure
      ready={account !== null}
      stage={
        <div class="beside">
          <Stage session={stage} eye={eye} setEye={setEye} label="The camera seen from outside">
            {(view) => (
              <>
                {corners.map((corner, i) => (
                  <Line key={i} view={view} from={at} to={corner} color="var(--soft)" width={1.2} />
                ))}
                <Path
                  view={view}
                  points={corners}
                  color="var(--ink)"
                  fill="var(--accent)"
                  opacity={0.1}
                  closed
                />
                <Line view={view} from={at} to={end} color="var(--ray-camera)" width={2.5} />
                <Dot view={view} at={end} color="var(--ray-camera)" />
                <Dot view={view} at={place(x, y)} color="var(--ray-camera)" />
                <Arrow view={view} from={at} dir={right} color="var(--ray-shadowed)" width={3} />
                <Arrow view={view} from={at} dir={up} color="var(--ray-lit)" width={3} />
                <Arrow
                  view={view}
                  from={at}
                  dir={forward}
                  length={distance}
                  color="var(--ray-reflected)"
                  width={3}
                />
                <Name view={view} at={add(at, right)} color="var(--ray-shadowed)">
                  u
                </Name>
                <Name view={view} at={add(at, up)} color="var(--ray-lit)">
                  v
                </Name>
                <Name
                  view={view}
                  at={add(at, mul(distance * 0.55, forward))}
                  color="var(--ray-reflected)"
                  dy={24}
                >
                  D w
                </Name>
              </>
            )}
          </Stage>
          <div class="inset">
            <canvas
              ref={canvas}
              role="img"
              aria-label="The image of this camera; click to see the ray of a pixel"
              onPointerDown={(event) => {
                const box = event.currentTarget.getBoundingClientRect();
                const column = Math.floor(((event.clientX - box.left) / box.width) * width);
                const row = Math.floor(((event.clientY - box.top) / box.height) * height);
                setPixel({ x: Math.min(width - 1, column), y: Math.min(height - 1, row) });
              }}
            />
            <span
              class="cross"
              style={{
                left: `${(100 * (pixel.x + 0.5)) / width}%`,
                top: `${(100 * (pixel.y + 0.5)) / height}%`,
              }}
            />
          </div>
        </div>
      }
      controls={
        <>
          <Slider
            label="angle"
            value={angle}
            min={10}
            max={wrong ? 85 : 120}
            step={1}
            text={`${angle}°`}
            change={setAngle}
          />
          <Slider
            label="x"
            value={pixel.x}
            min={0}
            max={width - 1}
            step={1}
            text={fixed(x)}
            change={(px) => setPixel({ ...pixel, x: px })}
          />
          <Slider
            label="y"
            value={height - 1 - pixel.y}
            min={0}
            max={height - 1}
            step={1}
            text={fixed(y)}
            change={(py) => setPixel({ ...pixel, y: height - 1 - py })}
          />
          <Mistake name="tan(angle) instead of tan(angle / 2)" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          <>
            1 / tan {angle / 2}° = <b>{fixed(1 / Math.tan((angle * Math.PI) / 360), 4)}</b>
            {wrong && (
              <Wrong>
                1 / tan {angle}° = {row(tree, "D") ?? fixed(distance, 4)}: everything looks too small
              </Wrong>
            )}
          </>
        }
      >
        <Sym>D</Sym> = 1 / tan(<Sym>angle</Sym> / 2)
      </Equation>
      <Equation numbers={<b>{row(tree, "d") ?? "–"}</b>}>
        <Sym vector color="var(--ray-camera)">
          d
        </Sym>{" "}
        = <Sym>D</Sym>{" "}
        <Sym vector color="var(--ray-reflected)">
          w
        </Sym>{" "}
        + <Sym>x</Sym>{" "}
        <Sym vector color="var(--ray-shadowed)">
          u
        </Sym>{" "}
        + <Sym>y</Sym>{" "}
        <Sym vector color="var(--ray-lit)">
          v
        </Sym>
      </Equation>
    </Figure>
  );
}

function row(tree: { rows: { name: string; result: string }[] } | null, name: string): string | undefined {
  return tree?.rows.find((known) => known.name === name)?.result;
}

export const camera: Topic = {
  id: "camera",
  title: "The camera",
  lead: "Three axes and an angle turn a position in the image into a ray.",
  text: [
    "The camera has a position and three axes: u to the right, v upwards, w forwards. The image plane is at distance D in front of it and reaches from −1 to 1 across its larger side. A pixel at (x, y) gets the ray with direction D w + x u + y v.",
    "Make the angle wider: D shrinks, the image plane comes closer, and more of the world fits into it.",
  ],
  Figure: CameraFigure,
  questions: [
    { ask: "At which angle is D exactly 1?", answer: "At 90°: tan 45° is 1." },
    {
      ask: "Why does y reach only from −0.75 to 0.75 here?",
      answer:
        "The aspect ratio is 4:3. The larger side spans −1 to 1, the other side three quarters of that, so that pixels are square.",
    },
  ],
};
