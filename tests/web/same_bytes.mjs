#!/usr/bin/env node
// Shipped scenarios under Node: JSON, traces and predictions have the bytes of the native program.
//
//   same_bytes.mjs PROGRAM MODULE_FOLDER SCENARIOS [NAME...]
//
// Left out are the times that a run took, and what a page cannot do: laws that are programs or
// plug-ins, and files that a scenario names. MODULE_FOLDER is an absolute path.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

import { labOf } from "../../ui/web/lab.mjs";

const [program, folder, scenarios, ...wanted] = process.argv.slice(2);

function native(...options) {
  return execFileSync(program, options, {
    encoding: "utf8",
    maxBuffer: 2 ** 30,
    stdio: ["ignore", "pipe", "ignore"],
  });
}

// What the program wrote, also where its exit status says that the run or a prediction failed.
function nativeAnyway(...options) {
  try {
    return native(...options);
  } catch (failure) {
    return failure.stdout;
  }
}

function withoutTimes(json) {
  return json.replace(/^ *"(wall|cpu)_time_s": .*\n/gm, "");
}

// Where two texts begin to differ, with what stands there.
function difference(ours, theirs) {
  let at = 0;
  while (at < ours.length && ours[at] === theirs[at]) {
    at++;
  }
  const from = Math.max(0, at - 40);
  return `${JSON.stringify(ours.slice(from, at + 40))} and natively ${JSON.stringify(theirs.slice(from, at + 40))}`;
}

function needsOtherFiles(text) {
  return /^\s*(law: *(process|plugin)|[a-z_]*file:)/m.test(text);
}

const start = createRequire(import.meta.url)(join(folder, "impactlab.js"));
const wasmBinary = readFileSync(join(folder, "impactlab.wasm"));
const names = wanted.length ? wanted : native("list", "--json", "-").match(/(?<="name": ")[^"]*/g);
let compared = 0;
let left = 0;
let wrong = 0;
for (const name of names) {
  const text = readFileSync(join(scenarios, `${name}.yaml`), "utf8");
  if (needsOtherFiles(text)) {
    left++;
    continue;
  }

  // a module of its own for each, so that none sees what another one left
  const lab = labOf(await start({ wasmBinary }));
  const scenario = lab.read(name, text);
  if (scenario.faults) {
    console.log(`${name}: refused under Node: ${scenario.faults.join(" ")}`);
    wrong++;
    continue;
  }
  const answers = {
    JSON: [
      withoutTimes(lab.run(3600, true)),
      withoutTimes(nativeAnyway("run", name, "--quiet", "--json", "-")),
    ],
    CSV: [lab.csv(), nativeAnyway("run", name, "--quiet", "--csv", "-")],
    predictions: [
      lab.predictions().replace(/^null\n$/, ""),
      nativeAnyway("predict", name, "--quiet", "--json", "-"),
    ],
  };
  for (const [kind, [ours, theirs]] of Object.entries(answers)) {
    if (ours !== theirs) {
      console.log(`${name}: ${kind} differs: under Node ${difference(ours, theirs)}`);
      wrong++;
    }
  }
  compared++;
}
console.log(`${compared} scenarios compared, ${left} need other files, ${wrong} wrong`);
process.exit(wrong > 0 || compared === 0 ? 1 : 0);
