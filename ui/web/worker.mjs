// What the worker does: opens scenarios, runs them, and hands out what the page draws.
import { labOf } from "./lab.mjs";

const MOST_ROWS = 6000; // that a curve is drawn through
const MOST_ANGLES = 1e6; // that poses of the arm are drawn from

let lab = null;
let opened = { name: null, text: null, scenario: null };

// The scenario of a request with its changes; it has `faults` if it cannot be run.
function open({ name, text, changes }) {
  if (opened.name !== name || opened.text !== text) {
    opened = { name, text, scenario: lab.read(name, text) };
  }
  if (opened.scenario.faults) {
    return { ...opened.scenario, inFile: true };
  }
  return lab.change(changes);
}

// The rows to draw: all, or of so many stretches the first, and the smallest and largest force.
function keptRows(force) {
  const count = force.length;
  const stretches = Math.min(count, MOST_ROWS / 3);
  if (count <= MOST_ROWS) {
    return Uint32Array.from({ length: count }, (_, i) => i);
  }
  const kept = new Set([count - 1]);
  for (let s = 0; s < stretches; s++) {
    const from = Math.floor((s * count) / stretches);
    const to = Math.floor(((s + 1) * count) / stretches);
    let least = from;
    let most = from;
    for (let i = from; i < to; i++) {
      least = force[i] < force[least] ? i : least;
      most = force[i] > force[most] ? i : most;
    }
    [from, least, most].forEach((i) => kept.add(i));
  }
  return Uint32Array.from(kept).sort();
}

// The poses at some of the rows: their instants and, one after the other, the links' angles.
function posesOf(time, links) {
  const freedoms = lab.freedoms();
  const all = lab.angles();
  const every = Math.max(1, Math.ceil((time.length * freedoms) / MOST_ANGLES));
  const count = Math.ceil(time.length / every);
  const angles = new Float64Array(count * links);
  const times = new Float64Array(count);
  for (let i = 0; i < count; i++) {
    // the hub's angle, where it is one of its own, comes first
    const from = i * every * freedoms + freedoms - links;
    angles.set(all.subarray(from, from + links), i * links);
    times[i] = time[i * every];
  }
  return { times, angles, links };
}

const answers = {
  run(request) {
    const scenario = open(request);
    if (scenario.faults) {
      return { scenario };
    }
    const start = performance.now();
    const result = JSON.parse(lab.run(request.seconds, true));
    const late = performance.now() - start > 1e3 * request.seconds;
    const predictions = JSON.parse(lab.predictions());
    const time = lab.signal("time");
    const rows = keptRows(lab.signal("force"));
    const signals = {};
    for (const name of new Set([...request.signals, ...scenario.panes])) {
      const values = lab.signal(name);
      signals[name] = Float64Array.from(rows, (row) => values[row]);
    }
    const links = Math.min(scenario.values["arm.links"], lab.freedoms());
    return {
      scenario,
      result,
      late,
      predictions,
      account: lab.account(),
      rows: time.length,
      signals,
      poses: posesOf(time, links),
    };
  },

  sweep(request) {
    const values = [];
    for (const value of request.values) {
      const scenario = open({
        ...request,
        changes: { ...request.changes, [request.path]: value },
      });
      const ran = scenario.faults ? null : JSON.parse(lab.run(request.seconds, false));
      values.push(ran === null || ran.status === "failed" ? null : ran[request.key]);
      self.postMessage({ number: request.number, part: [...values] });
    }
    return values;
  },

  csv(request) {
    const scenario = open(request);
    if (scenario.faults) {
      throw new Error(scenario.faults[0]);
    }
    lab.run(request.seconds, true);
    return lab.csv();
  },

  yaml(request) {
    const scenario = open(request);
    if (scenario.faults) {
      throw new Error(scenario.faults[0]);
    }
    return lab.yaml();
  },

  tables: () => lab.tables(),
};

// The worker gets the compiled module first, as it is the same for each that is begun anew.
async function begin(compiled) {
  const module = await startImpactlab({
    instantiateWasm(imports, receive) {
      WebAssembly.instantiate(compiled, imports).then((instance) => receive(instance, compiled));
      return {};
    },
  });
  lab = labOf(module);
}

let begun = null;
self.onmessage = async ({ data }) => {
  if (data.compiled) {
    begun = begin(data.compiled);
    return;
  }
  try {
    await begun;
    self.postMessage({ number: data.number, answer: answers[data.kind](data) });
  } catch (error) {
    self.postMessage({ number: data.number, failure: error.message });
  }
};
