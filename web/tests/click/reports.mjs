/** The files that `explain`, `compare`, `lesson` and `photo tour` write, opened without a network.
 */
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { check } from "./axe.mjs";
import { narrow, scenes, shot, test, wide } from "./harness.mjs";

const root = new URL("../../../", import.meta.url).pathname;
const program = process.env.DURER ?? resolve(root, process.env.CARGO_TARGET_DIR ?? "target", "debug/durer");
const folder = mkdtempSync(join(tmpdir(), "durer-reports-"));
process.on("exit", () => rmSync(folder, { recursive: true, force: true }));

/** Runs `durer`; different pictures are not an error. */
function durer(line, ...more) {
  const words = [...line.split(" "), ...more];
  try {
    return execFileSync(program, words, { cwd: folder, encoding: "utf8", stdio: ["ignore", "pipe", "pipe"] });
  } catch (error) {
    if (error.status !== 1) throw new Error(`${words.join(" ")}: ${error.stderr}`);
    return error.stdout;
  }
}

const whitted = join(scenes, "whitted.txt");
const pixel = "--pixel 100,100 --size 320x240 --samples 4";
// A name that would end the data if it were not escaped.
const hostile = "<!--<script>&'.txt";
writeFileSync(join(folder, hostile), readFileSync(whitted));
durer(`explain ${hostile} ${pixel} --html explain.html -q`);
const explained = JSON.parse(durer(`explain ${hostile} ${pixel} --json`)).pixel;
durer(
  `explain ${join(scenes, "cornell-box.txt")} --pixel 30,40 --size 64x64 --samples 3 --html path.html -q`,
);
durer(`explain ${whitted} --html ray.html -q --ray`, "0 1 5 0 0 -1");
for (const [name, options] of [
  ["ref/whitted", ""],
  ["class/ada/whitted", " --shadows=off"],
  ["class/bob/whitted", " --shadows=off"],
  ["class/eve/whitted", ""],
]) {
  mkdirSync(join(folder, name, ".."), { recursive: true });
  durer(`render ${whitted} -o ${name}.png --size 80x60 --samples 1 -q${options}`);
}
const pair = "compare ref/whitted.png class/ada/whitted.png";
durer(`${pair} --scene ${whitted} --report pair.html`);
const compared = JSON.parse(durer(`${pair} --json`)).pairs[0];
durer(`compare ref class --scene ${whitted} --report class.html`);
const csv = durer(`compare ref class --scene ${whitted} --csv`);
durer(`lesson ${whitted} -o lesson -q --size 80x60 --samples 2`);
const photographs = join(scenes, "photographs");
durer(`photo match ${photographs} -o matches.json --field 60 -q`);
durer("photo solve matches.json -o solved -q");
durer(`photo tour solved --pictures ${photographs} -o tour.html --side 200 -q`);

/** Text of an element. */
const text = (page, selector) => page.locator(selector).first().textContent();

function equal(found, wanted, what) {
  if (found !== wanted) throw new Error(`${what}: ${found}, not ${wanted}`);
}

/** Throws unless a condition holds within a second. */
async function becomes(page, what, condition, argument) {
  await page.waitForFunction(condition, argument, { timeout: 5000 }).catch(() => {
    throw new Error(`${what} did not come`);
  });
}

