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

const scenes = new URL("../../scenes/", import.meta.url).pathname;
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

await test("a row and the whole picture, step by step", wide, async (page) => {
  await open(page);
  await finished(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
  await page.getByRole("tab", { name: "Step by step" }).click();
  await page.getByRole("button", { name: "Its row" }).click();
  await page.waitForSelector(".picture .unseen");
  await page.waitForFunction(() =>
    /is the closest, at t = /.test(document.querySelector(".sentence").textContent),
  );
  await page.waitForTimeout(2500);
  await shot(page, "steps-row");
  await page.getByRole("button", { name: "The whole picture" }).click();
  await page.getByRole("button", { name: "Pause" }).click();
  await page.getByLabel("Row of the picture").fill("200");
  const words = /^row 200: (\d+) rays, (\d+) hit something, (\d+) the background$/;
  await page.waitForFunction(
    (source) => new RegExp(source).test(document.querySelector(".sentence").textContent),
    words.source,
  );
  const [, rays, hits, misses] = words.exec(await page.locator(".sentence").textContent()).map(Number);
  const columns = Number(/(\d+) ×/.exec(await page.locator(".status").textContent())[1]);
  if (rays !== columns || hits + misses !== rays || hits === 0) throw new Error(`${rays} ${hits} ${misses}`);
  await shot(page, "steps-picture");
});

await test("the picture is seen down to its pixels and their numbers", wide, async (page) => {
  await open(page);
  await finished(page);
  const hash = await page.locator(".status .hash").textContent();
  const box = await page.locator(".picture .frame").boundingBox();
  await page.mouse.click(box.x + 0.42 * box.width, box.y + 0.42 * box.height);
  await page.waitForSelector(".tree .term");
  for (let i = 0; i < 9 && (await page.getByRole("button", { name: "Larger" }).isEnabled()); i++)
    await page.getByRole("button", { name: "Larger" }).click();
  await page.waitForSelector(".cell");
  await finished(page);
  await page.waitForTimeout(400);
  // The number in the pixel is the one that its explanation has.
  const [, x, y] = /Pixel (\d+), (\d+)/.exec(await page.locator("header.pixel").textContent());
  const cell = page.locator(".cell", { hasText: `${x}, ${y}` }).first();
  const shown = await cell.locator("b").allTextContents();
  const told = (await page.locator("header.pixel p").textContent()).trim().split(/\s+/);
  for (let i = 0; i < shown.length; i++)
    if (Math.abs(Number(shown[i]) - Number(told[i])) > 0.006 * Math.abs(Number(told[i])) + 1e-5)
      throw new Error(`${shown} ${told}`);
  await shot(page, "pixels");
  await page.getByRole("button", { name: "Whole" }).click();
  await page.waitForFunction(
    (wanted) => document.querySelector(".status .hash")?.textContent === wanted,
    hash,
  );
});

await test("boxes of the tree in space", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
  await page.waitForSelector(".things li");
  await page.getByRole("tab", { name: "Explain" }).first().click();
  await page.getByRole("switch", { name: "Boxes of the tree" }).click();
  await page.waitForSelector(".boxes output");
  const count = () => page.locator(".boxes output").textContent();
  const first = await count();
  await page.getByLabel("level").fill("3");
  await page.waitForFunction((old) => document.querySelector(".boxes output").textContent !== old, first);
  const boxes = Number(/: (\d+) box/.exec(await count())[1]);
  if (!(boxes > 8)) throw new Error(`${boxes} boxes`);
  await shot(page, "boxes");
});

await test("denoised, and noise and time are told", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.getByLabel("Examples").selectOption("cornell-box.txt");
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await page.waitForFunction(() => /left/.test(document.querySelector(".status").textContent), null, {
    timeout: 60_000,
  });
  await page.getByLabel("Samples").fill("4");
  await page.getByLabel("Samples").blur();
  await finished(page);
  await page.waitForFunction(() => /error 0\.\d+/.test(document.querySelector(".status").textContent));
  const hash = await page.locator(".status .hash").textContent();
  await page.getByRole("switch", { name: "Denoise the finished picture" }).click();
  await page.waitForFunction(() => /denoised/.test(document.querySelector(".status").textContent), null, {
    timeout: 60_000,
  });
  if ((await page.locator(".status .hash").textContent()) !== hash) throw new Error("another hash");
  await shot(page, "denoised");
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
  "machine,ray,pinhole,obscura,camera,projection,cameras,homogeneous,plane,sphere,triangle,transform,normals,solids,epsilon,shading,shadow,mirror,glass,samples,structures,paths,caustics,own"
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

/** The words of a figure's equations. */
const equations = (page) => page.locator(".equations").textContent();
/** The number that a figure's words hold, once they do. */
async function told(page, pattern) {
  await page.waitForFunction(
    (source) => new RegExp(source).test(document.querySelector(".equations").textContent),
    pattern.source,
    { timeout: 60_000 },
  );
  return pattern
    .exec(await equations(page))
    .slice(1)
    .map((text) => Number(text.replaceAll(",", "").replace("−", "-")));
}
const near = (a, b, error, what) => {
  if (!(Math.abs(a - b) <= error)) throw new Error(`${what}: ${a} instead of ${b}`);
};

await test("numbers: homogeneous", wide, async (page) => {
  await open(page, "#/lecture/homogeneous");
  near((await told(page, /2\.00 = ([\d.]+)/))[0], 0.8, 1e-9, "1.6 / 2");
  await page.getByRole("slider", { name: "move by" }).fill("1");
  near((await told(page, /3\.60 \/ 2\.00 = ([\d.]+)/))[0], 1.8, 1e-9, "moved");
  await page.getByRole("button", { name: "Direction: w = 0" }).click();
  await page.waitForFunction(() =>
    /It is a direction/.test(document.querySelector(".equations").textContent),
  );
});

await test("numbers: obscura", wide, async (page) => {
  await open(page, "#/lecture/obscura");
  const [wanted, passed, all, spot] = await told(
    page,
    /z\) = (\d+\.\d{3})(\d+) of (\d+) rays.*spot ([\d.]+) high/,
  );
  if (!(passed > 0 && passed < all)) throw new Error(`${passed} of ${all}`);
  // Rays that pass are a tenth of the hole's radius apart.
  if (!(spot <= wanted && spot > 0.7 * wanted)) throw new Error(`spot ${spot}, ${wanted} at most`);
});

