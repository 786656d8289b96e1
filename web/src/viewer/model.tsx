import { useState } from "preact/hooks";
import type { FieldState, MaterialState, SceneNode } from "../protocol";
import { DragNumber } from "../ui/dragged";
import { Slider } from "../ui/slider";
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
      <ul class="things" aria-label="Objects">
        {tree?.nodes.map((node, i) => (
          <Node key={i} node={node} choose={setOpen} />
        ))}
      </ul>
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
            {open === number && <Fields store={store} number={number} material={material} />}
          </li>
        ))}
      </ul>
    </div>
  );
}

function Node({ node, choose }: { node: SceneNode; choose(material: number): void }) {
  const [open, setOpen] = useState(false);
  const inner = node.nodes.length > 0;
  return (
    <li>
      <button
        type="button"
        class="button plain"
        aria-expanded={inner ? open : undefined}
        onClick={() => {
          if (inner) setOpen(!open);
          else if (node.material !== null) choose(node.material);
        }}
      >
        {inner ? (open ? "▾" : "▸") : "·"} {node.name}
        {node.material !== null && !inner && <span class="soft"> material {node.material}</span>}
      </button>
      {open && (
        <ul class="things">
          {node.nodes.map((below, i) => (
            <Node key={i} node={below} choose={choose} />
          ))}
        </ul>
      )}
    </li>
  );
}

function Fields({ store, number, material }: { store: Store; number: number; material: MaterialState }) {
  const set = (field: FieldState, values: number[]) =>
    store.session.send({ kind: "material", number, name: field.name, values });
  return (
    <div class="fields">
      {material.fields
        .filter((field) => field.values.length > 0)
        .map((field) => (
          <MaterialField key={field.name} field={field} set={(values) => set(field, values)} />
        ))}
    </div>
  );
}

function MaterialField({ field, set }: { field: FieldState; set(values: number[]): void }) {
  const { name, values, doc, least, most } = field;
  const [only] = values;
  if (values.length === 3 && name.toLowerCase().includes("color")) {
    return (
      <div class="field" title={doc}>
        <span class="label">{name}</span>
        <input
          type="color"
          aria-label={name}
          value={hex(values)}
          onInput={(event) => set(linear(event.currentTarget.value))}
        />
      </div>
    );
  }
  if (values.length === 1 && only !== undefined && least !== null && most !== null) {
    return (
      <div title={doc}>
        <Slider label={name} value={only} min={least} max={most} change={(x) => set([x])} />
      </div>
    );
  }
  return (
    <div class="field" title={doc}>
      <span class="label">{name}</span>
      <span class="vector">
        {values.map((value, i) => (
          <DragNumber
            key={i}
            label={`${name} ${"xyz"[i] ?? ""}`}
            value={value}
            decimals={3}
            step={Math.max(0.01, Math.abs(value) / 200)}
            {...(least === null ? {} : { min: least })}
            change={(x) => set(values.with(i, x))}
          />
        ))}
      </span>
    </div>
  );
}

/** Converts linear RGB to a CSS colour. */
export function hex(values: number[]): string {
  const eight = (x: number) => {
    const clear = Math.min(1, Math.max(0, x));
    const curve = clear <= 0.0031308 ? 12.92 * clear : 1.055 * clear ** (1 / 2.4) - 0.055;
    return Math.round(255 * curve)
      .toString(16)
      .padStart(2, "0");
  };
  return `#${values.map(eight).join("")}`;
}

/** Converts a CSS colour to linear RGB. */
export function linear(color: string): number[] {
  return [1, 3, 5].map((at) => {
    const curve = Number.parseInt(color.slice(at, at + 2), 16) / 255;
    const light = curve <= 0.04045 ? curve / 12.92 : ((curve + 0.055) / 1.055) ** 2.4;
    return Number(light.toFixed(5));
  });
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
