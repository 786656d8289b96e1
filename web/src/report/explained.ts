import { termAt } from "../explain/segments";
import type { ExplainView } from "../explain/view";
import type { CastResult, PixelExplanation } from "../protocol";
import type { ExplainReport } from "./types";

/** State of the explanation in a report. */
export class ReportedExplanation implements ExplainView {
  readonly #report: ExplainReport;
  readonly boxes = [];
  readonly boxLevel = null;
  readonly marked = null;
  readonly scan = null;
  pixel: PixelExplanation | null = null;
  cast: CastResult | null = null;
  chosen = "0";
  hovered: string | null = null;
  unfolded = false;
  #sample = 0;
  #casts = new Map<string, CastResult>();
  #listeners = new Set<() => void>();

  constructor(report: ExplainReport) {
    this.#report = report;
    this.explain(0, 0, report.sample);
  }

  get outlines() {
    return this.#report.scene.outlines;
  }

  get lights() {
    return this.#report.scene.lights;
  }

  get camera() {
    return this.#report.scene.camera;
  }

  get aspect() {
    const [width, height] = this.#report.size;
    return width / height;
  }

  /** Index of the sample that is shown. */
  get sample() {
    return this.#sample;
  }

  /** True if the report contains the intersection tests of the sample. */
  get hasTests() {
    return this.#casts.size > 0;
  }

  subscribe(listener: () => void): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  #changed() {
    for (const listener of this.#listeners) listener();
  }

  explain(_x: number, _y: number, sample: number | null) {
    const found = this.#report.samples[sample ?? 0];
    if (!found) return;
    this.#sample = sample ?? 0;
    this.#casts = new Map(found.casts.map(({ path, cast }) => [path, cast]));
    this.pixel = found.explanation;
    this.hovered = null;
    this.choose("0");
  }

  choose(path: string) {
    this.chosen = path;
    // A term without a ray keeps the tests of the ray above it.
    if (path === "0" || termAt(this.pixel, path)?.ray) this.cast = this.#casts.get(path) ?? null;
    this.#changed();
  }

  hover(path: string | null) {
    if (this.hovered === path) return;
    this.hovered = path;
    this.#changed();
  }

  async castOf(path: string): Promise<CastResult | null> {
    return this.#casts.get(path) ?? null;
  }

  goTo() {}

  reveal() {}
}
