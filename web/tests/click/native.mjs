/** Compares the page with the command, and edits a file that another program changes. */
import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { open, scenes, shown, test, wide } from "./harness.mjs";

const root = new URL("../../../", import.meta.url).pathname;
const durer = process.env.DURER ?? join(process.env.CARGO_TARGET_DIR ?? join(root, "target"), "debug/durer");
const present = existsSync(durer);
if (!present) console.log(`skipped comparisons with the command: there is no ${durer}`);

/** Returns what each term of `durer explain --json` adds to the pixel. */
function additions(term, scale = [1, 1, 1]) {
  const times = (a, b) => a.map((x, i) => x * b[i]);
  const inner = times(scale, term.scale);
  const own = term.terms.length > 0 ? times(scale, term.value) : times(times(inner, term.factor), term.value);
  return [own, ...term.terms.flatMap((below) => additions(below, inner))];
}
const numbers = (text) =>
  text
    .trim()
    .split(/\s+/)
    .map((x) => Number(x.replace("−", "-")));
const equal = (a, b) => a.every((x, i) => Math.abs(x - b[i]) <= 6e-4 * Math.abs(b[i]) + 1e-5);

if (present) {
  await test("a pixel has the numbers of durer explain", wide, async (page) => {
    await open(page);
    await shown(page);
    await page.getByLabel("Examples").selectOption("sphere.txt");
    await page.waitForFunction(() =>
      /first picture/.test(document.querySelector(".cm-content")?.textContent),
    );
    await shown(page);
    const box = await page.locator(".picture .frame").boundingBox();
    await page.mouse.click(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.waitForSelector(".tree .term");
    const [, x, y] = /Pixel (\d+), (\d+)/.exec(await page.locator("header.pixel strong").textContent());
    const told = JSON.parse(
      execFileSync(durer, ["explain", `${scenes}sphere.txt`, "--pixel", `${x},${y}`, "--json"]),
    ).pixel;
    const color = numbers(await page.locator("header.pixel p").textContent());
    if (!equal(color, told.color)) throw new Error(`${color} instead of ${told.color}`);
    const at = Number(/Sample (\d+)/.exec(await page.locator(".samples span").textContent())[1]) - 1;
    const sample = told.samples.find((known) => known.sample === at);
    const wanted = additions(sample.light).map((adds) =>
      adds.map((x) => (x * sample.weight) / told.samples.length),
    );
    for (let more = page.locator(".more"); (await more.count()) > 0; ) await more.first().click();
    const titles = page.locator(".tree .title");
    let count = 0;
    for (; count < (await titles.count()); count++) {
      await titles.nth(count).click();
      const adds = numbers(await page.locator(".detail .value strong").textContent());
      const found = wanted.some(
        (known) =>
          equal(adds, known) ||
          equal(
            adds,
            known.map((x) => x * told.samples.length),
          ),
      );
      if (!found) throw new Error(`${adds} is not among ${JSON.stringify(wanted)}`);
    }
    if (count !== wanted.length) throw new Error(`${count} terms instead of ${wanted.length}`);
    await titles.first().click();
    const row = page.locator(".detail .rows > div", { has: page.locator("dt", { hasText: /^t$/ }) });
    const [t] = numbers((await row.locator(".result").textContent()).replace("=", ""));
    const hit = sample.light.what.hit.t;
    if (!(Math.abs(t - hit) < 1e-3)) throw new Error(`t = ${t} instead of ${hit}`);
  });

  await test("two programs save one file", wide, async (page) => {
    const file = join(mkdtempSync(join(tmpdir(), "durer-")), "scene.txt");
    copyFileSync(`${scenes}sphere.txt`, file);
    const live = spawn(durer, ["live", file]);
    try {
      const [address] = await createInterface({ input: live.stdout })
        [Symbol.asyncIterator]()
        .next()
        .then(({ value }) => [value]);
      await page.goto(address);
      await shown(page);
      const type = async (text) => {
        await page.locator(".cm-content").click();
        await page.keyboard.press("Control+End");
        await page.keyboard.type(text);
      };
      // Without edits, the page follows the file.
      writeFileSync(file, `${readFileSync(file, "utf8")}# by another program\n`);
      await page.waitForFunction(() => /by another/.test(document.querySelector(".cm-content").textContent));
      // With edits, it asks.
      await type("# by the page");
      writeFileSync(file, `${readFileSync(file, "utf8")}# again\n`);
      await page.getByText("The file changed on disk.").waitFor();
      await page.getByRole("button", { name: "Keep this text" }).click();
      await page.keyboard.press("Control+s");
      await page.locator(".bar").getByRole("button", { name: "Save" }).click();
      await page.getByText("Another program changed the file").waitFor();
      if (/by the page/.test(readFileSync(file, "utf8"))) throw new Error("overwritten without a question");
      await page.getByRole("button", { name: "Overwrite" }).click();
      await page.getByRole("button", { name: "Save", disabled: true }).waitFor();
      const saved = readFileSync(file, "utf8");
      if (!/by the page/.test(saved) || /again/.test(saved)) throw new Error(saved);
    } finally {
      live.kill();
    }
  });
}
