/** Clicks through the page in Chromium: `node tests/click.mjs ADDRESS [FOLDER FOR PICTURES]`. */
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { chromium } from "playwright-core";

const [address, folder = "/tmp/durer-pictures"] = process.argv.slice(2);
mkdirSync(folder, { recursive: true });
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
});
const wants = new RegExp(process.env.ONLY ?? ".");
let failed = 0;

async function test(name, options, work) {
  if (!wants.test(name)) return;
  const context = await browser.newContext(options);
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

const wide = { viewport: { width: 1440, height: 900 } };
const middle = { viewport: { width: 900, height: 1100 } };
const narrow = { viewport: { width: 400, height: 820 }, hasTouch: true };
const finished = (page) => page.waitForSelector(".status .hash", { timeout: 60_000 });
const shot = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });

async function open(page, hash = "#/viewer") {
  await page.goto(`${address}${hash}`);
}

for (const [width, size] of [
  ["wide", wide],
  ["middle", middle],
  ["narrow", narrow],
]) {
  for (const colorScheme of ["light", "dark"]) {
    await test(`viewer ${width} ${colorScheme}`, { ...size, colorScheme }, async (page) => {
      await open(page);
      await finished(page);
      const box = await page.locator(".picture canvas").boundingBox();
      await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
      await page.waitForSelector(".tree .term");
      await page.waitForSelector(".tests .test");
      await shot(page, `viewer-${width}-${colorScheme}`);
    });
  }
}

await test("orbit makes coarse pictures and settles", wide, async (page) => {
  await open(page);
  await finished(page);
  const before = await page.locator(".status .hash").textContent();
  const box = await page.locator(".picture canvas").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 12; i++) await page.mouse.move(x + 12 * i, y + 3 * i);
  await page.mouse.up();
  await page.waitForFunction(
    (old) => {
      const hash = document.querySelector(".status .hash")?.textContent;
      return hash && hash !== old;
    },
    before,
    { timeout: 60_000 },
  );
});

await test("an error is underlined and mended", wide, async (page) => {
  await open(page);
  await finished(page);
  const editor = page.locator(".cm-content");
  await editor.click();
  await page.keyboard.press("Control+End");
  await page.keyboard.type("\nGroup { Sphre ");
  await page.waitForSelector(".findings .error");
  await page.waitForSelector(".cm-lintRange-error");
  await shot(page, "error");
  for (let i = 0; i < 16; i++) await page.keyboard.press("Backspace");
  await page.waitForFunction(() => !document.querySelector(".findings .error"));
});

await test("step by step", wide, async (page) => {
  await open(page);
  await finished(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
  await page.getByRole("tab", { name: "Step by step" }).click();
  await page.waitForSelector(".stepper .code");
  for (let i = 0; i < 6; i++) await page.getByRole("button", { name: "Next", exact: true }).click();
  await shot(page, "steps");
});

await test("settings", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await page.getByRole("tab", { name: "Normals", exact: true }).click();
  // The picture turns from red, yellow and blue to that of upward normals.
  await page.waitForFunction(() => {
    const canvas = document.querySelector(".picture canvas");
    const [r, g, b] = canvas
      .getContext("2d")
      .getImageData(0.1 * canvas.width, 0.98 * canvas.height, 1, 1).data;
    return g > 200 && r < 160 && b < 160;
  });
  await shot(page, "settings");
});

const topics = (
  process.env.TOPICS ??
  "machine,ray,pinhole,camera,projection,plane,sphere,triangle,transform,normals,solids,shading,shadow,mirror,glass,samples,paths"
).split(",");
for (const topic of topics) {
  await test(`lecture ${topic}`, wide, async (page) => {
    await open(page, `#/lecture/${topic}`);
    await page.waitForSelector(".equation .numbers");
    await page.waitForTimeout(1800);
    await shot(page, `lecture-${topic}`);
    const handles = page.locator(".handle");
    const numbers = () => page.locator(".equations").textContent();
    for (let i = 0; i < (await handles.count()); i++) {
      const before = await numbers();
      await handles.nth(i).focus();
      for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowLeft");
      await page.waitForTimeout(250);
      if (before === (await numbers())) throw new Error(`handle ${i} changes no number`);
    }
  });
}

