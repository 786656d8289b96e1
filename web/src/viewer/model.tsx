import { useEffect, useRef, useState } from "preact/hooks";
import type { FieldState, MaterialState, SceneNode } from "../protocol";
import { hex } from "./color";
import { Fields, type FieldValue } from "./field";
import { pathsTo } from "./nodes";
import { download } from "./settings";
import { type Store, useStore } from "./store";
import { zip } from "./zip";

/** Shows a model, which has no text, as a tree of its objects, and its materials with their fields. */
export function Model({ store }: { store: Store }) {
  useStore(store);
  const { contents, tree } = store;
  const [open, setOpen] = useState<number | null>(null);
  if (!contents) return null;
  return (
    <div class="scrolls settings model">
      <h3>
        {contents.object_count} objects, {contents.triangles.toLocaleString("en")} triangles
      </h3>
      <div class="row">
        <button type="button" class="button strong" onClick={() => store.session.send({ kind: "as_text" })}>
          Edit as text
        </button>
        <button type="button" class="button" onClick={() => pack(store)}>
          Save as scene
        </button>
      </div>
      <Tree store={store} choose={setOpen} />
      <h3>{tree?.materials.length ?? 0} materials</h3>
      <ul class="materials" aria-label="Materials">
        {tree?.materials.map((material, number) => (
          <li key={number}>
            <button
              type="button"
              class="button plain"
              aria-expanded={open === number}
              onClick={() => setOpen(open === number ? null : number)}
            >
              <span class="chip" style={{ background: swatch(material) }} />
              {number}: {material.name}
            </button>
            {open === number && <MaterialFields store={store} number={number} fields={material.fields} />}
          </li>
        ))}
      </ul>
    </div>
  );
}

/**
 * Tree of the objects. A click on an object outlines it in the picture, and a click on a pixel shows
 * its object in the tree.
 */
function Tree({ store, choose }: { store: Store; choose(material: number): void }) {
  const [open, setOpen] = useState<ReadonlySet<string>>(new Set());
  const list = useRef<HTMLUListElement>(null);
  /** True until the revealed object is visible. */
  const hidden = useRef(false);
  const { tree, revealed } = store;
  const nodes = tree?.nodes ?? [];

  useEffect(() => {
    if (!revealed) return;
    hidden.current = true;
    setOpen((old) => new Set([...old, ...pathsTo(nodes, revealed.object).slice(0, -1)]));
  }, [revealed]);
  // The object is in the list only after its parents have been opened.
  useEffect(() => {
    const found = hidden.current && list.current?.querySelector("[aria-current]");
    if (!found) return;
    found.scrollIntoView({ block: "nearest" });
    hidden.current = false;
  }, [revealed, open]);

  const toggle = (path: string) => {
    const next = new Set(open);
    if (!next.delete(path)) next.add(path);
    setOpen(next);
  };
  return (
    <ul class="things" aria-label="Objects" ref={list}>
      {nodes.map((node, i) => (
        <Node key={i} node={node} path={String(i)} {...{ store, open, toggle, choose }} />
      ))}
    </ul>
  );
}

interface NodeProps {
  store: Store;
  node: SceneNode;
  path: string;
  /** Paths of the nodes whose children are visible. */
  open: ReadonlySet<string>;
  toggle(path: string): void;
  choose(material: number): void;
}

function Node({ node, path, ...rest }: NodeProps) {
  const { store, open, toggle, choose } = rest;
  const { name, object, material, nodes } = node;
  const inner = nodes.length > 0;
  const isOpen = inner && open.has(path);
  return (
    <li>
      <button
        type="button"
        class="button plain"
        aria-expanded={inner ? isOpen : undefined}
        aria-current={object !== null && object === store.revealed?.object ? true : undefined}
        onClick={() => {
          if (inner) return toggle(path);
          if (material !== null) choose(material);
          const isMarked = object === store.marked;
          store.reveal(object);
          store.mark(isMarked ? null : object);
        }}
      >
        {inner ? (isOpen ? "▾" : "▸") : "·"} {name}
        {material !== null && !inner && <span class="soft"> material {material}</span>}
      </button>
      {isOpen && (
        <ul class="things">
          {nodes.map((below, i) => (
            <Node key={i} node={below} path={`${path}.${i}`} {...rest} />
          ))}
        </ul>
      )}
    </li>
  );
}

function MaterialFields({ store, number, fields }: { store: Store; number: number; fields: FieldState[] }) {
  const set = (field: FieldState, value: FieldValue) => {
    // At the end of a motion, the same value comes again.
    if (value.values.join() === field.values.join() && (value.word ?? field.text) === field.text) return;
    store.session.send({ kind: "material", number, name: field.name, ...value });
  };
  return (
    <div class="fields">
      <Fields fields={fields} set={set} />
    </div>
  );
}

function swatch({ fields }: MaterialState): string {
  const color = fields.find((field) => /^(diffuse|base).*color$/i.test(field.name));
  return color?.values.length === 3 ? hex(color.values) : "var(--solid)";
}

/** Saves the model as a scene in the scene language with its files, in one ZIP archive. */
async function pack(store: Store) {
  try {
    const [{ names, sizes }, bytes] = await store.session.askBytes({ kind: "pack" }, "packed");
    let at = 0;
    const files = names.map((name, i) => {
      const from = at;
      at += sizes[i] ?? 0;
      return { name, bytes: bytes.subarray(from, at) };
    });
    download(`${names[0]?.replace(/\.[^.]*$/, "") ?? "scene"}.zip`, zip(files));
  } catch (error) {
    store.error = String(error);
    store.changed();
  }
}
