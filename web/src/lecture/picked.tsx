import type { ComponentChildren } from "preact";

/** Picked point of an image. */
interface Place {
  /** Position as fractions of the width and height. */
  x: number;
  y: number;
}

/** Wraps an image so that a point in it can be picked by a click or with the arrow keys. */
export function PixelPicker({
  place,
  pick,
  children,
}: {
  place: Place;
  pick(place: Place): void;
  children: ComponentChildren;
}) {
  const within = (x: number) => Math.min(0.9999, Math.max(0, x));
  return (
    <div
      class="picks"
      tabIndex={0}
      role="application"
      aria-label="Pick a pixel: click, or use the arrow keys"
      onPointerDown={(event) => {
        const box = event.currentTarget.getBoundingClientRect();
        pick({
          x: within((event.clientX - box.left) / box.width),
          y: within((event.clientY - box.top) / box.height),
        });
      }}
      onKeyDown={(event) => {
        const step = event.shiftKey ? 0.05 : 0.01;
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
        pick({ x: within(place.x + move[0]), y: within(place.y + move[1]) });
      }}
    >
      {children}
      <span class="cross" style={{ left: `${100 * place.x}%`, top: `${100 * place.y}%` }} />
    </div>
  );
}
