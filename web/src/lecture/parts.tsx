import { type ComponentChildren, createContext } from "preact";
import { useContext, useState } from "preact/hooks";
import { Switch } from "../ui/switch";

export { Choice } from "../ui/choice";
export { Switch };

/** True once the engine has answered the questions of the figure. */
const Ready = createContext(true);

/**
 * Layout of a figure: a drawing, its controls, and its equations. The equations have no numbers until the figure is
 * `ready`, because numbers without an answer would be wrong.
 */
export function Figure({
  stage,
  controls,
  children,
  ready = true,
}: {
  stage: ComponentChildren;
  controls?: ComponentChildren;
  children?: ComponentChildren;
  ready?: boolean;
}) {
  return (
    <figure class="figure">
      {stage}
      {controls && <div class="controls">{controls}</div>}
      {children && (
        <Ready.Provider value={ready}>
          <figcaption class="equations">{children}</figcaption>
        </Ready.Provider>
      )}
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
  const ready = useContext(Ready);
  return (
    <div class="equation">
      <div class="symbols">{children}</div>
      {ready && numbers && <div class="numbers">{numbers}</div>}
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
