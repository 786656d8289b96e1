import { useMemo } from "preact/hooks";
import type { Engine } from "../engine/engine";
import { type OwnScene, OwnSceneContext } from "./context";
import { Lecture } from "./lecture";
import { lesson as topicsOf } from "./lesson";
import { topics } from "./topics";

interface Props {
  engine: Engine;
  /** Name of the page in the address. */
  name: string;
  /** A teacher's lesson in Markdown; `null` for the lecture. */
  lesson: string | null;
  /** Id of the topic that is shown. */
  topic: string;
  scene: OwnScene;
}

/** The lecture or a teacher's lesson, with all that only they need. */
export function LecturePage({ engine, name, lesson, topic, scene }: Props) {
  const shown = useMemo(() => (lesson === null ? topics : topicsOf(lesson)), [lesson]);
  return (
    <OwnSceneContext.Provider value={scene}>
      <Lecture engine={engine} name={name} topics={shown} topic={topic} />
    </OwnSceneContext.Provider>
  );
}
