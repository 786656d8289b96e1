/** Names and contrast, by axe. */
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { finished, open, test, wide } from "./harness.mjs";

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
