import type { ComponentChild } from "preact";
import { useState } from "preact/hooks";
import type { PictureInfo, Setting } from "../protocol";
import { useSceneFile } from "./context";
import { ExplainedImage } from "./explained";
import { type Block, blocks, words } from "./markdown";
import { Equation, Figure } from "./parts";
import type { Topic } from "./topic";
import { topics } from "./topics";

/** Block of a lesson that shows a figure or a scene. */
type FigureBlock = Extract<Block, { kind: "figure" }>;

/** Converts a teacher's lesson in Markdown to topics: each heading of level 1 or 2 begins a step. */
export function lesson(text: string): Topic[] {
  const steps: { title: string; blocks: Block[] }[] = [];
  for (const block of blocks(text)) {
    if (block.kind === "heading" && block.level <= 2) steps.push({ title: block.text, blocks: [] });
    else {
      if (steps.length === 0) steps.push({ title: "Lesson", blocks: [] });
      steps.at(-1)?.blocks.push(block);
    }
  }
  return steps.map(topic);
}

function topic({ title, blocks }: { title: string; blocks: Block[] }, at: number): Topic {
  const [first, ...others] = blocks;
  const lead = first?.kind === "paragraph" ? words(first.text) : "";
  const rest = first?.kind === "paragraph" ? others : blocks;
  const figures = rest.filter((block): block is FigureBlock => block.kind === "figure");
  return {
    id: `${at + 1}-${title.toLowerCase().replace(/[^\p{Letter}\p{Number}]+/gu, "-")}`,
    title,
    lead,
    text: rest.flatMap((block, i) => prose(block, i) ?? []),
    Figure: () => (
      <>
        {figures.map((block, i) => (
          <LessonFigure key={i} {...block} />
        ))}
      </>
    ),
    questions: rest.flatMap((block) =>
      block.kind === "question" ? [{ ask: words(block.ask), answer: words(block.answer) }] : [],
    ),
  };
}

function prose(block: Block, key: number): ComponentChild {
  switch (block.kind) {
    case "heading":
      return <h2 key={key}>{words(block.text)}</h2>;
    case "paragraph":
      return <p key={key}>{words(block.text)}</p>;
    case "code":
      return (
        <pre key={key}>
          <code>{block.text}</code>
        </pre>
      );
    case "list": {
      const items = block.items.map((item, i) => <li key={i}>{words(item)}</li>);
      return block.ordered ? <ol key={key}>{items}</ol> : <ul key={key}>{items}</ul>;
    }
    default:
      return null;
  }
}

/** Shows a figure by its name: a figure of the lecture, or a scene file beside the lesson. */
function LessonFigure({ label, source, options }: FigureBlock) {
  const id = /^figure:(.+)$/.exec(source)?.[1];
  if (id === undefined) return <SceneFigure label={label} name={source} options={options} />;
  const found = topics.find((known) => known.id === id);
  if (found) return <found.Figure />;
  return (
    <p class="notice" role="alert">
      There is no figure “{id}”. Known are: {topics.map((known) => known.id).join(", ")}.
    </p>
  );
}

/** Renders a scene file, and explains the pixels that are clicked. */
function SceneFigure({ label, name, options }: { label: string; name: string; options: string }) {
  const given = settings(options);
  const picture = given.find((option) => option.name === "show")?.value ?? "color";
  const job = given.filter((option) => option.name !== "show");
  const { session, size, refused } = useSceneFile({ title: label, name, text: null }, job, picture);
  const [head, setHead] = useState<PictureInfo | null>(null);
  const [width, height] = size;
  return (
    <Figure
      stage={
        <ExplainedImage
          session={session}
          width={width}
          height={height}
          label={label || name}
          scene={name}
          onResult={setHead}
        />
      }
    >
      <Equation
        numbers={
          head ? (
            <>
              {width} × {height} pixels, <b>{(head.rays / 1e3).toFixed(0)}</b> thousand rays
            </>
          ) : (
            (refused ?? `reading ${name} …`)
          )
        }
      >
        {label}
      </Equation>
    </Figure>
  );
}

/** Parses render options such as `samples=16 show=normals`. */
export function settings(text: string): Setting[] {
  return text
    .split(/\s+/)
    .filter((word) => word !== "")
    .map((word) => {
      const [name = "", ...value] = word.split("=");
      return { name, value: value.length > 0 ? value.join("=") : "true" };
    });
}
