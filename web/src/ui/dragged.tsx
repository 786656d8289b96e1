import { useRef } from "preact/hooks";
import { fixed, short } from "./slider";

interface Props {
  label: string;
  value: number;
  /** Change per pixel of pointer motion. */
  step: number;
  decimals?: number;
  min?: number;
  max?: number;
  change(value: number, moving: boolean): void;
}

/** Number that is changed by dragging sideways or with the arrow keys. */
export function DragNumber({ label, value, step, decimals, min = -Infinity, max = Infinity, change }: Props) {
  const from = useRef<{ x: number; value: number } | null>(null);
  const clamp = (x: number) => Math.min(max, Math.max(min, x));
  const text = decimals === undefined ? short(value) : fixed(value, decimals);
  return (
    <button
      type="button"
      class="drags"
      role="slider"
      aria-label={label}
      aria-valuenow={value}
      aria-valuetext={text}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        from.current = { x: event.clientX, value };
      }}
      onPointerMove={(event) => {
        if (from.current) change(clamp(from.current.value + step * (event.clientX - from.current.x)), true);
      }}
      onPointerUp={() => {
        if (from.current) change(value, false);
        from.current = null;
      }}
      onKeyDown={(event) => {
        const sign = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
        if (sign === undefined) return;
        event.preventDefault();
        change(clamp(value + sign * step * (event.shiftKey ? 20 : 2)), false);
      }}
    >
      {text}
    </button>
  );
}
