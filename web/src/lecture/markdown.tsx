import type { ComponentChild } from "preact";

/** Block of a lesson's Markdown: a heading, paragraph, list, code, figure or question. */
export type Block =
  | { kind: "heading"; level: number; text: string }
  | { kind: "paragraph"; text: string }
  | { kind: "list"; ordered: boolean; items: string[] }
  | { kind: "code"; text: string }
  | { kind: "figure"; label: string; source: string; options: string }
  | { kind: "question"; ask: string; answer: string };

const figure = /^!\[([^\]]*)\]\(\s*(\S+?)\s*(?:"([^"]*)")?\s*\)$/;

/** Parses the Markdown of a lesson into blocks. */
export function blocks(text: string): Block[] {
  const all: Block[] = [];
  const lines = text.replaceAll("\r\n", "\n").split("\n");
  let at = 0;
  const run = (test: (line: string) => boolean): string[] => {
    const from = at;
    while (at < lines.length && test(lines[at] ?? "")) at++;
    return lines.slice(from, at);
  };
  while (at < lines.length) {
    const line = (lines[at] ?? "").trim();
    const heading = /^(#{1,6})\s+(.*?)\s*#*$/.exec(line);
    const shown = figure.exec(line);
    if (line === "" || line.startsWith("<!--")) {
      at++;
    } else if (line.startsWith("```")) {
      at++;
      all.push({ kind: "code", text: run((inner) => !inner.trim().startsWith("```")).join("\n") });
      at++;
    } else if (heading) {
      at++;
      all.push({ kind: "heading", level: heading[1]?.length ?? 1, text: heading[2] ?? "" });
    } else if (shown) {
      at++;
      all.push({ kind: "figure", label: shown[1] ?? "", source: shown[2] ?? "", options: shown[3] ?? "" });
    } else if (/^\?\s/.test(line)) {
      at++;
      const answer = run((inner) => /^\s*:\s|^\s{2,}\S/.test(inner)).map((inner) =>
        inner.replace(/^\s*:?\s+/, ""),
      );
      all.push({ kind: "question", ask: line.slice(1).trim(), answer: answer.join(" ") });
    } else if (/^([-*]|\d+\.)\s/.test(line)) {
      const ordered = /^\d/.test(line);
      const items: string[] = [];
      for (const inner of run((next) => /^\s*([-*]|\d+\.)\s|^\s{2,}\S/.test(next))) {
        const item = /^\s*(?:[-*]|\d+\.)\s+(.*)$/.exec(inner);
        if (item) items.push(item[1] ?? "");
        else items[items.length - 1] += ` ${inner.trim()}`;
      }
      all.push({ kind: "list", ordered, items });
    } else {
      const words = run(
        (inner) => inner.trim() !== "" && !/^(#{1,6}\s|```|!\[|\?\s|([-*]|\d+\.)\s)/.test(inner.trim()),
      );
      // A line that begins like another kind of block but is invalid is text.
      if (words.length === 0) words.push(lines[at++] ?? "");
      all.push({ kind: "paragraph", text: words.map((inner) => inner.trim()).join(" ") });
    }
  }
  return all;
}

const inline = /\*\*(.+?)\*\*|\*(.+?)\*|`([^`]+)`|\[([^\]]+)\]\((https?:\/\/[^)\s]+|#[^)\s]*)\)/;

/** Converts the inline Markdown of a line: strong, emphasised, code, and links. */
export function words(text: string): ComponentChild[] {
  const all: ComponentChild[] = [];
  let rest = text;
  for (let found = inline.exec(rest); found; found = inline.exec(rest)) {
    const [whole, strong, soft, code, link, address = ""] = found;
    if (found.index > 0) all.push(rest.slice(0, found.index));
    if (strong) all.push(<strong>{words(strong)}</strong>);
    else if (soft) all.push(<em>{words(soft)}</em>);
    else if (code) all.push(<code>{code}</code>);
    else all.push(<a href={address}>{link}</a>);
    rest = rest.slice(found.index + whole.length);
  }
  if (rest) all.push(rest);
  return all;
}
