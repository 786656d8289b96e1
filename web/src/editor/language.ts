import { HighlightStyle, StreamLanguage, syntaxHighlighting } from "@codemirror/language";
import { tags } from "@lezer/highlight";
import type { Keyword } from "../protocol";

/** State of the tokenizer: the nesting depth of braces. */
interface State {
  depth: number;
}

/** Syntax highlighting of the scene language, with the keywords that the library lists. */
export function sceneLanguage(words: Keyword[]) {
  const begins = new Set(words.map((word) => word.word));
  const fields = new Set(words.flatMap((word) => word.fields.map((field) => field.word)));
  return StreamLanguage.define<State>({
    name: "durer",
    startState: () => ({ depth: 0 }),
    token(stream, state) {
      if (stream.eatSpace()) return null;
      if (stream.match(/^#.*/)) return "comment";
      if (stream.match(/^[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?(?![\w.])/)) return "number";
      if (stream.match(/^"[^"]*"/)) return "string";
      const word = stream.match(/^[A-Za-z_][\w]*/);
      if (word) {
        const text = stream.current();
        if (begins.has(text)) return "keyword";
        if (fields.has(text)) return "propertyName";
        return "variableName";
      }
      const letter = stream.next();
      if (letter === "{") state.depth++;
      if (letter === "}") state.depth--;
      if (letter === "{" || letter === "}") return "bracket";
      return null;
    },
    indent: (state, after, context) =>
      Math.max(0, state.depth - (after.startsWith("}") ? 1 : 0)) * context.unit,
    languageData: { commentTokens: { line: "#" }, closeBrackets: { brackets: ["{"] } },
  });
}

/** Highlight colours, from the page's design tokens. */
export const sceneHighlight = syntaxHighlighting(
  HighlightStyle.define([
    { tag: tags.keyword, color: "var(--accent)", fontWeight: "600" },
    { tag: tags.propertyName, color: "var(--ray-transmitted)" },
    { tag: tags.number, color: "var(--ink)", class: "cm-number" },
    { tag: tags.comment, color: "var(--soft)", fontStyle: "italic" },
    { tag: tags.string, color: "var(--ray-reflected)" },
    { tag: tags.bracket, color: "var(--soft)" },
  ]),
);
