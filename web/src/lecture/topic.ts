import type { ComponentChild, ComponentType } from "preact";

/** Topic of the lecture or of a lesson: its text, figure and questions. */
export interface Topic {
  /** Identifier in the page's address. */
  id: string;
  title: string;
  /** One sentence, shown on slides. */
  lead: ComponentChild;
  /** Paragraphs, for readers of the previous topics. */
  text: ComponentChild[];
  Figure: ComponentType;
  questions: { ask: ComponentChild; answer: ComponentChild }[];
}
