/** Fields of cameras and materials, and the tree of a model. */
import { open, scenes, shot, shown, test, wide } from "./harness.mjs";

const text = (page) => page.locator(".cm-content").textContent();

await test("the kind of the camera and a word are changed", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  const camera = page.getByRole("region", { name: "Camera" });
  await camera.getByLabel("Kind").selectOption("FisheyeCamera");
  const projection = camera.getByLabel("projection");
  await projection.selectOption("stereographic");
  await camera.getByRole("button", { name: "Write into the scene" }).click();
  await page.waitForFunction(() =>
    /FisheyeCamera \{[^}]*projection stereographic/.test(document.querySelector(".cm-content").textContent),
  );
  if (!/center 0 1\.7 9/.test(await text(page))) throw new Error("the camera has moved");
  if ((await projection.inputValue()) !== "stereographic") throw new Error("another word is selected");
  // Straight lines are not straight in this image, so nothing is drawn over it.
  const box = await page.locator(".picture canvas").boundingBox();
  await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
  await page.waitForSelector(".tree .term");
  if ((await page.locator(".overlay line").count()) > 0)
    throw new Error("a straight ray in a fisheye's image");
  await shot(page, "fisheye");
  await page.getByRole("tab", { name: "Camera and render" }).click();
  await camera.getByLabel("Kind").selectOption("PerspectiveCamera");
  await camera.getByLabel("angle").waitFor();
  await page.waitForFunction(() => document.querySelectorAll(".overlay line").length > 0);
});

await test("an angle stops before a bound that is no value itself", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByRole("tab", { name: "Camera and render" }).click();
  const angle = page.getByRole("region", { name: "Camera" }).getByLabel("angle");
  await angle.focus();
  await page.keyboard.press("End");
  await page.waitForFunction(() => document.querySelector(".settings output")?.textContent === "179.5");
  await page.keyboard.press("Home");
  await page.waitForFunction(() => document.querySelector(".settings output")?.textContent === "0.5");
  if ((await page.getByRole("alert").count()) > 0) throw new Error("the value was refused");
});

await test("an object of a model is found in the tree and in the image", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
  await page.waitForSelector(".things li");
  const opened = () => page.locator('.things [aria-expanded="false"]').first();
  while ((await opened().count()) > 0) await opened().click();
  const leaf = page.locator(".things button:not([aria-expanded])").first();
  await leaf.click();
  await page.waitForSelector(".things [aria-current]");
  await page.waitForSelector(".overlay .outline", { state: "attached" });
  // Open the model again: the tree is folded, and a click into the image unfolds it.
  await page.setInputFiles('input[type="file"]', []);
  await page.setInputFiles('input[type="file"]', `${scenes}meshes/knot.ply`);
  await page.waitForSelector(".things [aria-current]", { state: "detached" });
  await shown(page);
  const box = await page.locator(".picture .frame").boundingBox();
  await page.waitForFunction(() => {
    const canvas = document.querySelector(".picture canvas");
    return canvas && canvas.width > 1;
  });
  for (const [x, y] of [
    [0.5, 0.5],
    [0.4, 0.4],
    [0.6, 0.6],
    [0.5, 0.3],
  ]) {
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await page.waitForSelector("header.pixel");
    await page.waitForTimeout(600);
    if ((await page.locator(".things [aria-current]").count()) > 0) break;
  }
  await page.locator(".things [aria-current]").waitFor();
  // Only objects that are selected in the tree are outlined.
  if ((await page.locator(".overlay .outline").count()) > 0)
    throw new Error("outlined by a click on a pixel");
  await shot(page, "model-tree");
});
