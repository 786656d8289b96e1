import type { ComponentChild, ComponentType } from "preact";

/** A topic of the lecture. */
export interface Topic {
  /** Part of the page's address. */
  id: string;
  title: string;
  /** One sentence, shown on slides. */
  lead: ComponentChild;
  /** Paragraphs, for readers of the previous topics. */
  text: ComponentChild[];
  Figure: ComponentType;
  questions: { ask: ComponentChild; answer: ComponentChild }[];
}