await test("numbers: cameras", wide, async (page) => {
  await open(page, "#/lecture/cameras");
  const [columns, rows, there] = await told(page, /of (\d+) × (\d+) rays, (\d+) exist/);
  // A disc in a square.
  near(there / (columns * rows), Math.PI / 4, 0.06, "share of the disc");
  await page.getByRole("button", { name: "Two eyes" }).click();
  near((await told(page, /they start at (\d+) places/))[0], 2, 0, "eyes");
});

await test("numbers: epsilon", wide, async (page) => {
  await open(page, "#/lecture/epsilon");
  const wrong = () => told(page, /([\d,]+) of 76,800 pixels are wrong/).then(([count]) => count);
  await page.waitForTimeout(2500);
  if (!((await wrong()) > 500)) throw new Error(`only ${await wrong()} wrong pixels without an epsilon`);
  await page.getByRole("slider", { name: "epsilon" }).fill("75");
  await page.waitForFunction(
    () => /light leaks/.test(document.querySelector(".equations").textContent),
    null,
    { timeout: 30_000 },
  );
  await shot(page, "epsilon-leaks");
  await page.getByRole("switch", { name: "Exact starts, no epsilon" }).click();
  await page.waitForFunction(
    () => /(^|\D)0 of 76,800/.test(document.querySelector(".equations").textContent),
    null,
    { timeout: 30_000 },
  );
});

await test("numbers: structures", wide, async (page) => {
  await open(page, "#/lecture/structures");
  const [every, grid, tree] = await told(page, /Every object: (\d+).*Grid: (\d+).*Tree of boxes: (\d+)/);
  near(every, 96, 0, "tests of all objects");
  if (!(grid < 48 && tree < 48)) throw new Error(`${grid} ${tree}`);
});

await test("numbers: caustics", wide, async (page) => {
  await open(page, "#/lecture/caustics");
  const [few] = await told(page, /(\d+) of [\d,]+ photons within/);
  await page.getByRole("slider", { name: "radius" }).fill("0.2");
  await page.waitForFunction(
    (old) =>
      Number(/(\d+) of [\d,]+ photons/.exec(document.querySelector(".equations").textContent)?.[1]) > 2 * old,
    few,
    { timeout: 60_000 },
  );
});

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

for (const topic of (process.env.NARROW ?? "").split(",").filter(Boolean)) {
  for (const [name, size] of [
    ["narrow", narrow],
    ["middle", middle],
    ["large", { viewport: { width: 2560, height: 1440 } }],
  ]) {
    await test(`lecture ${topic} ${name}`, size, async (page) => {
      await open(page, `#/lecture/${topic}`);
      await page.waitForSelector(".equation .numbers");
      await page.waitForTimeout(2500);
      await shot(page, `lecture-${topic}-${name}`);
    });
  }
}

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

await test("a model's material is changed, and it becomes a text", wide, async (page) => {
  await open(page);
  await finished(page);
  await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
  await page.waitForSelector(".materials li");
  await page.locator(".materials button").first().click();
  const color = page.locator('.materials input[type="color"]').first();
  await color.waitFor();
  await color.fill("#c02010");
  await page.waitForFunction(() => {
    const canvas = document.querySelector(".picture canvas");
    const [r, g] = canvas.getContext("2d").getImageData(canvas.width / 2, canvas.height / 2, 1, 1).data;
    return r > 2 * g;
  });
  await shot(page, "model-red");
  const download = page.waitForEvent("download");
  await page.getByRole("button", { name: "Save as scene" }).click();
  if ((await download).suggestedFilename() !== "knot.zip") throw new Error("another name");
  await page.getByRole("button", { name: "Edit as text" }).click();
  await page.waitForFunction(() => /Material/.test(document.querySelector(".cm-content")?.textContent ?? ""));
});

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

// `durer lesson web/tests/lesson/monday.md` is behind this address.
if (process.env.LESSON) {
  await test("a lesson of one's own", wide, async (page) => {
    await page.goto(process.env.LESSON.split("#")[0] + "#/lesson");
    await page.getByRole("heading", { name: "What a ball looks like" }).waitFor();
    await page.waitForSelector(".equation .numbers");
    await page.getByRole("button", { name: /How many points/ }).click();
    await page.waitForSelector(".answer");
    await shot(page, "lesson-1");
    await page.keyboard.press("Escape");
    await page.getByRole("link", { name: "On a floor" }).click();
    await page.waitForFunction(() =>
      /480 × 480 pixels|\d+ × \d+ pixels/.test(document.querySelector(".equations")?.textContent ?? ""),
    );
    await page.waitForFunction(() => document.querySelectorAll(".account li").length > 0);
    const box = await page.locator(".picks").boundingBox();
    await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.waitForFunction(() => /Diffuse/.test(document.querySelector(".account").textContent));
    await shot(page, "lesson-2");
    await page.getByRole("link", { name: "Its normals" }).click();
    await page.getByRole("heading", { name: "Its normals" }).waitFor();
    await page.waitForTimeout(1500);
    await shot(page, "lesson-3");
  });
}

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
