/** Links, examples, models, and times without a network. */
import { finished, open, scenes, shot, shown, test, wide } from "./harness.mjs";

await test("a link holds the scene", wide, async (page) => {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await open(page);
  await shown(page);
  const text = await page.locator(".cm-content").textContent();
  await page.getByRole("button", { name: "Copy link" }).click();
  await page.getByRole("button", { name: "Link copied" }).waitFor();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  await page.goto("about:blank");
  await page.goto(link);
  await page.waitForFunction((wanted) => document.querySelector(".cm-content")?.textContent === wanted, text);
});

await test("a link names files of the site, and of no other", wide, async (page) => {
  const scene =
    "PerspectiveCamera { center 0 0 5 direction 0 0 -1 up 0 1 0 angle 30 }\nGroup { TriangleMesh { obj_file meshes/cube.obj } }\n";
  await page.route("**/site/cube.txt", (route) => route.fulfill({ body: scene }));
  await page.route("**/site/meshes/cube.obj", (route) => route.fulfill({ path: `${scenes}meshes/cube.obj` }));
  await open(page, "#/open/site/cube.txt,site/meshes/cube.obj");
  await page.waitForFunction(() => document.querySelector(".file")?.textContent?.startsWith("cube.txt"));
  await shown(page);
  const findings = (await page.locator(".findings li").allTextContents()).join("\n");
  if (findings.includes("cube.obj")) throw new Error(findings);
  // Another link is opened in the same page.
  await page.evaluate(() => {
    location.hash = "#/open/https://example.com/gone.txt";
  });
  const notice = await page.getByRole("alert").textContent();
  if (!notice?.includes("https://example.com/gone.txt: only files of this site"))
    throw new Error(`${notice}`);
  if (!(await page.locator(".file").textContent())?.startsWith("cube.txt")) throw new Error("another scene");
});

await test("an example, a term, its line and its numbers", wide, async (page) => {
  await open(page);
  await shown(page);
  await page.getByLabel("Examples").selectOption("sphere.txt");
  await page.waitForFunction(() =>
    document.querySelector(".cm-content")?.textContent?.includes("first picture"),
  );
  await shown(page);
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
  await shown(page);
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
  await shown(page);
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
