import { type Store, useStore } from "../viewer/store";

const words = { error: "Error", warning: "Warning", note: "Note" } as const;

/** List of the scene's errors, warnings and notes. A click shows the position in the text. */
export function Findings({ store }: { store: Store }) {
  useStore(store);
  if (store.findings.length === 0) return null;
  return (
    <ul class="findings" aria-label="Findings">
      {store.findings.map((finding, i) => (
        <li key={i}>
          <button type="button" onClick={() => store.goTo(finding.place)}>
            <span class={`severity ${finding.severity}`}>{words[finding.severity]}</span>
            <span>
              {finding.file ? `${finding.file}: ` : finding.place ? `Line ${finding.place.line}: ` : ""}
              {finding.message}
              {finding.help ? ` (${finding.help})` : ""}
            </span>
          </button>
        </li>
      ))}
    </ul>
  );
}
