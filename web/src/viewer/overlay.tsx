import { segments } from "../explain/segments";
import { type Projector, projector, type Vec } from "../explain/space";
import type { CameraState } from "../protocol";
import type { Store } from "./store";

/** Draws the selected ray and the outline of the object at the cursor over the image. */
export function Overlay({ store, width, height }: { store: Store; width: number; height: number }) {
  const view = store.camera && cameraView(store.camera, width, height);
  if (!view || store.scan) return null;
  const focus = store.hovered ?? store.chosen;
  const found = segments(store.pixel).find(({ path }) => path === focus);
  const ray = found && view.line(found.segment.from, found.segment.to);
  const color = `var(--ray-${found?.segment.role})`;
  const outline = store.outlines.find(({ object }) => object === store.marked);
  return (
    <svg class="overlay" viewBox={`0 0 ${width} ${height}`} aria-hidden="true">
      {outline && <path class="outline" d={path(view, outline.lines)} />}
      {ray && (
        <g fill={color} stroke={color}>
          <line class="halo" x1={ray[0].x} y1={ray[0].y} x2={ray[1].x} y2={ray[1].y} />
          <line x1={ray[0].x} y1={ray[0].y} x2={ray[1].x} y2={ray[1].y} />
          {found.term.normal && <End view={view} at={found.term.normal[0]} />}
        </g>
      )}
    </svg>
  );
}

function End({ view, at }: { view: Projector; at: Vec }) {
  const end = view.point(at);
  return end && <circle cx={end.x} cy={end.y} r={5} />;
}

/** Returns the projection of a camera that shows straight lines as straight lines; `null` for other cameras. */
export function cameraView(camera: CameraState, width: number, height: number): Projector | null {
  return camera.projects ? projector({ ...camera, half: camera.half_width }, width, height) : null;
}

/** Returns the polylines of an outline as the data of a path. */
function path(view: Projector, lines: number[][]): string {
  const parts: string[] = [];
  for (const line of lines) {
    for (let i = 0; i + 5 < line.length; i += 3) {
      const part = view.line(line.slice(i, i + 3) as Vec, line.slice(i + 3, i + 6) as Vec);
      if (part)
        parts.push(part.map(({ x, y }, j) => `${j ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join(""));
    }
  }
  return parts.join("");
}
