import type { ComponentChildren } from "preact";
import { useState } from "preact/hooks";
import { Switch } from "../ui/switch";

export { Choice } from "../ui/choice";
export { Switch };

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

/** Switch that makes the usual mistake of a topic. */
export function Mistake({ name, on, change }: { name: string; on: boolean; change(on: boolean): void }) {
  return <Switch label={`Common mistake: ${name}`} on={on} change={change} />;
}

/** Result of the usual mistake, below the correct one. */
export function Wrong({ children }: { children: ComponentChildren }) {
  return <div class="wrong">{children}</div>;
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
