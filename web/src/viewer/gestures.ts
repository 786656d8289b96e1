import type { Store } from "./store";
import { clampZoom, zoomBy } from "./zoom";

interface Point {
  x: number;
  y: number;
}

/** Translates mouse, touch and keyboard input over an image to camera motions. Returns a cleanup function.
 */
export function gestures(element: HTMLElement, store: Store, most: () => number): () => void {
  const pointers = new Map<number, Point>();
  let start: Point | null = null;
  let dragged = false;
  let wheel = 0;
  const frame = () => (element.parentElement ?? element).getBoundingClientRect();
  const size = () => Math.max(1, frame().height);
  /** Returns a position on the page as fractions of the image's width and height. */
  const share = (x: number, y: number) => {
    const { left, top, width, height } = frame();
    const { zoom } = store;
    return {
      x: zoom.x + ((x - left) / width - 0.5) / zoom.magnification,
      y: zoom.y + ((y - top) / height - 0.5) / zoom.magnification,
    };
  };
  /** Returns the pixel at a position on the page. */
  const pixel = (x: number, y: number): [number, number] => {
    const at = share(x, y);
    const { full_width, full_height } = store.head ?? { full_width: 1, full_height: 1 };
    return [
      clamp(Math.floor(at.x * full_width), full_width),
      clamp(Math.floor(at.y * full_height), full_height),
    ];
  };
  const stop = new AbortController();
  const options = { signal: stop.signal };

  const spread = () => {
    const [a, b] = [...pointers.values()];
    if (!a || !b) return null;
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, distance: Math.hypot(a.x - b.x, a.y - b.y) };
  };

  element.addEventListener(
    "pointerdown",
    (event) => {
      element.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (pointers.size === 1) {
        start = { x: event.clientX, y: event.clientY };
        dragged = false;
      }
    },
    options,
  );
  element.addEventListener(
    "pointermove",
    (event) => {
      const last = pointers.get(event.pointerId);
      if (!last) return store.point(pixel(event.clientX, event.clientY));
      const before = spread();
      const now = { x: event.clientX, y: event.clientY };
      if (start && Math.hypot(now.x - start.x, now.y - start.y) > 4) dragged = true;
      pointers.set(event.pointerId, now);
      if (!dragged) return;
      const after = spread();
      const { zoom } = store;
      if (zoom.magnification > 1) {
        const { width, height } = frame();
        const x = zoom.x - (now.x - last.x) / width / zoom.magnification;
        const y = zoom.y - (now.y - last.y) / height / zoom.magnification;
        store.setZoom(clampZoom({ ...zoom, x, y }, most()));
        return;
      }
      if (before && after) {
        if (after.distance > 0) store.move({ kind: "dolly", factor: before.distance / after.distance }, true);
        const [right, up] = [(after.x - before.x) / size(), (before.y - after.y) / size()];
        store.move({ kind: "pan", right, up }, true);
        return;
      }
      const [dx, dy] = [(now.x - last.x) / size(), (now.y - last.y) / size()];
      if (event.shiftKey || (event.buttons & 6) !== 0) store.move({ kind: "pan", right: dx, up: -dy }, true);
      else if (event.ctrlKey || event.metaKey)
        store.move({ kind: "turn", right: dx * 1.5, up: -dy * 1.5 }, true);
      else store.move({ kind: "orbit", right: dx * Math.PI, up: -dy * Math.PI }, true);
    },
    options,
  );
  const release = (event: PointerEvent) => {
    if (!pointers.delete(event.pointerId) || pointers.size > 0) return;
    if (dragged && store.zoom.magnification === 1) store.settle();
    else if (!dragged && event.type === "pointerup" && event.button === 0)
      store.explain(...pixel(event.clientX, event.clientY));
    start = null;
  };
  element.addEventListener("pointerup", release, options);
  element.addEventListener("pointercancel", release, options);
  element.addEventListener("contextmenu", (event) => event.preventDefault(), options);
  element.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      if (event.altKey || store.zoom.magnification > 1) {
        const at = share(event.clientX, event.clientY);
        store.setZoom(zoomBy(store.zoom, Math.exp(-event.deltaY * 0.002), at, most()));
        return;
      }
      store.move({ kind: "dolly", factor: Math.exp(event.deltaY * (event.ctrlKey ? 0.01 : 0.0012)) }, true);
      clearTimeout(wheel);
      wheel = window.setTimeout(() => store.settle(), 140);
    },
    { ...options, passive: false },
  );
  element.addEventListener("pointerleave", () => store.point(null), options);
  element.addEventListener(
    "keydown",
    (event) => {
      if (event.key.toLowerCase() === "z" && !event.ctrlKey && !event.metaKey)
        store.setZoom(zoomBy(store.zoom, event.shiftKey ? 0.5 : 2, store.zoom, most()));
      else key(event, store);
    },
    options,
  );
  return () => stop.abort();
}

function clamp(x: number, size: number): number {
  return Math.min(size - 1, Math.max(0, x));
}

const turn = 0.06;
const walk = 0.05;

function key(event: KeyboardEvent, store: Store) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const step = event.shiftKey ? 3 : 1;
  const motions: Record<string, Parameters<Store["move"]>[0]> = {
    ArrowLeft: { kind: "orbit", right: -turn * step, up: 0 },
    ArrowRight: { kind: "orbit", right: turn * step, up: 0 },
    ArrowUp: { kind: "orbit", right: 0, up: turn * step },
    ArrowDown: { kind: "orbit", right: 0, up: -turn * step },
    "+": { kind: "dolly", factor: 0.9 },
    "-": { kind: "dolly", factor: 1 / 0.9 },
    w: { kind: "walk", forward: walk, right: 0, up: 0 },
    s: { kind: "walk", forward: -walk, right: 0, up: 0 },
    a: { kind: "walk", forward: 0, right: -walk, up: 0 },
    d: { kind: "walk", forward: 0, right: walk, up: 0 },
    e: { kind: "walk", forward: 0, right: 0, up: walk },
    q: { kind: "walk", forward: 0, right: 0, up: -walk },
    h: { kind: "home" },
    f: { kind: "frame" },
  };
  const pixel = neighbour(event.key, store);
  if (pixel) store.explain(...pixel);
  const motion = motions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!motion && !pixel) return;
  event.preventDefault();
  if (motion) store.move(motion, false);
}

/** Returns the pixel that a key selects: Enter the middle of the visible part, `i j k l` a neighbour. */
function neighbour(key: string, { pixel, zoom, head }: Store): [number, number] | null {
  if (!head) return null;
  const { full_width: width, full_height: height } = head;
  if (key === "Enter")
    return [clamp(Math.floor(zoom.x * width), width), clamp(Math.floor(zoom.y * height), height)];
  const steps: Record<string, [number, number]> = { i: [0, -1], j: [-1, 0], k: [0, 1], l: [1, 0] };
  const step = steps[key.toLowerCase()];
  return step && pixel ? [clamp(pixel.x + step[0], width), clamp(pixel.y + step[1], height)] : null;
}
