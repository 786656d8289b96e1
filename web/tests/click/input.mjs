/** The keyboard alone, and touch. */
import { finished, middle, narrow, open, shot, test, wide } from "./harness.mjs";

/** Presses Tab until an element that matches has the focus. */
async function tabTo(page, selector) {
  for (let i = 0; i < 80; i++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate((wanted) => document.activeElement?.matches(wanted), selector)) return;
  }
  throw new Error(`Tab does not reach ${selector}`);
}

await test("the viewer with the keyboard alone", wide, async (page) => {
  await open(page);
  await finished(page);
  const hash = await page.locator(".status .hash").textContent();
  // In the editor, Tab indents; Escape and Tab leave it.
  await page.locator(".bar a").first().focus();
  await tabTo(page, ".cm-content");
  await page.keyboard.press("Escape");
  await tabTo(page, ".picture canvas");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".tree .term");
  const pixel = () => page.locator("header.pixel strong").textContent();
  const before = await pixel();
  await page.keyboard.press("l");
  await page.waitForFunction(
    (old) => document.querySelector("header.pixel strong").textContent !== old,
    before,
  );
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((old) => {
    const now = document.querySelector(".status .hash")?.textContent;
    return now && now !== old;
  }, hash);
  await page.keyboard.press("h");
  await page.waitForFunction((old) => document.querySelector(".status .hash")?.textContent === old, hash);
  await tabTo(page, ".tree .title");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".tree .detail");
  await tabTo(page, ".test");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".tests .rows");
});

await test("the lecture with the keyboard alone", wide, async (page) => {
  await open(page, "#/lecture/sphere");
  await page.waitForSelector(".equation .numbers");
  await tabTo(page, ".handle");
  const numbers = await page.locator(".equations").textContent();
  for (let i = 0; i < 4; i++) await page.keyboard.press("ArrowUp");
  await page.waitForFunction((old) => document.querySelector(".equations").textContent !== old, numbers);
  await tabTo(page, ".question button");
  await page.keyboard.press("Enter");
  await page.waitForSelector(".answer");
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("h1")?.textContent === "Triangle");
});

/** Moves fingers over the page, each from one position to another. */
async function drag(page, fingers) {
  const client = await page.context().newCDPSession(page);
  const send = (type, share) =>
    client.send("Input.dispatchTouchEvent", {
      type,
      touchPoints:
        share === null
          ? []
          : fingers.map(([[x1, y1], [x2, y2]], id) => ({
              x: x1 + share * (x2 - x1),
              y: y1 + share * (y2 - y1),
              id,
            })),
    });
  await send("touchStart", 0);
  for (let i = 1; i <= 10; i++) await send("touchMove", i / 10);
  await send("touchEnd", null);
}

for (const [name, size] of [
  ["narrow", narrow],
  ["middle", { ...middle, hasTouch: true }],
]) {
  await test(`touch ${name}`, size, async (page) => {
    await open(page);
    await finished(page);
    const hash = () => page.locator(".status .hash").textContent();
    const changed = (old) =>
      page.waitForFunction(
        (before) => ![undefined, before].includes(document.querySelector(".status .hash")?.textContent),
        old,
      );
    const box = await page.locator(".picture canvas").boundingBox();
    const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
    await page.touchscreen.tap(...at(0.4, 0.42));
    await page.waitForSelector(".tree .term");
    let before = await hash();
    await drag(page, [[at(0.5, 0.5), at(0.7, 0.5)]]);
    await changed(before);
    before = await hash();
    await drag(page, [
      [at(0.45, 0.5), at(0.25, 0.5)],
      [at(0.55, 0.5), at(0.75, 0.5)],
    ]);
    await changed(before);
    await shot(page, `touch-${name}`);
    await open(page, "#/lecture/sphere");
    await page.waitForSelector(".equation .numbers");
    const numbers = await page.locator(".equations").textContent();
    const handle = await page.locator(".handle").first().boundingBox();
    const from = [handle.x + handle.width / 2, handle.y + handle.height / 2];
    await drag(page, [[from, [from[0] - 30, from[1] + 20]]]);
    await page.waitForFunction((old) => document.querySelector(".equations").textContent !== old, numbers);
  });
}
