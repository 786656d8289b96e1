import { type ComponentChild, render } from "preact";
import { useEffect, useState } from "preact/hooks";
import { Lecture } from "../lecture/lecture";
import type { Topic } from "../lecture/topic";
import { equationParts } from "./data";
import { Shell } from "./shell";
import type { LessonReport, LessonStep } from "./types";
import { Wipe } from "./wipe";

/** Report of `durer lesson`: the steps as a book, or as slides. */
export function Lesson({ report }: { report: LessonReport }) {
  const [at, setAt] = useState(topicInAddress);
  const [topics] = useState(() => lessonTopics(report));
  useEffect(() => {
    const follow = () => setAt(topicInAddress());
    window.addEventListener("hashchange", follow);
    return () => window.removeEventListener("hashchange", follow);
  }, []);
  useEffect(() => printAll(topics), [topics]);
  return (
    <Shell
      command={`lesson ${report.scene}`}
      title={`${report.scene}, in the order of the lecture`}
      height="window"
    >
      <Lecture engine={null} name="lesson" topics={topics} topic={at} />
    </Shell>
  );
}

/** Prints all steps in place of the one on the screen. Returns a function that ends this. */
function printAll(topics: Topic[]): () => void {
  const sheet = document.createElement("div");
  sheet.className = "printed report";
  document.body.append(sheet);
  // The browser prints right after the event, so the steps are added without delay.
  const show = () => render(<Printed topics={topics} />, sheet);
  const hide = () => render(null, sheet);
  window.addEventListener("beforeprint", show);
  window.addEventListener("afterprint", hide);
  return () => {
    window.removeEventListener("beforeprint", show);
    window.removeEventListener("afterprint", hide);
    hide();
    sheet.remove();
  };
}

function Printed({ topics }: { topics: Topic[] }) {
  return (
    <>
      {topics.map(({ id, title, lead, text, Figure }) => (
        <section key={id}>
          <h2>{title}</h2>
          {lead && <p>{lead}</p>}
          {text}
          <Figure />
        </section>
      ))}
    </>
  );
}

function topicInAddress(): string {
  return location.hash.split("/")[2] ?? "";
}

/** Converts the steps to topics of the lecture. */
export function lessonTopics(report: LessonReport): Topic[] {
  const topics = report.steps.map(
    (step, i): Topic => ({
      id: `step-${i + 1}`,
      title: step.title,
      lead: step.words ?? "",
      text: i === 0 ? [...text(step), introduction] : [...text(step)],
      Figure: () => <StepFigure step={step} pictures={report.pictures} />,
      questions: [],
    }),
  );
  if (report.own_scene)
    topics.push({
      id: "scene",
      title: "The built-in scene",
      lead: "Steps that the scene cannot show use this one.",
      text: [],
      Figure: () => (
        <pre class="source" tabIndex={0}>
          {report.own_scene}
        </pre>
      ),
      questions: [],
    });
  return topics;
}

const introduction = (
  <p>
    Each step adds one thing to the last. If a step has a before and an after, drag across the picture, or use
    the slider below it. The first four steps show different quantities, which cannot be subtracted.{" "}
    <code>durer explain</code> explains the colour of any pixel.
  </p>
);

function* text(step: LessonStep): Generator<ComponentChild> {
  yield <p class="facts">{step.facts}</p>;
  if (step.places.length > 0)
    yield (
      <details class="places">
        <summary>In Dürer's source</summary>
        {step.places.map(([file, symbol], i) => (
          <span key={i}>
            {i > 0 && "; "}
            <code>{file}</code> <code>{symbol}</code>
          </span>
        ))}
      </details>
    );
}

function StepFigure({ step, pictures }: { step: LessonStep; pictures: LessonReport["pictures"] }) {
  const { before, after, change, plan } = step;
  return (
    <figure class="figure step">
      {step.elsewhere && <p class="notice">{step.elsewhere}</p>}
      <div class="shots">
        {before ? (
          <BeforeAndAfter
            before={[pictures[before.file] ?? "", before.caption]}
            after={[pictures[after.file] ?? "", after.caption]}
          />
        ) : (
          <Shot caption={after.caption}>
            <img src={pictures[after.file]} alt={after.caption} />
          </Shot>
        )}
        {change && (
          <Shot caption="the change: lighter or darker than middle grey, by half the difference; a tint shows which of red, green and blue changed most">
            <img src={pictures[change]} alt="difference" />
          </Shot>
        )}
        {plan && (
          <Shot caption="rays of the middle row, seen from above: the large dot is the camera, small dots are hits">
            {/* `durer lesson` draws the SVG, which contains no text of the scene. */}
            <div class="plan" role="img" aria-label="plan" dangerouslySetInnerHTML={{ __html: plan }} />
          </Shot>
        )}
      </div>
      {step.equations.length > 0 && (
        <figcaption class="equations">
          <div class="equation">
            {step.equations.map((equation) => (
              <div key={equation} class="symbols">
                {equationParts(equation).map(({ kind: Kind, text }, i) =>
                  Kind === "text" ? text : <Kind key={i}>{text}</Kind>,
                )}
              </div>
            ))}
          </div>
        </figcaption>
      )}
    </figure>
  );
}

function Shot({ caption, children }: { caption: string; children: ComponentChild }) {
  return (
    <figure class="shot">
      {children}
      <figcaption>{caption}</figcaption>
    </figure>
  );
}

/** Two pictures with a line between them, and the second one alone beside it. */
function BeforeAndAfter({ before, after }: { before: [string, string]; after: [string, string] }) {
  const [split, setSplit] = useState(0.5);
  return (
    <>
      <Shot caption={`left: ${before[1]}; right: ${after[1]}`}>
        <Wipe
          under={before[0]}
          over={after[0]}
          labels={[before[1], after[1]]}
          label="Before and after"
          split={split}
          change={setSplit}
        />
        <input
          type="range"
          aria-label="Before and after"
          min={0}
          max={100}
          value={Math.round(100 * split)}
          onInput={(event) => setSplit(event.currentTarget.valueAsNumber / 100)}
        />
      </Shot>
      <Shot caption={after[1]}>
        <img src={after[0]} alt={after[1]} />
      </Shot>
    </>
  );
}
