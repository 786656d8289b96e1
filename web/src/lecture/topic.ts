import type { ComponentType } from "preact";

/** A step of the lecture. */
export interface Topic {
  /** For the address. */
  id: string;
  title: string;
  /** One sentence for slides. */
  lead: string;
  /** What is new, for one who has read what comes before. */
  text: string[];
  Figure: ComponentType;
  questions: { ask: string; answer: string }[];
}
