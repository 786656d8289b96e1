/** Image, text, explanation and settings. */
import { finished, middle, narrow, open, scenes, shot, shown, test, wide } from "./harness.mjs";

for (const [width, size] of [
  ["wide", wide],
  ["middle", middle],
  ["narrow", narrow],
]) {
  for (const colorScheme of ["light", "dark"]) {
    await test(`viewer ${width} ${colorScheme}`, { ...size, colorScheme }, async (page) => {
      await open(page);
      await shown(page);
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
  await page.waitForFunction((old) => {
    const hash = document.querySelector(".status .hash")?.textContent;
    return hash && hash !== old;
  }, before);
});

await test("an error is underlined and mended", wide, async (page) => {
  await open(page);
  await shown(page);
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
  await shown(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
  await page.getByRole("tab", { name: "Step by step" }).click();
  await page.waitForSelector(".stepper .code");
  for (let i = 0; i < 6; i++) await page.getByRole("button", { name: "Next", exact: true }).click();
  await shot(page, "steps");
});

await test("a row and the entire image, step by step", wide, async (page) => {
  await open(page);
  await shown(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
  await page.getByRole("tab", { name: "Step by step" }).click();
  await page.getByRole("button", { name: "Its row" }).click();
  await page.waitForSelector(".picture .unseen");
  await page.waitForFunction(() =>
    /is the closest, at t = /.test(document.querySelector(".sentence")?.textContent ?? ""),
  );
  await page.waitForTimeout(2500);
  await shot(page, "steps-row");
  await page.getByRole("button", { name: "The entire image" }).click();
  await page.getByRole("button", { name: "Pause" }).click();
  await page.getByLabel("Row of the image").fill("200");
  const words = /^row 200: (\d+) rays, (\d+) hit something, (\d+) the background$/;
  await page.waitForFunction(
    (source) => new RegExp(source).test(document.querySelector(".sentence")?.textContent ?? ""),
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
  // The number shown in the pixel is that of its explanation.
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
  await shown(page);
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
  await page.waitForFunction(() => /left/.test(document.querySelector(".status")?.textContent ?? ""));
  await page.getByLabel("Samples").fill("4");
  await page.getByLabel("Samples").blur();
  await finished(page);
  await page.waitForFunction(() => /error 0\.\d+/.test(document.querySelector(".status")?.textContent ?? ""));
  const hash = await page.locator(".status .hash").textContent();
  await page.getByRole("switch", { name: "Denoise the finished image" }).click();
  await page.waitForFunction(() => /denoised/.test(document.querySelector(".status")?.textContent ?? ""));
  if ((await page.locator(".status .hash").textContent()) !== hash) throw new Error("another hash");
  await shot(page, "denoised");
});

await test("settings", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await page.getByRole("tab", { name: "Normals", exact: true }).click();
  // The image changes from red, yellow and blue to the colour of upward normals.
  await page.waitForFunction(() => {
    const canvas = document.querySelector(".picture canvas");
    const [r, g, b] = canvas
      .getContext("2d")
      .getImageData(0.1 * canvas.width, 0.98 * canvas.height, 1, 1).data;
    return g > 200 && r < 160 && b < 160;
  });
  await shot(page, "settings");
});

await test("the camera is written into the text", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await page.locator(".picture canvas").focus();
  await page.keyboard.press("ArrowLeft");
  await page.getByRole("button", { name: "Write into the scene" }).click();
  await page.waitForFunction(
    () => !document.querySelector(".cm-content")?.textContent?.includes("center 0 1.7 9"),
  );
  await page.getByRole("button", { name: "Write into the scene", disabled: true }).waitFor();
});

await test("a term, its ray, its line and its object are shown together", wide, async (page) => {
  await open(page);
  await shown(page);
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
  // The text shows the line of the object.
  await page.waitForFunction(() =>
    document.querySelector(".cm-activeLine")?.textContent?.includes("center -0.75"),
  );
  await page.locator(".tree .title", { hasText: "Mirrored ray hits Plane" }).first().hover();
  await page.waitForFunction(() => document.querySelector(".cm-marked")?.textContent?.includes("Plane {"));
  const length = await page
    .locator(".overlay line")
    .last()
    .evaluate((line) => line.getTotalLength());
  if (!(length > 50)) throw new Error(`the ray in the image is ${length} long`);
  await shot(page, "hover");
  // The image outlines the object at the cursor, and changes with the text.
  await page.locator(".cm-line", { hasText: "center 1.15" }).click();
  await page.waitForSelector(".overlay .outline");
  await shot(page, "outline");
  const color = () => page.locator("header.pixel p").textContent();
  const before = await color();
  await page.locator(".cm-line", { hasText: "center -0.75" }).click();
  await page.keyboard.press("End");
  for (let i = 0; i < 6; i++) await page.keyboard.press("Backspace");
  await page.keyboard.type("0.2 }");
  await page.waitForFunction((old) => document.querySelector("header.pixel p").textContent !== old, before);
});
