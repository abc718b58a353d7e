// The page: what was chosen goes to the worker, what it computed is drawn.
import { createArm, rowAt } from "./arm.mjs";
import { createEditor } from "./editor.mjs";
import { createEngine } from "./engine.mjs";
import { recipeOf, save, savePicture } from "./files.mjs";
import { createKnobs } from "./knobs.mjs";
import { createPlots, neededSignals, signalsOf } from "./plots.mjs";
import {
  fillEvents,
  fillNumbers,
  fillPredictors,
  fillStrip,
  peakKey,
  summaryOf,
} from "./results.mjs";
import { FIRST_SCENARIO, MOST_KEPT, hashOf, stateOf } from "./state.mjs";
import { element, fillTable, measured, shortName } from "./words.mjs";

const RUN_SECONDS = 8; // of computing, then a run ends with what it has
const MOST_SECONDS = 12; // then the worker is ended
const USUAL_PANES = ["gap", "hub_velocity", "command"]; // the last one under a law
const MOST_HASH = 50000; // letters of a link
const SPEEDS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2];
const at = (id) => document.getElementById(id);

// --- what the page is made of: files beside it, or texts within it ---------------------------

// The bytes of a part that the page holds, in base64; null if it lies in a file.
function heldPart(id) {
  const text = at(id)?.textContent;
  return text ? Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)) : null;
}

async function partOf(id, file) {
  const held = heldPart(id);
  if (held !== null) {
    return held;
  }
  const answer = await fetch(file);
  if (!answer.ok) {
    throw new Error(`${file} cannot be read (${answer.status}).`);
  }
  return answer.arrayBuffer();
}

function workerUrl() {
  const held = heldPart("part-worker");
  return held ? URL.createObjectURL(new Blob([held], { type: "text/javascript" })) : "worker.js";
}

// --- state -----------------------------------------------------------------------------------

let catalogue = new Map(); // of scenarios: {title, text}
let tables = null;
let state = stateOf(location.hash);
let history = []; // of states, for undo
let runs = []; // as drawn, this one first
let beside = []; // of them the reference and those that are kept
let besideOf = ""; // what these were asked for
let playing = false;
let speed = 0.2;
let engine, sweeper, knobs, plots, arm, editor;

function scenarioText() {
  return state.text ?? catalogue.get(state.scenario)?.text ?? "";
}

function requestOf(kind, changes, more) {
  const { scenario: name } = state;
  return { kind, name, text: scenarioText(), changes, seconds: RUN_SECONDS, ...more };
}

function panesOf({ panes, values }) {
  const [gap, lawless, lawful] = USUAL_PANES;
  const usual = [gap, values["control.law"] === "none" ? lawless : lawful];
  const wanted = state.show ?? (panes.length > 0 ? panes : usual);
  const isKnown = (pane) => pane === "energy" || tables.signals.some(({ name }) => name === pane);
  return wanted.filter((pane) => pane !== "force" && isKnown(pane));
}

// Another state; what belongs to the moment before is undone with it.
function change(next, sameMoment = false) {
  if (!sameMoment) {
    history = [...history.slice(-200), state];
  }
  state = { ...state, ...next };
  refresh();
}

let lastChange = { path: "", when: -Infinity };
function changeValue(path, value) {
  const when = performance.now();
  const sameMoment = lastChange.path === path && when - lastChange.when < 1000;
  lastChange = { path, when };
  change({ changes: { ...state.changes, [path]: value } }, sameMoment);
}

function undo() {
  if (history.length > 0) {
    state = history.pop();
    lastChange = { path: "", when: -Infinity };
    refresh();
  }
}

function open(scenario) {
  change({ scenario, text: null, changes: {}, kept: [], show: null, at: null });
}

function keep() {
  if (state.kept.length >= MOST_KEPT) {
    complain(`At most ${MOST_KEPT} runs are kept beside this one; drop one first.`);
    return;
  }
  change({ kept: [...state.kept, state.changes] });
}

// Browsers bound how often an address may change.
let hashTimer = 0;
function writeHash() {
  clearTimeout(hashTimer);
  hashTimer = setTimeout(() => {
    const hash = hashOf(state);
    window.history.replaceState(null, "", hash.length < MOST_HASH ? hash : "#");
  }, 300);
}

