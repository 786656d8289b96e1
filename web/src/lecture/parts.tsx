import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";

export { Choice } from "../ui/choice";
export { Switch } from "../ui/switch";

/** Layout of a figure: a drawing, its controls, and its equations. */
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

/** Equation in symbols, and with the current numbers of the figure. */
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

/** Symbol of an equation, in the colour that it has in the figure. */
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

/** Question with an answer that can be unfolded. */
export function Question({ ask, children }: { ask: ComponentChildren; children: ComponentChildren }) {
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
