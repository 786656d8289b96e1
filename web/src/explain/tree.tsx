import { useState } from "preact/hooks";
import type { Term } from "../protocol";
import { short } from "../ui/slider";
import { Rows } from "./rows";
import type { ExplainView } from "./view";

/** Terms that contribute a smaller fraction of the pixel are folded. */
const little = 0.01;

/** Tree of the terms of a pixel's colour, largest first. */
export function Tree({ store }: { store: ExplainView }) {
  const tree = store.pixel?.tree;
  if (!tree) return <p class="hint">The camera sees nothing through this pixel.</p>;
  return (
    <ul class="tree" role="tree" aria-label="Terms of the pixel" onKeyDown={moveFocus}>
      <Branch store={store} term={tree} path="0" level={1} />
    </ul>
  );
}

function Branch({
  store,
  term,
  path,
  level,
}: {
  store: ExplainView;
  term: Term;
  path: string;
  level: number;
}) {
  const [open, setOpen] = useState(level < 4);
  const [all, setAll] = useState(false);
  const order = term.terms.map((child, i) => ({ child, path: `${path}.${i}` }));
  order.sort((a, b) => b.child.share - a.child.share);
  const large = order.filter(
    ({ child }) => all || Math.abs(child.share) >= little || child.segment?.role === "shadowed",
  );
  const hidden = order.length - large.length;
  const chosen = store.chosen === path;
  const choose = () => {
    store.unfolded = !(chosen && store.unfolded);
    store.choose(path);
    store.goTo(term.place);
    store.reveal(term.object);
  };
  return (
    <li
      role="treeitem"
      aria-expanded={order.length > 0 ? open : undefined}
      aria-selected={chosen}
      aria-level={level}
    >
      <div
        class={`term${chosen ? " chosen" : ""}${store.hovered === path ? " hovered" : ""}`}
        onPointerEnter={() => store.hover(path)}
        onPointerLeave={() => store.hover(null)}
      >
        <button
          type="button"
          class="fold"
          aria-label={open ? "Fold" : "Unfold"}
          disabled={order.length === 0}
          onClick={() => setOpen(!open)}
        >
          {order.length === 0 ? "·" : open ? "▾" : "▸"}
        </button>
        <button type="button" class="title" onClick={choose}>
          <span class="chip" style={{ background: `rgb(${term.swatch.join(" ")})` }} />
          <span class={`words ${term.segment ? `ray-${term.segment.role}` : ""}`}>{term.title}</span>
          <span class="share" style={{ "--share": bar(term.share) }}>
            {percent(term.share)}
          </span>
        </button>
      </div>
      {chosen && store.unfolded && (
        <div class="detail">
          <Rows rows={term.rows} />
          {term.origins.length > 0 && (
            <ul class="origins">
              {term.origins.map((line) => (
                <li key={line}>{line}</li>
              ))}
            </ul>
          )}
          <p class="value">
            adds <strong>{term.adds.map((x) => short(x)).join("  ")}</strong>, alone{" "}
            {term.value.map((x) => short(x)).join("  ")}, in eight bits {term.swatch.join(" ")}
          </p>
        </div>
      )}
      {open && large.length > 0 && (
        <ul role="group">
          {large.map(({ child, path: at }) => (
            <Branch key={at} store={store} term={child} path={at} level={level + 1} />
          ))}
        </ul>
      )}
      {open && hidden > 0 && (
        <button type="button" class="more" onClick={() => setAll(true)}>
          {hidden} more below 1 %
        </button>
      )}
    </li>
  );
}

/** Moves between the terms with the arrow keys: up and down to the next term, left and right to fold and unfold. */
function moveFocus(event: KeyboardEvent & { currentTarget: Element }) {
  const titles = [...event.currentTarget.querySelectorAll<HTMLElement>(".title")];
  const at = titles.indexOf(document.activeElement as HTMLElement);
  const title = titles[at];
  if (!title) return;
  if (event.key === "ArrowDown") titles[at + 1]?.focus();
  else if (event.key === "ArrowUp") titles[at - 1]?.focus();
  else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
    const isOpen = title.closest("[role=treeitem]")?.getAttribute("aria-expanded");
    if (isOpen === String(event.key === "ArrowLeft"))
      title.parentElement?.querySelector<HTMLElement>(".fold")?.click();
  } else return;
  event.preventDefault();
}

/** Width of the bar that shows a share. */
function bar(share: number): string {
  return `${(100 * Math.min(1, Math.max(0, share))).toFixed(1)}%`;
}

function percent(share: number): string {
  const value = 100 * share;
  if (value === 0) return "0 %";
  if (Math.abs(value) < 0.1) return "< 0.1 %";
  return `${value.toFixed(Math.abs(value) < 10 ? 1 : 0)} %`;
}
