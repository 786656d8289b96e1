/** Clicks through the page in Chromium: `node tests/click.mjs ADDRESS [FOLDER FOR PICTURES]`. */
import { close } from "./click/harness.mjs";

const parts = ["viewer", "fields", "lecture", "mistakes", "files", "input", "native", "access"];
// Reports do not depend on the engine of the page.
if (!process.env.OFFLINE) parts.push("reports");
for (const part of parts) await import(`./click/${part}.mjs`);
await close();
