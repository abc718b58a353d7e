#!/usr/bin/env node
// How long the page takes, beside the program in the same run; a person reads it, nothing is asserted.
//
//   page_bench.mjs PROGRAM PAGE_FOLDER NPM_FOLDER
//
// Times are medians: from the start of the page's file to its first drawing, and from a slider's move
// to the drawn page (worker and script, with the wait for a frame), beside the run's own time natively.
import { execFileSync } from "node:child_process";
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [program, folder, npm] = process.argv.slice(2).map((path) => resolve(path));
const puppeteer = createRequire(join(npm, "node_modules/"))("puppeteer-core");
const MOVES = 41;

function median(values) {
  return [...values].sort((a, b) => a - b)[values.length >> 1];
}

function nativeTime(scenario) {
  const times = Array.from({ length: 9 }, () => {
    const text = execFileSync(program, ["run", scenario, "--json", "-", "--quiet"]);
    return 1e3 * JSON.parse(text).wall_time_s;
  });
  return median(times);
}

const browser = await puppeteer.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
});

async function open(scenario) {
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(`file://${join(folder, "impactlab.html")}#scenario=${scenario}`);
  await page.waitForFunction(() => document.body.dataset.state === "drawn");
  return page;
}

const starts = [];
for (let i = 0; i < 5; i++) {
  const page = await open("corrected/first-impact");
  starts.push(await page.evaluate(() => performance.getEntriesByName("drawn")[0].startTime));
  await page.close();
}
console.log(`start to the first drawing: ${median(starts).toFixed(0)} ms`);

for (const [scenario, knob] of [
  ["corrected/first-impact", "motor-voltage"],
  ["compare/hybrid", "control-force"],
  ["corrected/twenty-links", "motor-voltage"],
]) {
  const page = await open(scenario);
  const moves = await page.evaluate(
    async (id, count) => {
      const slider = document.getElementById(`knob-${id}`);
      const times = [];
      for (let i = 0; i < count; i++) {
        performance.clearMarks("drawn");
        slider.value = 500 + 5 * i;
        const start = performance.now();
        slider.dispatchEvent(new Event("input"));
        await new Promise((resolve) => {
          const look = () =>
            performance.getEntriesByName("drawn").length > 0 ? resolve() : setTimeout(look, 1);
          look();
        });
        times.push(performance.getEntriesByName("drawn")[0].startTime - start);
        await new Promise((resolve) => setTimeout(resolve, 30));
      }
      return times;
    },
    knob,
    MOVES,
  );
  const native = nativeTime(scenario).toFixed(2);
  console.log(
    `${scenario}: slider to page ${median(moves).toFixed(1)} ms, the run natively ${native} ms`,
  );
  await page.close();
}
await browser.close();