await test("present", { viewport: { width: 1600, height: 900 } }, async (page) => {
  await open(page, "#/lecture/sphere");
  await page.waitForSelector(".equation .numbers");
  await page.keyboard.press("p");
  await page.waitForSelector(".presents");
  await page.waitForTimeout(800);
  await shot(page, "present-sphere");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("h1")?.textContent === "Triangle");
  await page.waitForTimeout(1500);
  await shot(page, "present-triangle");
  await page.keyboard.press("Escape");
  await page.waitForSelector(".presents", { state: "detached" });
});

await test("lecture narrow dark", { ...narrow, colorScheme: "dark" }, async (page) => {
  await open(page, "#/lecture/shadow");
  await page.waitForSelector(".equation .numbers");
  await page.waitForTimeout(1800);
  await shot(page, "lecture-narrow-dark");
});

await test("a link holds the scene", wide, async (page) => {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await open(page);
  await finished(page);
  const text = await page.locator(".cm-content").textContent();
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.getByRole("button", { name: "Link copied" }).waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction((wanted) => document.querySelector(".cm-content")?.textContent === wanted, text);
});

await test("an example, a term, its line and its numbers", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.getByLabel("Examples").selectOption("sphere.txt");
  await page.waitForFunction(() =>
    document.querySelector(".cm-content")?.textContent?.includes("first picture"),
  );
  await finished(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  const term = page.locator(".tree .title").first();
  await term.waitFor();
  await term.click();
  await page.waitForSelector(".detail .rows");
  await page.waitForFunction(() =>
    document.querySelector(".cm-activeLine")?.textContent?.includes("Sphere {"),
  );
  await page.locator(".test.closest").click();
  const rows = await page.locator(".tests .rows").textContent();
  for (const name of ["Δ", "t₁", "t₂"])
    if (!rows?.includes(name)) throw new Error(`${name} is missing: ${rows}`);
});

const scenes = new URL("../../scenes/", import.meta.url).pathname;

await test("a model is opened and gone around in", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
  await page.waitForSelector(".things li");
  await page.waitForFunction(() =>
    document.querySelector(".settings h3")?.textContent?.includes("triangles"),
  );
  await page.locator(".picture canvas").focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("+");
  await page.waitForFunction(() => document.querySelector(".status")?.textContent?.includes("of 64 samples"));
  await shot(page, "model");
});

await test("the camera is written into the text", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await page.locator(".picture canvas").focus();
  await page.keyboard.press("ArrowLeft");
  await page.getByRole("button", { name: "Write into the scene" }).click();
  await page.waitForFunction(
    () => !document.querySelector(".cm-content")?.textContent?.includes("center 0 1.7 9"),
  );
  await page.getByRole("button", { name: "Write into the scene", disabled: true }).waitFor();
});

if (process.env.OFFLINE) {
  await test("without a network", wide, async (page) => {
    await open(page);
    await finished(page);
    const hash = await page.locator(".status .hash").textContent();
    await page.evaluate(() => navigator.serviceWorker.ready);
    await page.waitForTimeout(1500);
    await page.context().setOffline(true);
    await page.reload();
    await finished(page);
    if ((await page.locator(".status .hash").textContent()) !== hash) throw new Error("another hash");
  });
}

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
for (const colorScheme of ["light", "dark"]) {
  for (const hash of ["#/viewer", "#/lecture/sphere", "#/lecture/shadow"]) {
    await test(`accessible ${hash.slice(2)} ${colorScheme}`, { ...wide, colorScheme }, async (page) => {
      await open(page, hash);
      if (hash === "#/viewer") {
        await finished(page);
        const box = await page.locator(".picture canvas").boundingBox();
        await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
        await page.waitForSelector(".tree .term");
      } else await page.waitForSelector(".equation .numbers");
      await page.evaluate(axe);
      const { violations } = await page.evaluate(() =>
        window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa"] }),
      );
      const told = violations.map(
        ({ id, nodes }) => `${id}: ${nodes.map((node) => node.html.slice(0, 90)).join(" | ")}`,
      );
      if (told.length > 0) throw new Error(told.join("\n"));
    });
  }
}

await browser.close();
process.exit(failed === 0 ? 0 : 1);
