import whitted from "../../../scenes/whitted.txt?raw";

/** The scene that the page opens by default. */
export const firstScene: string = whitted;

const mark = "#/scene/";
const filesMark = "#/open/";

/** Returns a link that contains the entire scene, compressed, in the URL's fragment, which servers never receive.
 */
export async function linkOf(text: string): Promise<string> {
  const stream = new Blob([text]).stream().pipeThrough(new CompressionStream("deflate-raw"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  const code = btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${location.href.split("#")[0]}${mark}${code}`;
}

/** Returns the scene that a link contains; `null` if there is none or it is damaged. */
export async function openLink(hash: string): Promise<string | null> {
  if (!hash.startsWith(mark)) return null;
  try {
    const letters = atob(hash.slice(mark.length).replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    return await new Response(stream).text();
  } catch {
    return null;
  }
}

/** Returns the paths in a link such as `#/open/scenes/shelf.txt,scenes/wood.png`: the scene, then the files that
 * it refers to. Returns `null` for other links.
 */
export function linkedFiles(hash: string): string[] | null {
  if (!hash.startsWith(filesMark)) return null;
  try {
    const paths = hash.slice(filesMark.length).split(",").map(decodeURIComponent);
    return paths.every((path) => path !== "") ? paths : null;
  } catch {
    return null;
  }
}
