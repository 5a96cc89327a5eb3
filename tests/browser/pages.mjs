// The simulator's pages in Debian's Chromium: no error, a scene that is not empty and moves, and
// nothing that axe-core has to say. node pages.mjs PROGRAM, with playwright-core and axe-core to be
// found from the working directory.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(join(process.cwd(), "package.json"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const program = process.argv[2];
const scenario = (name) => new URL(name, import.meta.url).pathname;
const out = mkdtempSync(join(tmpdir(), "pages-"));
const hil = (...arguments_) => execFileSync(program, [...arguments_, "--quiet", "--out", out]);
let passed = 0;

function check(what, condition) {
  assert.ok(condition, what);
  passed += 1;
}

hil("run", "tilted-circle");
check("a flight of 60 s has at most 6 MB", statSync(join(out, "report.html")).size <= 6e6);
execFileSync("mv", [join(out, "report.html"), join(out, "minute.html")]);
check("a lost flight ends with an error", spawnSync(program, ["run", "fig2a", "fig2b", scenario("lost.toml"), "--quiet", "--out", out]).status === 1);
hil("campaign", "--runs", "24");
hil("campaign", "--replay", "3", "--runs", "24");
hil("compare", "--runs", "1");

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});

// A page that is open, and the errors it has had; whatever is not in its file is one.
async function open(file, colorScheme) {
  const context = await browser.newContext({ colorScheme, viewport: { width: 1300, height: 1000 } });
  const page = await context.newPage();
  const errors = [];
  page.on("console", (message) => { if (["error", "warning"].includes(message.type())) errors.push(message.text()); });
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("request", (request) => { if (!/^(file|data|blob):/.test(request.url())) errors.push(request.url()); });
  await page.goto(pathToFileURL(join(out, file)).href);
  return { context, page, errors };
}

// Colours in the first scene, and a picture of it to be compared.
const scene = (page) => page.evaluate(() => {
  const canvas = document.querySelector(".scene canvas");
  // From a copy: the page's own canvas is made for drawing, not for reading.
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const pixels = new Uint32Array(copy.getImageData(0, 0, canvas.width, canvas.height).data.buffer);
  return { colours: new Set(pixels).size, picture: canvas.toDataURL() };
});
const seek = (page, t) => page.evaluate((t) => {
  const slider = document.getElementById("time");
  slider.value = String(t);
  slider.dispatchEvent(new Event("input"));
}, t);
const clock = async (page) => parseFloat(await page.textContent("#clock"));

for (const colorScheme of ["light", "dark"]) {
  for (const file of ["report.html", "minute.html", "replay-3.html", "campaign.html", "compare.html"]) {
    const { context, page, errors } = await open(file, colorScheme);
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => axe.run());
    for (const { id, help, nodes } of violations) console.error(`${file}, ${colorScheme}: ${id}: ${help}: ${nodes.map((node) => node.html).slice(0, 3).join(" ")}`);
    check(`${file} in ${colorScheme}: axe-core finds nothing`, violations.length === 0);
    assert.deepEqual(errors, [], `${file} in ${colorScheme}`);
    await context.close();
  }
}

const { context, page, errors } = await open("minute.html", "light");
const ready = await page.evaluate(() => performance.getEntriesByName("ready")[0]?.startTime);
console.log(`interactive after ${Math.round(ready)} ms`);
check("a flight of 60 s is interactive within 2 s", ready <= 2000);
await context.close();

const report = await open("report.html", "light");
const text = await report.page.textContent(".lost");
check("a lost flight is told in large letters", /Lost at \d+\.\d s: /.test(text));
check("and they are large", parseFloat(await report.page.evaluate(() => getComputedStyle(document.querySelector(".lost")).fontSize)) >= 28);
await seek(report.page, 0);
const before = await scene(report.page);
check("the scene is not empty", before.colours > 200);
await seek(report.page, 1.5);
const after = await scene(report.page);
check("scrubbing moves the scene", before.picture !== after.picture);
check("and the clock", Math.abs((await clock(report.page)) - 1.5) < 0.02);
await report.page.selectOption("#second", { label: "fig2b" });
check("two flights stand side by side", (await report.page.locator(".scene canvas").count()) === 2);
check("with their plots", (await report.page.locator("#plots canvas").count()) >= 5);
await report.page.click("#play");
await report.page.waitForFunction(() => parseFloat(document.getElementById("clock").textContent) > 1.8);
await report.page.click("#play");
const stopped = await clock(report.page);
await report.page.locator("h1").click();
await report.page.keyboard.press("ArrowRight");
check("keys move the time", Math.abs((await clock(report.page)) - stopped - 0.1) < 0.02);
const unzoomed = await report.page.locator("#plots canvas").first().evaluate((canvas) => canvas.toDataURL());
await report.page.keyboard.press("+");
await report.page.waitForTimeout(100);
check("and zoom the plots", unzoomed !== (await report.page.locator("#plots canvas").first().evaluate((canvas) => canvas.toDataURL())));
const beforeTurn = await scene(report.page);
await report.page.keyboard.press("a");
check("and turn the view", beforeTurn.picture !== (await scene(report.page)).picture);
assert.deepEqual(report.errors, []);
await report.context.close();
await browser.close();
rmSync(out, { recursive: true });
console.log(`${passed} passed, 0 failed`);
