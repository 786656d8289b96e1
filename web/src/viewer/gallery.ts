/** Texts of the example scenes, which need no other files. */
const texts = import.meta.glob<string>(
  [
    "../../../scenes/whitted.txt",
    "../../../scenes/sphere.txt",
    "../../../scenes/room.txt",
    "../../../scenes/lens.txt",
    "../../../scenes/die.txt",
    "../../../scenes/gear.txt",
    "../../../scenes/marble.txt",
    "../../../scenes/thin-lens.txt",
    "../../../scenes/glass-of-water.txt",
    "../../../scenes/highlights.txt",
    "../../../scenes/cornell-box.txt",
    "../../../scenes/caustic.txt",
    "../../../scenes/layers.txt",
    "../../../scenes/plates.txt",
    "../../../scenes/prism.txt",
    "../../../scenes/soap.txt",
    "../../../scenes/fog.txt",
    "../../../scenes/milk.txt",
    "../../../scenes/daylight.txt",
  ],
  { query: "?raw", import: "default", eager: true },
);

/** Example scenes by name, in alphabetical order. */
export const gallery: { name: string; text: string }[] = Object.entries(texts)
  .map(([path, text]) => ({ name: path.split("/").at(-1) ?? path, text }))
  .sort((a, b) => a.name.localeCompare(b.name));
