import { add, dot, mul, type Projector, sub, type Vec } from "../explain/space";
import { Handle } from "./draw";

interface Props {
  view: Projector;
  at: Vec;
  color: string;
  label: string;
  move(to: Vec): void;
  end?(): void;
  /** Normal of the plane in which the point moves; by default, the plane is parallel to the page. */
  plane?: Vec;
}

/** Point in space that can be dragged within a plane. */
export function Point3({ view, at, color, label, move, end, plane }: Props) {
  const projected = view.point(at);
  if (!projected) return null;
  const drag = (x: number, y: number) => {
    const { origin, direction } = view.ray(x, y);
    const middle = view.ray(projected.x, projected.y);
    const normal = plane ?? middle.direction;
    const slope = dot(direction, normal);
    if (Math.abs(slope) < 1e-3) return;
    const to = add(origin, mul(dot(sub(at, origin), normal) / slope, direction));
    if (to.every((c) => Math.abs(c) < 50)) move(to);
  };
  return (
    <Handle
      x={projected.x}
      y={projected.y}
      color={color}
      label={label}
      drag={drag}
      {...(end ? { end } : {})}
    />
  );
}
