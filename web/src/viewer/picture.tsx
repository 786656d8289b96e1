import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import { gestures } from "./gestures";
import { Overlay } from "./overlay";
import { PixelNumbers } from "./pixel-numbers";
import { Under } from "./status";
import { type Store, useStore } from "./store";
import { whole, zoomBy } from "./zoom";

/** Maximum width of an image pixel, in page pixels. */
const widest = 96;

/** The rendered image. Drag to orbit, click a pixel to explain it, and zoom in to see single pixels. */
export function Picture({ store }: { store: Store }) {
  useStore(store);
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [space, setSpace] = useState({ width: 0, height: 0 });
  const { head, pixels, pixel, zoom, scan } = store;

  useEffect(() => {
    if (!box.current) return;
    const observer = new ResizeObserver(([entry]) => {
      if (entry) setSpace({ width: entry.contentRect.width, height: entry.contentRect.height });
    });
    observer.observe(box.current);
    return () => observer.disconnect();
  }, []);

  const [fullWidth, fullHeight] = [head?.full_width ?? 1, head?.full_height ?? 1];
  const room = { width: Math.max(0, space.width - 24), height: Math.max(0, space.height - 24) };
  const width = Math.min(room.width, (room.height * fullWidth) / fullHeight);
  const height = (width * fullHeight) / fullWidth;
  const most = Math.max(1, (widest * fullWidth) / Math.max(1, width));
  const mostRef = useRef(most);
  mostRef.current = most;

  useEffect(() => {
    if (!canvas.current) return;
    return gestures(canvas.current, store, () => mostRef.current);
  }, [store]);

  useLayoutEffect(() => {
    if (canvas.current && head && pixels) draw(canvas.current, head.width, head.height, pixels);
  }, [head, pixels]);

  // Page pixels per image pixel, and the position of the image's upper left corner.
  const scale = (width * zoom.magnification) / fullWidth;
  const corner = [width / 2 - zoom.x * fullWidth * scale, height / 2 - zoom.y * fullHeight * scale] as const;
  const place = (left: number, top: number, columns: number, rows: number) => ({
    left: `${corner[0] + left * scale}px`,
    top: `${corner[1] + top * scale}px`,
    width: `${columns * scale}px`,
    height: `${rows * scale}px`,
  });
  const region = head?.region ?? [0, 0, 1, 1];
  return (
    <div class="picture" ref={box}>
      <div class="frame" style={{ width: `${width}px`, height: `${height}px` }}>
        <canvas
          ref={canvas}
          tabIndex={0}
          role="img"
          class={scale > 2 ? "squares" : ""}
          aria-label={
            "The image. Drag or use the arrow keys to orbit, w a s d to walk, plus and minus to move closer or farther, z to zoom into the image. Click a pixel to explain it, or use Enter for the middle one and i j k l for its neighbours."
          }
          style={place(...region)}
        />
        {scan && (
          <>
            <div class="unseen" style={place(scan.x + 1, scan.y, fullWidth - scan.x - 1, 1)} />
            <div class="unseen" style={place(0, scan.y + 1, fullWidth, fullHeight - scan.y - 1)} />
          </>
        )}
        <div class="whole" style={place(0, 0, fullWidth, fullHeight)}>
          <Overlay store={store} width={fullWidth * scale} height={fullHeight * scale} />
        </div>
        <PixelNumbers store={store} scale={scale} corner={corner} />
        {pixel && head && (
          <div
            class={`mark${scale > 12 ? " framed" : ""}`}
            style={
              scale > 12
                ? place(pixel.x, pixel.y, 1, 1)
                : { left: place(pixel.x + 0.5, 0, 1, 1).left, top: place(0, pixel.y + 0.5, 1, 1).top }
            }
          />
        )}
      </div>
      <Under store={store} />
      <div class="zoom row" role="group" aria-label="Zoom into the image">
        {zoom.magnification > 1 && (
          <button type="button" class="button" onClick={() => store.setZoom(whole)}>
            Whole
          </button>
        )}
        {[
          ["−", 0.5, "Smaller"],
          ["+", 2, "Larger"],
        ].map(([sign, factor, name]) => (
          <button
            key={name}
            type="button"
            class="button icon"
            aria-label={String(name)}
            disabled={factor === 0.5 ? zoom.magnification <= 1 : zoom.magnification >= most}
            onClick={() => store.setZoom(zoomBy(zoom, Number(factor), middle(store), most))}
          >
            {sign}
          </button>
        ))}
        {zoom.magnification > 1 && (
          <output>
            {zoom.magnification < 10 ? zoom.magnification.toFixed(1) : Math.round(zoom.magnification)} ×
          </output>
        )}
      </div>
    </div>
  );
}

/** Returns the centre of a zoom by the buttons: the explained pixel, if it is visible. */
function middle({ pixel, head, zoom }: Store) {
  if (!pixel || !head) return zoom;
  const at = { x: (pixel.x + 0.5) / head.full_width, y: (pixel.y + 0.5) / head.full_height };
  const isVisible = Math.max(Math.abs(at.x - zoom.x), Math.abs(at.y - zoom.y)) < 0.5 / zoom.magnification;
  return isVisible ? at : zoom;
}

/** Draws pixels onto a canvas, which gets the size of the image. */
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
