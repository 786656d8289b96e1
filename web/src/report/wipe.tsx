import type { ComponentChildren, CSSProperties } from "preact";
import { useRef } from "preact/hooks";

interface Props {
  /** Picture that is visible left of the line. */
  under: string;
  /** Picture that is visible right of the line. */
  over: string;
  labels: [string, string];
  /** Position of the line, from 0 to 1. */
  split: number;
  change(split: number): void;
  /** False if the line and its effect are off, for other ways to compare. */
  on?: boolean;
  /** Name of the slider. */
  label: string;
  /** Style of the upper picture, for other ways to compare. */
  look?: CSSProperties;
  frame?: CSSProperties;
  point?(x: number, y: number): void;
  children?: ComponentChildren;
}

/** Two pictures in the same place, with a line between them that is dragged or moved with the arrow
 * keys.
 */
export function Wipe({
  under,
  over,
  labels,
  split,
  change,
  on = true,
  label,
  look = {},
  frame = {},
  point,
  children,
}: Props) {
  const box = useRef<HTMLDivElement>(null);
  const place = (event: PointerEvent): [number, number] => {
    const { left, top, width, height } = box.current?.getBoundingClientRect() ?? new DOMRect(0, 0, 1, 1);
    return [clamp((event.clientX - left) / width), clamp((event.clientY - top) / height)];
  };
  const slide = (event: PointerEvent) => {
    if (on && event.buttons) change(place(event)[0]);
  };
  const percent = Math.round(100 * split);
  return (
    <div
      ref={box}
      class={`wipe${on ? "" : " off"}`}
      style={frame}
      tabIndex={0}
      role="slider"
      aria-label={label}
      aria-valuemin={0}
      aria-valuemax={100}
      aria-valuenow={percent}
      aria-valuetext={`${labels[0]} on the left ${percent} %, ${labels[1]} on the right`}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        slide(event);
      }}
      onPointerMove={(event) => {
        point?.(...place(event));
        slide(event);
      }}
      onKeyDown={(event) => {
        const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
        if (!step || !on) return;
        event.preventDefault();
        event.stopPropagation();
        change(clamp(split + step));
      }}
    >
      <img src={under} alt={labels[0]} draggable={false} />
      <img
        src={over}
        alt={labels[1]}
        draggable={false}
        style={{ ...(on ? { clipPath: `inset(0px 0px 0px ${100 * split}%)` } : {}), ...look }}
      />
      {on && <span class="line" style={{ left: `${100 * split}%` }} />}
      {children}
    </div>
  );
}

function clamp(x: number): number {
  return Math.min(1, Math.max(0, x));
}
