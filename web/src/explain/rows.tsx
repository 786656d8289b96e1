import type { FormulaRow } from "../protocol";

/** Table of formulas with their numbers. */
export function Rows({ rows }: { rows: FormulaRow[] }) {
  if (rows.length === 0) return null;
  return (
    <dl class="rows">
      {rows.map((row) => (
        <div key={row.name + row.formula}>
          <dt>{row.name}</dt>
          <dd>
            {row.formula && <span class="formula">{row.formula}</span>}
            {row.numbers && <span class="numbers">= {row.numbers}</span>}
            <span class="result">{row.formula || row.numbers ? `= ${row.result}` : row.result}</span>
          </dd>
        </div>
      ))}
    </dl>
  );
}
