import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { Shell } from "./shell";
import { best, moves } from "./tour-math";
import { TourSpace, type TourState } from "./tour-space";
import type { TourReport } from "./types";

/** Report of `durer photo tour`: a walk among photographs, as points and cameras in space. */
export function Tour({ report }: { report: TourReport }) {
  const { photographs, points } = report;
  const [state, setState] = useState<TourState | null>(null);
  const space = useMemo(() => new TourSpace(report, setState), [report]);
  const { current, message } = state ?? space.state;
  const strip = useRef<HTMLUListElement>(null);

  useEffect(() => {
    const shown = strip.current?.querySelector('[aria-current="true"]');
    shown?.scrollIntoView({ block: "nearest", inline: "center" });
  }, [current]);
  const move = (name: string) => {
    const score = moves[name];
    if (!score) return;
    if (current < 0) return space.say("choose a photograph first");
    const next = best(photographs, points, current, score);
    if (next < 0) space.say(`no photograph ${name}`);
    else space.fly(next);
  };
  return (
    <Shell command="photo tour" title="A walk among photographs" height="window">
      <main class="tour">
        <h1 class="visually-hidden">A walk among photographs</h1>
        <View space={space} report={report} />
        <nav class="moves" aria-label="Go to another photograph">
          <button type="button" class="button" onClick={() => space.fly(-1)}>
            all of it
          </button>
          {Object.keys(moves).map((name) => (
            <button key={name} type="button" class="button" onClick={() => move(name)}>
              {name}
            </button>
          ))}
          <p role="status">{message}</p>
        </nav>
        <ul class="strip" ref={strip} aria-label="Photographs">
          {photographs.map(({ name, picture }, i) => (
            <li key={name}>
              <button
                type="button"
                title={name}
                aria-current={i === current ? "true" : undefined}
                onClick={() => space.fly(i)}
              >
                <img src={picture} alt={name} />
              </button>
            </li>
          ))}
        </ul>
        <p class="hint">
          Drag to turn, scroll to zoom. Click a photograph, here or in the view, to fly to it; click a point
          to see every photograph of it. Lens distortion is shown as photographed.
        </p>
      </main>
    </Shell>
  );
}

/** Drawing of the points and cameras, with the photographs above it. */
function View({ space, report }: { space: TourSpace; report: TourReport }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const images = useRef<(HTMLImageElement | null)[]>([]);
  const held = useRef<{ x: number; y: number; moved: number } | null>(null);

  useLayoutEffect(() => {
    if (!canvas.current) return;
    space.attach(
      canvas.current,
      images.current.filter((image) => image !== null),
    );
    const observer = new ResizeObserver(() => space.resize());
    observer.observe(canvas.current);
    return () => observer.disconnect();
  }, [space]);
  return (
    <div class="tour-space">
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label="Points and cameras in 3D: arrow keys turn, plus and minus zoom"
        onPointerDown={(event) => {
          event.currentTarget.setPointerCapture(event.pointerId);
          held.current = { x: event.clientX, y: event.clientY, moved: 0 };
        }}
        onPointerMove={(event) => {
          const from = held.current;
          if (!from) return;
          const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
          held.current = {
            x: event.clientX,
            y: event.clientY,
            moved: from.moved + Math.abs(dx) + Math.abs(dy),
          };
          if (held.current.moved > 4) space.turn(dx / 200, dy / 200);
        }}
        onPointerUp={(event) => {
          const { left, top } = event.currentTarget.getBoundingClientRect();
          if (held.current && held.current.moved <= 4) space.pick(event.clientX - left, event.clientY - top);
          held.current = null;
        }}
        onWheel={(event) => {
          event.preventDefault();
          space.zoom(Math.exp(event.deltaY / 800));
        }}
        onKeyDown={(event) => {
          const turns: Record<string, [number, number]> = {
            ArrowLeft: [-0.1, 0],
            ArrowRight: [0.1, 0],
            ArrowUp: [0, 0.1],
            ArrowDown: [0, -0.1],
          };
          const [turn, zoom] = [turns[event.key], { "+": 0.9, "-": 1.1 }[event.key]];
          if (!turn && !zoom) return;
          event.preventDefault();
          if (turn) space.turn(...turn);
          if (zoom) space.zoom(zoom);
        }}
      />
      {report.photographs.map(({ name, picture }, i) => (
        <img
          key={name}
          ref={(image) => {
            images.current[i] = image;
          }}
          src={picture}
          alt=""
          onLoad={() => space.draw()}
        />
      ))}
    </div>
  );
}
