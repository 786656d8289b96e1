/** Pages in Chromium, and pictures of them. */
import { mkdirSync } from "node:fs";
import { chromium } from "playwright-core";

const [address, folder = "/tmp/durer-pictures"] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
});
const wants = new RegExp(process.env.ONLY ?? ".");
let failed = 0;

export async function test(name, options, work) {
  if (!wants.test(name)) return;
  const context = await browser.newContext(options);
  // Other programs may need the processors.
  context.setDefaultTimeout(180_000);
  const page = await context.newPage();
  const errors = [];
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  try {
    await work(page);
    if (errors.length > 0) throw new Error(errors.join("\n"));
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}: ${error.message}`);
    await page.screenshot({ path: `${folder}/failed-${name.replaceAll(" ", "-")}.png` });
  }
  await context.close();
}

/** Chapters of the lecture. */
export const topics = (
  process.env.TOPICS ??
  "machine,ray,pinhole,obscura,camera,projection,cameras,homogeneous,plane,sphere,triangle,transform,normals,solids,epsilon,shading,shadow,mirror,glass,samples,structures,paths,caustics,own"
).split(",");
export const scenes = new URL("../../../scenes/", import.meta.url).pathname;
export const wide = { viewport: { width: 1440, height: 900 } };
export const middle = { viewport: { width: 900, height: 1100 } };
export const narrow = { viewport: { width: 400, height: 820 }, hasTouch: true };
export const finished = (page) => page.waitForSelector(".status .hash");
/** Waits for the first image in full size, which need not be finished. */
export const shown = (page) =>
  page.waitForFunction(() => / of \d+ samples/.test(document.querySelector(".status")?.textContent));
export const shot = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });

export async function open(page, hash = "#/viewer") {
  await page.goto(`${address}${hash}`);
}

/** Closes the browser; exits with 1 if a test failed. */
export async function close() {
  await browser.close();
  process.exit(failed === 0 ? 0 : 1);
}
