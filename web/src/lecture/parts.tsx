import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";

/** A figure: a drawing, its controls, and its equations. */
export function Figure({
  stage,
  controls,
  children,
}: {
  stage: ComponentChildren;
  controls?: ComponentChildren;
  children?: ComponentChildren;
}) {
  return (
    <figure class="figure">
      {stage}
      {controls && <div class="controls">{controls}</div>}
      {children && <figcaption class="equations">{children}</figcaption>}
    </figure>
  );
}

/** An equation in symbols and in the numbers of the figure. */
export function Equation({
  children,
  numbers,
}: {
  children: ComponentChildren;
  numbers?: ComponentChildren;
}) {
  return (
    <div class="equation">
      <div class="symbols">{children}</div>
      {numbers && <div class="numbers">{numbers}</div>}
    </div>
  );
}

/** A symbol, in the colour of its counterpart in the figure. */
export function Sym({
  children,
  color,
  vector = false,
}: {
  children: ComponentChildren;
  color?: string;
  vector?: boolean;
}) {
  return (
    <var class={vector ? "vector" : ""} style={color ? { color } : {}}>
      {children}
    </var>
  );
}

/** A switch, often for a common mistake. */
export function Switch({ label, on, change }: { label: string; on: boolean; change(on: boolean): void }) {
  return (
    <label class="switch">
      <input
        type="checkbox"
        role="switch"
        aria-checked={on}
        checked={on}
        onChange={(event) => change(event.currentTarget.checked)}
      />
      <span>{label}</span>
    </label>
  );
}

/** A group of buttons with one selected. */
export function Choice<T extends string>({
  label,
  value,
  values,
  change,
}: {
  label: string;
  value: T;
  values: readonly (readonly [T, string])[];
  change(value: T): void;
}) {
  return (
    <div class="choice" role="group" aria-label={label}>
      {values.map(([name, text]) => (
        <button
          key={name}
          type="button"
          class="button"
          aria-pressed={name === value}
          onClick={() => change(name)}
        >
          {text}
        </button>
      ))}
    </div>
  );
}

/** A question with an answer that can be unfolded. */
export function Question({ ask, children }: { ask: string; children: ComponentChildren }) {
  const [open, setOpen] = useState(false);
  return (
    <div class="question">
      <button type="button" aria-expanded={open} onClick={() => setOpen(!open)}>
        {ask}
      </button>
      {open && <div class="answer">{children}</div>}
    </div>
  );
}
