/** Clicks through the page in Chromium: `node tests/click.mjs ADDRESS [FOLDER FOR PICTURES]`. */
import { close } from "./click/harness.mjs";

for (const part of ["viewer", "fields", "lecture", "mistakes", "files", "input", "native", "access"])
  await import(`./click/${part}.mjs`);
await close();
