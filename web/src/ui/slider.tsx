import { useId } from "preact/hooks";

interface Props {
  label: string;
  value: number;
  min: number;
  max: number;
  step?: number;
  /** Value as displayed. */
  text?: string;
  change(value: number): void;
  /** Called when the user has finished a change. */
  settle?(value: number): void;
}

/** Slider with its label and value. */
export function Slider({ label, value, min, max, step, text, change, settle }: Props) {
  const id = useId();
  return (
    <div class="slider">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="range"
        min={min}
        max={max}
        step={step ?? (max - min) / 400}
        value={value}
        onInput={(event) => change(event.currentTarget.valueAsNumber)}
        onChange={(event) => settle?.(event.currentTarget.valueAsNumber)}
      />
      <output for={id}>{text ?? short(value)}</output>
    </div>
  );
}

/** Formats a number with four significant digits and a true minus sign. */
export function short(x: number, digits = 4): string {
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "–" : x > 0 ? "∞" : "−∞";
  if (Math.abs(x) < 5e-6) return "0";
  const text = String(Number(x.toPrecision(digits)));
  return text.replace("-", "−");
}

/** Formats a number with a fixed number of decimals, for values that change continuously. */
export function fixed(x: number, decimals = 2): string {
  if (!Number.isFinite(x)) return short(x);
  const text = x.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}
