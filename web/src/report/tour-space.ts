import { add, length, mul, sub, type Vec } from "../explain/space";
import {
  between,
  type Corners,
  eyeOf,
  homography,
  lookFrom,
  median,
  overview,
  type Projected,
  pyramid,
  shared,
  type TourEye,
  tourProjector,
} from "./tour-math";
import type { TourReport } from "./types";

/** Movement from one photograph to another, or to a view of all of them. */
interface Flight {
  from: number;
  to: number;
  begin: TourEye;
  end: TourEye;
  /** Corners of both photographs on a common plane. */
  corners: [Corners, Corners] | null;
  /** Progress from 0 to 1. */
  t: number;
  start: number;
  message: string | null;
}

/** What the page shows of a tour beside the drawing. */
export interface TourState {
  /** Photograph at the viewpoint; -1 if there is none. */
  current: number;
  /** Photographs of the selected point. */
  chosen: Set<number> | null;
  message: string;
}

/** Draws points, cameras and photographs, and moves the viewpoint. */
export class TourSpace {
  readonly #report: TourReport;
  readonly #middle: Vec;
  readonly #reach: number;
  readonly #changed: (state: TourState) => void;
  #eye: TourEye;
  #flight: Flight | null = null;
  #state: TourState;
  #canvas: HTMLCanvasElement | null = null;
  #images: HTMLImageElement[] = [];
  /** Visible points: depth, position on the canvas, and number. */
  #visible: [number, number, number, number][] = [];

  constructor(report: TourReport, changed: (state: TourState) => void) {
    this.#report = report;
    this.#changed = changed;
    const { points, photographs } = report;
    const along = (i: 0 | 1 | 2) => median(points.map((p) => p[i]));
    this.#middle = [along(0), along(1), along(2)];
    this.#reach = median(photographs.map((p) => length(sub(p.center, this.#middle)))) || 1;
    this.#eye = this.#overview();
    this.#state = { current: -1, chosen: null, message: this.#all };
  }

