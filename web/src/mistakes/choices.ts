import type { MistakeChoice } from "../protocol";
import { short } from "../ui/slider";

/** Titles of the topics, in the order of the lecture. */
const topics: Record<string, string> = {
  rays: "Camera and rays",
  distance: "Intersections",
  flat: "Colours and textures",
  normals: "Normals",
  transforms: "Transforms",
  diffuse: "Diffuse light",
  specular: "Highlights",
  shadows: "Shadows",
  epsilon: "Epsilon",
  reflection: "Reflection",
  refraction: "Refraction",
  fresnel: "Fresnel",
  supersampling: "Samples",
};

/** Mistakes of one topic. */
export interface TopicMistakes {
  topic: string;
  title: string;
  mistakes: MistakeChoice[];
}

/** Returns true if a mistake contains all words of a query in its name, description or code. */
export function matches({ name, description, right, wrong, topic }: MistakeChoice, query: string): boolean {
  const text = [name, description, right, wrong, titleOf(topic)].join("\n").toLowerCase();
  return query
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}

/** Groups mistakes by topic, in the order of the lecture. */
export function byTopic(mistakes: MistakeChoice[]): TopicMistakes[] {
  const groups = new Map<string, MistakeChoice[]>(Object.keys(topics).map((topic) => [topic, []]));
  for (const mistake of mistakes) {
    const group = groups.get(mistake.topic);
    if (group) group.push(mistake);
    else groups.set(mistake.topic, [mistake]);
  }
  return [...groups]
    .filter(([, group]) => group.length > 0)
    .map(([topic, group]) => ({ topic, title: titleOf(topic), mistakes: group }));
}

function titleOf(topic: string): string {
  return topics[topic] ?? topic.replace(/^./, (letter) => letter.toUpperCase());
}

/** Tells which fraction of a picture's pixels differs from the correct picture. */
export function describeChange(changed: number): string {
  if (changed === 0) return "No pixel differs in this scene";
  const percent = 100 * changed;
  const number = percent < 0.1 ? "Less than 0.1" : percent < 10 ? short(percent, 2) : percent.toFixed(0);
  return `${number} % of the pixels differ`;
}

/** Returns the largest size with the shape of a picture whose sides are at most `most` pixels. */
export function reducedSize([width, height]: [number, number], most: number): [number, number] {
  const scale = Math.min(1, most / Math.max(width, height));
  return [Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))];
}
