import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";
import type { Session } from "../engine/engine";
import type { MistakeChoice } from "../protocol";
import { draw } from "../viewer/picture";

/** Picture that a program with a mistake would render. */
export interface MistakenPicture {
  width: number;
  height: number;
  /** Fraction of the pixels that differ from the correct picture. */
  changed: number;
  /** Description and code of the mistake; `null` for the correct picture. */
  mistake: MistakeChoice | null;
  pixels: Uint8Array<ArrayBuffer>;
}

/** Picture that the library renders: with a mistake, or without one if `name` is null. */
export interface MistakeRequest {
  name: string | null;
  /** Value of the mistake; `null` for its first value. */
  value: number | null;
  size: [number, number];
}

/** Time without changes of the scene before a picture is requested, in milliseconds. */
const patience = 120;

/**
 * Returns the picture of a mistake in a session's scene; `null` until it is rendered. It is
 * rendered again if one of `changes` changes. Without a request, nothing is rendered.
 */
export function useMistaken(
  session: Session,
  request: MistakeRequest | null,
  changes: unknown[],
): { picture: MistakenPicture | null; refused: string | null } {
  const [picture, setPicture] = useState<MistakenPicture | null>(null);
  const [refused, setRefused] = useState<string | null>(null);
  const key = JSON.stringify(request);
  // The picture of another mistake is not shown any more, that of an older scene is.
  useLayoutEffect(() => {
    setPicture(null);
    setRefused(null);
  }, [session, key]);
  useEffect(() => {
    if (!request) return;
    const { name, value, size } = request;
    const [width, height] = size;
    let isLatest = true;
    const timer = setTimeout(() => {
      session
        .askBytes({ kind: "mistake", name, value, width, height }, "mistaken")
        .then(([event, bytes]) => {
          if (!isLatest) return;
          setPicture({ ...event, pixels: bytes });
          setRefused(null);
        })
        .catch(
          (error: unknown) => isLatest && setRefused(error instanceof Error ? error.message : `${error}`),
        );
    }, patience);
    return () => {
      isLatest = false;
      clearTimeout(timer);
    };
  }, [session, key, ...changes]);
  return { picture, refused };
}

/** Canvas with the picture of a mistake. */
export function MistakenCanvas({
  picture,
  label,
  look = "",
}: {
  picture: MistakenPicture;
  label: string;
  /** CSS classes. */
  look?: string;
}) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useLayoutEffect(() => {
    if (canvas.current) draw(canvas.current, picture.width, picture.height, picture.pixels);
  }, [picture]);
  return <canvas ref={canvas} class={look} role="img" aria-label={label} />;
}
