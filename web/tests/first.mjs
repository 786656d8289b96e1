/** How soon the first picture of the playground comes, and how many bytes it takes:
 * `node tests/first.mjs FOLDER [VISITS]`. Each visit starts with an empty cache. */
import { readdirSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join, relative } from "node:path";
import { gzipSync } from "node:zlib";
import { chromium } from "playwright-core";

const [folder, visits = "7"] = process.argv.slice(2);
const types = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".woff2": "font/woff2",
};
const packed = new Map(
  readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => {
      const path = join(entry.parentPath ?? entry.path, entry.name);
      return [`/${relative(folder, path)}`, gzipSync(readFileSync(path), { level: 9 })];
    }),
);
let sent = new Map();
const server = createServer((request, response) => {
  const path = new URL(request.url, "http://localhost").pathname;
  const name = path === "/" ? "/index.html" : path;
  const bytes = packed.get(name);
  if (!bytes) {
    response.writeHead(404).end();
    return;
  }
  sent.set(name, bytes.length);
  response.writeHead(200, { "content-type": types[extname(name)], "content-encoding": "gzip" });
  response.end(bytes);
});
await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
const address = `http://127.0.0.1:${server.address().port}/`;

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
  await page.goto(address);
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
