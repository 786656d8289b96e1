/** Figures, their numbers, and slides. */
import { middle, narrow, open, shot, test, topics, wide } from "./harness.mjs";

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
      if (!(await handles.nth(i).evaluate((handle) => handle === document.activeElement)))
        throw new Error(`handle ${i} cannot be focused`);
      for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowLeft");
      await page
        .waitForFunction((old) => document.querySelector(".equations").textContent !== old, before)
        .catch(() => {
          throw new Error(`handle ${i} changes no number`);
        });
    }
    if (!page.url().endsWith(`/${topic}`)) throw new Error("a handle's key turned the page");
    const mistake = page.getByRole("switch", { name: /^Common mistake/ });
    if ((await mistake.count()) > 0) {
      const before = await page.locator(".figure").innerHTML();
      await mistake.click();
      await page.waitForFunction((old) => document.querySelector(".figure").innerHTML !== old, before);
    }
  });
}

/** Waits until the equations of a figure match, and returns the captured numbers. */
async function told(page, pattern) {
  const found = await page.waitForFunction(
    (source) => new RegExp(source).exec(document.querySelector(".equations")?.textContent ?? "")?.slice(1),
    pattern.source,
  );
  const texts = await found.jsonValue();
  return texts.map((text) => Number(text.replaceAll(",", "").replace("−", "-")));
}
const near = (a, b, error, what) => {
  if (!(Math.abs(a - b) <= error)) throw new Error(`${what}: ${a} instead of ${b}`);
};

await test("numbers: homogeneous", wide, async (page) => {
  await open(page, "#/lecture/homogeneous");
  near((await told(page, /\/ 2\.00 = ([\d.]+)/))[0], 0.8, 1e-9, "1.6 / 2");
  await page.getByRole("slider", { name: "move by" }).fill("1");
  // The ray is cast in the background, so the old quotient is shown for a moment.
  await told(page, /3\.60 \/ 2\.00 = 1\.800?\D/);
  await page.getByRole("button", { name: "Direction: w = 0" }).click();
  await page.waitForFunction(() =>
    /It is a direction/.test(document.querySelector(".equations")?.textContent ?? ""),
  );
});

await test("numbers: obscura", wide, async (page) => {
  await open(page, "#/lecture/obscura");
  const [wanted, passed, all, spot] = await told(
    page,
    /z\) = (\d+\.\d{3})(\d+) of (\d+) rays.*spot ([\d.]+) high/,
  );
  if (!(passed > 0 && passed < all)) throw new Error(`${passed} of ${all}`);
  // The rays are spaced by a tenth of the hole's radius.
  if (!(spot <= wanted && spot > 0.7 * wanted)) throw new Error(`spot ${spot}, ${wanted} at most`);
});

await test("numbers: cameras", wide, async (page) => {
  await open(page, "#/lecture/cameras");
  const [columns, rows, there] = await told(page, /of (\d+) × (\d+) pixels, (\d+) have a ray/);
  // The rays fill a disc in a square.
  near(there / (columns * rows), Math.PI / 4, 0.06, "share of the disc");
  await page.getByRole("button", { name: "Two eyes" }).click();
  near((await told(page, /they start at (\d+) points/))[0], 2, 0, "eyes");
});

await test("numbers: epsilon", wide, async (page) => {
  await open(page, "#/lecture/epsilon");
  const wrong = () => told(page, /([\d,]+) of 76,800 pixels are wrong/).then(([count]) => count);
  await page.waitForTimeout(2500);
  if (!((await wrong()) > 20)) throw new Error(`only ${await wrong()} wrong pixels without an epsilon`);
  await page.getByRole("slider", { name: "epsilon" }).fill("75");
  await page.waitForFunction(
    () => /light leaks/.test(document.querySelector(".equations")?.textContent ?? ""),
    null,
  );
  await shot(page, "epsilon-leaks");
  await page.getByRole("switch", { name: "Exact origins, no epsilon" }).click();
  await page.waitForFunction(
    () => /(^|\D)0 of 76,800/.test(document.querySelector(".equations")?.textContent ?? ""),
    null,
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
      Number(/(\d+) of [\d,]+ photons/.exec(document.querySelector(".equations")?.textContent ?? "")?.[1]) >
      2 * old,
    few,
  );
});

