import { useEffect, useLayoutEffect, useMemo, useRef, useState } from "preact/hooks";
import { type DrawingSize, useDrawingSize } from "../ui/drawing-size";
import { useStore } from "../viewer/store";
import { lines } from "./edges";
import { frustum, points, roles, segments, termAt } from "./segments";
import {
  add,
  type Eye,
  frame,
  frameEye,
  length,
  mul,
  orbit,
  type Projector,
  projector,
  sub,
  type Vec,
} from "./space";
import type { ExplainView } from "./view";

/** Maximum number of lights that have names; more names would cover the drawing. */
const mostNames = 6;

/** 3D view of a pixel's rays, with the outlines of all objects. */
export function RaysView({ store }: { store: ExplainView }) {
  useStore(store);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [eye, setEye] = useState<Eye | null>(null);
  const size = useDrawingSize(canvas);
  const [theme, setTheme] = useState(0);
  const drag = useRef<{ x: number; y: number; moved: boolean } | null>(null);
  const start = useMemo(() => beside(store), [store.pixel, store.outlines]);
  const used = eye ?? start;

  useEffect(() => setEye(null), [start]);
  useEffect(() => {
    const again = () => setTheme((count) => count + 1);
    window.addEventListener("durer-theme", again);
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", again);
    return () => {
      window.removeEventListener("durer-theme", again);
      dark.removeEventListener("change", again);
    };
  }, []);
  useLayoutEffect(() => {
    if (canvas.current) paint(canvas.current, used, size, store);
  }, [
    used,
    size,
    theme,
    store.outlines,
    store.pixel,
    store.chosen,
    store.hovered,
    store.marked,
    store.camera,
    store.cast,
    store.boxes,
    store.boxLevel,
    store.scan,
  ]);

  const nearest = (x: number, y: number): string | null => {
    if (!canvas.current) return null;
    const box = canvas.current.getBoundingClientRect();
    const view = projector(frame(used), size.width, size.height);
    let best: { path: string; distance: number } | null = null;
    for (const { path, segment } of segments(store.pixel)) {
      const line = view.line(segment.from, segment.to);
      if (!line) continue;
      const distance = toLine((x - box.left) / size.unit, (y - box.top) / size.unit, line[0], line[1]);
      if (distance < 9 && (!best || distance < best.distance)) best = { path, distance };
    }
    return best?.path ?? null;
  };
  const turn = (right: number, up: number) => setEye(orbit(used, right, up));

  return (
    <canvas
      ref={canvas}
      class="rays"
      tabIndex={0}
      role="img"
      aria-label={describe(store)}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        drag.current = { x: event.clientX, y: event.clientY, moved: false };
      }}
      onPointerMove={(event) => {
        const from = drag.current;
        if (!from) return store.hover(nearest(event.clientX, event.clientY));
        const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
        if (!from.moved && Math.hypot(dx, dy) < 4) return;
        drag.current = { x: event.clientX, y: event.clientY, moved: true };
        turn(dx * 0.01, dy * 0.01);
      }}
      onPointerUp={(event) => {
        const path = drag.current?.moved ? null : nearest(event.clientX, event.clientY);
        drag.current = null;
        if (path) store.choose(path);
      }}
      onPointerLeave={() => store.hover(null)}
      onWheel={(event) => {
        event.preventDefault();
        setEye({ ...used, distance: used.distance * Math.exp(event.deltaY * 0.0012) });
      }}
      onKeyDown={(event) => {
        const turns: Record<string, [number, number]> = {
          ArrowLeft: [-0.1, 0],
          ArrowRight: [0.1, 0],
          ArrowUp: [0, -0.1],
          ArrowDown: [0, 0.1],
        };
        const zooms: Record<string, number> = { "+": 0.9, "-": 1 / 0.9 };
        const [by, zoom] = [turns[event.key], zooms[event.key]];
        if (!by && !zoom) return;
        event.preventDefault();
        if (by) turn(...by);
        if (zoom) setEye({ ...used, distance: used.distance * zoom });
      }}
    />
  );
}

