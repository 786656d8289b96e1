import type { FieldState } from "../protocol";

/** Values that the controls of a field can set. */
export interface FieldRange {
  min: number;
  max: number;
  /** Step of a slider, and distance from bounds that are not values themselves. */
  step: number;
}

/** Numbers of a field that determine its range. */
type Bounds = Pick<FieldState, "values" | "least" | "most" | "above_least" | "below_most" | "whole">;

/** Maximum range of whole numbers for which a slider is precise enough. */
const widest = 1000;

/**
 * Returns the range of a field. The step is 1 for whole numbers, otherwise a power of ten: about a
 * thousandth of the range, or of the value if the range is infinite. Exclusive bounds are moved
 * inwards by five steps, so by half a degree if angles range from 0 to 180.
 */
export function rangeOf({ values, least, most, above_least, below_most, whole }: Bounds): FieldRange {
  const span = least !== null && most !== null ? most - least : Math.max(...values.map(Math.abs)) || 1;
  const step = whole ? 1 : 10 ** Math.floor(Math.log10(Math.max(span, 1e-9) / 1000) + 1e-9);
  const inset = whole ? 1 : 5 * step;
  return {
    min: least === null ? -Infinity : least + (above_least ? inset : 0),
    max: most === null ? Infinity : most - (below_most ? inset : 0),
    step,
  };
}

/** Returns true if a slider suits the field: a single number with two bounds. */
export function hasSlider(field: Bounds): boolean {
  const { min, max } = rangeOf(field);
  return (
    field.values.length === 1 &&
    Number.isFinite(max - min) &&
    max > min &&
    (!field.whole || max - min <= widest)
  );
}

/** Rounds a value if the field takes only whole numbers, and moves it into the range of the field. */
export function fitted(field: Bounds, value: number): number {
  const { min, max } = rangeOf(field);
  return Math.min(max, Math.max(min, field.whole ? Math.round(value) : value));
}

/** Returns the change of a dragged number per pixel. */
export function dragStep(field: Bounds): number {
  // Arrow keys move by two such steps.
  if (field.whole) return 0.5;
  return Math.max(0.5, Math.hypot(...field.values)) / 400;
}

/** Returns true if the field is a colour. */
export function isColor({ name, values }: Pick<FieldState, "name" | "values">): boolean {
  return values.length === 3 && name.toLowerCase().includes("color");
}

/** Returns true if the page can edit the field, which is not the case for files and absent values. */
export function isEditable({ values, choices }: Pick<FieldState, "values" | "choices">): boolean {
  return values.length > 0 || choices.length > 0;
}
