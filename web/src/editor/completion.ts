import type { Completion, CompletionContext, CompletionResult } from "@codemirror/autocomplete";
import { hoverTooltip } from "@codemirror/view";
import type { Keyword } from "../protocol";

/** Keyword of the block that contains a position; `null` outside of all blocks. */
export function blockAt(text: string, position: number): string | null {
  let depth = 0;
  for (let i = position - 1; i >= 0; i--) {
    if (text[i] === "}") depth++;
    else if (text[i] === "{" && depth-- === 0) {
      return /([A-Za-z_]\w*)\s*$/.exec(text.slice(Math.max(0, i - 60), i))?.[1] ?? null;
    }
  }
  return null;
}

/** Completes the fields of the block at the cursor, and keywords that begin a statement. */
export function completion(words: () => Keyword[]) {
  return (context: CompletionContext): CompletionResult | null => {
    const before = context.matchBefore(/[A-Za-z_]\w*/);
    if (!before && !context.explicit) return null;
    const block = blockAt(context.state.doc.toString(), context.pos);
    const within = words().find((word) => word.word === block);
    const fields: Completion[] = (within?.fields ?? []).map((field) => ({
      label: field.word,
      type: "property",
      detail: field.value,
      info: field.doc,
      boost: 2,
    }));
    const begins: Completion[] = words().map((word) => ({
      label: word.word,
      type: "keyword",
      detail: word.chapter,
      info: word.doc,
      apply: word.fields.length > 0 ? word.example.trim() : word.word,
    }));
    return { from: before?.from ?? context.pos, options: [...fields, ...begins], validFor: /^\w*$/ };
  };
}

/** Shows the manual's entry for the keyword under the pointer. */
export function manual(words: () => Keyword[]) {
  return hoverTooltip((view, position) => {
    const at = view.state.wordAt(position);
    if (!at) return null;
    const text = view.state.sliceDoc(at.from, at.to);
    const block = blockAt(view.state.doc.toString(), at.from);
    const field = words()
      .find((word) => word.word === block)
      ?.fields.find((known) => known.word === text);
    const word = field ? null : words().find((known) => known.word === text);
    if (!field && !word) return null;
    return { pos: at.from, end: at.to, above: true, create: () => ({ dom: entry(text, field, word) }) };
  });
}

function entry(text: string, field: Keyword["fields"][number] | undefined, word: Keyword | null | undefined) {
  const dom = document.createElement("div");
  dom.className = "manual";
  const head = document.createElement("strong");
  head.textContent = text;
  const kind = document.createElement("span");
  kind.textContent = field
    ? ` ${field.value}${field.default ? ` · default ${field.default}` : ""}`
    : ` ${word?.chapter}`;
  const doc = document.createElement("p");
  doc.textContent = field?.doc ?? word?.doc ?? "";
  dom.append(head, kind, doc);
  return dom;
}
