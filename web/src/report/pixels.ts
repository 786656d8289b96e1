import { useEffect, useState } from "preact/hooks";

/** Eight-bit values of the pixels of a picture. */
export interface Pixels {
  at(x: number, y: number): number[];
}

/** Decodes pictures; `null` until they are decoded. */
export function usePixels(sources: string[]): (Pixels | null)[] {
  const [pixels, setPixels] = useState<(Pixels | null)[]>(sources.map(() => null));
  useEffect(() => {
    let current = true;
    Promise.all(sources.map(decode)).then((decoded) => current && setPixels(decoded));
    return () => {
      current = false;
    };
  }, sources);
  return pixels;
}

async function decode(source: string): Promise<Pixels | null> {
  const image = new Image();
  image.src = source;
  try {
    await image.decode();
  } catch {
    return null;
  }
  const canvas = document.createElement("canvas");
  canvas.width = image.naturalWidth;
  canvas.height = image.naturalHeight;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  if (!context) return null;
  context.drawImage(image, 0, 0);
  const { data, width } = context.getImageData(0, 0, canvas.width, canvas.height);
  return { at: (x, y) => [...data.slice(4 * (y * width + x), 4 * (y * width + x) + 3)] };
}
