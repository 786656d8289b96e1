import type { TreeBox } from "../protocol";
import type { Projector, Vec } from "./space";

/** Edges of a box as pairs of corner indices, which differ in one bit. */
export const edges: [number, number][] = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((a) =>
  [1, 2, 4].filter((bit) => (a & bit) === 0).map((bit): [number, number] => [a, a | bit]),
);

/** Returns the edges of boxes as lines in space. */
export function lines(boxes: TreeBox[]): [Vec, Vec][] {
  return boxes.flatMap(({ corners }) =>
    edges.map(([a, b]): [Vec, Vec] => [
      corners.slice(3 * a, 3 * a + 3) as Vec,
      corners.slice(3 * b, 3 * b + 3) as Vec,
    ]),
  );
}

/** Draws boxes in space as a single path. */
export function Boxes({
  view,
  boxes,
  color,
  opacity = 1,
  width = 1,
}: {
  view: Projector;
  boxes: TreeBox[];
  color: string;
  opacity?: number;
  width?: number;
}) {
  const path = lines(boxes)
    .map(([a, b]) => view.line(a, b))
    .map((line) =>
      line
        ? `M${line[0].x.toFixed(1)} ${line[0].y.toFixed(1)}L${line[1].x.toFixed(1)} ${line[1].y.toFixed(1)}`
        : "",
    )
    .join("");
  return (
    <path
      d={path}
      stroke={color}
      stroke-opacity={opacity}
      stroke-width={width}
      fill="none"
      pointer-events="none"
    />
  );
}
