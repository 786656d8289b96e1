import { short } from "../ui/slider";
import { type Store, useStore } from "./store";

/** Status line: the progress of the render, and the hash of the finished image. */
export function Status({ store }: { store: Store }) {
  useStore(store);
  const { head, error: refused } = store;
  if (refused) {
    return (
      <p class="status" role="alert">
        {refused}
      </p>
    );
  }
  if (!head) return <p class="status">…</p>;
  const coarse = head.width < head.full_width;
  return (
    <p class="status">
      <span>
        {head.full_width} × {head.full_height}
      </span>
      <span>{coarse ? "coarse" : `${head.samples} of ${head.all_samples} samples`}</span>
      <span>{time(head.ms)}</span>
      {head.left_ms !== null && <span>{time(head.left_ms)} left</span>}
      {head.noise !== null && (
        <span title="Visible error of the pixels, which --noise-threshold limits">
          error {short(head.noise, 2)}
        </span>
      )}
      {head.denoised && <span>denoised</span>}
      {head.rays > 0 && <span>{(head.rays / 1e6).toFixed(1)} M rays</span>}
      {head.hash === null && !coarse && (
        <progress aria-label="Rendering" value={head.samples} max={head.all_samples} />
      )}
      {head.hash && (
        <span class="hash" title={`Hash of the image, as durer render --hash prints it: ${head.hash}`}>
          {head.hash.slice(0, 16)}
        </span>
      )}
    </p>
  );
}

/** Shows the pixel below the pointer and its 8-bit values. */
export function Under({ store }: { store: Store }) {
  const { hoveredPixel: under, head, pixels } = store;
  if (!under || !head || !pixels) return null;
  const [left, top, columns, rows] = head.region;
  const x = Math.floor(((under[0] + 0.5 - left) * head.width) / columns);
  const y = Math.floor(((under[1] + 0.5 - top) * head.height) / rows);
  const at = 4 * (y * head.width + x);
  const inside = x >= 0 && x < head.width && y >= 0 && y < head.height;
  return (
    <output class="under">
      {under.join(", ")}
      {inside && ` · ${[...pixels.slice(at, at + 3)].join(" ")}`}
    </output>
  );
}

export function time(ms: number): string {
  return ms < 1000 ? `${Math.round(ms)} ms` : `${(ms / 1000).toFixed(1)} s`;
}