const reports = {
  async explain(page) {
    equal(await text(page, "h1"), "Pixel 100, 100", "heading");
    const shown = (await text(page, ".pixel p"))
      .match(/[\d.]+/g)
      .slice(0, 3)
      .map(Number);
    explained.color.forEach((x, i) => {
      if (Math.abs(shown[i] - x) > 1e-3 * Math.max(1e-3, x))
        throw new Error(`${shown}, not ${explained.color}`);
    });
    equal(await page.locator(".sample-choice option").count(), explained.samples.length, "samples");
    equal(await text(page, ".tree .share"), "100 %", "share");
    await page.locator(".tree .title").first().focus();
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("Enter");
    await becomes(page, "formulas", () => document.querySelector(".tree .detail"));
    equal(await page.locator(".tests .test").count(), 3, "tested objects");
    await page.locator(".tests .test").first().click();
    await becomes(page, "roots of a sphere", () => document.querySelector(".tests .rows"));
    await page.getByLabel("Sample", { exact: true }).selectOption("2");
    await becomes(page, "another sample", () => document.querySelectorAll(".tree .term").length > 0);
    await page.getByRole("tab", { name: "Step by step" }).click();
    await page.getByRole("button", { name: "Next", exact: true }).click();
    await becomes(page, "line of the code", () => document.querySelector(".code .now"));
    await check(page);
    await page.getByRole("tab", { name: "Tree" }).click();
  },
  async path(page) {
    equal(await page.locator(".sample-choice option").count(), 3, "samples");
    await page.locator(".tree .title").first().click();
    await becomes(page, "formulas", () => document.querySelector(".tree .detail"));
  },
  async ray(page) {
    equal(await text(page, "h1"), "A ray", "heading");
    equal(await page.locator(".marked-picture").count(), 0, "pictures");
  },
  async pair(page) {
    const metrics = await text(page, ".metrics");
    if (!metrics.includes(compared.rmse.toFixed(6))) throw new Error(`${metrics}: RMSE is ${compared.rmse}`);
    equal(await page.locator(".regions li").count(), compared.regions.length, "regions");
    for (const mode of ["Blink", "Reference", "Picture", "Heat map", "Difference", "Slider"])
      await page.getByRole("button", { name: mode, exact: true }).click();
    const slider = page.getByRole("slider", { name: "Reference and picture" });
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    await becomes(page, "the line", () =>
      document.querySelector(".wipe").getAttribute("aria-valuenow").startsWith("52"),
    );
    await page.keyboard.press("5");
    await becomes(page, "the heat map", () => document.querySelector("[data-mode=heat][aria-pressed=true]"));
    await page.keyboard.press("1");
    await page.locator(".regions .place").first().click();
    await becomes(page, "the box", () => document.querySelector(".wipe .box"));
    await page.locator(".regions summary").first().click();
    if (!(await text(page, ".regions pre")).includes("durer explain")) throw new Error("no command");
    await page.locator(".wipe").hover({ position: { x: 5, y: 5 } });
    await becomes(page, "the values", () =>
      /reference \d+ \d+ \d+, picture/.test(document.querySelector(".below output").textContent),
    );
  },
  async class(page) {
    equal(await page.locator(".matrix tbody tr").count(), 3, "students");
    equal(await text(page, ".groups li"), "there are no shadowswhitted.png: ada, bob", "groups");
    const download = page.waitForEvent("download");
    await page.getByRole("button", { name: "Save as CSV" }).click();
    equal(readFileSync(await (await download).path(), "utf8").trim(), csv.trim(), "CSV");
    await page.locator(".matrix button.cell").nth(1).click();
    await becomes(page, "the pair", () =>
      document.querySelector(".finding h2").textContent.startsWith("bob/whitted.png"),
    );
    await page.locator(".pairs .link").first().click();
    await becomes(page, "the pair", () =>
      document.querySelector(".finding h2").textContent.startsWith("ada/"),
    );
  },
  async "lesson/index"(page) {
    const count = await page.locator(".contents a").count();
    if (count < 10) throw new Error(`${count} steps`);
    for (let i = 0; i < count; i++) {
      await page.locator(".contents a").nth(i).click();
      await page.waitForFunction(
        (at) => document.querySelector(".number").textContent.startsWith(`${at} of`),
        i + 1,
      );
      if (i % 5 === 4) await check(page);
    }
    await page.locator(".contents a").nth(5).click();
    await page.waitForSelector(".wipe");
    await page.keyboard.press("p");
    await page.waitForSelector(".lecture.presents");
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => document.querySelector(".number").textContent.startsWith("7 of"));
    await page.keyboard.press("Escape");
    await page.waitForSelector(".lecture:not(.presents)");
  },
  async tour(page) {
    equal(await page.locator(".strip button").count(), 6, "photographs");
    await page.locator(".strip button").nth(2).click();
    await becomes(page, "the photograph", () =>
      /^2\.jpg: sees \d+/.test(document.querySelector("[role=status]").textContent),
    );
    await page.getByRole("button", { name: "more like this" }).click();
    await becomes(page, "another", () =>
      /^[0-5]\.jpg: sees/.test(document.querySelector("[role=status]").textContent),
    );
    await page.locator(".tour-space canvas").focus();
    await page.keyboard.press("ArrowLeft");
    await becomes(page, "a turn", () => !document.querySelector(".strip [aria-current=true]"));
    await page.getByRole("button", { name: "all of it" }).click();
    await becomes(page, "all of it", () =>
      /^6 photographs/.test(document.querySelector("[role=status]").textContent),
    );
  },
};

const huge = { viewport: { width: 3840, height: 2160 } };
for (const [name, look] of Object.entries(reports)) {
  for (const [width, size] of [
    ["wide", wide],
    ["narrow", narrow],
    ["huge", huge],
  ]) {
    for (const colorScheme of width === "huge" ? ["dark"] : ["light", "dark"]) {
      const options = { ...size, colorScheme, offline: true, acceptDownloads: true };
      await test(`report ${name} ${width} ${colorScheme}`, options, async (page) => {
        const requests = [];
        page.on("request", (request) => requests.push(request.url()));
        await page.goto(`file://${folder}/${name}.html`);
        await page.waitForSelector("main");
        await look(page);
        await check(page);
        const loaded = requests.filter((url) => !/^(data|blob):/.test(url));
        equal(loaded.length, 1, `loaded files ${loaded.join(" ")}`);
        const columns = await page.evaluate(() => document.documentElement.scrollWidth);
        if (columns > size.viewport.width) throw new Error(`${columns} pixels wide`);
        await shot(page, `report-${name.replace("/", "-")}-${width}-${colorScheme}`);
      });
    }
  }
}
