/** Screens of the viewer and the lecture, by axe. */
import { check } from "./axe.mjs";
import { narrow, open, scenes, shown, test, topics, wide } from "./harness.mjs";

/** Explains a pixel of the glass sphere. */
async function explain(page) {
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.42 * box.height);
  await page.waitForSelector(".tree .term");
}

/** Screens of the viewer, and how to reach them. */
const screens = {
  explain,
  async steps(page) {
    await explain(page);
    await page.getByRole("tab", { name: "Step by step" }).click();
    await page.waitForSelector(".stepper .code");
  },
  async settings(page) {
    await page.getByRole("tab", { name: "Camera and render" }).click();
  },
  async mistakes(page) {
    await page.getByRole("tab", { name: "Common mistakes" }).click();
    await page.getByLabel("Search mistakes").fill("no shadows");
    await page.getByRole("button", { name: "there are no shadows" }).click();
    await page.waitForSelector(".comparison strong");
  },
  async model(page) {
    await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
    await page.waitForSelector(".materials li", { state: "attached" });
    if (!(await page.locator(".materials").isVisible()))
      await page.getByRole("tab", { name: "Scene" }).click();
    await page.locator(".materials button").first().click();
  },
};

for (const [width, size] of [
  ["wide", wide],
  ["narrow", narrow],
]) {
  for (const colorScheme of ["light", "dark"]) {
    await test(`accessible viewer ${width} ${colorScheme}`, { ...size, colorScheme }, async (page) => {
      for (const [name, reach] of Object.entries(screens)) {
        await page.goto("about:blank");
        await open(page);
        await shown(page);
        await reach(page);
        await check(page).catch((error) => {
          throw new Error(`${name}: ${error.message}`);
        });
      }
    });
    await test(`accessible lecture ${width} ${colorScheme}`, { ...size, colorScheme }, async (page) => {
      for (const topic of topics) {
        await open(page, `#/lecture/${topic}`);
        await page.waitForSelector(".equation .numbers");
        await check(page).catch((error) => {
          throw new Error(`${topic}: ${error.message}`);
        });
      }
    });
  }
}

await test("accessible slides", wide, async (page) => {
  await open(page, "#/lecture/sphere");
  await page.waitForSelector(".equation .numbers");
  await page.keyboard.press("p");
  await page.keyboard.press("q");
  await page.waitForSelector(".questions", { state: "visible" });
  await check(page);
});
