import { StateEffect, StateField } from "@codemirror/state";
import { Decoration, type DecorationSet, EditorView } from "@codemirror/view";

/** Effect that marks the line of the term below the pointer; `null` removes the mark. */
export const setMark = StateEffect.define<number | null>();

const look = Decoration.line({ class: "cm-marked" });

/** Marks the line that a hovered term comes from. */
export const marks = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(set, { changes, effects, state }) {
    for (const effect of effects) {
      if (!effect.is(setMark)) continue;
      if (effect.value === null) return Decoration.none;
      return Decoration.set([look.range(state.doc.lineAt(effect.value).from)]);
    }
    return set.map(changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});
