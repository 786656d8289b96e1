import type {
  CameraRay,
  CameraState,
  CastResult,
  LightMarker,
  Outline,
  PixelExplanation,
  TextPosition,
  TreeBox,
} from "../protocol";

/** State of an explanation, which its components show and change: the viewer's, or that of a
 * report.
 */
export interface ExplainView {
  readonly pixel: PixelExplanation | null;
  /** Intersection tests of the selected term's ray. */
  readonly cast: CastResult | null;
  /** Path of the selected term in the tree. */
  readonly chosen: string;
  /** True if the formulas of the selected term are visible. */
  unfolded: boolean;
  readonly hovered: string | null;
  /** Number of the object that is highlighted. */
  readonly marked: number | null;
  readonly outlines: Outline[];
  readonly lights: LightMarker[];
  readonly camera: CameraState | null;
  /** Width of the image divided by its height. */
  readonly aspect: number;
  /** Bounding boxes of the trees that are drawn. */
  readonly boxes: TreeBox[];
  readonly boxLevel: number | null;
  /** The pixel that the step-by-step view has reached, and its ray. */
  readonly scan: { x: number; y: number; ray: CameraRay | null } | null;
  subscribe(listener: () => void): () => void;
  /** Explains another sample of a pixel, or another pixel. */
  explain(x: number, y: number, sample: number | null): void;
  choose(path: string): void;
  hover(path: string | null): void;
  /** Returns the intersection tests of a term's ray; `null` if there are none. */
  castOf(path: string): Promise<CastResult | null>;
  /** Shows a place in the scene's text. */
  goTo(place: TextPosition | null): void;
  /** Shows an object in the tree of a model. */
  reveal(object: number | null): void;
}
