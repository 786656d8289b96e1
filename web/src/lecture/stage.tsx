import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import type { Session } from "../engine/engine";
import { type Eye, frame, orbit, type Projector, projector } from "../explain/space";
import { useDrawingSize } from "../ui/drawing-size";
import { draw } from "../viewer/picture";

interface Props {
  session: Session;
  eye: Eye;
  setEye(eye: Eye): void;
  label: string;
  /** Width divided by height. */
  aspect?: number;
  children(view: Projector): ComponentChildren;
}

/** Rendered scene with a drawing on top. Dragging orbits the camera. */
export function Stage({ session, eye, setEye, label, aspect = 16 / 9, children }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const size = useDrawingSize(box);
  const drag = useRef<{ x: number; y: number } | null>(null);
  const moving = useRef(false);

  useEffect(
    () =>
      session.on((event, bytes) => {
        if (event.kind === "picture" && canvas.current)
          draw(canvas.current, event.head.width, event.head.height, bytes);
        // Replace the scene's own camera by the figure's.
        if (event.kind === "scene") look(session, latest.current, false);
      }),
    [session],
  );
  const fitted = { ...eye, angle: fitAngle(eye.angle, size.width / size.height, aspect) };
  const latest = useRef(fitted);
  latest.current = fitted;

  useEffect(() => {
    if (size.width < 2) return;
    const ratio = size.unit * Math.min(window.devicePixelRatio || 1, 2);
    session.send({
      kind: "size",
      width: Math.round(size.width * ratio),
      height: Math.round(size.height * ratio),
    });
    look(session, fitted, moving.current);
  }, [session, size]);
  useLayoutEffect(() => {
    if (size.width >= 2) look(session, fitted, moving.current);
  }, [session, eye]);

  const view = projector(frame(fitted), size.width, size.height);
  const settle = () => {
    drag.current = null;
    if (moving.current) {
      moving.current = false;
      look(session, fitted, false);
    }
  };
  return (
    <div class="stage" ref={box} style={{ aspectRatio: String(aspect) }}>
      <canvas ref={canvas} />
      <svg
        viewBox={`0 0 ${size.width} ${size.height}`}
        role="group"
        aria-label={label}
        tabindex={0}
        onPointerDown={(event) => {
          if (event.defaultPrevented) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          drag.current = { x: event.clientX, y: event.clientY };
        }}
        onPointerMove={(event) => {
          const from = drag.current;
          if (!from) return;
          drag.current = { x: event.clientX, y: event.clientY };
          moving.current = true;
          setEye(orbit(eye, (event.clientX - from.x) * 0.008, (event.clientY - from.y) * 0.008));
        }}
        onPointerUp={settle}
        onPointerCancel={settle}
        onKeyDown={(event) => {
          if (event.target !== event.currentTarget || !event.shiftKey) return;
          const turns: Record<string, [number, number]> = {
            ArrowLeft: [-0.1, 0],
            ArrowRight: [0.1, 0],
            ArrowUp: [0, 0.1],
            ArrowDown: [0, -0.1],
          };
          const by = turns[event.key];
          if (!by) return;
          event.preventDefault();
          event.stopPropagation();
          setEye(orbit(eye, ...by));
        }}
      >
        {size.width > 1 && children(view)}
      </svg>
    </div>
  );
}

/** Widens the angle of a stage that is wider than designed, so that nothing is cut off at its top and bottom. */
export function fitAngle(angle: number, aspect: number, designed: number): number {
  if (!(aspect > designed)) return angle;
  return (Math.atan((Math.tan((angle * Math.PI) / 360) * aspect) / designed) * 360) / Math.PI;
}

function look(session: Session, eye: Eye, moving: boolean) {
  const { eye: center, forward: direction } = frame(eye);
  session.send({ kind: "look", center, direction, up: [0, 1, 0], angle: eye.angle, moving });
}
