import { useState } from "preact/hooks";
import type { ObjectTest, Verdict } from "../protocol";
import { short } from "../ui/slider";
import { Rows } from "./rows";
import type { ExplainView } from "./view";

const order: Verdict[] = ["closest", "farther", "behind", "beyond", "missed"];
const words: Record<Verdict, string> = {
  closest: "closest",
  farther: "farther",
  behind: "behind",
  beyond: "beyond",
  missed: "missed",
};

/** Lists the intersection tests of the selected ray with all objects, and why each is not the closest hit.
 */
export function Tests({ store }: { store: ExplainView }) {
  const [open, setOpen] = useState<number | null>(null);
  const { cast } = store;
  if (!cast) return null;
  const tests = [...cast.tests].sort((a, b) => rank(a) - rank(b) || (a.t ?? 0) - (b.t ?? 0));
  return (
    <section class="tests" aria-label="Objects tested against this ray">
      <h3>
        {cast.tests.length + cast.left_out} objects tested against this ray
        {cast.hit ? `, closest at t = ${short(cast.hit.t)}` : ", none hit"}
      </h3>
      <ul>
        {tests.map((test) => (
          <li key={test.object}>
            <button
              type="button"
              class={`test ${test.verdict}`}
              aria-expanded={open === test.object}
              onClick={() => {
                setOpen(open === test.object ? null : test.object);
                store.goTo(test.place);
                store.reveal(test.object);
              }}
            >
              <span class="verdict">{words[test.verdict]}</span>
              <span class="name">{test.name}</span>
              <span class="t">{test.t === null ? "" : `t = ${short(test.t)}`}</span>
              <span class="why">{test.why}</span>
            </button>
            {open === test.object && <Rows rows={test.rows} />}
          </li>
        ))}
      </ul>
      {cast.left_out > 0 && <p class="hint">{cast.left_out} more objects are not listed.</p>}
    </section>
  );
}

function rank(test: ObjectTest): number {
  return order.indexOf(test.verdict);
}
