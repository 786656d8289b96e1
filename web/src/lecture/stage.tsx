import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Session } from "../engine/engine";
import { type Eye, frame, orbit, type Projector, projector } from "../explain/space";
import { draw } from "../viewer/picture";

interface Props {
  session: Session;
  eye: Eye;
  setEye(eye: Eye): void;
  label: string;
  /** Width divided by height. */
  aspect?: number;
  children(view: Projector, size: { width: number; height: number }): ComponentChildren;
}

/** Rendered scene with a drawing on top. Dragging orbits the camera. */
export function Stage({ session, eye, setEye, label, aspect = 16 / 9, children }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState({ width: 0, height: 0 });
  const drag = useRef<{ x: number; y: number } | null>(null);
  const moving = useRef(false);

  useEffect(() => {
    if (!box.current) return;
    const observer = new ResizeObserver(([entry]) => {
      if (entry) setSize({ width: entry.contentRect.width, height: entry.contentRect.height });
    });
    observer.observe(box.current);
    return () => observer.disconnect();
  }, []);
  useEffect(
    () =>
      session.on((event, bytes) => {
        if (event.kind === "picture" && canvas.current)
          draw(canvas.current, event.head.width, event.head.height, bytes);
        // Replace the scene's own camera by the figure's.
        if (event.kind === "scene") look(session, eyeRef.current, false);
      }),
    [session],
  );
  const eyeRef = useRef(eye);
  eyeRef.current = eye;

  useEffect(() => {
    if (size.width < 2) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    session.send({
      kind: "size",
      width: Math.round(size.width * ratio),
      height: Math.round(size.height * ratio),
    });
    look(session, eye, moving.current);
  }, [session, size]);
  useLayoutEffect(() => {
    if (size.width >= 2) look(session, eye, moving.current);
  }, [session, eye]);

  const view = projector(frame(eye), size.width, size.height);
  const settle = () => {
    drag.current = null;
    if (moving.current) {
      moving.current = false;
      look(session, eye, false);
    }
  };
  return (
    <div class="stage" ref={box} style={{ aspectRatio: String(aspect) }}>
      <canvas ref={canvas} />
      <svg
        width={size.width}
        height={size.height}
        role="group"
        aria-label={label}
        tabIndex={0}
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
        {size.width > 1 && children(view, size)}
      </svg>
    </div>
  );
}

function look(session: Session, eye: Eye, moving: boolean) {
  const { eye: center, forward: direction } = frame(eye);
  session.send({ kind: "look", center, direction, up: [0, 1, 0], angle: eye.angle, moving });
}
