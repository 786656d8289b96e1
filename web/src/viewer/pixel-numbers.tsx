import { useEffect, useState } from "preact/hooks";
import { short } from "../ui/slider";
import { type Store, useStore } from "./store";
import { partOf } from "./zoom";

/** Minimum width of an image pixel, in page pixels, at which its numbers are shown. */
const readable = 44;

/** Values of the visible part of the image. */
interface PixelValues {
  part: [number, number, number, number];
  values: (number | null)[];
}

/** Shows the numbers of the visible pixels, if the pixels are large enough. */
export function PixelNumbers({
  store,
  scale,
  corner,
}: {
  store: Store;
  scale: number;
  corner: readonly [number, number];
}) {
  useStore(store);
  const { head, zoom } = store;
  const [numbers, setNumbers] = useState<PixelValues | null>(null);
  const wanted = head !== null && scale >= readable && head.width === head.region[2];
  const part = wanted ? partOf(zoom, head.full_width, head.full_height) : null;
  const key = JSON.stringify([part, head?.samples, head?.hash, head?.picture]);
  useEffect(() => {
    if (!part) {
      setNumbers(null);
      return;
    }
    let current = true;
    const [left, top, width, height] = part;
    store.session
      .ask({ kind: "values", left, top, width, height }, "values")
      .then(({ values }) => current && setNumbers({ part, values }))
      .catch(() => {});
    return () => {
      current = false;
    };
  }, [store, key]);
  if (!numbers || !wanted) return null;
  const [left, top, width] = numbers.part;
  const cells = [];
  for (let i = 0; 3 * i < numbers.values.length; i++) {
    const [x, y] = [left + (i % width), top + Math.floor(i / width)];
    const values = numbers.values.slice(3 * i, 3 * i + 3);
    cells.push(
      <div
        key={`${x} ${y}`}
        class={`cell${isLight(values) ? " light" : ""}`}
        style={{
          left: `${corner[0] + x * scale}px`,
          top: `${corner[1] + y * scale}px`,
          width: `${scale}px`,
          height: `${scale}px`,
          fontSize: `${Math.min(13, scale / 5.4)}px`,
        }}
      >
        <span>
          {x}, {y}
        </span>
        {formatValues(values).map((value, k) => (
          <b key={k}>{value}</b>
        ))}
      </div>,
    );
  }
  return <div class="cells">{cells}</div>;
}

/** Formats the values of a pixel; a single number if all three are equal, as for depth. */
export function formatValues(values: (number | null)[]): string[] {
  const [r, g, b] = values;
  const all = r === g && g === b ? [r] : values;
  return all.map((value) => (value == null ? "∞" : short(value, 3)));
}

function isLight(values: (number | null)[]): boolean {
  const [r = 0, g = 0, b = 0] = values.map((value) => value ?? 1);
  return 0.21 * r + 0.72 * g + 0.07 * b > 0.18;
}