// --- computing -------------------------------------------------------------------------------

// Says what went wrong, or a remark on what did not.
function complain(text, isRemark = false) {
  at("message").textContent = text;
  at("message").classList.toggle("remark", isRemark);
}

function labelOf(changes) {
  const words = Object.entries(changes).map(([path, value]) => {
    const unit = tables.parameters.find((row) => row.path === path)?.unit ?? "";
    return `${shortName(path, tables.parameters)} ${value} ${unit}`.trim();
  });
  return words.join(", ") || "as opened";
}

// A run of the scenario with changes; null if a newer one came before it.
async function runOf(changes, options) {
  const every = tables.signals.map(({ name }) => name);
  const signals = neededSignals(state.show ?? USUAL_PANES).filter((name) => every.includes(name));
  const answer = await engine.ask(requestOf("run", changes, { signals }), options);
  return answer && { ...answer, changes, label: labelOf(changes) };
}

function besideWanted() {
  return JSON.stringify([state.scenario, state.text, state.kept, state.show]);
}

// Computes the reference, which is the scenario as it was opened, and the runs that are kept.
async function runBeside(run) {
  const wanted = besideWanted();
  if (wanted === besideOf) {
    return false;
  }
  besideOf = wanted;
  const entries = [
    [{}, { isReference: true }],
    ...state.kept.map((changes, kept) => [changes, { kept }]),
  ];
  const found = [];
  for (const [changes, more] of entries) {
    const same = JSON.stringify(changes) === JSON.stringify(run.changes);
    found.push({ ...(same ? run : await runOf(changes)), ...more });
    if (wanted !== besideWanted()) {
      return false;
    }
  }
  beside = found.filter(({ scenario }) => !scenario.faults);
  return true;
}

// Runs what the state says and draws it. While a knob is dragged a run may come when newer values are
// known already: it is drawn, too, if it is of the same scenario.
let refreshes = 0;
async function refresh() {
  writeHash();
  at("scenario").value = state.scenario;
  editor.set(scenarioText());
  if (besideOf !== besideWanted()) {
    beside = [];
  }
  refreshes += 1;
  const asked = refreshes;
  const wanted = besideWanted();
  document.body.dataset.state = "busy";
  try {
    const run = await runOf(state.changes, { newest: true });
    if (run === null || wanted !== besideWanted()) {
      return;
    }
    take(run);
    if ((await runBeside(run)) && asked === refreshes) {
      take(run);
    }
    if (asked === refreshes && !run.scenario.faults) {
      knobs.again(lastChange.path);
    }
  } catch (error) {
    besideOf = "";
    complain(error.message);
  }
  if (asked === refreshes) {
    requestAnimationFrame(() => (document.body.dataset.state = "drawn"));
  }
}

function sweep(path, values, progress) {
  const key = peakKey(runs[0].scenario.values);
  const more = { path, values, key, seconds: RUN_SECONDS / values.length };
  return sweeper
    .ask(requestOf("sweep", state.changes, more), { newest: true, progress })
    .catch((error) => complain(error.message));
}

// --- drawing ---------------------------------------------------------------------------------

let frame = 0;
function take(run) {
  const { faults, inFile } = run.scenario;
  editor.complain(inFile ? faults : []);
  if (faults) {
    complain(inFile ? "The file has faults; the curves are those of before." : faults.join(" "));
    at("file").open ||= Boolean(inFile);
    return;
  }

  // without changes this run is the reference itself
  const isReference = Object.keys(run.changes).length === 0;
  const others = beside.filter((one) => !isReference || !one.isReference);
  runs = [{ ...run, isReference }, ...others];
  cancelAnimationFrame(frame);
  frame = requestAnimationFrame(draw);
}

function instant() {
  const { first_contact_s: contact, time_to_peak_s: delay } = runs[0].result;
  return state.at ?? (contact ?? 0) + (delay ?? 0);
}

