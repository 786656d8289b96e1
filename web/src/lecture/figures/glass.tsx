import { useState } from "preact/hooks";
import { flatten } from "../../explain/segments";
import { fixed, Slider } from "../../ui/slider";
import { usePageBackground, useScene, useTrace } from "../context";
import { Handle } from "../draw";
import { Choice, Equation, Figure, Mistake, Sym, Wrong } from "../parts";
import { PlaneArrow, PlaneName, Plot } from "../plot";
import { sceneText } from "../scenes";
import type { Topic } from "../topic";

type Side = "outside" | "inside";

function GlassFigure() {
  const [degrees, setDegrees] = useState(38);
  const [index, setIndex] = useState(1.5);
  const [side, setSide] = useState<Side>("outside");
  const [wrong, setWrong] = useState(false);
  const text = sceneText({
    background: usePageBackground(),
    materials: [`diffuseColor 0 0 0 specularColor 1 1 1 transparentColor 1 1 1 refractionIndex ${index}`],
    group: "MaterialIndex 0 Plane { normal 0 1 0 offset 0 }",
  });
  const probe = useScene(text, [
    { name: "samples", value: "1" },
    { name: "min-throughput", value: "0" },
    { name: "bounces", value: "1" },
  ]);
  const sign = side === "outside" ? 1 : -1;
  const angle = (degrees * Math.PI) / 180;
  const from: [number, number] = [-2.1 * Math.sin(angle), sign * 2.1 * Math.cos(angle)];
  const pixel = useTrace(probe, [...from, 0], [-from[0], -from[1], 0], text);
  const terms = flatten(pixel?.tree).map(({ term }) => term);
  const split = terms.find((term) => term.rows.some((row) => row.name === "η"));
  const value = (name: string) => split?.rows.find((row) => row.name === name)?.value ?? null;
  const [here, there, sine] = [value("η"), value("η′"), value("sin θ′")];
  const total = sine != null && sine > 1;
  const mirrored = total ? 1 : value("R");
  const through = terms.find((term) => term.segment?.role === "transmitted")?.segment;
  const back = terms.find((term) => term.segment?.role === "reflected")?.segment;
  const end = (segment: typeof through): [number, number] | null => {
    if (!segment) return null;
    const [dx, dy] = [segment.to[0] - segment.from[0], segment.to[1] - segment.from[1]];
    const size = Math.hypot(dx, dy) || 1;
    return [(2.1 * dx) / size, (2.1 * dy) / size];
  };
  const [ahead, away] = [end(through), end(back)];
  const width = (share: number) => 1 + 7 * share;
  const wrongSine = here == null || there == null ? null : (there * Math.sin(angle)) / here;
  const wrongAngle = Math.asin(Math.min(1, wrongSine ?? 0));
  return (
    <Figure
      stage={
        <Plot reach={[4.4, 2.4]} label="A ray at a glass surface">
          {(scale) => (
            <>
              <rect
                x={0}
                y={scale.y(0)}
                width={scale.width}
                height={scale.height}
                fill="var(--ray-transmitted)"
                fill-opacity={0.13}
              />
              <line
                x1={0}
                x2={scale.width}
                y1={scale.y(0)}
                y2={scale.y(0)}
                stroke="var(--ink)"
                stroke-width={2.5}
              />
              <line
                x1={scale.x(0)}
                x2={scale.x(0)}
                y1={scale.y(2.2)}
                y2={scale.y(-2.2)}
                stroke="var(--soft)"
                stroke-dasharray="6 6"
              />
              <text class="name small" x={16} y={scale.y(0) - 14}>
                air, 1
              </text>
              <text class="name small" x={16} y={scale.y(0) + 28}>
                glass, {fixed(index)}
              </text>
              {away && (
                <PlaneArrow
                  scale={scale}
                  from={[0, 0]}
                  to={away}
                  color="var(--ray-reflected)"
                  width={width(mirrored ?? 0)}
                />
              )}
              {ahead && !total && (
                <PlaneArrow
                  scale={scale}
                  from={[0, 0]}
                  to={ahead}
                  color="var(--ray-transmitted)"
                  width={width(1 - (mirrored ?? 0))}
                />
              )}
              {wrong && wrongSine !== null && wrongSine <= 1 && (
                <PlaneArrow
                  scale={scale}
                  from={[0, 0]}
                  to={[2.1 * Math.sin(wrongAngle), -sign * 2.1 * Math.cos(wrongAngle)]}
                  color="var(--ray-shadowed)"
                  width={4}
                  dashed
                />
              )}
              <PlaneArrow scale={scale} from={from} to={[0, 0]} color="var(--ray-camera)" width={8} />
              {away && (
                <PlaneName scale={scale} at={away} color="var(--ray-reflected)">
                  {Math.round(100 * (mirrored ?? 0))} %
                </PlaneName>
              )}
              {ahead && !total && (
                <PlaneName
                  scale={scale}
                  at={ahead}
                  color="var(--ray-transmitted)"
                  dy={side === "outside" ? 24 : -12}
                >
                  {Math.round(100 * (1 - (mirrored ?? 0)))} %
                </PlaneName>
              )}
              <PlaneName scale={scale} at={[from[0] / 3.4, from[1] / 2.2]} dx={6} color="var(--ray-camera)">
                θ
              </PlaneName>
              <Handle
                x={scale.x(from[0])}
                y={scale.y(from[1])}
                color="var(--ray-camera)"
                label="Origin of the ray"
                drag={(x, y) => {
                  const [px, py] = scale.back(x, y);
                  setDegrees(
                    Math.min(
                      89,
                      Math.max(
                        1,
                        Math.round((Math.atan2(Math.abs(px), Math.max(0.01, sign * py)) * 180) / Math.PI),
                      ),
                    ),
                  );
                }}
              />
            </>
          )}
        </Plot>
      }
      controls={
        <>
          <Slider
            label="θ"
            value={degrees}
            min={1}
            max={89}
            step={1}
            text={`${degrees}°`}
            change={setDegrees}
          />
          <Slider
            label="refractive index"
            value={index}
            min={1.05}
            max={2.5}
            step={0.01}
            text={fixed(index)}
            change={setIndex}
          />
          <Choice
            label="Side of the ray"
            value={side}
            values={[
              ["outside", "From air"],
              ["inside", "From glass"],
            ]}
            change={(value) => setSide(value)}
          />
          <Mistake name="swap η and η′" on={wrong} change={setWrong} />
        </>
      }
    >
      <Equation
        numbers={
          sine == null ? (
            "–"
          ) : (
            <>
              {fixed(here ?? Number.NaN)} · {fixed(Math.sin(angle), 3)} / {fixed(there ?? Number.NaN)} ={" "}
              <b>{fixed(sine, 3)}</b>
              {total ? " > 1: total reflection" : `, θ′ = ${fixed((Math.asin(sine) * 180) / Math.PI, 1)}°`}
              {wrong && wrongSine !== null && (
                <Wrong>
                  {fixed(wrongSine, 3)}
                  {wrongSine > 1
                    ? " > 1: total reflection"
                    : `, θ′ = ${fixed((wrongAngle * 180) / Math.PI, 1)}°`}
                  {wrongSine <= 1 && ": bent the wrong way"}
                </Wrong>
              )}
            </>
          )
        }
      >
        sin <Sym>θ</Sym>′ = <Sym>η</Sym> sin <Sym>θ</Sym> / <Sym>η</Sym>′
      </Equation>
      <Equation numbers={<b>{mirrored == null ? "–" : fixed(mirrored, 4)}</b>}>
        <Sym color="var(--ray-reflected)">R</Sym> = <Sym>R</Sym>
        <sub>0</sub> + (1 − <Sym>R</Sym>
        <sub>0</sub>) (1 − cos <Sym>θ</Sym>)<sup>5</sup>
      </Equation>
    </Figure>
  );
}

export const glass: Topic = {
  id: "glass",
  title: "Glass",
  lead: "Snell's law gives the direction of the refracted ray, Fresnel's equations its share of the light.",
  text: [
    "At the boundary of two media a ray bends: the sines of its angles are inversely proportional to the refractive indices. Part of the light is reflected, more of it at grazing angles: look at a shop window from the side.",
    "Let the ray come from the glass and rotate it. Beyond a critical angle the sine would exceed 1: no light leaves, and the boundary is a perfect mirror.",
  ],
  Figure: GlassFigure,
  questions: [
    {
      ask: "How much light does a window reflect if you look straight through it?",
      answer: "With an index of 1.5, R₀ = ((1.5 − 1) / (1.5 + 1))² = 4 % on each side.",
    },
    {
      ask: "At which angle does total reflection begin in glass of index 1.5?",
      answer: "Where sin θ = 1 / 1.5: at 41.8°.",
    },
  ],
};
