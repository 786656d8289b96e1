import type { PairReport, Report } from "./types";

const kinds = ["explain", "compare", "lesson", "tour"];

/** Parses the data of a report. Throws an error if it is not a report. */
export function readReport(text: string): Report {
  const report = JSON.parse(text) as Report;
  if (report === null || typeof report !== "object" || !kinds.includes(report.kind))
    throw new Error("the file contains no report");
  return report;
}

/** Students whose picture has the same mistake. */
export interface MistakeGroup {
  /** Name of the picture. */
  name: string;
  mistake: string;
  students: string[];
}

/** Returns the mistakes that several students made in a picture, most frequent first. */
export function groups(pairs: PairReport[]): MistakeGroup[] {
  const all = new Map<string, MistakeGroup>();
  for (const { name, mistake, student } of pairs) {
    if (mistake === null || student === null) continue;
    const key = JSON.stringify([name, mistake]);
    const group = all.get(key) ?? { name, mistake, students: [] };
    group.students.push(student);
    all.set(key, group);
  }
  const several = [...all.values()].filter(({ students }) => students.length > 1);
  return several.sort((a, b) => b.students.length - a.students.length);
}

/** Returns how often each verdict occurs, such as `3 same, 1 different`. */
export function verdictCounts(pairs: PairReport[]): string {
  const counts = new Map<string, number>();
  for (const { verdict } of pairs) counts.set(verdict, (counts.get(verdict) ?? 0) + 1);
  return [...counts].map(([verdict, count]) => `${count} ${verdict}`).join(", ");
}

/** Formats a number with a fixed number of digits; a missing one as a dash. */
export function digits(value: number | null | undefined, count: number): string {
  return value === null || value === undefined ? "–" : value.toFixed(count);
}

/** Part of an equation: text, or a subscript or superscript, as in `k_d` and `x^s`. */
export interface EquationPart {
  kind: "text" | "sub" | "sup";
  text: string;
}

/** Splits an equation into text, subscripts and superscripts. */
export function equationParts(equation: string): EquationPart[] {
  return equation
    .split(/([_^]\w+)/)
    .filter((part) => part !== "")
    .map((part) => {
      if (/^[_^]\w/.test(part)) return { kind: part[0] === "_" ? "sub" : "sup", text: part.slice(1) };
      return { kind: "text", text: part };
    });
}
