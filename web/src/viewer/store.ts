import { useEffect, useReducer } from "preact/hooks";
import type { Session } from "../engine/engine";
import { termAt } from "../explain/segments";
import type { ExplainView } from "../explain/view";
import type {
  CameraRay,
  CameraState,
  CastResult,
  Event,
  Finding,
  Keyword,
  LightMarker,
  Motion,
  Outline,
  PictureInfo,
  PixelExplanation,
  SceneSummary,
  Setting,
  TreeBox,
} from "../protocol";
import { mergeMotions } from "./motion";
import { cropForZoom, whole, type Zoom } from "./zoom";

/** Event that states which file was opened. */
type Opened = Extract<Event, { kind: "opened" }>;

/** State and operations of the viewer, to which its components subscribe. */
export class Store implements ExplainView {
  readonly session: Session;
  opened: Opened | null = null;
  text = "";
  /** Number of times that the text was replaced from outside the editor. */
  textVersion = 0;
  edited = false;
  diskText: string | null = null;
  conflict = false;
  findings: Finding[] = [];
  contents: SceneSummary | null = null;
  valid = true;
  camera: CameraState | null = null;
  head: PictureInfo | null = null;
  pixels: Uint8Array<ArrayBuffer> | null = null;
  pixel: PixelExplanation | null = null;
  cast: CastResult | null = null;
  /** Path of the selected term in the tree. */
  chosen = "0";
  /** True if the formulas of the selected term are visible. */
  unfolded = false;
  hovered: string | null = null;
  /** Number of the object at the cursor in the text, or of the one selected in a model's tree. */
  marked: number | null = null;
  /** Object that is selected in a model's tree. */
  revealed: { object: number; count: number } | null = null;
  /** Number of pixels that the user has asked to explain. */
  explanations = 0;
  outlines: Outline[] = [];
  lights: LightMarker[] = [];
  words: Keyword[] = [];
  error: string | null = null;
  /** The pixel that the step-by-step view has reached, and its ray. */
  scan: { x: number; y: number; ray: CameraRay | null } | null = null;
  /** The visible part of the image. */
  zoom: Zoom = whole;
  denoiseEnabled = false;
  hoveredPixel: [number, number] | null = null;
  /** Bounding boxes of the trees that are drawn. */
  boxes: TreeBox[] = [];
  boxLevel: number | null = null;
  tree: Extract<Event, { kind: "tree" }> | null = null;
  picture = "color";
  stops = 0;
  tone = "none";
  options: Setting[] = [];
  /** Byte range to show in the editor. */
  jump: { start: number; end: number; count: number } | null = null;
  #listeners = new Set<() => void>();
  #crop: [number, number, number, number] | null = null;
  #waiting: Motion[] = [];
  #refresh = 0;
  #due = false;

  constructor(session: Session) {
    this.session = session;
    session.on((event, bytes) => this.#hear(event, bytes));
    session.ask({ kind: "language" }, "language").then(({ words }) => {
      this.words = words;
      this.changed();
    });
  }

  subscribe(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  changed() {
    for (const listener of this.#listeners) listener();
  }

  open(name: string, text: string | null) {
    this.pixel = null;
    this.cast = null;
    this.session.send({ kind: "open", name, text });
  }

  edit(text: string) {
    if (text === this.text) return;
    this.text = text;
    this.edited = true;
    this.session.send({ kind: "edit", text });
    this.changed();
  }

  /** Replaces the text in the editor. */
  replace(text: string) {
    this.textVersion++;
    this.edit(text);
  }

  show(picture: string, stops = this.stops, tone = this.tone) {
    this.picture = picture;
    this.stops = stops;
    this.tone = tone;
    this.session.send({ kind: "show", picture, stops, tone });
    this.changed();
  }

  setOption(name: string, value: string | null) {
    this.options = this.options.filter((option) => option.name !== name);
    if (value !== null) this.options.push({ name, value });
    this.session.send({ kind: "options", options: this.options });
    this.changed();
  }

  /** Zooms to a part of the image. From a zoom of two, only that part is rendered. */
  setZoom(zoom: Zoom) {
    this.zoom = zoom;
    const { full_width, full_height } = this.head ?? { full_width: 1, full_height: 1 };
    const crop = cropForZoom(zoom, full_width, full_height);
    if (JSON.stringify(crop) !== JSON.stringify(this.#crop)) {
      this.#crop = crop;
      this.session.send({ kind: "crop", crop });
    }
    this.changed();
  }

  /** Sets the pixel below the pointer. */
  point(pixel: [number, number] | null) {
    if (this.hoveredPixel?.join() === pixel?.join()) return;
    this.hoveredPixel = pixel;
    this.changed();
  }

  denoise(on: boolean) {
    this.denoiseEnabled = on;
    this.session.send({ kind: "denoise", on });
    this.changed();
  }

  /** Draws the bounding boxes of the trees up to a level; `null` hides them. */
  async showBoxes(level: number | null) {
    this.boxLevel = level;
    if (level !== null && this.boxes.length === 0) await this.#askBoxes();
    this.changed();
  }

  async #askBoxes() {
    const { boxes } = await this.session.ask({ kind: "boxes" }, "boxes");
    this.boxes = boxes;
    this.changed();
  }

  /** Moves the camera; motions within a frame are merged. */
  move(motion: Motion, moving: boolean) {
    if (!moving) {
      this.session.send({ kind: "move", motion, moving });
      return;
    }
    this.#waiting.push(motion);
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => {
      this.#due = false;
      const motions = this.#waiting;
      this.#waiting = [];
      for (const motion of mergeMotions(motions)) this.session.send({ kind: "move", motion, moving: true });
    });
  }

  /** Ends a motion, so that the image is rendered with all samples. */
  settle() {
    requestAnimationFrame(() =>
      this.session.send({
        kind: "move",
        motion: { kind: "walk", forward: 0, right: 0, up: 0 },
        moving: false,
      }),
    );
  }

  async explain(x: number, y: number, sample: number | null = null) {
    try {
      const { pixel } = await this.session.ask({ kind: "explain", x, y, sample }, "explained");
      this.pixel = pixel;
      this.chosen = "0";
      this.hovered = null;
      this.cast = null;
      this.unfolded = false;
      this.explanations++;
      this.choose("0");
      this.goTo(pixel.tree?.place ?? null);
      this.reveal(pixel.tree?.object ?? null);
    } catch (error) {
      this.error = String(error);
    }
    this.changed();
  }

  /** Explains the pixel again after the scene or the camera has changed. */
  #explainAgain() {
    clearTimeout(this.#refresh);
    this.#refresh = window.setTimeout(async () => {
      const old = this.pixel;
      if (!old) return;
      try {
        const { x, y } = old;
        const { pixel } = await this.session.ask({ kind: "explain", x, y, sample: null }, "explained");
        if (this.pixel !== old) return;
        this.pixel = pixel;
        this.choose(termAt(pixel, this.chosen) ? this.chosen : "0");
      } catch {
        // The pixel no longer exists, or the scene has errors.
      }
    }, 250);
  }

