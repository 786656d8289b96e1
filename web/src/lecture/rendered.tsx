import { useEffect, useRef } from "preact/hooks";
import type { Session } from "../engine/engine";
import { MistakenCanvas, type MistakenPicture } from "../mistakes/mistaken";
import type { PictureInfo } from "../protocol";
import { draw } from "../viewer/picture";

interface Props {
  session: Session;
  width: number;
  height: number;
  label: string;
  /** True to show pixels as squares. */
  squares?: boolean;
  /** Picture with a mistake, which is shown instead. */
  mistaken?: MistakenPicture | null;
  onResult?(head: PictureInfo): void;
}

/** Shows the image that a session renders. */
export function RenderedImage({
  session,
  width,
  height,
  label,
  squares = false,
  mistaken = null,
  onResult,
}: Props) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const callback = useRef(onResult);
  callback.current = onResult;
  useEffect(() => {
    session.send({ kind: "size", width, height });
    return session.on((event, bytes) => {
      if (event.kind !== "picture" || !canvas.current) return;
      // Skip coarse previews, which would only flicker at so few pixels.
      if (squares && event.head.width < width) return;
      draw(canvas.current, event.head.width, event.head.height, bytes);
      callback.current?.(event.head);
    });
  }, [session, width, height, squares]);
  return (
    <div class="stage render" style={{ aspectRatio: `${width} / ${height}` }}>
      <canvas ref={canvas} class={squares ? "squares" : ""} role="img" aria-label={label} />
      {mistaken && (
        <MistakenCanvas
          picture={mistaken}
          label={`${label}, with the mistake`}
          look={squares ? "instead squares" : "instead"}
        />
      )}
    </div>
  );
}
