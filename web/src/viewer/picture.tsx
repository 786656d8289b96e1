import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { gestures } from "./gestures";
import { type Store, useStore } from "./store";

/** The picture: drag to orbit, click to explain a pixel. */
export function Picture({ store }: { store: Store }) {
  useStore(store);
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [space, setSpace] = useState({ width: 0, height: 0 });
  const { head, pixels, pixel } = store;

  useEffect(() => {
    if (!box.current) return;
    const observer = new ResizeObserver(([entry]) => {
      if (entry) setSpace({ width: entry.contentRect.width, height: entry.contentRect.height });
    });
    observer.observe(box.current);
    return () => observer.disconnect();
  }, []);

  useEffect(() => {
    if (!canvas.current) return;
    const element = canvas.current;
    return gestures(element, store, (x, y) => {
      const at = element.getBoundingClientRect();
      const { full_width, full_height } = store.head ?? { full_width: 1, full_height: 1 };
      const column = Math.floor(((x - at.left) / at.width) * full_width);
      const row = Math.floor(((y - at.top) / at.height) * full_height);
      store.explain(clamp(column, full_width), clamp(row, full_height));
    });
  }, [store]);

  useLayoutEffect(() => {
    if (canvas.current && head && pixels) draw(canvas.current, head.width, head.height, pixels);
  }, [head, pixels]);

  const aspect = head ? head.full_width / head.full_height : 1;
  const room = { width: Math.max(0, space.width - 24), height: Math.max(0, space.height - 24) };
  const width = Math.min(room.width, room.height * aspect);
  const height = width / aspect;
  const mark = pixel &&
    head && {
      left: `calc(50% + ${((pixel.x + 0.5) / head.full_width - 0.5) * width}px)`,
      top: `calc(50% + ${((pixel.y + 0.5) / head.full_height - 0.5) * height}px)`,
    };
  return (
    <div class="picture" ref={box}>
      <canvas
        ref={canvas}
        tabIndex={0}
        role="img"
        aria-label={
          "The picture. Drag or use arrow keys to orbit, w a s d to walk, plus and minus to zoom, click to explain a pixel."
        }
        style={{ width: `${width}px`, height: `${height}px` }}
      />
      {mark && <div class="mark" style={mark} />}
    </div>
  );
}

function clamp(x: number, size: number): number {
  return Math.min(size - 1, Math.max(0, x));
}

/** Draws pixels onto a canvas of their size. */
export function draw(
  canvas: HTMLCanvasElement,
  width: number,
  height: number,
  pixels: Uint8Array<ArrayBuffer>,
) {
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
  }
  const data = new Uint8ClampedArray(pixels.buffer, pixels.byteOffset, 4 * width * height);
  canvas.getContext("2d")?.putImageData(new ImageData(data, width, height), 0, 0);
}
