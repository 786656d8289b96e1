import { useId } from "preact/hooks";
import type { FieldState } from "../protocol";
import { DragNumber } from "../ui/dragged";
import { Slider } from "../ui/slider";
import { hex, linear } from "./color";
import { dragStep, fitted, hasSlider, isColor, isEditable, rangeOf } from "./field-range";

/** Value of a field as in requests: numbers, or a word. */
export interface FieldValue {
  values: number[];
  word: string | null;
}

interface FieldsProps {
  fields: FieldState[];
  /** Sets the value of a field. `moving` is true while the user drags. */
  set(field: FieldState, value: FieldValue, moving: boolean): void;
}

/** Controls for the fields of a camera or a material. */
export function Fields({ fields, set }: FieldsProps) {
  return (
    <>
      {fields.filter(isEditable).map((field) => (
        <Field
          key={field.name}
          field={field}
          numbers={(values, moving) => set(field, { values, word: null }, moving)}
          choose={(word) => set(field, { values: [], word }, false)}
        />
      ))}
    </>
  );
}

interface FieldProps {
  field: FieldState;
  numbers(values: number[], moving: boolean): void;
  choose(word: string): void;
}

function Field({ field, numbers, choose }: FieldProps) {
  const { name, doc, values } = field;
  const id = useId();
  const [only] = values;
  const { min, max, step } = rangeOf(field);
  if (field.choices.length > 0) return <WordField field={field} choose={choose} />;
  if (isColor(field)) {
    return (
      <div class="field" title={doc}>
        <label for={id}>{name}</label>
        <input
          id={id}
          type="color"
          value={hex(values)}
          onInput={(event) => numbers(linear(event.currentTarget.value), true)}
          onChange={(event) => numbers(linear(event.currentTarget.value), false)}
        />
      </div>
    );
  }
  if (hasSlider(field) && only !== undefined) {
    return (
      <div title={doc}>
        <Slider
          label={name}
          value={only}
          min={min}
          max={max}
          step={step}
          change={(x) => numbers([x], true)}
          settle={(x) => numbers([x], false)}
        />
      </div>
    );
  }
  return (
    <div class="field" title={doc}>
      <span class="label">{name}</span>
      <span class="vector">
        {values.map((value, i) => (
          <DragNumber
            key={i}
            label={values.length > 1 ? `${name} ${"xyz"[i] ?? ""}` : name}
            value={value}
            decimals={field.whole ? 0 : 3}
            step={dragStep(field)}
            min={min}
            max={max}
            change={(x, moving) => numbers(values.with(i, fitted(field, x)), moving)}
          />
        ))}
      </span>
    </div>
  );
}

function WordField({ field, choose }: { field: FieldState; choose(word: string): void }) {
  const id = useId();
  const { name, doc, text, choices } = field;
  return (
    <div class="field" title={doc}>
      <label for={id}>{name}</label>
      <select id={id} value={text} onChange={(event) => choose(event.currentTarget.value)}>
        {!choices.includes(text) && (
          <option value={text} disabled>
            {text || "not set"}
          </option>
        )}
        {choices.map((word) => (
          <option key={word}>{word}</option>
        ))}
      </select>
    </div>
  );
}
