import { code } from "./steps";

/** Pseudocode of the algorithm, with the current line highlighted. */
export function Code({ line }: { line: number }) {
  return (
    <ol class="code">
      {code.map((words, i) => (
        <li key={words} class={i === line ? "now" : ""} aria-current={i === line ? "step" : undefined}>
          {words}
        </li>
      ))}
    </ol>
  );
}

/** Controls of the step-by-step view: back, next, play, and a slider over all steps. */
export function Player({
  at,
  count,
  plays,
  go,
  play,
  unit,
}: {
  at: number;
  count: number;
  plays: boolean;
  go(to: number): void;
  play(on: boolean): void;
  unit: string;
}) {
  return (
    <div class="row">
      <button type="button" class="button" onClick={() => go(at - 1)} disabled={at === 0}>
        Back
      </button>
      <button type="button" class="button strong" onClick={() => go(at + 1)} disabled={at >= count - 1}>
        Next
      </button>
      <button type="button" class="button" aria-pressed={plays} onClick={() => play(!plays)}>
        {plays ? "Pause" : "Play"}
      </button>
      <input
        type="range"
        aria-label={unit}
        min={0}
        max={Math.max(0, count - 1)}
        step={1}
        value={at}
        onInput={(event) => go(event.currentTarget.valueAsNumber)}
      />
      <span class="count">
        {at + 1} of {count}
      </span>
    </div>
  );
}