function draw() {
  const [run] = runs;
  const { scenario, result } = run;
  at("title").textContent = scenario.title;
  at("title").title = scenario.description;
  fillStrip(at("strip"), runs, (kept) => change({ kept: state.kept.filter((_, i) => i !== kept) }));
  at("why").firstElementChild.textContent = run.account.line;
  at("why").lastElementChild.textContent = run.account.sentences.join(" ");
  const late = run.late ? `; in the page a run computes for ${RUN_SECONDS} s at most` : "";
  complain(result.message + late, result.status === "ok");
  knobs.update(scenario, run.changes);
  plots.draw(runs, panesOf(scenario), instant());
  arm.draw(runs, instant());
  showClock();
  fillPredictors(at("predictors"), run);
  fillOpen();
  summarise();
  performance.mark("drawn");
}

// Tables that are folded away need no rows.
function fillOpen() {
  if (runs.length === 0) {
    return;
  }
  if (at("events").closest("details").open) {
    fillEvents(at("events"), runs[0], seek);
  }
  if (at("numbers").closest("details").open) {
    fillNumbers(at("numbers"), tables.numbers, runs[0]);
  }
  if (at("signals").open) {
    fillSignals();
  }
}

let summaryTimer = 0;
function summarise() {
  clearTimeout(summaryTimer);
  summaryTimer = setTimeout(() => (at("summary").textContent = summaryOf(runs)), 600);
}

function fillSignals() {
  const shown = panesOf(runs[0].scenario);
  const names = ["energy", ...tables.signals.map(({ name }) => name).slice(1)];
  const boxes = names
    .filter((name) => name !== "force" && name !== "impulse")
    .map((name) => {
      const box = element("input", { type: "checkbox", checked: shown.includes(name) });
      box.addEventListener("change", () => {
        const others = panesOf(runs[0].scenario).filter((pane) => pane !== name);
        change({ show: box.checked ? [...others, name].slice(-6) : others });
      });
      const about = tables.signals.find((row) => row.name === name)?.about;
      return element(
        "label",
        { title: about ?? "the energy balance" },
        box,
        ` ${name.replaceAll("_", " ")}`,
      );
    });
  at("signals")
    .querySelector(".choices")
    .replaceChildren(...boxes);
}

// --- time ------------------------------------------------------------------------------------

function showClock() {
  at("clock").textContent = `${instant().toFixed(4)} s`;
  at("play").textContent = playing ? "Pause" : "Play";
}

function seek(time) {
  const end = runs[0].signals.time.at(-1);
  state = { ...state, at: Math.min(Math.max(time, 0), end) };
  plots.mark(state.at);
  arm.draw(runs, state.at);
  showClock();
  if (!playing) {
    writeHash();
  }
}

function step(rows) {
  const { time } = runs[0].signals;
  let row = rowAt(time, instant());

  // several rows of one instant are one step back
  while (rows < 0 && row > 0 && time[row - 1] === time[row]) {
    row -= 1;
  }
  playing = false;
  seek(time[Math.min(Math.max(row + rows, 0), time.length - 1)]);
}

function toEvent(by) {
  const times = runs[0].result.events.map(({ t_s }) => t_s);
  const now = instant();
  const next = by > 0 ? times.find((time) => time > now) : times.findLast((time) => time < now);
  playing = false;
  if (next !== undefined) {
    seek(next);
  }
  showClock();
}

