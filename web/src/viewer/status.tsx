import { type Store, useStore } from "./store";

/** Progress of the picture, and its hash when it is finished. */
export function Status({ store }: { store: Store }) {
  useStore(store);
  const { head, refused } = store;
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
      {head.rays > 0 && <span>{(head.rays / 1e6).toFixed(1)} M rays</span>}
      {head.hash === null && !coarse && (
        <progress aria-label="Rendering" value={head.samples} max={head.all_samples} />
      )}
      {head.hash && (
        <span class="hash" title={`Hash of the picture, as durer render --hash prints it: ${head.hash}`}>
          {head.hash.slice(0, 16)}
        </span>
      )}
    </p>
  );
}

function time(ms: number): string {
  return ms < 1000 ? `${Math.round(ms)} ms` : `${(ms / 1000).toFixed(1)} s`;
}