function describe(store: ExplainView): string {
  const all = segments(store.pixel);
  if (all.length === 0) return "Outlines of the scene.";
  return `The rays of the pixel in 3D: ${all.map(({ segment }) => roles[segment.role]).join(", ")}.`;
}

/** Returns a view from the side of the camera's view frustum. */
function beside(store: ExplainView): Eye {
  const { pixel, camera } = store;
  const projected = points(pixel, camera);
  if (!camera) return frameEye(projected, 0.8, 0.4);
  const yaw = Math.atan2(-camera.forward[0], -camera.forward[2]) + 0.95;
  const pitch = Math.min(
    0.7,
    Math.max(0.15, Math.asin(Math.max(-1, Math.min(1, -camera.forward[1]))) + 0.28),
  );
  if (projected.length < 2) projected.push(add(camera.eye, mul(camera.distance * 1.4, camera.forward)));
  return frameEye(projected, yaw, pitch);
}

function toLine(x: number, y: number, a: { x: number; y: number }, b: { x: number; y: number }): number {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const t = Math.max(0, Math.min(1, ((x - a.x) * dx + (y - a.y) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(x - a.x - t * dx, y - a.y - t * dy);
}

function paint(canvas: HTMLCanvasElement, eye: Eye, size: DrawingSize, store: ExplainView) {
  const context = canvas.getContext("2d");
  if (!context || size.width < 1) return;
  const ratio = size.unit * (window.devicePixelRatio || 1);
  canvas.width = Math.round(size.width * ratio);
  canvas.height = Math.round(size.height * ratio);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.lineCap = "round";
  context.lineJoin = "round";
  const view = projector(frame(eye), size.width, size.height);
  const style = getComputedStyle(canvas);
  const color = (name: string) => style.getPropertyValue(name);
  objects(context, view, store, color("--solid"), color("--accent"));
  const { camera, aspect } = store;
  if (camera) {
    const reach = camera.distance * 0.35;
    // The rays of other cameras do not fill a pyramid, so only their direction is drawn.
    const outline: [Vec, Vec][] = camera.projects
      ? frustum(camera, aspect, reach)
      : [[camera.eye, add(camera.eye, mul(reach, camera.forward))]];
    stroke(context, view, outline, color("--soft"), 1, 0.8);
  }
  const { boxLevel, scan } = store;
  if (boxLevel !== null) {
    for (let level = 0; level <= boxLevel; level++) {
      const some = lines(store.boxes.filter((box) => box.level === level));
      stroke(
        context,
        view,
        some,
        color("--ray-reflected"),
        level === boxLevel ? 1.4 : 0.7,
        level === boxLevel ? 0.9 : 0.35,
      );
    }
  }
  if (scan?.ray) {
    const { origin, direction, t } = scan.ray;
    const end = add(origin, mul(t ?? camera?.distance ?? 10, direction));
    stroke(context, view, [[origin, end]], color(t === null ? "--soft" : "--ray-camera"), 2.4, 1);
    const projected = t === null ? null : view.point(end);
    if (projected) dot(context, projected.x, projected.y, 4.5, color("--ray-lit"));
  } else rays(context, view, store, color);
  const isNamed = store.lights.length <= mostNames;
  for (const lamp of store.lights) {
    const at = view.point(lamp.at);
    if (!at) continue;
    dot(context, at.x, at.y, 4, color("--ray-scattered"));
    if (isNamed) label(context, at, lamp.name, size.width, color);
  }
  const at = camera && view.point(camera.eye);
  // Below the eye, because the rays go up or ahead.
  if (at) label(context, { x: at.x - 16, y: at.y + 22 }, "eye", size.width, color);
}

function objects(
  context: CanvasRenderingContext2D,
  view: Projector,
  store: ExplainView,
  plain: string,
  strong: string,
) {
  const term = termAt(store.pixel, store.hovered ?? store.chosen);
  for (const { object, lines } of store.outlines) {
    const chosen = term?.object === object || store.marked === object;
    context.strokeStyle = chosen ? strong : plain;
    context.globalAlpha = chosen ? 0.95 : 0.42;
    context.lineWidth = chosen ? 1.4 : 0.8;
    context.beginPath();
    for (const line of lines) {
      for (let i = 0; i + 5 < line.length; i += 3) {
        const projected = view.line(line.slice(i, i + 3) as Vec, line.slice(i + 3, i + 6) as Vec);
        if (!projected) continue;
        context.moveTo(projected[0].x, projected[0].y);
        context.lineTo(projected[1].x, projected[1].y);
      }
    }
    context.stroke();
  }
  context.globalAlpha = 1;
}

function rays(
  context: CanvasRenderingContext2D,
  view: Projector,
  store: ExplainView,
  color: (name: string) => string,
) {
  const focus = store.hovered ?? store.chosen;
  for (const { path, segment, term } of segments(store.pixel)) {
    const strong = path === focus;
    const paint = color(`--ray-${segment.role}`);
    const dashed = segment.role === "shadowed" || segment.role === "lit";
    context.setLineDash(dashed ? [5, 4] : []);
    stroke(context, view, [[segment.from, segment.to]], paint, strong ? 3.2 : 1.6, strong ? 1 : 0.85);
    context.setLineDash([]);
    arrow(context, view, segment.from, segment.to, paint, strong ? 9 : 6);
    if (term.normal) {
      const [at, n] = term.normal;
      const reach = 0.16 * Math.max(1e-6, length(sub(segment.to, segment.from)));
      stroke(context, view, [[at, add(at, mul(reach, n))]], color("--normal"), 1.6, 1);
      arrow(context, view, at, add(at, mul(reach * 1.8, n)), color("--normal"), 5);
      const projected = view.point(at);
      if (projected) dot(context, projected.x, projected.y, strong ? 4.5 : 3, paint);
    }
  }
}

function stroke(
  context: CanvasRenderingContext2D,
  view: Projector,
  lines: [Vec, Vec][],
  color: string,
  width: number,
  alpha: number,
) {
  context.strokeStyle = color;
  context.lineWidth = width;
  context.globalAlpha = alpha;
  context.beginPath();
  for (const [a, b] of lines) {
    const projected = view.line(a, b);
    if (!projected) continue;
    context.moveTo(projected[0].x, projected[0].y);
    context.lineTo(projected[1].x, projected[1].y);
  }
  context.stroke();
  context.globalAlpha = 1;
}

/** Draws an arrowhead in the middle of a ray. */
function arrow(
  context: CanvasRenderingContext2D,
  view: Projector,
  from: Vec,
  to: Vec,
  color: string,
  size: number,
) {
  const projected = view.line(from, to);
  if (!projected) return;
  const [a, b] = projected;
  const angle = Math.atan2(b.y - a.y, b.x - a.x);
  if (Math.hypot(b.x - a.x, b.y - a.y) < 3 * size) return;
  const [x, y] = [a.x + 0.56 * (b.x - a.x), a.y + 0.56 * (b.y - a.y)];
  context.fillStyle = color;
  context.beginPath();
  context.moveTo(x + size * Math.cos(angle), y + size * Math.sin(angle));
  context.lineTo(x + size * Math.cos(angle + 2.5), y + size * Math.sin(angle + 2.5));
  context.lineTo(x + size * Math.cos(angle - 2.5), y + size * Math.sin(angle - 2.5));
  context.fill();
}

/** Writes a name beside a point, on its left at the right edge of the view. */
function label(
  context: CanvasRenderingContext2D,
  at: { x: number; y: number },
  name: string,
  width: number,
  color: (name: string) => string,
) {
  context.font = `11.5px ${color("--font")}`;
  const before = at.x + 12 + context.measureText(name).width > width;
  context.textAlign = before ? "right" : "left";
  context.lineWidth = 3;
  context.strokeStyle = color("--paper");
  context.fillStyle = color("--soft");
  const [x, y] = [at.x + (before ? -9 : 9), at.y - 5];
  context.strokeText(name, x, y);
  context.fillText(name, x, y);
}

function dot(context: CanvasRenderingContext2D, x: number, y: number, radius: number, color: string) {
  context.fillStyle = color;
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}
