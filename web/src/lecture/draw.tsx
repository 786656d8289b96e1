import type { ComponentChildren } from "preact";
import { useRef } from "preact/hooks";
import { add, mul, type Projector, type Vec } from "../explain/space";

/** Properties of a line in world space. */
interface LineProps {
  view: Projector;
  from: Vec;
  to: Vec;
  color: string;
  width?: number;
  dashed?: boolean;
  arrow?: boolean;
}

/** Draws a line in world space. */
export function Line({ view, from, to, color, width = 2.5, dashed, arrow }: LineProps) {
  const projected = view.line(from, to);
  if (!projected) return null;
  const [a, b] = projected;
  return (
    <g stroke={color} fill={color} stroke-width={width} stroke-linecap="round">
      <line x1={a.x} y1={a.y} x2={b.x} y2={b.y} stroke-dasharray={dashed ? "6 6" : undefined} />
      {arrow && <Head x={b.x} y={b.y} angle={Math.atan2(b.y - a.y, b.x - a.x)} size={4 + 2.4 * width} />}
    </g>
  );
}

/** Draws an arrowhead at a position in the drawing. */
export function Head({ x, y, angle, size }: { x: number; y: number; angle: number; size: number }) {
  const corner = (turn: number) =>
    `${x + size * Math.cos(angle + turn)},${y + size * Math.sin(angle + turn)}`;
  return <polygon points={`${x},${y} ${corner(2.68)} ${corner(-2.68)}`} stroke="none" />;
}

/** Draws a vector as an arrow from a point. */
export function Arrow(props: Omit<LineProps, "to" | "arrow"> & { dir: Vec; length?: number }) {
  const { dir, length = 1, ...rest } = props;
  return <Line {...rest} to={add(props.from, mul(length, dir))} arrow />;
}

/** Draws a closed or open polyline. */
export function Path({
  view,
  points,
  color,
  width = 2,
  fill = "none",
  opacity = 1,
  closed = false,
}: {
  view: Projector;
  points: Vec[];
  color: string;
  width?: number;
  fill?: string;
  opacity?: number;
  closed?: boolean;
}) {
  const projected = points.map((point) => view.point(point));
  if (projected.some((point) => point === null)) return null;
  const text = projected.map((point) => `${point?.x},${point?.y}`).join(" ");
  const look = { points: text, stroke: color, "stroke-width": width, fill, "fill-opacity": opacity };
  return closed ? (
    <polygon {...look} stroke-linejoin="round" />
  ) : (
    <polyline {...look} stroke-linejoin="round" />
  );
}

/** Draws a label beside a point in world space. */
export function Name({
  view,
  at,
  color,
  children,
  dx = 10,
  dy = -10,
}: {
  view: Projector;
  at: Vec;
  color?: string;
  children: ComponentChildren;
  dx?: number;
  dy?: number;
}) {
  const projected = view.point(at);
  if (!projected) return null;
  return (
    <Label x={projected.x} y={projected.y} dx={dx} dy={dy} width={view.width} color={color}>
      {children}
    </Label>
  );
}

/** Draws a label beside a position, on its left near the right edge of the drawing. */
export function Label({
  x,
  y,
  dx,
  dy,
  width,
  color,
  children,
}: {
  x: number;
  y: number;
  dx: number;
  dy: number;
  /** Width of the drawing. */
  width: number;
  color: string | undefined;
  children: ComponentChildren;
}) {
  const isLeft = dx > 0 && x + dx > width - 90;
  return (
    <text
      class="name"
      x={isLeft ? x - dx : x + dx}
      y={Math.max(20, y + dy)}
      text-anchor={isLeft ? "end" : "start"}
      fill={color ?? "var(--ink)"}
    >
      {children}
    </text>
  );
}

/** Draws a point in world space. */
export function Dot({
  view,
  at,
  color,
  radius = 5,
}: {
  view: Projector;
  at: Vec;
  color: string;
  radius?: number;
}) {
  const projected = view.point(at);
  return (
    projected && (
      <circle
        cx={projected.x}
        cy={projected.y}
        r={radius}
        fill={color}
        stroke="var(--paper)"
        stroke-width={1.5}
      />
    )
  );
}

/** Properties of a handle at a position in the drawing. */
interface HandleProps {
  x: number;
  y: number;
  color: string;
  label: string;
  /** Handles a drag to a position in the drawing. */
  drag(x: number, y: number): void;
  /** Handles arrow keys, with steps in units of the drawing. */
  nudge?(dx: number, dy: number): void;
  end?(): void;
}

/** Handle that can be dragged, or moved with the arrow keys. */
export function Handle({ x, y, color, label, drag, nudge, end }: HandleProps) {
  const held = useRef<{ dx: number; dy: number } | null>(null);
  const place = (event: PointerEvent & { currentTarget: Element }) => {
    const svg = event.currentTarget.closest("svg");
    if (!svg) return { x: 0, y: 0 };
    const box = svg.getBoundingClientRect();
    const unit = box.width / svg.viewBox.baseVal.width;
    return { x: (event.clientX - box.left) / unit, y: (event.clientY - box.top) / unit };
  };
  const release = () => {
    held.current = null;
    end?.();
  };
  return (
    <g
      class="handle"
      role="button"
      tabindex={0}
      aria-label={`${label}: drag, or use the arrow keys`}
      transform={`translate(${x} ${y})`}
      onPointerDown={(event) => {
        event.preventDefault();
        event.stopPropagation();
        event.currentTarget.focus();
        event.currentTarget.setPointerCapture(event.pointerId);
        const at = place(event);
        held.current = { dx: x - at.x, dy: y - at.y };
      }}
      onPointerMove={(event) => {
        if (!held.current) return;
        const at = place(event);
        drag(at.x + held.current.dx, at.y + held.current.dy);
      }}
      onPointerUp={release}
      onPointerCancel={release}
      onKeyDown={(event) => {
        const step = event.shiftKey ? 24 : 6;
        const by: Record<string, [number, number]> = {
          ArrowLeft: [-step, 0],
          ArrowRight: [step, 0],
          ArrowUp: [0, -step],
          ArrowDown: [0, step],
        };
        const move = by[event.key];
        if (!move) return;
        event.preventDefault();
        event.stopPropagation();
        if (nudge) nudge(...move);
        else drag(x + move[0], y + move[1]);
        end?.();
      }}
    >
      <circle class="halo" r={17} fill={color} />
      <circle r={8} fill={color} stroke="var(--paper)" stroke-width={2.5} />
    </g>
  );
}
