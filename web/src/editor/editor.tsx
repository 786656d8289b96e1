import {
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  completionKeymap,
} from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab, toggleComment } from "@codemirror/commands";
import { bracketMatching, indentUnit } from "@codemirror/language";
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Compartment, EditorState } from "@codemirror/state";
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from "@codemirror/view";
import { useEffect, useRef } from "preact/hooks";
import { termAt } from "../explain/segments";
import type { Finding } from "../protocol";
import { type Store, useStore } from "../viewer/store";
import { completion, manual } from "./completion";
import { sceneHighlight, sceneLanguage } from "./language";
import { marks, setMark } from "./marks";
import { colorPicking, scrubbing } from "./numbers";
import { objectAt } from "./objects";
import { toOffsets } from "./offsets";

const severities = { error: "error", warning: "warning", note: "info" } as const;

/** Text editor for the scene. */
export function Editor({ store }: { store: Store }) {
  useStore(store);
  const place = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  const language = useRef(new Compartment());

  useEffect(() => {
    if (!place.current) return;
    const made = new EditorView({ parent: place.current, state: state(store, language.current) });
    view.current = made;
    return () => made.destroy();
  }, [store]);

  useEffect(() => {
    view.current?.dispatch({ effects: language.current.reconfigure(sceneLanguage(store.words)) });
  }, [store.words]);

  useEffect(() => {
    const editor = view.current;
    if (!editor || editor.state.doc.toString() === store.text) return;
    editor.dispatch({ changes: { from: 0, to: editor.state.doc.length, insert: store.text } });
  }, [store.textVersion]);

  useEffect(() => {
    const editor = view.current;
    if (!editor) return;
    const text = editor.state.doc.toString();
    if (text !== store.text) return;
    editor.dispatch(setDiagnostics(editor.state, diagnostics(store.findings, text)));
  }, [store.findings]);

  useEffect(() => {
    const editor = view.current;
    if (!editor || !store.jump) return;
    const at = toOffsets(editor.state.doc.toString());
    const anchor = at(store.jump.start);
    editor.dispatch({
      selection: { anchor },
      effects: EditorView.scrollIntoView(anchor, { y: "center" }),
    });
  }, [store.jump]);

  useEffect(() => {
    const editor = view.current;
    if (!editor) return;
    const found = store.hovered === null ? null : termAt(store.pixel, store.hovered)?.place;
    const at = toOffsets(editor.state.doc.toString());
    editor.dispatch({ effects: setMark.of(found ? at(found.start) : null) });
  }, [store.hovered, store.pixel]);

  return <div class="editor" ref={place} />;
}

function state(store: Store, language: Compartment): EditorState {
  const words = () => store.words;
  return EditorState.create({
    doc: store.text,
    extensions: [
      lineNumbers(),
      lintGutter(),
      history(),
      drawSelection(),
      highlightActiveLine(),
      highlightSelectionMatches(),
      bracketMatching(),
      EditorView.lineWrapping,
      closeBrackets(),
      indentUnit.of("    "),
      language.of(sceneLanguage(store.words)),
      sceneHighlight,
      scrubbing,
      colorPicking,
      marks,
      autocompletion({ override: [completion(words)] }),
      manual(words),
      keymap.of([
        { key: "Mod-s", run: () => save(store) },
        { key: "Mod-/", run: toggleComment },
        indentWithTab,
        ...closeBracketsKeymap,
        ...completionKeymap,
        ...lintKeymap,
        ...searchKeymap,
        ...historyKeymap,
        ...defaultKeymap,
      ]),
      EditorView.contentAttributes.of({ "aria-label": "The scene's text" }),
      EditorView.updateListener.of((update) => {
        if (update.docChanged) store.edit(update.state.doc.toString());
        if (update.selectionSet || update.focusChanged) markObject(store, update.view);
      }),
    ],
  });
}

/** Marks the object at the cursor, if the editor has the focus. */
function markObject(store: Store, view: EditorView) {
  const { doc, selection } = view.state;
  const objects = view.hasFocus ? (store.contents?.objects ?? []) : [];
  store.mark(objectAt(doc.toString(), objects, selection.main.head));
}

function save(store: Store): boolean {
  if (store.opened?.saves) store.save(false);
  return true;
}

/** Converts findings to the editor's diagnostics, each with its fix as an action. */
export function diagnostics(findings: Finding[], text: string): Diagnostic[] {
  const at = toOffsets(text);
  return findings
    .filter((finding) => finding.place !== null)
    .map((finding) => {
      const from = Math.min(at(finding.place?.start ?? 0), text.length);
      const to = Math.min(Math.max(at(finding.place?.end ?? 0), from), text.length);
      const message = [finding.message, finding.effect, finding.help].filter(Boolean).join("\n");
      const fix = finding.fix.length > 0 ? finding.fix : meant(finding);
      const apply = (view: EditorView) =>
        view.dispatch({
          changes: fix.map((edit) => ({ from: at(edit.start), to: at(edit.end), insert: edit.text })),
        });
      const actions = fix.length > 0 ? [{ name: fixName(fix), apply }] : [];
      return { from, to, severity: severities[finding.severity], message, source: finding.code, actions };
    });
}

/** Returns the edit that a `did you mean` suggests. */
function meant(finding: Finding): Finding["fix"] {
  const word = /did you mean `([^`]+)`/.exec(`${finding.help ?? ""} ${finding.message}`)?.[1];
  if (!word || !finding.place) return [];
  return [{ start: finding.place.start, end: finding.place.end, text: word }];
}

function fixName(fix: Finding["fix"]): string {
  const text = fix.length === 1 ? fix[0]?.text.trim() : "";
  if (fix.length === 1 && text === "") return "Remove";
  return text && text.length < 28 ? `Write ${text}` : "Fix";
}
