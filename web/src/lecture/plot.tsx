import type { ComponentChildren } from "preact";
import { useRef } from "preact/hooks";
import { useDrawingSize } from "../ui/drawing-size";
import { Label } from "./draw";

/** Mapping from the plane of a figure to the units of its drawing. */
export interface Scale {
  x(x: number): number;
  y(y: number): number;
  /** Maps units of the drawing back to the plane. */
  back(x: number, y: number): [number, number];
  /** Units of the drawing per unit of the plane. */
  unit: number;
  width: number;
  height: number;
}

interface Props {
  /** Minimum visible range in units: from -x to x and from -y to y around the middle. */
  reach: [number, number];
  middle?: [number, number];
  label: string;
  aspect?: number;
  children(scale: Scale): ComponentChildren;
}

/** Two-dimensional drawing of a figure. */
export function Plot({ reach, middle = [0, 0], label, aspect = 16 / 9, children }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const { width, height } = useDrawingSize(box);
  const unit = Math.min(width / (2 * reach[0]), height / (2 * reach[1]));
  const scale: Scale = {
    x: (x) => width / 2 + (x - middle[0]) * unit,
    y: (y) => height / 2 - (y - middle[1]) * unit,
    back: (x, y) => [(x - width / 2) / unit + middle[0], (height / 2 - y) / unit + middle[1]],
    unit,
    width,
    height,
  };
  return (
    <div class="stage plot" ref={box} style={{ aspectRatio: String(aspect) }}>
      <svg viewBox={`0 0 ${width} ${height}`} role="group" aria-label={label}>
        {width > 1 && children(scale)}
      </svg>
    </div>
  );
}

/** Draws an arrow in the plane. */
export function PlaneArrow({
  scale,
  from,
  to,
  color,
  width = 3,
  dashed = false,
  head = true,
}: {
  scale: Scale;
  from: [number, number];
  to: [number, number];
  color: string;
  width?: number;
  dashed?: boolean;
  head?: boolean;
}) {
  const [x1, y1, x2, y2] = [scale.x(from[0]), scale.y(from[1]), scale.x(to[0]), scale.y(to[1])];
  const angle = Math.atan2(y2 - y1, x2 - x1);
  const size = 5 + 2.6 * width;
  const corner = (turn: number) =>
    `${x2 + size * Math.cos(angle + turn)},${y2 + size * Math.sin(angle + turn)}`;
  const short = head ? size * 0.6 : 0;
  return (
    <g stroke={color} fill={color} stroke-width={width} stroke-linecap="round">
      <line
        x1={x1}
        y1={y1}
        x2={x2 - short * Math.cos(angle)}
        y2={y2 - short * Math.sin(angle)}
        stroke-dasharray={dashed ? "7 7" : undefined}
      />
      {head && <polygon points={`${x2},${y2} ${corner(2.68)} ${corner(-2.68)}`} stroke="none" />}
    </g>
  );
}

/** Draws the point that a common mistake takes for the hit. */
export function WrongHit({ scale, at, name }: { scale: Scale; at: [number, number]; name: string }) {
  const color = "var(--ray-shadowed)";
  return (
    <>
      <circle
        cx={scale.x(at[0])}
        cy={scale.y(at[1])}
        r={8}
        fill="var(--paper)"
        stroke={color}
        stroke-width={3}
      />
      <PlaneName scale={scale} at={at} color={color} dy={-18}>
        {name}
      </PlaneName>
    </>
  );
}

/** Draws a label in the plane. */
export function PlaneName({
  scale,
  at,
  color,
  children,
  dx = 12,
  dy = -12,
}: {
  scale: Scale;
  at: [number, number];
  color?: string;
  children: ComponentChildren;
  dx?: number;
  dy?: number;
}) {
  return (
    <Label x={scale.x(at[0])} y={scale.y(at[1])} dx={dx} dy={dy} width={scale.width} color={color}>
      {children}
    </Label>
  );
}
