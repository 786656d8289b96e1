/** Row of buttons, exactly one of which is selected. */
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
