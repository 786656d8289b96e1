import { useState } from "preact/hooks";
import type { Session } from "../engine/engine";
import { Rows } from "../explain/rows";
import { flatten } from "../explain/segments";
import type { MistakenPicture } from "../mistakes/mistaken";
import type { PictureInfo } from "../protocol";
import { short } from "../ui/slider";
import { usePixel } from "./context";
import { PixelPicker } from "./picked";
import { RenderedImage } from "./rendered";

interface Props {
  session: Session;
  width: number;
  height: number;
  label: string;
  /** Key of the image; a change asks for a new explanation. */
  scene: string;
  /** Picture with a mistake, which is shown instead. */
  mistaken?: MistakenPicture | null;
  onResult?(head: PictureInfo): void;
}

/** Rendered image, with the terms of the last clicked pixel beside it. */
export function ExplainedImage({ session, width, height, label, scene, mistaken = null, onResult }: Props) {
  const [place, setPlace] = useState({ x: 0.5, y: 0.5 });
  const [hash, setHash] = useState("");
  const at = { x: Math.floor(place.x * width), y: Math.floor(place.y * height) };
  const account = usePixel(session, at.x, at.y, `${scene} ${width} ${hash}`);
  const terms = flatten(account?.tree).slice(0, 12);
  return (
    <div class="halves explained">
      <PixelPicker place={place} pick={setPlace}>
        <RenderedImage
          session={session}
          width={width}
          height={height}
          label={label}
          mistaken={mistaken}
          onResult={(head) => {
            setHash(head.hash ?? "");
            onResult?.(head);
          }}
        />
      </PixelPicker>
      <div class="stage account" tabIndex={0} role="region" aria-label="Terms of the pixel">
        <h3>
          Pixel {at.x}, {at.y}:{" "}
          <b class="sum">{account ? account.color.map((x) => short(x)).join("  ") : "…"}</b>
        </h3>
        {terms[0] && <Rows rows={terms[0].term.rows} />}
        <ul>
          {terms.slice(1).map(({ path, term }) => (
            <li key={path} style={{ "--level": path.split(".").length - 2 }}>
              <span>{term.title}</span> <b>{term.adds.map((x) => short(x, 3)).join("  ")}</b>
            </li>
          ))}
        </ul>
      </div>
    </div>
  );
}
