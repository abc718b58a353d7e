#!/usr/bin/env node
// The report in headless Chromium as people meet it: four widths, light and dark, by keyboard and by touch,
// without script, and on paper.
//
//   report_test.mjs REPORT.html NPM_FOLDER OUTPUT_FOLDER
//
// NPM_FOLDER has node_modules with puppeteer-core; pictures of the page go to OUTPUT_FOLDER.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [report, npm, output] = process.argv.slice(2).map((path) => resolve(path));
const puppeteer = createRequire(join(npm, "node_modules/"))("puppeteer-core");
mkdirSync(output, { recursive: true });
const browser = await puppeteer.launch({ executablePath: "/usr/bin/chromium", args: ["--no-sandbox"] });

// The report in a window; `faults` fills with what the page complains of.
async function opened(width, scheme, faults, script = true) {
  const page = await browser.newPage();
  const touch = width < 800;
  page.on("pageerror", (e) => faults.push(e.message));
  await page.setJavaScriptEnabled(script);
  await page.setViewport({ width, height: 900, hasTouch: touch, isMobile: touch });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.goto("file://" + report, { waitUntil: "load" });
  return page;
}

const figure = 'figure[aria-label^="Fig. 4.3"]';
const press = (page, words) =>
  page.$$eval(figure + " button", (all, w) => all.find((b) => b.textContent.startsWith(w)).focus(), words)
    .then(() => page.keyboard.press("Enter"));
// the brightness of a colour that a style has, 0 to 255
const brightness = (css) => Math.max(...css.match(/\d+/g).slice(0, 3).map(Number));

for (const width of [400, 768, 1280, 1600]) {
  for (const scheme of ["light", "dark"]) {
    const faults = [], page = await opened(width, scheme, faults);
    const name = `${width} ${scheme}`;
    await page.screenshot({ path: join(output, `${width}-${scheme}.png`) });

    // nothing sticks out of the page, and every figure has one title
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), name);
    assert.ok(await page.$$eval("section", (all) => all.every((s) => s.querySelectorAll("h2").length === 1)));

    // drawings are as dark as the page: their ground is not bright, their letters are not dark
    const [ground, letters] = await page.$eval(figure, (f) => {
      const styles = [...f.querySelectorAll(".drawing [style*='fill:#']")].map((e) => getComputedStyle(e).fill);
      return [getComputedStyle(document.body).backgroundColor, styles.at(-1)];
    });
    assert.equal(brightness(ground) > 128, scheme === "light", name);
    assert.equal(brightness(letters) < 128, scheme === "light", name);

    // charts by the keyboard alone, as wide as the page; marks and impulses are in them
    await press(page, "Zoom and read values");
    const [chart, place] = await page.$eval(figure, (f) =>
      [".u-wrap", ".charts"].map((part) => f.querySelector(part).getBoundingClientRect().width));
    assert.ok(Math.abs(chart - place) < 2, name);
    const data = await page.$eval(figure, (f) => [f.dataset.marks, f.dataset.panels].map(JSON.parse));
    assert.ok(data[0].lines.length === 2 && data[1][0].impulses.length === 1);

    // values where one points or taps
    const over = await page.$(figure + " .u-over");
    await over.scrollIntoView();
    if (width < 800) {
      await over.tap();
    } else {
      await over.hover();
    }
    const values = await page.$$eval(figure + " .u-value", (all) => all.map((v) => parseFloat(v.textContent)));
    assert.ok(values.some((v) => v > 0.1), `${name}: ${values}`);
    await (await page.$(figure)).screenshot({ path: join(output, `${width}-${scheme}-chart.png`) });
    await press(page, "Back to the drawing");
    assert.equal((await page.$$(figure + " canvas")).length, 0);
    assert.deepEqual(faults, [], name);
    await page.close();
  }
}

// without script the drawings stay, and no button promises more
const bare = await opened(1280, "light", [], false);
assert.equal(await bare.$$eval("figure button", (all) => all.length), 0);
assert.ok(await bare.$eval(figure + " svg", (svg) => svg.clientWidth > 600));

// on paper a dark screen's report is light
const paper = await opened(1280, "dark", []);
await paper.emulateMediaType("print");
assert.ok(await paper.evaluate(() => getComputedStyle(document.body).backgroundColor === "rgb(255, 255, 255)"));
assert.equal(await paper.$$eval(".buttons", (all) => all.filter((b) => b.offsetHeight > 0).length), 0);
await paper.pdf({ path: join(output, "report.pdf"), format: "A4" });
await browser.close();
