import { createContext } from "preact";
import { useContext, useEffect, useMemo, useRef, useState } from "preact/hooks";
import type { Engine, EventOf, Session } from "../engine/engine";
import type { Vec } from "../explain/space";
import type { CastResult, Event, PixelExplanation, Request, Setting, Traversal } from "../protocol";

/** The engine that all figures share. */
export const EngineContext = createContext<Engine | null>(null);

/** Scene that is open in the viewer, for the chapter "Your own scene". */
export interface OwnScene {
  /** Displayed name. */
  title: string;
  /** File name; empty for the server's scene. */
  name: string;
  /** Text of the scene; `null` for a file that the server reads. */
  text: string | null;
}

/** Passes the viewer's scene to the chapter "Your own scene". */
export const OwnSceneContext = createContext<OwnScene>({ title: "", name: "", text: null });

/** Render options of figures: few samples, so that images finish quickly. */
const figureOptions: Setting[] = [{ name: "samples", value: "4" }];

/** File that the scene of a figure refers to. */
interface FigureFile {
  name: string;
  text: string;
}

/** Opens a session with the scene of a figure. If the text or the file changes, the session gets the new one. */
export function useScene(text: string, options: Setting[] = figureOptions, file?: FigureFile): Session {
  const engine = useContext(EngineContext);
  if (!engine) throw new Error("figures need an `EngineContext`");
  const session = useMemo(() => engine.session(), [engine]);
  const opened = useRef(false);
  const key = JSON.stringify(options);
  useEffect(() => {
    if (file) session.send({ kind: "give", name: file.name, base64: btoa(file.text), opens: false });
  }, [session, file?.text]);
  useEffect(() => {
    if (opened.current) session.send({ kind: "edit", text });
    else session.send({ kind: "open", name: "figure.txt", text });
    opened.current = true;
  }, [session, text]);
  useEffect(() => {
    session.send({ kind: "options", options });
  }, [session, key]);
  useEffect(
    () =>
      session.on((event) => {
        // Report errors. Otherwise a figure with an invalid scene would silently show the old one.
        if (event.kind !== "scene" || event.contents) return;
        console.error(event.findings.map((finding) => finding.message).join("; "));
      }),
    [session],
  );
  useEffect(() => () => session.close(), [session]);
  return session;
}

/** Opens a session with a scene by name, and fits the size of its image to the figure. */
export function useSceneFile(scene: OwnScene, options: Setting[], picture: string) {
  const engine = useContext(EngineContext);
  if (!engine) throw new Error("figures need an `EngineContext`");
  const session = useMemo(() => engine.session(), [engine]);
  const [size, setSize] = useState<[number, number]>([480, 360]);
  const [refused, setRefused] = useState<string | null>(null);
  const key = JSON.stringify(options);
  useEffect(() => {
    session.send({ kind: "open", name: scene.name, text: scene.text });
    return session.on((event) => {
      if (event.kind === "refused") setRefused(event.why);
      if (event.kind !== "scene") return;
      setRefused(event.contents ? null : (event.findings[0]?.message ?? "the scene has errors"));
      if (event.contents) setSize(fitSize(event.contents.job.size));
    });
  }, [session, scene.name, scene.text]);
  useEffect(() => {
    session.send({ kind: "options", options });
    session.send({ kind: "show", picture, stops: 0, tone: "none" });
  }, [session, key, picture]);
  useEffect(() => () => session.close(), [session]);
  return { session, size, refused };
}

function fitSize([width, height]: [number, number]): [number, number] {
  const scale = Math.min(1, 480 / Math.max(width, height));
  return [Math.max(1, Math.round(width * scale)), Math.max(1, Math.round(height * scale))];
}

/** Returns the latest answer to a request, which is sent again if it or the scene changes. */
export function useAnswer<K extends Event["kind"]>(
  session: Session,
  request: Request,
  kind: K,
  scene: string,
): EventOf<K> | null {
  const [answer, setAnswer] = useState<EventOf<K> | null>(null);
  const latest = useRef(0);
  useEffect(() => {
    const number = ++latest.current;
    session
      .ask(request, kind)
      .then((event) => number === latest.current && setAnswer(event))
      .catch(() => {});
  }, [session, scene, JSON.stringify(request)]);
  return answer;
}

/** Returns the results of intersecting a ray with all objects of a scene. */
export function useCast(session: Session, origin: Vec, direction: Vec, scene: string): CastResult | null {
  return useAnswer(session, { kind: "cast", origin, direction, t_max: null }, "cast", scene)?.cast ?? null;
}

/** Returns the traversal of a structure by a ray. */
export function useWalk(
  session: Session,
  ray: Omit<Extract<Request, { kind: "walk" }>, "kind">,
  scene: string,
): Traversal | null {
  return useAnswer(session, { kind: "walk", ...ray }, "walk", scene)?.walk ?? null;
}

/** Returns the explanation of a pixel of a session's image. */
export function usePixel(session: Session, x: number, y: number, key: string): PixelExplanation | null {
  return useAnswer(session, { kind: "explain", x, y, sample: null }, "explained", key)?.pixel ?? null;
}

/** Returns the explanation of the light along a ray, as the single pixel of a camera that looks along it. */
export function useTrace(session: Session, from: Vec, direction: Vec, key: string): PixelExplanation | null {
  const [pixel, setPixel] = useState<PixelExplanation | null>(null);
  const latest = useRef(0);
  useEffect(() => {
    const number = ++latest.current;
    const up: Vec = Math.abs(direction[1]) > 0.9 * Math.hypot(...direction) ? [0, 0, 1] : [0, 1, 0];
    session.send({ kind: "size", width: 1, height: 1 });
    session.send({ kind: "look", center: from, direction, up, angle: 1, moving: false });
    session
      .ask({ kind: "explain", x: 0, y: 0, sample: null }, "explained")
      .then(({ pixel }) => number === latest.current && setPixel(pixel))
      .catch(() => {});
  }, [session, key, ...from, ...direction]);
  return pixel;
}

/** Returns the value of a row of an object's test, such as `Δ`. */
export function numberOf(cast: CastResult | null, object: number, name: string): number | null {
  const test = cast?.tests.find((test) => test.object === object);
  return test?.rows.find((row) => row.name === name)?.value ?? null;
}

/** Returns the page's background in linear RGB, which is also the background of rendered figures. */
export function usePageBackground(): string {
  const [dark, setDark] = useState(isDark);
  useEffect(() => {
    const look = () => setDark(isDark());
    const system = matchMedia("(prefers-color-scheme: dark)");
    system.addEventListener("change", look);
    window.addEventListener("durer-theme", look);
    return () => {
      system.removeEventListener("change", look);
      window.removeEventListener("durer-theme", look);
    };
  }, []);
  return dark ? "0.0080 0.0086 0.0103" : "0.9647 0.9559 0.9301";
}

function isDark(): boolean {
  const theme = document.documentElement.dataset.theme;
  return theme ? theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
}
