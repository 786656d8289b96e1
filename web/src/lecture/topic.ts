import type { ComponentType } from "preact";

/** A topic of the lecture. */
export interface Topic {
  /** Part of the page's address. */
  id: string;
  title: string;
  /** One sentence, shown on slides. */
  lead: string;
  /** Paragraphs, for readers of the previous topics. */
  text: string[];
  Figure: ComponentType;
  questions: { ask: string; answer: string }[];
}