await test("numbers: mistakes", wide, async (page) => {
  await open(page, "#/lecture/sphere");
  const [b, a, c] = await told(page, /\(?(−?[\d.]+)\)?² − 4 · ([\d.]+) · \(?(−?[\d.]+)/);
  await page.getByRole("switch", { name: /^Common mistake/ }).click();
  const [t] = await told(page, /(\d\.\d{3}) and \d+\.\d{3}: not on the sphere/);
  near(t, (-b - Math.sqrt(b * b - 4 * c)) / 2, 0.02, `root for a = 1 instead of ${a}`);
  await open(page, "#/lecture/camera");
  await told(page, /1 \/ tan 23° = ([\d.]+)/);
  await page.getByRole("switch", { name: /^Common mistake/ }).click();
  near((await told(page, /1 \/ tan 46° = (0\.\d+)/))[0], 1 / Math.tan((46 * Math.PI) / 180), 1e-4, "D");
  await open(page, "#/lecture/shadow");
  // The ball occludes the light, and is tested before the last of three objects.
  const counts = /any hit: (\d+) tests?, closest hit: ([1-9]\d*) tests?/;
  const [any, all] = await told(page, counts);
  if (any !== 2 || all !== 3) throw new Error(`${any} and ${all} tests`);
  // A ray that nothing occludes is tested against all objects in both cases.
  const point = page.getByRole("button", { name: /^The point on the floor/ });
  await point.focus();
  for (let i = 0; i < 8; i++) await page.keyboard.press("Shift+ArrowRight");
  await told(page, /the light is (visible)/);
  const [free] = await told(page, /any hit: (\d+) tests, closest hit: 3 tests/);
  near(free, 3, 0, "tests of a ray that reaches the light");
});

await test("numbers: interpolation", wide, async (page) => {
  await open(page, "#/lecture/triangle");
  const [, beta, gamma] = await told(page, /α = ([\d.]+), β = ([\d.]+), γ = ([\d.]+)/);
  for (const name of ["Normals", "u, v"]) await page.getByRole("button", { name, exact: true }).click();
  const [u, v] = await told(page, /\(u, v\) = \(([\d.]+), ([\d.]+)\)/);
  near(u, beta, 0.006, "u");
  near(v, gamma, 0.006, "v");
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
  // Keys turn the page even if a switch or a slider has the focus.
  await page.getByRole("switch", { name: /^Common mistake/ }).click();
  await page.keyboard.press("q");
  await page.getByRole("button", { name: /all three weights equal/ }).click();
  await page.waitForSelector(".answer");
  await page.keyboard.press("PageDown");
  await page.waitForFunction(() => document.querySelector("h1")?.textContent === "Transforms");
  await page.waitForSelector(".equation .numbers");
  const sizes = await page.evaluate(() =>
    [".lead", ".equation .symbols", ".equation .numbers"].map(
      (name) => Number.parseFloat(getComputedStyle(document.querySelector(name)).fontSize) / innerHeight,
    ),
  );
  // The last row reads letters of 1/40 of the height of the screen.
  if (Math.min(...sizes) < 1 / 40) throw new Error(`small letters: ${sizes}`);
  const { height, fits } = await page.evaluate(() => {
    const chapter = document.querySelector(".chapter");
    return { height: chapter.scrollHeight, fits: chapter.scrollHeight <= chapter.clientHeight + 1 };
  });
  if (!fits) throw new Error(`the slide is ${height} high`);
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

// This address serves `durer lesson web/tests/lesson/monday.md`.
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
    await page.waitForFunction(() => /Diffuse/.test(document.querySelector(".account")?.textContent ?? ""));
    await shot(page, "lesson-2");
    await page.getByRole("link", { name: "Its normals" }).click();
    await page.getByRole("heading", { name: "Its normals" }).waitFor();
    await page.waitForTimeout(1500);
    await shot(page, "lesson-3");
  });
}
