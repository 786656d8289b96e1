import { useEffect, useState } from "preact/hooks";
import type { CameraRay } from "../protocol";
import { short } from "../ui/slider";
import type { Store } from "../viewer/store";
import { Code, Player } from "./code";

/** Runs the algorithm for a row, pixel by pixel, or for the image, row by row, while the image fills. */
export function Scan({ store, scope }: { store: Store; scope: "row" | "picture" }) {
  const [width, height] = [store.head?.full_width ?? 1, store.head?.full_height ?? 1];
  const count = scope === "row" ? width : height;
  const [at, setAt] = useState(0);
  const [plays, setPlays] = useState(true);
  const [loaded, setLoaded] = useState<{ y: number; rays: (CameraRay | null)[] } | null>(null);
  const y = scope === "row" ? Math.min(store.pixel?.y ?? 0, height - 1) : Math.min(at, height - 1);

  useEffect(() => {
    let current = true;
    store.session
      .ask({ kind: "rays", columns: width, rows: height, row: y }, "rays")
      .then(({ rays }) => current && setLoaded({ y, rays }))
      .catch(() => {});
    return () => {
      current = false;
    };
  }, [store, width, height, y]);
  useEffect(() => {
    if (!plays) return;
    const timer = setInterval(() => setAt((i) => Math.min(i + 1, count - 1)), scope === "row" ? 60 : 40);
    return () => clearInterval(timer);
  }, [plays, count, scope]);
  useEffect(() => {
    if (at >= count - 1) setPlays(false);
  }, [at, count]);

  // The rays of the previous row are not shown for this one.
  const rays = loaded?.y === y ? loaded.rays : null;
  const x = scope === "row" ? Math.min(at, width - 1) : width - 1;
  const ray = rays?.[scope === "row" ? x : width >> 1] ?? null;
  useEffect(() => {
    store.scan = { x, y, ray };
    store.changed();
  }, [store, x, y, ray]);
  useEffect(
    () => () => {
      store.scan = null;
      store.changed();
    },
    [store],
  );

  return (
    <>
      <Player
        at={at}
        count={count}
        plays={plays}
        go={(to) => setAt(Math.min(count - 1, Math.max(0, to)))}
        play={setPlays}
        unit={scope === "row" ? "Pixel of the row" : "Row of the image"}
      />
      <p class="sentence" aria-live={plays ? "off" : "polite"}>
        {rays === null
          ? `row ${y}: …`
          : scope === "row"
            ? describePixel(store, x, y, ray)
            : describeRow(y, rays)}
      </p>
      <p class="closest">closest = {ray ? short(ray.t ?? Number.POSITIVE_INFINITY) : "–"}</p>
      <Code line={scope === "picture" ? 0 : ray === null ? 1 : ray.t === null ? 8 : 2} />
    </>
  );
}

function describePixel(store: Store, x: number, y: number, ray: CameraRay | null): string {
  if (!ray) return `pixel ${x}, ${y}: the camera has no ray for this pixel`;
  if (ray.t === null) return `pixel ${x}, ${y}: nothing is hit, so the pixel shows the background`;
  const name = store.contents?.objects[ray.object ?? -1]?.name ?? `object ${ray.object}`;
  return `pixel ${x}, ${y}: ${name} is the closest, at t = ${short(ray.t)}`;
}

/** Describes the results of the rays of a row. */
export function describeRow(y: number, rays: (CameraRay | null)[]): string {
  const hits = rays.filter((ray) => ray !== null && ray.t !== null).length;
  const there = rays.filter((ray) => ray !== null).length;
  return `row ${y}: ${there} rays, ${hits} hit something, ${there - hits} the background`;
}
