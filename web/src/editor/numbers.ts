import { type EditorState, RangeSetBuilder } from "@codemirror/state";
import {
  Decoration,
  type DecorationSet,
  EditorView,
  ViewPlugin,
  type ViewUpdate,
  WidgetType,
} from "@codemirror/view";

const number = /[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?/g;

/** Returns the range and value of the number at a column of a line. */
export function numberAt(line: string, column: number): { from: number; to: number; value: number } | null {
  for (const found of line.matchAll(number)) {
    const to = found.index + found[0].length;
    const before = line[found.index - 1] ?? " ";
    if (column >= found.index && column <= to && !/[\w.]/.test(before)) {
      return { from: found.index, to, value: Number(found[0]) };
    }
  }
  return null;
}

/** Returns the number after a drag by some pixels, with a suitable number of decimals. */
export function scrubbed(text: string, pixels: number): string {
  const value = Number(text);
  const decimals = Math.max(text.split(".")[1]?.length ?? 0, Math.abs(value) < 10 ? 2 : 1);
  const whole = !text.includes(".") && Math.abs(value) >= 20;
  const step = whole
    ? Math.max(1, Math.round(Math.abs(value) / 100))
    : Math.max(10 ** -decimals, Math.abs(value) / 200);
  const changed = value + step * pixels;
  return whole ? String(Math.round(changed)) : String(Number(changed.toFixed(Math.min(decimals, 4))));
}

/** Changes numbers by dragging with the Alt key held. */
export const scrubbing = EditorView.domEventHandlers({
  mousedown(event, view) {
    if (!event.altKey || event.button !== 0) return false;
    const position = view.posAtCoords({ x: event.clientX, y: event.clientY });
    if (position === null) return false;
    const line = view.state.doc.lineAt(position);
    const found = numberAt(line.text, position - line.from);
    if (!found) return false;
    event.preventDefault();
    const from = line.from + found.from;
    const original = view.state.sliceDoc(from, line.from + found.to);
    let length = original.length;
    const stop = new AbortController();
    const move = (moved: MouseEvent) => {
      const insert = scrubbed(original, Math.round((moved.clientX - event.clientX) / 2));
      view.dispatch({ changes: { from, to: from + length, insert }, userEvent: "input.scrub" });
      length = insert.length;
    };
    window.addEventListener("mousemove", move, { signal: stop.signal });
    window.addEventListener("mouseup", () => stop.abort(), { signal: stop.signal });
    return true;
  },
});

class Swatch extends WidgetType {
  readonly color: string;
  readonly from: number;
  readonly to: number;
  constructor(color: string, from: number, to: number) {
    super();
    this.color = color;
    this.from = from;
    this.to = to;
  }

  override eq(other: Swatch) {
    return other.color === this.color && other.from === this.from;
  }

  toDOM(view: EditorView) {
    const input = document.createElement("input");
    input.type = "color";
    input.className = "swatch";
    input.value = this.color;
    input.setAttribute("aria-label", "Pick the colour");
    let { from, to } = this;
    input.oninput = () => {
      const insert = linear(input.value).join(" ");
      view.dispatch({ changes: { from, to, insert }, userEvent: "input.color" });
      to = from + insert.length;
      from = to - insert.length;
    };
    return input;
  }

  override ignoreEvent() {
    return true;
  }
}

/** Converts three numbers of linear RGB to a CSS colour. */
export function encoded(rgb: number[]): string {
  const byte = (x: number) => {
    const clamped = Math.min(1, Math.max(0, x));
    const curve = clamped <= 0.0031308 ? 12.92 * clamped : 1.055 * clamped ** (1 / 2.4) - 0.055;
    return Math.round(255 * curve)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${rgb.map(byte).join("")}`;
}

/** Converts a CSS colour to three numbers of linear RGB. */
export function linear(color: string): number[] {
  return [1, 3, 5].map((at) => {
    const x = Number.parseInt(color.slice(at, at + 2), 16) / 255;
    const light = x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4;
    return Number(light.toPrecision(3));
  });
}

const colors = /\b\w*(?:[cC]olor|ambientLight|ambient_light)\s+((?:[-+.\deE]+\s+){2}[-+.\deE]+)/g;

function swatches(state: EditorState, from: number, to: number): DecorationSet {
  const set = new RangeSetBuilder<Decoration>();
  for (const found of state.sliceDoc(from, to).matchAll(colors)) {
    const numbers = found[1] ?? "";
    const rgb = numbers.trim().split(/\s+/).map(Number);
    if (rgb.length !== 3 || rgb.some((x) => !Number.isFinite(x))) continue;
    const end = from + found.index + found[0].length;
    const start = end - numbers.length;
    set.add(start, start, Decoration.widget({ widget: new Swatch(encoded(rgb), start, end), side: -1 }));
  }
  return set.finish();
}

/** Shows a swatch before each colour, which opens the browser's colour picker. */
export const colorPicking = ViewPlugin.fromClass(
  class {
    decorations: DecorationSet;
    constructor(view: EditorView) {
      this.decorations = swatches(view.state, view.viewport.from, view.viewport.to);
    }
    update(update: ViewUpdate) {
      const picking = update.transactions.some((transaction) => transaction.isUserEvent("input.color"));
      if (picking) this.decorations = this.decorations.map(update.changes);
      else if (update.docChanged || update.viewportChanged) {
        this.decorations = swatches(update.state, update.view.viewport.from, update.view.viewport.to);
      }
    }
  },
  { decorations: (plugin) => plugin.decorations },
);
