/** Visible part of an image: its centre as fractions of the width and height, and the magnification. */
export interface Zoom {
  x: number;
  y: number;
  magnification: number;
}

export const whole: Zoom = { x: 0.5, y: 0.5, magnification: 1 };

/** Returns the zoom, limited to `most` and shifted so that the visible part lies within the image. */
export function clampZoom({ x, y, magnification: times }: Zoom, most: number): Zoom {
  const size = Math.min(most, Math.max(1, times));
  const half = 0.5 / size;
  const within = (c: number) => Math.min(1 - half, Math.max(half, c));
  return { x: within(x), y: within(y), magnification: size };
}

/** Returns the zoom changed by a factor, such that a point of the image stays in place. */
export function zoomBy(zoom: Zoom, factor: number, at: { x: number; y: number }, most: number): Zoom {
  const times = Math.min(most, Math.max(1, zoom.magnification * factor));
  const stays = zoom.magnification / times;
  return clampZoom(
    { x: at.x + (zoom.x - at.x) * stays, y: at.y + (zoom.y - at.y) * stays, magnification: times },
    most,
  );
}

/** Returns the visible part in pixels, rounded outwards: first column, first row, width and height. */
export function partOf(
  { x, y, magnification: times }: Zoom,
  width: number,
  height: number,
): [number, number, number, number] {
  const side = (middle: number, size: number): [number, number] => {
    const from = Math.max(0, Math.floor((middle - 0.5 / times) * size));
    const to = Math.min(size, Math.ceil((middle + 0.5 / times) * size));
    return [from, Math.max(1, to - from)];
  };
  const [[left, columns], [top, rows]] = [side(x, width), side(y, height)];
  return [left, top, columns, rows];
}

/** Returns the part of the image to render; `null` for the entire image, below a zoom of two. */
export function cropForZoom(
  zoom: Zoom,
  width: number,
  height: number,
): [number, number, number, number] | null {
  return zoom.magnification < 2 ? null : partOf(zoom, width, height);
}
