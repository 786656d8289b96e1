import type { ComponentChild, ComponentType } from "preact";

/** A step of the lecture. */
export interface Topic {
  /** For the address. */
  id: string;
  title: string;
  /** One sentence for slides. */
  lead: ComponentChild;
  /** What is new, for one who has read what comes before. */
  text: ComponentChild[];
  Figure: ComponentType;
  questions: { ask: ComponentChild; answer: ComponentChild }[];
}
