import { useState } from "preact/hooks";
import type { Session } from "../engine/engine";
import { describeChange } from "../mistakes/choices";
import { type MistakenPicture, useMistaken } from "../mistakes/mistaken";
import { Equation, Mistake, Wrong } from "./parts";

/** Common mistake that a figure can make, which the library renders. */
export interface FigureMistake {
  on: boolean;
  change(on: boolean): void;
  /** The picture with the mistake, if it is on. */
  picture: MistakenPicture | null;
}

/**
 * Returns the state of a mistake of the library's table in a figure, which is off at first. Without
 * a name, there is no picture. `changes` are the values that change the session's scene.
 */
export function useFigureMistake(
  session: Session,
  name: string | null,
  size: [number, number],
  changes: unknown[],
): FigureMistake {
  const [on, change] = useState(false);
  const { picture } = useMistaken(session, on && name !== null ? { name, value: null, size } : null, changes);
  return { on, change, picture };
}

/** Switch that makes the mistake of a figure. */
export function MistakeSwitch({ name, mistake }: { name: string; mistake: FigureMistake }) {
  return <Mistake name={name} on={mistake.on} change={mistake.change} />;
}

/** Right and wrong code of a figure's mistake, while it is on. */
export function MistakeCode({ mistake: { on, picture } }: { mistake: FigureMistake }) {
  if (!on || !picture?.mistake) return null;
  return (
    <Equation
      numbers={
        <Wrong>
          <code>{picture.mistake.wrong}</code>
          <p>{describeChange(picture.changed)}</p>
        </Wrong>
      }
    >
      <code>{picture.mistake.right}</code>
    </Equation>
  );
}
