/** Common mistakes in the viewer and in the lecture. */
import { narrow, open, shot, shown, test, wide } from "./harness.mjs";

/** Returns the mean difference of two canvases, 0 to 255. */
const difference = (page) =>
  page.evaluate(() => {
    const [a, b] = [...document.querySelectorAll(".comparison canvas")].map(
      (canvas) => canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data,
    );
    let sum = 0;
    for (let i = 0; i < a.length; i++) sum += Math.abs(a[i] - b[i]);
    return sum / a.length;
  });
const told = async (page) => {
  await page.waitForFunction(() => document.querySelectorAll(".comparison canvas").length === 2);
  return (await page.locator(".comparison strong").textContent()).trim();
};

for (const [name, size] of [
  ["wide", wide],
  ["narrow dark", { ...narrow, colorScheme: "dark" }],
]) {
  await test(`mistakes in the viewer ${name}`, size, async (page) => {
    await open(page);
    await shown(page);
    await page.getByRole("tab", { name: "Common mistakes" }).click();
    // Topics are folded at first.
    const topic = page.getByRole("button", { name: /^Shadows \d+$/ });
    await topic.click();
    const mistake = page.getByRole("button", { name: "there are no shadows", exact: true });
    await mistake.waitFor();
    await topic.click();
    await mistake.waitFor({ state: "detached" });
    // The keyboard alone finds one and shows it.
    await page.getByLabel("Search mistakes").focus();
    await page.keyboard.type("no shadows");
    await page.waitForFunction(() =>
      /^\d of \d{3} mistakes$/.test(document.querySelector(".mistakes [role=status]").textContent),
    );
    await mistake.focus();
    await page.keyboard.press("Enter");
    const words = await told(page);
    if (!/^\d+ % of the pixels differ$/.test(words)) throw new Error(words);
    if (!((await difference(page)) > 1)) throw new Error("both pictures are the same");
    await shot(page, `mistakes-${name.replace(" ", "-")}`);
    // A mistake that the scene does not show.
    await page.getByLabel("Search mistakes").fill("noise has");
    await page.getByRole("button", { name: /^noise has/ }).click();
    const none = await told(page);
    if (none !== "No pixel differs in this scene") throw new Error(none);
  });
}

await test("a value of a mistake is selected", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByRole("tab", { name: "Common mistakes" }).click();
  await page.getByLabel("Search mistakes").fill("ambient light is multiplied");
  await page.getByRole("button", { name: /^the ambient light is multiplied by \d/ }).click();
  await told(page);
  const before = await difference(page);
  const values = page.locator(".comparison select");
  await values.selectOption({ index: 1 });
  await page.locator(".comparison p", { hasText: /^the ambient light is multiplied by/ }).waitFor();
  await told(page);
  await page.waitForFunction(() => document.querySelector(".comparison strong"));
  if ((await difference(page)) === before) throw new Error("both values give the same picture");
});

await test("a mistake in the lecture is rendered by the library", wide, async (page) => {
  await open(page, "#/lecture/normals");
  await page.waitForSelector(".equation .numbers");
  const mistake = page.getByRole("switch", { name: /^Common mistake: transform normals/ });
  await mistake.click();
  await page.waitForSelector("canvas.instead");
  await page.waitForFunction(() =>
    /N = normalize\(M n\)\s*\d+ % of the pixels differ/.test(
      document.querySelector(".equation .wrong")?.textContent,
    ),
  );
  await shot(page, "lecture-normals-mistake");
  // Without shear and squash, both normals agree.
  await page.getByRole("slider", { name: "shear" }).fill("0");
  await page.getByRole("slider", { name: "squash" }).fill("1");
  await page.waitForFunction(() =>
    /No pixel differs|Less than/.test(document.querySelector(".equation .wrong")?.textContent),
  );
  await mistake.click();
  await page.waitForSelector("canvas.instead", { state: "detached" });
});

await test("a mistake of one's own scene", wide, async (page) => {
  await open(page, "#/lecture/own");
  await page.waitForSelector(".equation .numbers");
  const mistake = page.getByRole("switch", { name: /^Common mistake/ });
  if ((await mistake.count()) > 0) throw new Error("a picture of distances has no mistake");
  await page.getByRole("button", { name: "Light", exact: true }).click();
  await mistake.click();
  await page.waitForFunction(() =>
    /\d+ % of the pixels differ/.test(document.querySelector(".equation .wrong")?.textContent),
  );
  await page.getByRole("button", { name: "Normals", exact: true }).click();
  await page.waitForSelector("canvas.instead", { state: "detached" });
});
