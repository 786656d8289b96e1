import { groups } from "./data";
import type { CompareReport, PairReport } from "./types";

/** Results of a class: mistakes that several students made, a matrix of students and pictures, and
 * counts.
 */
export function Class({ report, pick }: { report: CompareReport; pick(index: number): void }) {
  const { pairs, students } = report;
  const names = [...new Set(pairs.map((pair) => pair.name))];
  const same = groups(pairs);
  return (
    <>
      {same.length > 0 && (
        <section aria-label="The same mistake">
          <h2>The same mistake</h2>
          <ul class="groups">
            {same.map(({ name, mistake, students: who }) => (
              <li key={name + mistake}>
                <strong>{mistake}</strong>
                <span>
                  {name}: {who.join(", ")}
                </span>
              </li>
            ))}
          </ul>
        </section>
      )}
      <section aria-label="Students and pictures">
        <div class="heading">
          <h2>Students and pictures</h2>
          <button type="button" class="button" onClick={() => save("class.csv", report.csv)}>
            Save as CSV
          </button>
        </div>
        <div class="wide" tabIndex={0} role="region" aria-label="Matrix of students and pictures">
          <table class="matrix">
            <thead>
              <tr>
                <th scope="col">student</th>
                {names.map((name) => (
                  <th key={name} scope="col">
                    {name}
                  </th>
                ))}
                {["same", "different", "missing", "error"].map((name) => (
                  <th key={name} scope="col" class="count">
                    {name}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {students.map((student) => (
                <tr key={student.name}>
                  <th scope="row">{student.name}</th>
                  {names.map((name) => (
                    <td key={name}>
                      <Cell pairs={pairs} student={student.name} name={name} pick={pick} />
                    </td>
                  ))}
                  {[student.same, student.different, student.missing, student.error].map((count, i) => (
                    <td key={i} class="count">
                      {count}
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </section>
    </>
  );
}

/** A student's picture with its verdict or mistake. */
function Cell({
  pairs,
  student,
  name,
  pick,
}: {
  pairs: PairReport[];
  student: string;
  name: string;
  pick(index: number): void;
}) {
  const index = pairs.findIndex((pair) => pair.student === student && pair.name === name);
  const pair = pairs[index];
  if (!pair) return null;
  const words = <span class={`verdict ${pair.verdict}`}>{pair.mistake ?? pair.verdict}</span>;
  if (!pair.comparison) return <div class="cell">{words}</div>;
  return (
    <button type="button" class="cell" onClick={() => pick(index)}>
      <img src={pair.comparison.pictures.picture} alt={`${student}, ${name}`} />
      {words}
    </button>
  );
}

/** Offers a text as a file to save. */
function save(name: string, text: string) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}