  get #all(): string {
    return `${this.#report.photographs.length} photographs, ${this.#report.points.length} points`;
  }

  get state(): TourState {
    return this.#state;
  }

  attach(canvas: HTMLCanvasElement, images: HTMLImageElement[]) {
    this.#canvas = canvas;
    this.#images = images;
    if (this.#state.current < 0) this.#eye = this.#overview();
    this.draw();
  }

  /** Fits the photograph into the window again. */
  resize() {
    const photo = this.#report.photographs[this.#state.current];
    if (photo && !this.#flight) this.#eye = eyeOf(photo, this.#shape());
    this.draw();
  }

  #shape(): [number, number] {
    const { clientWidth, clientHeight } = this.#canvas ?? { clientWidth: 16, clientHeight: 10 };
    return [Math.max(1, clientWidth), Math.max(1, clientHeight)];
  }

  #overview(): TourEye {
    return overview(this.#report.photographs, this.#middle, this.#reach, this.#shape());
  }

  #set(state: Partial<TourState>) {
    this.#state = { ...this.#state, ...state };
    this.#changed(this.#state);
  }

  /** Flies to a photograph, or with -1 to a view of all of them. */
  fly(to: number, message: string | null = null) {
    const { photographs, points } = this.#report;
    const [there, here] = [photographs[to], photographs[this.#state.current]];
    const flight: Flight = {
      from: this.#state.current,
      to,
      begin: this.#eye,
      end: there ? eyeOf(there, this.#shape()) : this.#overview(),
      corners: here && there ? shared(here, there, points) : null,
      t: 0,
      start: performance.now(),
      message,
    };
    this.#flight = flight;
    if (to < 0) this.#set({ chosen: null });
    const duration = matchMedia("(prefers-reduced-motion: reduce)").matches ? 1 : 1100;
    const step = (now: number) => {
      if (this.#flight !== flight) return;
      const t = Math.min(1, Math.max(0, (now - flight.start) / duration));
      flight.t = t * t * (3 - 2 * t);
      this.#eye = between(flight.begin, flight.end, flight.t);
      if (t === 1) return this.#land(flight);
      this.draw();
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  #land({ end, to, message }: Flight) {
    this.#eye = end;
    this.#flight = null;
    const photo = this.#report.photographs[to];
    const told = photo ? `${photo.name}: sees ${photo.points.length} of the points` : this.#all;
    this.#set({ current: to, message: message ?? told });
    this.draw();
  }

  say(message: string) {
    this.#set({ message });
  }

  /** Selects the camera or the point at a position on the canvas, in page pixels. */
  pick(left: number, top: number) {
    const { photographs, points } = this.#report;
    const ratio = window.devicePixelRatio || 1;
    const [x, y] = [left * ratio, top * ratio];
    const isNear = (px: number, py: number) => Math.hypot(px - x, py - y) < 14 * ratio;
    const project = this.#projector();
    const tip = photographs.findIndex((photo, i) => {
      const [px, py, depth] = project(photo.center);
      return i !== this.#state.current && depth > 0 && isNear(px, py);
    });
    if (tip >= 0) return this.fly(tip);
    const near = this.#visible.filter((v) => isNear(v[1], v[2])).sort((a, b) => a[0] - b[0])[0];
    const point = near && points[near[3]];
    if (!near || !point) {
      this.#set({ chosen: null });
      return this.draw();
    }
    const seers = photographs.flatMap((photo, i) => {
      const size = photo.focal / Math.max(...photo.size) / length(sub(point, photo.center));
      return photo.points.includes(near[3]) ? [{ i, name: photo.name, size }] : [];
    });
    seers.sort((a, b) => b.size - a.size);
    const message = `point ${near[3]} is in ${seers.length} photographs: ${seers.map(({ name }) => name).join(", ")}`;
    this.#set({ chosen: new Set(seers.map(({ i }) => i)), message });
    const next = seers.find(({ i }) => i !== this.#state.current);
    if (next) this.fly(next.i, message);
    else this.draw();
  }

  /** Turns around the middle of the points. */
  turn(right: number, up: number) {
    this.#stop();
    const d = sub(this.#eye.center, this.#middle);
    const r = length(d);
    const yaw = Math.atan2(d[0], d[2]) - right;
    const pitch = Math.max(-1.5, Math.min(1.5, Math.asin(d[1] / r) + up));
    const away: Vec = [Math.cos(pitch) * Math.sin(yaw), Math.sin(pitch), Math.cos(pitch) * Math.cos(yaw)];
    const center = add(this.#middle, mul(r, away));
    this.#eye = { ...this.#eye, center, rows: lookFrom(center, this.#middle) };
    this.draw();
  }

  /** Changes the distance to the middle by a factor. */
  zoom(factor: number) {
    this.#stop();
    const center = add(this.#middle, mul(factor, sub(this.#eye.center, this.#middle)));
    this.#eye = { ...this.#eye, center };
    this.draw();
  }

  #stop() {
    this.#flight = null;
    if (this.#state.current >= 0) this.#set({ current: -1 });
  }

  #projector(): (p: Vec) => Projected {
    return tourProjector(this.#eye, this.#canvas?.width ?? 1, this.#canvas?.height ?? 1);
  }

  draw() {
    const [canvas, pen] = [this.#canvas, this.#canvas?.getContext("2d")];
    if (!canvas || !pen) return;
    const ratio = window.devicePixelRatio || 1;
    const box = canvas.getBoundingClientRect();
    canvas.width = Math.max(1, box.width * ratio);
    canvas.height = Math.max(1, box.height * ratio);
    const project = this.#projector();
    // Points and lines grow with the text.
    const unit = (ratio * Number.parseFloat(getComputedStyle(document.documentElement).fontSize)) / 16;
    this.#points(canvas, pen, project, unit);
    this.#cameras(pen, project, unit);
    this.#photographs(project, ratio);
  }

  #points(
    { width, height }: HTMLCanvasElement,
    pen: CanvasRenderingContext2D,
    project: (p: Vec) => Projected,
    unit: number,
  ) {
    const { points, colors } = this.#report;
    this.#visible = [];
    points.forEach((p, i) => {
      const [x, y, z] = project(p);
      if (z > 0.01 * this.#reach && x >= 0 && y >= 0 && x < width && y < height)
        this.#visible.push([z, x, y, i]);
    });
    this.#visible.sort((a, b) => b[0] - a[0]);
    for (const [z, x, y, i] of this.#visible) {
      const side = Math.min(7, Math.max(2, (3.5 * this.#reach) / z)) * unit;
      pen.fillStyle = `rgb(${colors[i]?.join()})`;
      pen.fillRect(x - side / 2, y - side / 2, side, side);
    }
  }

  #cameras(pen: CanvasRenderingContext2D, project: (p: Vec) => Projected, unit: number) {
    const { current, chosen } = this.#state;
    this.#report.photographs.forEach((photo, i) => {
      if (i === current && !this.#flight) return;
      const drawn = pyramid(photo);
      const [tip, ends] = [project(drawn.tip), drawn.ends.map(project)];
      if (tip[2] <= 0 || ends.some((end) => end[2] <= 0)) return;
      pen.strokeStyle = chosen?.has(i) ? "#ffb000" : "#7fb2ff";
      pen.lineWidth = (chosen?.has(i) ? 2.5 : 1.2) * unit;
      pen.beginPath();
      ends.forEach((end, k) => {
        const next = ends[(k + 1) % 4] ?? end;
        pen.moveTo(tip[0], tip[1]);
        pen.lineTo(end[0], end[1]);
        pen.lineTo(next[0], next[1]);
      });
      pen.stroke();
    });
  }

  /** Places the current photograph, or during a flight both, onto their rectangles in space. */
  #photographs(project: (p: Vec) => Projected, ratio: number) {
    const flight = this.#flight;
    this.#images.forEach((image, i) => {
      const photo = this.#report.photographs[i];
      if (!photo) return;
      const inFlight = i === flight?.to ? flight.t : i === flight?.from ? 1 - flight.t : 0;
      const opacity = flight ? inFlight : Number(i === this.#state.current);
      const own = flight?.corners?.[i === flight.from ? 0 : 1] ?? photo.corners;
      const corners = own.map(project);
      const isBefore = corners.every((corner) => corner[2] > 0);
      image.style.opacity = String(isBefore ? 0.95 * opacity : 0);
      if (!isBefore || opacity === 0) return;
      const [w, h] = [image.naturalWidth || 1, image.naturalHeight || 1];
      image.style.width = `${w}px`;
      image.style.height = `${h}px`;
      image.style.transform = homography(
        corners.map(([x, y]) => [x / ratio, y / ratio]),
        w,
        h,
      );
    });
  }
}