  /** Selects a term of the tree, and intersects its ray with all objects. */
  async choose(path: string) {
    this.chosen = path;
    this.changed();
    const cast = await this.castOf(path);
    if (cast && this.chosen === path) {
      this.cast = cast;
      this.changed();
    }
  }

  /** Intersects the ray of a term with all objects. */
  async castOf(path: string): Promise<CastResult | null> {
    const term = termAt(this.pixel, path);
    if (!term?.ray) return null;
    const [origin, direction] = term.ray;
    return (await this.session.ask({ kind: "cast", origin, direction, t_max: term.t_max }, "cast")).cast;
  }

  get aspect(): number {
    return this.head ? this.head.full_width / this.head.full_height : 1;
  }

  hover(path: string | null) {
    if (this.hovered === path) return;
    this.hovered = path;
    this.changed();
  }

  /** Marks an object in the image and in the view of the rays; `null` marks none. */
  mark(object: number | null) {
    if (object === this.marked) return;
    this.marked = object;
    this.changed();
  }

  /** Replaces the text with the one that another program wrote to the file. */
  takeDisk(text: string) {
    this.diskText = null;
    this.replace(text);
    this.edited = false;
    this.changed();
  }

  keepEdits() {
    this.diskText = null;
    this.changed();
  }

  goTo(place: { start: number; end: number } | null) {
    if (!place) return;
    this.jump = { start: place.start, end: place.end, count: (this.jump?.count ?? 0) + 1 };
    this.changed();
  }

  /** Shows an object of a model, which has no text, in the tree. */
  reveal(object: number | null) {
    if (object === null || this.opened?.text !== null) return;
    this.revealed = { object, count: (this.revealed?.count ?? 0) + 1 };
    this.marked = null;
    this.changed();
  }

  async save(force: boolean) {
    try {
      this.session.send({ kind: "save", force });
    } catch (error) {
      this.error = String(error);
    }
  }

  #hear(event: Event, bytes: Uint8Array<ArrayBuffer>) {
    switch (event.kind) {
      case "opened":
        this.opened = event;
        this.text = event.text ?? "";
        this.textVersion++;
        this.edited = false;
        this.diskText = null;
        this.conflict = false;
        this.contents = null;
        this.tree = null;
        this.marked = null;
        this.revealed = null;
        this.zoom = whole;
        this.#crop = null;
        break;
      case "scene":
        this.findings = event.findings;
        this.valid = event.contents !== null;
        this.error = null;
        if (event.contents) {
          const first = this.contents === null;
          this.contents = event.contents;
          this.camera = event.contents.camera;
          if (first) this.#frame(event.contents.job.size);
          this.#outlines();
          this.boxes = [];
          if (this.boxLevel !== null) this.#askBoxes();
          if (this.opened?.text === null) this.#askTree();
          this.#explainAgain();
        }
        break;
      case "checked":
        this.findings = event.findings;
        break;
      case "camera":
        this.camera = event.camera;
        this.#explainAgain();
        break;
      case "picture":
        this.head = event.head;
        this.pixels = bytes;
        break;
      case "text":
        if (event.from_disk && this.edited) {
          this.diskText = event.text;
        } else {
          this.text = event.text;
          this.textVersion++;
          this.edited = !event.from_disk;
          if (event.from_disk) this.session.send({ kind: "edit", text: event.text });
        }
        break;
      case "saved":
        this.edited = false;
        this.conflict = false;
        this.diskText = null;
        break;
      case "conflict":
        this.conflict = true;
        break;
      case "refused":
        this.error = event.why;
        break;
    }
    this.changed();
  }

  async #askTree() {
    this.tree = await this.session.ask({ kind: "tree" }, "tree");
    this.changed();
  }

  #frame([width, height]: [number, number]) {
    this.session.send({ kind: "size", width, height });
  }

  async #outlines() {
    const { outlines, lamps } = await this.session.ask({ kind: "outlines" }, "outlines");
    this.outlines = outlines;
    this.lights = lamps;
    this.changed();
  }
}

/** Renders the component again when the store changes. */
export function useStore(store: { subscribe(listener: () => void): () => void }) {
  const [, again] = useReducer((count: number) => count + 1, 0);
  useEffect(() => store.subscribe(() => again(undefined as never)), [store]);
}
