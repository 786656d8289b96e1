/** How soon the first picture of the playground comes, and how many bytes it takes:
 * `node tests/first.mjs FOLDER [VISITS]`. Each visit starts with an empty cache. */
import { chromium } from "playwright-core";
import { serve } from "./serve.mjs";

const [folder, visits = "7"] = process.argv.slice(2);
let sent = new Map();
const server = await serve(folder, (name, length) => sent.set(name, length));

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox"],
});
const first = [];
const finished = [];
let files = [];
for (let i = 0; i < Number(visits); i++) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  const page = await context.newPage();
  sent = new Map();
  await page.exposeFunction("shown", () => {
    files = [...sent];
  });
  await page.addInitScript(() => {
    const look = () => {
      const status = document.querySelector("p.status");
      if (status?.querySelector("span") && !window.firstPicture) {
        window.firstPicture = performance.now();
        window.shown();
      }
      if (status?.querySelector(".hash")) window.finishedPicture ??= performance.now();
      else requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
  });
  await page.goto(server.address);
  await page.waitForFunction(() => window.firstPicture);
  first.push(await page.evaluate(() => window.firstPicture));
  await page.waitForFunction(() => window.finishedPicture, undefined, { timeout: 120_000 });
  finished.push(await page.evaluate(() => window.finishedPicture));
  await context.close();
}
await browser.close();
server.close();
const seconds = (times) => {
  const sorted = [...times].sort((a, b) => a - b);
  const at = (share) => (sorted[Math.round(share * (sorted.length - 1))] / 1000).toFixed(2);
  return `median ${at(0.5)} s, ${at(0)} to ${at(1)} s`;
};
console.log(`first picture: ${seconds(first)}, ${visits} visits; finished picture: ${seconds(finished)}`);
for (const [name, bytes] of files) console.log(`${String(bytes).padStart(9)} ${name}`);
const bytes = files.reduce((sum, [, length]) => sum + length, 0);
console.log(`${(bytes / 1e6).toFixed(2)} MB until the first picture (gzip)`);