function play() {
  playing = !playing;
  const end = runs[0].signals.time.at(-1);
  if (playing && instant() >= end) {
    seek(0);
  }
  let last = performance.now();
  const tick = (now) => {
    if (!playing) {
      return;
    }
    seek(instant() + ((now - last) / 1e3) * speed);
    last = now;
    if (instant() >= runs[0].signals.time.at(-1)) {
      playing = false;
      seek(instant());
      return;
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
  showClock();
}

function replay() {
  seek(0);
  if (!playing) {
    play();
  }
}

function setSpeed(by) {
  const place = SPEEDS.indexOf(speed) + by;
  speed = SPEEDS[Math.min(Math.max(place, 0), SPEEDS.length - 1)];
  at("speed").value = String(speed);
}

// --- files -----------------------------------------------------------------------------------

function fileName() {
  return state.scenario.replaceAll("/", "-");
}

function picture() {
  const texts = [{ text: runs[0].scenario.title, ink: "ink" }];
  runs.forEach(({ label, result }, i) => {
    const peak = measured(result[peakKey(runs[0].scenario.values)], "N");
    const impulse = measured(result.contact_impulse_Ns, "N s");
    texts.push({ text: `━ ${label}: peak ${peak}, impulse ${impulse}`, ink: `run${i}` });
  });
  savePicture(`${fileName()}.png`, texts, [at("arm"), ...plots.canvases()]);
}

async function download(kind, ending, type) {
  try {
    const text = await engine.ask(requestOf(kind, state.changes));
    save(`${fileName()}.${ending}`, text, type);
  } catch (error) {
    complain(error.message);
  }
}

// A recipe knows shipped scenarios by name, an edited one by the file that is saved with it.
function recipe() {
  const edited = state.text !== null;
  const file = edited ? `${fileName()}.yaml` : state.scenario;
  const panes = ["force", ...panesOf(runs[0].scenario)].map(signalsOf);
  const text = recipeOf(runs[0].scenario.title, file, runs, panes);
  save(`${fileName()}-figure.yaml`, text, "text/yaml");
  if (edited) {
    save(file, state.text, "text/yaml");
  }
}

async function writeChanges() {
  try {
    const text = await engine.ask(requestOf("yaml", state.changes));
    change({ text, changes: {} });
  } catch (error) {
    complain(error.message);
  }
}

async function copyLink() {
  const hash = hashOf(state);
  if (hash.length >= MOST_HASH) {
    complain("The file is too long for a link; save it as YAML and send that.");
    return;
  }
  window.history.replaceState(null, "", hash);
  try {
    await navigator.clipboard.writeText(location.href);
    at("link").textContent = "Copied";
  } catch {
    complain("The browser does not let the page copy; the address bar has the link.");
  }
  setTimeout(() => (at("link").textContent = "Link"), 2000);
}

// --- keys ------------------------------------------------------------------------------------

// The terminal's keys: what they are called, what they do, and the key of the event.
const KEYS = [
  ["Space", "play or pause", [" "], play],
  ["→ ←", "one row on or back", ["ArrowRight", "l"], () => step(1)],
  ["", "", ["ArrowLeft", "h"], () => step(-1)],
  ["PgDn PgUp", "twenty rows", ["PageDown"], () => step(20)],
  ["", "", ["PageUp"], () => step(-20)],
  ["n N", "next event, the one before", ["n"], () => toEvent(1)],
  ["", "", ["N"], () => toEvent(-1)],
  ["g G", "to the start, to the end", ["Home", "g"], () => seek(0)],
  ["", "", ["End", "G"], () => seek(Infinity)],
  ["+ −", "faster, slower", ["+", "="], () => setSpeed(1)],
  ["", "", ["-"], () => setSpeed(-1)],
  ["r", "play from the start", ["r", "Backspace"], replay],
  ["j k", "next knob, the one before", ["j"], () => knobs.move(1)],
  ["", "", ["k"], () => knobs.move(-1)],
  ["> <", "the knob a little up or down", [">"], () => knobs.nudge(1)],
  ["", "", ["<"], () => knobs.nudge(-1)],
  ["/", "look for a parameter", ["/"], () => at("more").focus()],
  ["C", "choose a law", ["C"], () => at("knob-control-law").focus()],
  ["b", "keep this run beside the others", ["b"], keep],
  ["u", "undo", ["u"], undo],
  ["s", "save the picture", ["s"], picture],
  ["?", "this list", ["?"], () => at("keys").showModal()],
];

function onKey(event) {
  const { target, key } = event;
  const types =
    /^(textarea|select)$/i.test(target.tagName) ||
    target.matches("input:not([type=range]):not([type=checkbox])");
  const own = target.type === "range" && /^(Arrow|Page|Home|End)/.test(key);
  const pressed = /^(button|summary|a)$/i.test(target.tagName) || target.type === "checkbox";
  if (types || own || (pressed && /^( |Enter)$/.test(key)) || at("keys").open) {
    return;
  }
  const found = KEYS.find(([, , keys]) => keys.includes(key));
  if (found && !event.ctrlKey && !event.metaKey && !event.altKey && runs.length > 0) {
    event.preventDefault();
    found[3]();
  }
}

// --- the beginning ---------------------------------------------------------------------------

function fillControls() {
  const groups = new Map();
  for (const [name, { title }] of catalogue) {
    const group = name.split("/")[0];
    if (!groups.has(group)) {
      groups.set(group, element("optgroup", { label: group }));
    }
    groups
      .get(group)
      .append(element("option", { value: name }, `${name.split("/").at(-1)}: ${title}`));
  }
  at("scenario").replaceChildren(...groups.values());
  at("speed").replaceChildren(...SPEEDS.map((one) => element("option", { value: one }, `x${one}`)));
  setSpeed(0);
  at("paths").replaceChildren(
    ...tables.parameters.map(({ path, about }) => element("option", { value: path }, about)),
  );
  fillTable(
    at("keys").querySelector("table"),
    ["key", "does"],
    KEYS.filter(([name]) => name).map(([name, does]) => [name, does]),
  );
}

function listen() {
  const actions = { undo, keep, play, png: picture, recipe, write: writeChanges, link: copyLink };
  for (const [id, act] of Object.entries(actions)) {
    at(id).addEventListener("click", () => act());
  }
  at("reset").addEventListener("click", () => change({ text: null, changes: {}, kept: [] }));
  at("back").addEventListener("click", () => step(-1));
  at("step").addEventListener("click", () => step(1));
  at("event").addEventListener("click", () => toEvent(1));
  at("help").addEventListener("click", () => at("keys").showModal());
  at("csv").addEventListener("click", () => download("csv", "csv", "text/csv"));
  at("yaml").addEventListener("click", () => download("yaml", "yaml", "text/yaml"));
  at("scenario").addEventListener("change", () => open(at("scenario").value));
  at("speed").addEventListener("change", () => (speed = Number(at("speed").value)));
  at("more").addEventListener("change", () => {
    const path = at("more").value.trim();
    if (tables.parameters.some((row) => row.path === path)) {
      knobs.look(path);
      at("more").value = "";
      draw();
    } else if (path) {
      complain(`There is no parameter '${path}'; the list beside the field has all of them.`);
    }
  });
  document.querySelectorAll("details").forEach((box) => box.addEventListener("toggle", fillOpen));
  document.addEventListener("keydown", onKey);
  const again = () => runs.length > 0 && draw();
  addEventListener("resize", again);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  addEventListener("hashchange", () => change(stateOf(location.hash)));
}

async function begin() {
  document.body.classList.toggle("embedded", new URLSearchParams(location.hash).has("embedded"));
  const [binary, listed] = await Promise.all([
    partOf("part-wasm", "impactlab.wasm"),
    partOf("part-scenarios", "scenarios.json"),
  ]);
  const scenarios = JSON.parse(new TextDecoder().decode(listed));
  catalogue = new Map(scenarios.map((one) => [one.name, one]));
  if (state.text === catalogue.get(state.scenario)?.text) {
    state.text = null; // it was not edited
  }
  const compiled = await WebAssembly.compile(binary);
  const url = workerUrl();
  const startWorker = () => {
    const worker = new Worker(url);
    worker.postMessage({ compiled });
    return worker;
  };
  engine = createEngine(startWorker, MOST_SECONDS);
  sweeper = createEngine(startWorker, MOST_SECONDS);
  tables = await engine.ask({ kind: "tables" });

  const units = Object.fromEntries(tables.signals.map(({ name, unit }) => [name, unit]));
  knobs = createKnobs(at("knob-list"), tables, { onChange: changeValue, sweep });
  plots = createPlots(at("plots"), { ...units, energy: "J" }, (time) => {
    playing = false;
    seek(time);
  });
  arm = createArm(at("arm"));
  editor = createEditor({ lines: at("lines"), text: at("text"), faults: at("faults") }, (text) =>
    change({ text }),
  );
  fillControls();
  listen();
  const known = catalogue.has(state.scenario);
  if (!known && state.text === null) {
    const lost = state.scenario;
    state = { ...state, scenario: FIRST_SCENARIO, changes: {}, kept: [] };
    await refresh();
    complain(`There is no scenario '${lost}'; this is the first one.`);
    return;
  }
  refresh();
}

begin().catch((error) => complain(`The lab cannot begin: ${error.message}`));
