// The simulator's pages in Debian's Chromium: no error, a scene that is not empty and moves, and
// nothing that axe-core has to say; pictures like those beside this file; and a page that shows a
// flight while it flies. node pages.mjs PROGRAM [--keep], with playwright-core and axe-core to be
// found from the working directory; --keep keeps the pictures as they now are.

import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const require = createRequire(join(process.cwd(), "package.json"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const program = process.argv[2];
const keeps = process.argv[3] === "--keep";
const scenario = (name) => new URL(name, import.meta.url).pathname;
const out = mkdtempSync(join(tmpdir(), "pages-"));
const hil = (...arguments_) => execFileSync(program, [...arguments_, "--quiet", "--out", out]);
let passed = 0;

function check(what, condition) {
  assert.ok(condition, what);
  passed += 1;
}

hil("figures");
const size = readdirSync(out).reduce((sum, file) => sum + statSync(join(out, file)).size, 0);
console.log(`the default run leaves ${(size / 1e6).toFixed(1)} MB`);
check("the default run leaves at most 20 MB", size <= 20e6);
hil("run", "tilted-circle");
const minute = statSync(join(out, "report.html")).size;
console.log(`a flight of 60 s is a page of ${(minute / 1e6).toFixed(1)} MB`);
check("a flight of 60 s has at most 6 MB", minute <= 6e6);
const rename = (from, to) => execFileSync("mv", [join(out, from), join(out, to)]);
rename("report.html", "minute.html");
hil("run", scenario("ground.toml"));
rename("report.html", "ground.html");
hil("run", "a-to-b");
rename("report.html", "route.html");
hil("replay", join(out, "ground.csv"), "--with", scenario("ground.toml"));
rename("report.html", "replayed.html");
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
  for (const file of ["report.html", "curves.html", "minute.html", "ground.html", "replayed.html", "route.html", "replay-3.html", "campaign.html", "compare.html"]) {
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

// Pictures, 640 by 400: a pixel differs if a channel does by more than 48 of 255, which another
// Chromium's smoothing of edges does not reach. The fonts of another machine are the words of a
// scene: a hundredth of it. What a second of flight changes is more than the hundredth allowed.
const ALLOWED = 0.01;
async function differs(page, data, name) {
  const file = new URL(name, import.meta.url).pathname;
  if (keeps) writeFileSync(file, Buffer.from(data.split(",")[1], "base64"));
  const kept = `data:image/png;base64,${readFileSync(file).toString("base64")}`;
  return page.evaluate(async (pictures) => {
    const [a, b] = await Promise.all(pictures.map(async (source) => {
      const image = new Image();
      image.src = source;
      await image.decode();
      const pen = new OffscreenCanvas(image.width, image.height).getContext("2d");
      pen.drawImage(image, 0, 0);
      return pen.getImageData(0, 0, image.width, image.height);
    }));
    if (a.width !== b.width || a.height !== b.height) return 1;
    let count = 0;
    for (let k = 0; k < a.data.length; k += 4) if ([0, 1, 2].some((channel) => Math.abs(a.data[k + channel] - b.data[k + channel]) > 48)) count += 1;
    return (4 * count) / a.data.length;
  }, [data, kept]);
}

const ground = await open("ground.html", "light");
await ground.page.addStyleTag({ content: ".scene canvas { width: 640px !important; height: 400px !important }" });
await ground.page.click("#follow");
await ground.page.locator("h1").click();
for (let k = 0; k < 7; k += 1) await ground.page.keyboard.press("e");
await ground.page.evaluate(() => dispatchEvent(new Event("resize")));
const sceneAt = async (t) => {
  await seek(ground.page, t);
  return ground.page.evaluate(() => document.querySelector(".scene canvas").toDataURL());
};
for (const [name, t] of [["slack.png", 4], ["taut.png", 30]]) {
  const same = await differs(ground.page, await sceneAt(t), name);
  check(`${name}: the scene at ${t} s is the one that was kept: ${same} differs`, same <= ALLOWED);
  if (keeps) continue;
  const later = await differs(ground.page, await sceneAt(t + 1), name);
  check(`${name}: and a second later it is another: ${later} differs`, later > ALLOWED);
}
// The curves alone, without the words beside them.
const plot = await ground.page.evaluate(() => {
  const root = document.querySelectorAll("#plots .uplot")[2];
  const canvas = root.querySelector("canvas"), [all, over] = [canvas, root.querySelector(".u-over")].map((element) => element.getBoundingClientRect());
  const ratio = canvas.width / all.width, copy = document.createElement("canvas");
  copy.width = 640;
  copy.height = 160;
  copy.getContext("2d").drawImage(canvas, (over.left - all.left) * ratio, (over.top - all.top) * ratio, over.width * ratio, over.height * ratio, 0, 0, 640, 160);
  return copy.toDataURL();
});
const plotted = await differs(ground.page, plot, "plot.png");
check(`plot.png: thrust and tension are those that were kept: ${plotted} differs`, plotted <= ALLOWED);
check("the cable's slack is said", (await ground.page.getAttribute(".strip", "aria-label")).includes("cable slack from 0.0"));
const events = await ground.page.textContent("#events");
check("and who comes to the ground", events.includes("load on the ground") && events.includes("UAV on the ground"));
assert.deepEqual(ground.errors, []);
await ground.context.close();

const route = await open("route.html", "light");
const legs = route.page.getByRole("region", { name: "a-to-b leg by leg" }).locator("tbody tr");
check("a route is shown leg by leg", (await legs.count()) === 2 && /^1 to 2/.test(await legs.nth(1).innerText()));
check("with the speed that its limits allow", (await route.page.textContent("#plots")).includes("limits allow"));
await route.context.close();

const replayed = await open("replayed.html", "light");
const said = await replayed.page.textContent("main");
check("a replay says what its log lacks", said.includes("no f1 … f3"));
check("and shows what was logged", said.includes("thrust logged"));
await replayed.context.close();

// A board that is this program, and a page that sees it fly.
const place = `unix:${join(out, "target")}`;
const target = spawn(program, ["target", "--listen", place]);
// Whatever fails: neither outlives the checks.
process.on("exit", () => target.kill());
await new Promise((listens) => target.stderr.once("data", listens));
const flying = spawn(program, ["hil", "fig3a", "--connect", place, "--real-time", "--live=0", "--out", join(out, "live")]);
process.on("exit", () => flying.kill());
const address = await new Promise((found, failed) => {
  let heard = "";
  flying.stderr.on("data", (text) => { heard += text; const [match] = heard.match(/http:\S+(?=\n)/) ?? []; if (match) found(match); });
  flying.on("exit", () => failed(new Error(heard)));
});
const live = await browser.newContext({ viewport: { width: 1300, height: 1000 } });
const watching = await live.newPage();
const liveErrors = [];
watching.on("pageerror", (error) => liveErrors.push(error.message));
await watching.goto(address);
await watching.waitForFunction(() => parseFloat(document.getElementById("clock").textContent) > 1, null, { timeout: 15000 });
const early = await clock(watching);
check("a flight is seen while it flies", flying.exitCode === null && early < 9.5);
await watching.waitForFunction(() => document.getElementById("live").textContent.includes("over"), null, { timeout: 30000 });
check("to its end", Math.abs((await clock(watching)) - 10) < 0.05);
await watching.evaluate(axe);
for (const colorScheme of ["light", "dark"]) {
  await watching.emulateMedia({ colorScheme });
  check(`live in ${colorScheme}: axe-core finds nothing`, (await watching.evaluate(() => axe.run())).violations.length === 0);
}
assert.deepEqual(liveErrors, []);
await live.close();
await browser.close();
rmSync(out, { recursive: true });
console.log(`${passed} passed, 0 failed`);
// Not awaited: the programs that were started, which end with this one.
process.exit();
