import { useEffect, useState } from "preact/hooks";
import { digits } from "./data";
import { Quoted } from "./quoted";
import { Stage } from "./stage";
import type { ComparisonReport, PairReport, RegionReport } from "./types";

/** A pair of pictures: why they differ, the pictures, their metrics and the regions that differ. */
export function Pair({ pair }: { pair: PairReport }) {
  const [region, setRegion] = useState<RegionReport | null>(null);
  const shown = pair.comparison;
  if (!shown) return null;
  return (
    <>
      <header class="finding">
        <h2>
          {pair.title} <span class={`verdict ${pair.verdict}`}>{pair.verdict}</span>
        </h2>
        <Causes lines={pair.causes} />
        {pair.note && <p class="soft">{pair.note}</p>}
      </header>
      <div class="columns">
        <Stage shown={shown} region={region} />
        <div class="facts">
          <Metrics shown={shown} />
          {shown.regions.length > 0 && <Regions regions={shown.regions} marked={region} mark={setRegion} />}
        </div>
      </div>
    </>
  );
}

/** Lines that explain a difference; indented lines with code follow their cause. */
function Causes({ lines }: { lines: string[] }) {
  return (
    <div class="causes">
      {lines.map((line, i) => {
        const code = /^ {2}(should be|may be):\s+(.*)$/s.exec(line);
        if (!code)
          return (
            <p key={i}>
              <Quoted sentence={line.trim()} />
            </p>
          );
        return (
          <div key={i} class={`code-line ${code[1] === "may be" ? "wrong" : "right"}`}>
            <span>{code[1]}</span>
            <code>{code[2]}</code>
          </div>
        );
      })}
    </div>
  );
}

function Metrics({ shown }: { shown: ComparisonReport }) {
  const { width, height, largest, not_finite: odd } = shown;
  const share = (100 * shown.over_tolerance) / (width * height);
  const rows: [string, string][] = [
    ["size", `${width} × ${height}, ${shown.linear ? "linear light" : "display values"}`],
    ["pixels over the tolerance", `${shown.over_tolerance} (${digits(share, 3)} %)`],
    ["RMSE", digits(shown.rmse, 6)],
    ["PSNR", shown.psnr === null ? "infinite" : `${digits(shown.psnr, 2)} dB`],
    ["SSIM", digits(shown.ssim, 5)],
    ["FLIP", digits(shown.flip, 5)],
  ];
  if (shown.hdr_flip !== null) rows.push(["HDR-FLIP", digits(shown.hdr_flip, 5)]);
  if (largest) {
    const color = (values: number[]) => values.map((value) => digits(value, 3)).join(" ");
    rows.push(["largest difference", `${digits(largest.difference, 4)} at ${largest.x},${largest.y}`]);
    rows.push(["values there", `reference ${color(largest.reference)}, picture ${color(largest.picture)}`]);
  }
  if (odd[0] + odd[1] > 0)
    rows.push(["not finite", `${odd[0]} pixels of the reference, ${odd[1]} of the picture`]);
  return (
    <dl class="metrics">
      {rows.map(([name, value]) => (
        <div key={name}>
          <dt>{name}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

/** Regions that differ, each with what the scene shows there. */
function Regions({
  regions,
  marked,
  mark,
}: {
  regions: RegionReport[];
  marked: RegionReport | null;
  mark(region: RegionReport | null): void;
}) {
  useEffect(() => () => mark(null), [regions]);
  return (
    <section class="regions" aria-label="Regions that differ">
      <h3>Regions that differ</h3>
      <ol>
        {regions.map((region, i) => (
          <li key={i}>
            <span class="number">{i + 1}</span>
            <button
              type="button"
              class="place"
              aria-pressed={marked === region}
              onClick={() => mark(marked === region ? null : region)}
            >
              {region.text}
            </button>
            {region.there && (
              <details>
                <summary>{region.there.hit}</summary>
                <pre tabIndex={0}>{[region.there.command, "", ...region.there.explanation].join("\n")}</pre>
              </details>
            )}
          </li>
        ))}
      </ol>
    </section>
  );
}
