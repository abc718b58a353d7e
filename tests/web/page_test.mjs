#!/usr/bin/env node
// The page in headless Chromium, used as a person would: sliders dragged, keys pressed, a finger on a
// phone, files taken along, texts that are wrong or hostile.
//
//   page_test.mjs PROGRAM PAGE_FOLDER NPM_FOLDER OUTPUT_FOLDER
//
// NPM_FOLDER has node_modules with puppeteer-core; pictures of the page go to OUTPUT_FOLDER.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { extname, join, resolve } from "node:path";

const [program, folder, npm, output] = process.argv.slice(2).map((path) => resolve(path));
const puppeteer = createRequire(join(npm, "node_modules/"))("puppeteer-core");
const PATIENCE = 60000; // for anything to appear [ms]
const files = join(output, "files");
rmSync(files, { recursive: true, force: true });
mkdirSync(files, { recursive: true });

// --- the page and its browser --------------------------------------------------------------------

const types = {
  ".html": "text/html",
  ".js": "text/javascript",
  ".css": "text/css",
  ".wasm": "application/wasm",
  ".json": "application/json",
};
const server = createServer((request, answer) => {
  const file = join(folder, new URL(request.url, "http://here").pathname.slice(1));
  if (!existsSync(file)) {
    answer.writeHead(404).end();
    return;
  }
  answer.writeHead(200, { "Content-Type": types[extname(file)] ?? "text/plain" });
  answer.end(readFileSync(file));
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}/`;

const browser = await puppeteer.launch({
  executablePath: "/usr/bin/chromium",
  args: ["--no-sandbox", "--disable-gpu"],
  protocolTimeout: 180000,
});
const troubles = [];
const elsewhere = [];

async function openPage(url, width, height, { dark = false, touch = false } = {}) {
  const page = await browser.newPage();
  page.on("pageerror", (error) => troubles.push(error.message));
  page.on("request", (request) => {
    if (!/^(blob|data|file):/.test(request.url()) && !request.url().startsWith(address)) {
      elsewhere.push(request.url());
    }
  });
  await page.emulateMediaFeatures([
    { name: "prefers-color-scheme", value: dark ? "dark" : "light" },
  ]);
  await page.setViewport({ width, height, hasTouch: touch, isMobile: touch });
  const client = await page.createCDPSession();
  await client.send("Browser.setDownloadBehavior", { behavior: "allow", downloadPath: files });
  await page.goto(url);
  await settled(page);
  return page;
}

// Waits until the page has drawn what was asked for last.
async function settled(page) {
  await page.waitForFunction(() => document.body.dataset.state === "drawn", {
    timeout: PATIENCE,
    polling: 50,
  });
}

function cells(page) {
  return page.$$eval("#strip tbody tr", (rows) =>
    rows.map((row) =>
      [...row.cells].map((cell) =>
        [...(cell.firstChild.childNodes ?? [])]
          .filter((node) => node.nodeName !== "SMALL" && node.nodeName !== "BUTTON")
          .map((node) => node.textContent)
          .join("")
          .trim(),
      ),
    ),
  );
}

async function peakOf(page) {
  return Number.parseFloat((await cells(page))[0][1]);
}

function textOf(page, selector) {
  return page.$eval(selector, (one) => one.textContent);
}

// A finger or a mouse takes a slider from one share of its width to another.
async function drag(page, selector, from, to, press = page.mouse) {
  const slider = await page.$(selector);
  await slider.scrollIntoView();
  const box = await slider.boundingBox();
  const place = (share) => [box.x + share * box.width, box.y + box.height / 2];
  const finger = press === page.touchscreen;
  const [down, move, up] = finger
    ? ["touchStart", "touchMove", "touchEnd"]
    : ["down", "move", "up"];
  if (!finger) {
    await press.move(...place(from));
  }
  await press[down](...place(from));
  for (let i = 1; i <= 8; i++) {
    await press[move](...place(from + ((to - from) * i) / 8));
  }
  await press[up]();

  // the browser hands the last moves on with its next frame
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
  await settled(page);
}

async function typeText(page, text) {
  await page.$eval("#file", (box) => (box.open = true));
  await page.$eval(
    "#text",
    (area, value) => {
      area.value = value;
      area.dispatchEvent(new Event("input"));
    },
    text,
  );
  await new Promise((done) => setTimeout(done, 400));
  await settled(page);
}

// Presses a button and waits for the file that it saves.
async function taken(page, button, name) {
  const path = join(files, name);
  rmSync(path, { force: true });
  await page.$eval(button, (one) => one.click());
  for (let i = 0; i < PATIENCE / 50; i++) {
    if (existsSync(path)) {
      return path;
    }
    await new Promise((done) => setTimeout(done, 50));
  }
  throw new Error(`${button} saved no ${name}`);
}

function nativeJson(...options) {
  const text = execFileSync(program, ["run", ...options, "--json", "-", "--quiet"]);
  return JSON.parse(text);
}

function near(value, other, share) {
  assert.ok(
    Math.abs(value - other) <= share * Math.abs(other),
    `${value} is not near ${other} (within ${share})`,
  );
}

// --- what a person does --------------------------------------------------------------------------

const tests = {
  async "the first screen says how hard it hits, as the program does"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const native = nativeJson("corrected/first-impact");
    const [[, peak, impulse]] = await cells(page);
    near(Number.parseFloat(peak), native.peak_force_N, 0.005);
    near(Number.parseFloat(impulse) / 1e3, native.contact_impulse_Ns, 0.005);
    assert.match(await textOf(page, "#why summary"), /hits at 0\.743 m\/s/);

    // predictors, and the summary for who does not see the curves
    assert.match(await textOf(page, "#predictors"), /linearised\s*1\.34 N/);
    await page.waitForFunction(() => document.querySelector("#summary").textContent !== "");
    assert.match(await textOf(page, "#summary"), /peak 1\.34 N/);
    await page.close();
  },

  async "a drag moves the peak, and the link holds it"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const before = await peakOf(page);
    await drag(page, "#knob-motor-voltage", 0.6, 0.75);
    const middle = await peakOf(page);
    await drag(page, "#knob-motor-voltage", 0.75, 0.9);
    const after = await peakOf(page);
    assert.ok(before < middle && middle < after, `${before} < ${middle} < ${after}`);

    // the run as opened stands beside it
    const rows = await cells(page);
    assert.equal(rows.length, 2);
    near(Number.parseFloat(rows[1][1]), before, 1e-9);

    // and the program comes to the same
    const voltage = await page.$eval("#knob-motor-voltage", (slider) =>
      Number(slider.closest(".knob").querySelector(".value").value),
    );
    const native = nativeJson("corrected/first-impact", "--set", `motor.voltage=${voltage}`);
    near(after, native.peak_force_N, 0.005);

    await page.waitForFunction(
      (value) => decodeURIComponent(location.hash).includes(`motor.voltage=${value}`),
      { timeout: PATIENCE },
      voltage,
    );
    const other = await openPage(await page.evaluate(() => location.href), 1280, 900);
    assert.deepEqual(await cells(other), rows);
    await other.close();
    await page.close();
  },

  async "a law holds the force, and its own numbers are knobs"() {
    const page = await openPage(`${address}index.html#scenario=compare/open-loop`, 1280, 900);
    await page.select("#knob-control-law", "touch");
    await settled(page);
    const [row] = await cells(page);
    const native = nativeJson("compare/open-loop", "--set", "control.law=touch");
    near(Number.parseFloat(row[2]) / 1e3, native.contact_impulse_Ns, 0.005);
    near(Number.parseFloat(row[3]), native.steady_force_N, 0.005);
    assert.ok(await page.$("#knob-control-settings-cruise"));
    await drag(page, "#knob-control-force", 0.2, 0.4);
    const force = await page.$eval(
      "#knob-control-force",
      (slider) => slider.closest(".knob").querySelector(".value").value,
    );
    near(Number.parseFloat((await cells(page))[0][3]), Number(force), 0.06);
    await page.close();
  },

  async "keys step, play, keep and undo"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const clock = async () => Number.parseFloat(await textOf(page, "#clock"));
    await page.keyboard.press("Home");
    assert.equal(await clock(), 0);
    await page.keyboard.press("ArrowRight");
    const first = await clock();
    assert.ok(first > 0);
    await page.keyboard.press("n");
    near(await clock(), 0.2934, 0.001);
    await page.keyboard.press("ArrowLeft");
    assert.ok((await clock()) < 0.2934);
    await page.keyboard.press("End");
    assert.equal(await clock(), 1);
    await page.keyboard.press("r");
    await page.waitForFunction(
      () => Number.parseFloat(document.querySelector("#clock").value) > 0.01,
    );
    await page.keyboard.press("Space");
    const stopped = await clock();
    await new Promise((done) => setTimeout(done, 200));
    assert.equal(await clock(), stopped);

    // a knob by keys alone: focus, up, kept, undone
    await page.keyboard.press("j");
    await page.keyboard.press(">");
    await settled(page);
    assert.equal((await cells(page)).length, 2);
    await page.keyboard.press("b");
    await settled(page);
    assert.equal((await cells(page)).length, 3);
    await page.keyboard.press("u");
    await page.keyboard.press("u");
    await settled(page);
    assert.equal((await cells(page)).length, 1);
    await page.keyboard.press("?");
    assert.ok(await page.$eval("#keys", (dialog) => dialog.open));
    await page.close();
  },

  async "it plays on under a drag, and runs of an edited file stay beside each other"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    await page.keyboard.press("Home");
    await page.keyboard.press("Space");
    await drag(page, "#knob-motor-voltage", 0.6, 0.7);
    assert.equal((await cells(page)).length, 2);
    assert.equal(await textOf(page, "#play"), "Pause");
    await page.keyboard.press("b");
    await settled(page);

    // the file becomes another one: reference and kept run are of that
    await typeText(page, "title: soft\narm: {k2: 3 N m/rad}\nwall: {angle: 0.1 rad}\n");
    const rows = await cells(page);
    assert.equal(rows.length, 3);
    const soft = nativeJson("corrected/first-impact", "--set", "arm.k2=3");
    near(Number.parseFloat(rows[1][1]), soft.peak_force_N, 0.005);
    assert.equal(rows[0][1], rows[2][1]);
    await page.close();
  },

  async "a sweep stands under its slider"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    await page.$eval("#knob-motor-voltage", (slider) =>
      slider.closest(".knob").querySelector(".sweep").click(),
    );
    await page.waitForFunction(() => document.querySelector(".over").dataset.known === "31", {
      timeout: PATIENCE,
    });
    assert.match(await page.$eval(".over", (one) => one.getAttribute("aria-label")), /peak/);
    await page.close();
  },

  async "a file's faults are those of check, at their lines"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const text = "title: wrong\nmotor: {voltage: 2 N}\narm:\n  k3: 1\n";
    writeFileSync(join(files, "wrong.yaml"), text);
    const said = spawnSync(program, ["check", "wrong.yaml"], { cwd: files, encoding: "utf8" });
    await typeText(page, text);
    const faults = await page.$$eval("#faults li", (items) => items.map((one) => one.textContent));
    const native = said.stderr
      .split("\n")
      .map((line) => line.match(/wrong\.yaml:(\d+):\d+: (.*)/))
      .filter(Boolean)
      .map(([, line, rest]) => `line ${line} ${rest}`);
    assert.ok(native.length >= 2);
    assert.deepEqual(faults, native);
    assert.equal(await page.$$eval("#lines .wrong", (items) => items.length), native.length);

    // and a file without faults is run
    await typeText(page, "title: right\nmotor: {voltage: 2 V}\nwall: {angle: 0.1 rad}\n");
    const right = nativeJson("corrected/first-impact", "--set", "motor.voltage=2");
    near(await peakOf(page), right.peak_force_N, 0.005);
    await page.close();
  },

  async "what is hostile or endless ends with a sentence, and the page lives"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const bombs = [
      `a: &a [${"x,".repeat(9)}x]\n` +
        "bcdefgh".replace(/./g, (n, i) => `${n}: &${n} [${`*${"abcdefg"[i]},`.repeat(10)}]\n`),
      "[".repeat(200000),
      `title: ${"x".repeat(1000000)}\n`,
      "\u0000\uffff: {",
    ];
    for (const bomb of bombs) {
      await typeText(page, bomb);
      const said = (await textOf(page, "#faults")) + (await textOf(page, "#message"));
      assert.notEqual(said, "", `nothing is said of ${bomb.slice(0, 20)}`);
    }
    const endless = [
      "title: many rows\nmethod: {name: newmark, step: 1e-7 s}\nrun: {duration: 1 s}\n",
      "title: long\nmotor: {voltage: 5 V}\narm: {links: 200}\nrun: {duration: 1000 s}\n",
    ];
    for (const text of endless) {
      await typeText(page, text);
      assert.notEqual(await textOf(page, "#message"), "", `nothing is said of ${text}`);
    }
    await typeText(
      page,
      "title: slow\nmotor: {voltage: 5 V}\narm: {links: 1024}\nrun: {duration: 10 s}\n" +
        "method: {step: 0.01 s}\nwall: {kind: plane}\n",
    );
    assert.match(await textOf(page, "#message"), /a run computes for 8 s at most/);
    await typeText(page, "title: right\nmotor: {voltage: 2 V}\nwall: {angle: 0.1 rad}\n");
    assert.equal(await textOf(page, "#message"), "");
    near(await peakOf(page), 2.51, 0.01);
    await page.close();
  },

  async "traces of all shipped scenarios have the program's bytes in Chromium"() {
    const page = await openPage(`${address}index.html`, 1280, 900);
    const hashes = await page.evaluate(async () => {
      const scenarios = await (await fetch("scenarios.json")).json();
      const binary = await (await fetch("impactlab.wasm")).arrayBuffer();
      const worker = new Worker("worker.js");
      worker.postMessage({ compiled: await WebAssembly.compile(binary) });
      const found = [];
      for (const { name, text } of scenarios) {
        worker.postMessage({ kind: "csv", number: 1, name, text, changes: {}, seconds: 600 });
        const { data } = await new Promise((resolve) => (worker.onmessage = resolve));
        const bytes = new TextEncoder().encode(data.answer ?? data.failure);
        const hash = new Uint8Array(await crypto.subtle.digest("SHA-256", bytes));
        found.push([name, Array.from(hash, (byte) => byte.toString(16).padStart(2, "0")).join("")]);
      }
      return found;
    });
    assert.ok(hashes.length > 50);
    for (const [name, hash] of hashes) {
      const options = ["run", name, "--csv", "-", "--quiet"];
      const { stdout } = spawnSync(program, options, { maxBuffer: 2 ** 28 });
      assert.equal(hash, createHash("sha256").update(stdout).digest("hex"), name);
    }
    await page.close();
  },

  async "files are what the program writes and reads"() {
    for (const [scenario, set] of [
      ["corrected/first-impact", "motor.voltage=2"],
      ["compare/hybrid", "control.force=2"],
      ["corrected/five-links", "arm.k2=6"],
    ]) {
      const url = `${address}index.html#scenario=${scenario}&set=${set}`;
      const page = await openPage(url, 1280, 900);
      const name = scenario.replace("/", "-");
      const csv = readFileSync(await taken(page, "#csv", `${name}.csv`), "utf8");
      const native = execFileSync(
        program,
        ["run", scenario, "--set", set, "--csv", "-", "--quiet"],
        { encoding: "utf8", maxBuffer: 2 ** 28 },
      );
      assert.ok(csv === native, `${scenario}: the CSV differs from the program's`);

      // the scenario runs alike, the recipe draws
      const yaml = await taken(page, "#yaml", `${name}.yaml`);
      const peak = nativeJson(yaml).peak_force_N;
      assert.equal(peak, nativeJson(scenario, "--set", set).peak_force_N);
      const recipe = await taken(page, "#recipe", `${name}-figure.yaml`);
      execFileSync(program, ["plot", recipe, "-o", join(files, `${name}-figure.png`), "-q"]);
      const picture = readFileSync(await taken(page, "#png", `${name}.png`));
      assert.equal(picture.toString("latin1", 1, 4), "PNG");
      assert.ok(picture.readUInt32BE(20) > 400);
      await page.close();
    }
  },

  async "a finger on a phone drags the voltage and chooses touch"() {
    const page = await openPage(`${address}index.html`, 360, 740, { touch: true });
    const before = await peakOf(page);
    await drag(page, "#knob-motor-voltage", 0.6, 0.8, page.touchscreen);
    assert.ok((await peakOf(page)) > before);

    // slider, peak and force are in view together
    for (const selector of ["#knob-motor-voltage", "#strip", "#plots canvas"]) {
      const box = await (await page.$(selector)).boundingBox();
      assert.ok(box.y >= 0 && box.y + 40 < 740, `${selector} at ${box.y} is out of view`);
    }
    await page.select("#knob-control-law", "touch");
    await settled(page);
    assert.equal((await cells(page)).length, 2);
    await page.close();
  },

  async "it fits every width, light and dark, with a name for every control"() {
    for (const width of [360, 768, 1280]) {
      for (const dark of [false, true]) {
        const url = `${address}index.html#scenario=compare/hybrid&set=control.force=2&show=gap,energy`;
        const page = await openPage(url, width, 900, { dark, touch: width === 360 });
        await page.screenshot({
          path: join(output, `page-${width}-${dark ? "dark" : "light"}.png`),
          fullPage: true,
        });
        const room = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
        assert.ok(room[0] <= room[1], `${room[0]} px wide at ${width}`);
        const nameless = await namelessControls(page);
        assert.deepEqual(nameless, []);
        await page.close();
      }
    }
  },

  async "one file alone works from the disk, and nothing may be evaluated"() {
    const page = await openPage(`file://${join(folder, "impactlab.html")}`, 1280, 900);
    near(await peakOf(page), 1.34, 0.005);
    for (const url of [page.url(), `${address}index.html`]) {
      await page.goto(url);
      await settled(page);
      // in a task of the page's own: what a debugger evaluates is exempt
      const refused = await page.evaluate(
        () =>
          new Promise((resolve) => {
            setTimeout(() => {
              try {
                resolve(new Function("return 'evaluated'")());
              } catch (error) {
                resolve(error.name);
              }
            });
          }),
      );
      assert.equal(refused, "EvalError");
    }
    await page.close();
  },

  async "a report's figure moves, and its drawing comes back"() {
    const report = join(files, "report");
    execFileSync(program, ["report", "corrected/first-impact", "--live", "-q", "-o", report]);
    const page = await browser.newPage();
    await page.goto(`file://${report}/report.html`);
    const press = (text) =>
      page.evaluate((wanted) => {
        const all = [...document.querySelectorAll("button")];
        all.find((button) => button.textContent === wanted).click();
      }, text);
    await press("Move its knobs");
    const frame = await page.waitForFrame((one) => one.url().startsWith("blob:"));
    await settled(frame);
    near(await peakOf(frame), 1.34, 0.005);
    assert.equal(await page.$eval(".drawing", (one) => one.clientHeight), 0);
    await press("Back to the drawing");
    assert.ok((await page.$eval(".drawing", (one) => one.clientHeight)) > 0);
    await page.close();
  },

  async "a damaged link is no end"() {
    for (const hash of [
      "#scenario=no/such&at=x",
      "#text=%%%",
      "#set=motor.voltage=x;=;a=b",
      "#show=,x,gap",
    ]) {
      const page = await openPage(`${address}index.html${hash}`, 1280, 900);
      await page.select("#scenario", "corrected/first-impact");
      await settled(page);
      near(await peakOf(page), 1.34, 0.005);
      await page.close();
    }
  },
};

async function namelessControls(page) {
  const found = [];
  const look = (node) => {
    if (/^(slider|button|combobox|textbox|checkbox)$/.test(node.role) && !node.name) {
      found.push(node.role);
    }
    (node.children ?? []).forEach(look);
  };
  look(await page.accessibility.snapshot());
  return found;
}

const wanted = process.argv.slice(6);
let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  if (wanted.length > 0 && !wanted.some((word) => name.includes(word))) {
    continue;
  }
  try {
    await test();
    console.log(`ok: ${name}`);
  } catch (error) {
    console.log(`FAILED: ${name}\n${error.message}`);
    failed += 1;
  }
}
if (troubles.length > 0 || elsewhere.length > 0) {
  console.log(`FAILED: errors ${troubles.join("; ")}, requests elsewhere ${elsewhere.join(" ")}`);
  failed += 1;
}
await browser.close();
server.close();
process.exit(failed > 0 ? 1 : 0);
