import { useEffect, useRef, useState } from "preact/hooks";
import type { Session } from "../../engine/engine";
import { fixed, Slider } from "../../ui/slider";
import { usePixel, useScene } from "../context";
import { MistakeCode, MistakeSwitch, useFigureMistake } from "../mistaken";
import { Equation, Figure, Switch, Sym } from "../parts";
import { PixelPicker } from "../picked";
import { RenderedImage } from "../rendered";
import type { Topic } from "../topic";

const [width, height] = [320, 240];
/** Scene with a ring and a thin wall on a floor. A ray that starts too far off the floor is already behind the wall. */
const text = `PerspectiveCamera { center 0.2 1.5 5.4 direction 0 -0.3 -1 up 0 1 0 angle 40 }
Background { color 0.72 0.78 0.86 ambientLight 0.16 0.16 0.18 }
Lights { PointLight { position -3.2 3.4 2 color 0.9 0.9 0.86 } }
Materials {
  PhongMaterial { diffuseColor 0.62 0.61 0.58 }
  PhongMaterial { diffuseColor 0.72 0.30 0.18 }
  PhongMaterial { diffuseColor 0.20 0.38 0.62 }
}
Group {
  MaterialIndex 0 Plane { normal 0 1 0 offset -0.8 }
  MaterialIndex 1 Torus { center -0.75 -0.22 0 axis 0.35 1 0.5 majorRadius 0.62 minorRadius 0.26 }
  MaterialIndex 2 Transform { Translate 0.8 -0.1 -0.1 YRotate 8 Box { min -0.03 -0.7 -1 max 0.03 0.7 1 } }
}
`;
const options = [{ name: "samples", value: "1" }];

function EpsilonFigure() {
  // The slider moves in powers of ten; its first step is 0.
  const [step, setStep] = useState(0);
  const [exact, setExact] = useState(false);
  const [wrong, setWrong] = useState<number | null>(null);
  const epsilon = step === 0 ? 0 : 10 ** (step / 10 - 7.5);
  const withEpsilon = useScene(text, options);
  const exactSession = useScene(text, options);
  const pictures = useRef<{ broken?: Uint8Array; sound?: Uint8Array }>({});
  useEffect(() => {
    withEpsilon.send({ kind: "epsilon", epsilon: exact ? null : epsilon });
  }, [withEpsilon, epsilon, exact]);
  useEffect(() => {
    const hear = (name: "broken" | "sound") => (session: Session) =>
      session.on((event, bytes) => {
        if (event.kind !== "picture" || event.head.hash === null) return;
        pictures.current[name] = bytes.slice();
        const { broken: a, sound: b } = pictures.current;
        if (a && b) setWrong(differing(a, b));
      });
    const ends = [hear("broken")(withEpsilon), hear("sound")(exactSession)];
    return () => {
      for (const end of ends) end();
    };
  }, [withEpsilon, exactSession]);
  const mistake = useFigureMistake(withEpsilon, "epsilon-negative", [width, height], [epsilon, exact]);
  const [place, setPlace] = useState({ x: 0.36, y: 0.5 });
  const pixel = { x: Math.floor(place.x * width), y: Math.floor(place.y * height) };
  const account = usePixel(withEpsilon, pixel.x, pixel.y, `${epsilon} ${exact}`);
  const light = account?.tree?.terms.find(
    (term) => term.segment?.role === "shadowed" || term.segment?.role === "lit",
  );
  const shadow = light?.rows.find((row) => row.name === "shadow ray")?.result ?? "this pixel sees no surface";
  const sizes = { session: withEpsilon, width, height };
  return (
    <Figure
      stage={
        <div class="halves">
          <PixelPicker place={place} pick={setPlace}>
            <RenderedImage
              {...sizes}
              label="The scene with this epsilon; click for the shadow ray of a pixel"
              mistaken={mistake.picture}
            />
          </PixelPicker>
          <RenderedImage {...sizes} session={exactSession} label="The scene with exact ray origins" />
        </div>
      }
      controls={
        <>
          <Slider
            label="epsilon"
            value={step}
            min={0}
            max={75}
            step={1}
            text={exact ? "none" : formatEpsilon(epsilon)}
            change={(next) => {
              setStep(next);
              setExact(false);
            }}
          />
          <Switch label="Exact origins, no epsilon" on={exact} change={setExact} />
          <MistakeSwitch name="an epsilon with the wrong sign" mistake={mistake} />
        </>
      }
    >
      <Equation
        numbers={
          wrong === null ? (
            "…"
          ) : (
            <>
              <b>{wrong.toLocaleString("en")}</b> of {(width * height).toLocaleString("en")} pixels are wrong
              {describeErrors(exact ? null : epsilon, wrong)}
            </>
          )
        }
      >
        a hit counts if <Sym>t</Sym> &gt; <Sym>ε</Sym>
      </Equation>
      <Equation numbers={<b>{shadow}</b>}>
        the shadow ray of pixel {pixel.x}, {pixel.y}
      </Equation>
      <MistakeCode mistake={mistake} />
    </Figure>
  );
}

/** Counts pixels whose colours differ visibly. */
export function differing(a: Uint8Array, b: Uint8Array): number {
  let count = 0;
  for (let i = 0; i + 3 < Math.min(a.length, b.length); i += 4) {
    if ([0, 1, 2].some((k) => Math.abs((a[i + k] ?? 0) - (b[i + k] ?? 0)) > 4)) count++;
  }
  return count;
}

function formatEpsilon(epsilon: number): string {
  if (epsilon === 0) return "0";
  return epsilon < 0.001 ? epsilon.toExponential(1).replace("-", "−") : fixed(epsilon, 3);
}

function describeErrors(epsilon: number | null, wrong: number): string {
  if (wrong === 0) return "";
  return epsilon !== null && epsilon < 0.01 ? ": surfaces shadow themselves" : ": light leaks below objects";
}

export const epsilon: Topic = {
  id: "epsilon",
  title: "Epsilon",
  lead: "A shadow ray starts on a surface. Rounding can put its origin just inside, and then the surface shadows itself.",
  text: [
    "The hit point is rounded, so it lies slightly above or slightly below the surface. From below, the shadow ray hits the very surface that it leaves. This gives dark spots, called shadow acne. The usual remedy is an epsilon: hits with a smaller t do not count.",
    "But how small should it be? If it is too small, spots remain. If it is too large, rays miss nearby objects, and light leaks at the foot of the wall and below the ring. A scene of a different size needs a different epsilon.",
    "Dürer uses none. It computes a bound on the rounding error of each point, and starts the ray just outside of it. In addition, its test of a ray against the edge between two triangles is exact, so no ray slips through between them.",
  ],
  Figure: EpsilonFigure,
  questions: [
    {
      ask: "Why does the ring have spots, but the floor none?",
      answer:
        "The floor’s height is a number that needs no rounding, so hit points lie exactly on the floor. On the ring, all three coordinates are rounded.",
    },
    {
      ask: "Where does light leak first if epsilon grows?",
      answer: "Where objects touch the floor: there, the distance to the occluder is shortest.",
    },
  ],
};
