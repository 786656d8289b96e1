import { useRef, useState } from "preact/hooks";
import { Class } from "./class";
import { digits, verdictCounts } from "./data";
import { Pair } from "./pair";
import { Quoted } from "./quoted";
import { Shell } from "./shell";
import type { CompareReport, PairReport } from "./types";

/** Report of `durer compare`: for a class its matrix, then the selected pair, then all pairs. */
export function Compare({ report }: { report: CompareReport }) {
  const { pairs, students } = report;
  const [chosen, setChosen] = useState(() => first(pairs));
  const view = useRef<HTMLElement>(null);
  const title = `${report.picture} compared with ${report.reference}`;
  const pick = (index: number) => {
    setChosen(index);
    view.current?.scrollIntoView({ block: "start" });
  };
  const pair = chosen === null ? undefined : pairs[chosen];
  return (
    <Shell command="compare" title={title}>
      <main class="sheet">
        <header>
          <h1>{title}</h1>
          <p class="lead">
            {verdictCounts(pairs)} (tolerance {tolerance(report.tolerance)}, allowed in {report.allow} % of
            the pixels)
            {report.extra.length > 0 && `; without a reference: ${report.extra.join(", ")}`}
          </p>
        </header>
        {students.length > 0 && <Class report={report} pick={pick} />}
        {pair && (
          <section class="pair" ref={view} aria-label="Selected pair">
            <Pair key={pair.title} pair={pair} />
          </section>
        )}
        {pairs.length > 1 && <Pairs pairs={pairs} chosen={chosen} pick={pick} />}
        {pairs.length === 1 && pairs[0]?.error && <p class="notice">{pairs[0].error}</p>}
      </main>
    </Shell>
  );
}

/** Returns the first pair that differs, or else the first that can be shown. */
function first(pairs: PairReport[]): number | null {
  const differs = pairs.findIndex((pair) => pair.comparison && pair.verdict === "different");
  const any = pairs.findIndex((pair) => pair.comparison);
  if (differs >= 0) return differs;
  return any >= 0 ? any : null;
}

/** Formats a tolerance; a multiple of 1/255 as such. */
function tolerance(value: number): string {
  const steps = value * 255;
  return Math.abs(steps - Math.round(steps)) < 1e-3 ? `${Math.round(steps)}/255` : value.toPrecision(4);
}

function Pairs({
  pairs,
  chosen,
  pick,
}: {
  pairs: PairReport[];
  chosen: number | null;
  pick(index: number): void;
}) {
  return (
    <section aria-label="All pictures">
      <h2>All pictures</h2>
      <div class="wide" tabIndex={0} role="region" aria-label="Table of all pictures">
        <table class="numbers pairs">
          <thead>
            <tr>
              {["picture", "verdict", "differ %", "RMSE", "PSNR", "SSIM", "FLIP", "why"].map((name) => (
                <th key={name} scope="col">
                  {name}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {pairs.map((pair, index) => (
              <Row key={pair.title} pair={pair} on={index === chosen} pick={() => pick(index)} />
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function Row({ pair, on, pick }: { pair: PairReport; on: boolean; pick(): void }) {
  const shown = pair.comparison;
  const share = shown && (100 * shown.over_tolerance) / (shown.width * shown.height);
  return (
    <tr class={on ? "on" : ""}>
      <th scope="row">
        {shown ? (
          <button type="button" class="link" aria-pressed={on} onClick={pick}>
            {pair.title}
          </button>
        ) : (
          pair.title
        )}
      </th>
      <td class={`verdict ${pair.verdict}`}>{pair.verdict}</td>
      <td>{digits(share, 3)}</td>
      <td>{digits(shown?.rmse, 5)}</td>
      <td>{shown && shown.psnr === null ? "∞" : digits(shown?.psnr, 2)}</td>
      <td>{digits(shown?.ssim, 4)}</td>
      <td>{digits(shown && (shown.hdr_flip ?? shown.flip), 4)}</td>
      <td class="text">
        <Quoted sentence={pair.error ?? pair.causes[0] ?? ""} />
      </td>
    </tr>
  );
}
