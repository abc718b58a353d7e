// The parameters that stand beside the curves, each with a slider, a choice or a switch, and, where
// it is asked for, the peak over the slider's range.
import { colour, digits, element, shortName } from "./words.mjs";

const STEPS = 1000; // of a slider
const MOST = 9; // knobs at first
const SWEPT = 31; // values of a sweep
const USUAL = ["motor.voltage", "arm.k2", "wall.angle", "wall.kind", "arm.links"];
const USUAL_OF_LAW = ["control.force", "control.approach_voltage"];

function valueAt(slider, share) {
  const { low, high, logarithmic, whole } = slider;
  const value = logarithmic ? low * (high / low) ** share : low + share * (high - low);
  const step = 10 ** (Math.floor(Math.log10(logarithmic ? value : high - low)) - 3);
  return whole ? Math.round(value) : Number((Math.round(value / step) * step).toPrecision(12));
}

function shareOf(slider, value) {
  const { low, high, logarithmic } = slider;
  const share = logarithmic
    ? Math.log(value / low) / Math.log(high / low)
    : (value - low) / (high - low);
  return Math.min(1, Math.max(0, Number.isFinite(share) ? share : 0));
}

// A law's own number as a parameter with a slider.
function settingRow({ name, unit, about, initial, minimum, maximum }) {
  const about10 = initial !== 0 ? 10 * Math.abs(initial) : 1;
  return {
    path: `control.settings.${name}`,
    unit,
    about,
    initial,
    choices: "",
    slider: {
      low: Math.max(minimum, minimum < 0 ? -about10 : 0),
      high: Math.min(maximum, about10),
      logarithmic: false,
    },
  };
}

// onChange(path, value) takes a value as text, sweep(path, values, take) has take() called with the
// peaks known so far.
export function createKnobs(host, tables, { onChange, sweep }) {
  const byPath = new Map(tables.parameters.map((row) => [row.path, row]));
  const made = new Map();
  const asked = new Set(); // that a person looked for
  let order = "";
  let shown = null;
  const fold = element("details", {}, element("summary", {}, "The law's own numbers"));

  function rowsOf(scenario) {
    const settings = scenario.law.settings.map(settingRow);
    const sliders = new Map(scenario.sliders.map((slider) => [slider.path, slider]));
    const rows = [...byPath.values()].map((row) => ({
      ...row,
      slider: sliders.has(row.path) ? { ...sliders.get(row.path), whole: row.whole } : undefined,
    }));
    return new Map([...rows, ...settings].map((row) => [row.path, row]));
  }

  // The law, what a person looked for or changed, what the law needs, then what was given.
  function pathsOf(scenario, changes, rows) {
    const idle = new Set(scenario.without_effect.map(({ path }) => path));
    const lawless = scenario.values["control.law"] === "none";
    const usual = lawless ? USUAL : [...USUAL_OF_LAW, ...USUAL.slice(1)];
    const settings = lawless
      ? []
      : [...rows.keys()].filter((path) => path.startsWith("control.settings."));
    const given = scenario.given.filter((path) => !/^method\.|^control\.settings$/.test(path));
    const wanted = [usual[0], "control.law", ...asked, ...Object.keys(changes)];
    const others = [...usual, ...given, ...scenario.law.shared].filter((path) => !idle.has(path));
    const paths = [...new Set([...wanted, ...others])].filter((path) => rows.has(path));
    const least = new Set(wanted).size;
    const first = paths.slice(0, Math.max(least, MOST));
    return { first, folded: settings.filter((path) => !first.includes(path)) };
  }

  function label(row, id) {
    const title = `${row.path}: ${row.about}`;
    return element("label", { htmlFor: id, title }, shortName(row.path, tables.parameters));
  }

  function createNumber(row, id) {
    const slider = element("input", { type: "range", min: 0, max: STEPS, step: 1, id });
    const field = element("input", { className: "value", inputMode: "decimal" });
    field.setAttribute("aria-label", `${row.path} in ${row.unit || "1"}`);
    const over = element("canvas", { className: "over", hidden: true, role: "img" });
    over.setAttribute("aria-label", `peak force over ${row.path}`);
    const button = element("button", {
      className: "sweep",
      title: `the peak over ${row.path}`,
      textContent: "∿",
    });
    button.setAttribute("aria-label", `peak over ${row.path}`);
    button.setAttribute("aria-pressed", "false");
    const knob = { row, peaks: null, slider, field, over };

    slider.addEventListener("input", () => {
      const value = valueAt(knob.row.slider, slider.value / STEPS);
      field.value = String(value);
      onChange(row.path, String(value));
    });
    field.addEventListener("change", () => onChange(row.path, field.value));
    button.addEventListener("click", () => {
      over.hidden = !over.hidden;
      button.setAttribute("aria-pressed", String(!over.hidden));
      startSweep(knob);
    });
    const box = element("div", { className: "knob" }, label(row, id), field);
    box.append(element("span", { className: "unit" }, row.unit), button, slider, over);
    knob.box = box;
    knob.update = (value) => {
      // a finger on the slider, or a caret in the field, is not pushed aside
      if (document.activeElement !== field && !slider.matches(":active")) {
        field.value =
          value === null || value === undefined ? "" : String(Number(value.toPrecision(7)));
      }
      if (!slider.matches(":active")) {
        slider.value = Math.round(STEPS * shareOf(knob.row.slider, value));
      }
      slider.setAttribute("aria-valuetext", `${digits(value, 4)} ${row.unit}`);
      drawSweep(knob, value);
    };
    return knob;
  }

  function createChoice(row, id) {
    const words = row.switch ? ["false", "true"] : row.choices.split("|");
    const list = element("select", { id });
    list.append(...words.map((word) => element("option", { value: word }, word)));
    list.addEventListener("change", () => onChange(row.path, list.value));
    const box = element("div", { className: "knob" }, label(row, id), list);
    return { row, box, update: (value) => (list.value = String(value)) };
  }

  function createText(row, id) {
    const field = element("input", { id, className: "text" });
    field.addEventListener("change", () => onChange(row.path, field.value));
    const box = element("div", { className: "knob" }, label(row, id), field);
    return { row, box, update: (value) => (field.value = String(value ?? "")) };
  }

  function create(row) {
    const id = `knob-${row.path.replaceAll(".", "-")}`;
    if (row.choices || row.switch) {
      return createChoice(row, id);
    }
    return row.slider ? createNumber(row, id) : createText(row, id);
  }

  function startSweep(knob) {
    if (knob.over.hidden) {
      return;
    }
    const range = { ...knob.row.slider };
    const values = Array.from({ length: SWEPT }, (_, i) => valueAt(range, i / (SWEPT - 1)));
    sweep(knob.row.path, values, (peaks) => {
      knob.peaks = { range, values, peaks };
      drawSweep(knob, shown.values[knob.row.path] ?? knob.row.initial);
    });
  }

  // The peaks over the slider's range, with the value in force.
  function drawSweep(knob, value) {
    if (knob.over.hidden || knob.peaks === null) {
      return;
    }
    const { range, values, peaks } = knob.peaks;
    const known = peaks.filter((peak) => peak !== null);
    knob.over.dataset.known = peaks.length;
    const most = Math.max(...known, 1e-12);
    const width = knob.over.clientWidth;
    const height = knob.over.clientHeight;
    const scale = devicePixelRatio || 1;
    knob.over.width = width * scale;
    knob.over.height = height * scale;
    const pen = knob.over.getContext("2d");
    pen.scale(scale, scale);
    pen.strokeStyle = colour("run0");
    pen.lineWidth = 1.5;
    pen.beginPath();
    const x = (share) => 8 + share * (width - 16);
    peaks.forEach((peak, i) => {
      if (peak !== null) {
        pen.lineTo(x(shareOf(range, values[i])), height - 3 - (peak / most) * (height - 16));
      }
    });
    pen.stroke();
    pen.fillStyle = colour("ink");
    pen.font = "11px sans-serif";
    pen.fillText(`peak up to ${digits(most)} N`, 8, 10);
    pen.fillRect(x(shareOf(range, value)), 12, 1, height);
  }

  function update(scenario, changes) {
    const rows = rowsOf(scenario);
    const { first, folded } = pathsOf(scenario, changes, rows);
    const paths = [...first, ...folded];
    shown = scenario;
    if (`${first};${folded}` !== order) {
      order = `${first};${folded}`;
      for (const path of paths) {
        const row = rows.get(path);
        const old = made.get(path);
        if (old === undefined || Boolean(old.row.slider) !== Boolean(row.slider)) {
          made.set(path, create(row));
        }
      }
      const focus = document.activeElement;
      const boxOf = (path) => made.get(path).box;
      fold.replaceChildren(fold.firstChild, ...folded.map(boxOf));
      fold.hidden = folded.length === 0;
      host.replaceChildren(...first.map(boxOf), fold);
      if (host.contains(focus)) {
        focus.focus();
      }
    }
    for (const path of paths) {
      const knob = made.get(path);
      if (!knob.slider?.matches(":active")) {
        knob.row = rows.get(path);
      }
      knob.box.classList.toggle("changed", path in changes);
      const why = scenario.without_effect.find((one) => one.path === path)?.why;
      knob.box.classList.toggle("idle", why !== undefined);
      knob.box.title = why ? `no effect: ${why}` : "";
      knob.update(scenario.values[path] ?? knob.row.initial ?? null);
    }
  }

  return {
    update,
    look(path) {
      asked.add(path);
      order = "";
    },
    // What is swept is swept again, after another knob has changed.
    again(path) {
      const others = [...made.values()].filter(
        (knob) => knob.over && knob.row.path !== path && host.contains(knob.box),
      );
      others.forEach(startSweep);
    },
    move(by) {
      const fields = [...host.querySelectorAll("input[type=range], select")];
      const at = fields.indexOf(document.activeElement);
      fields[(at + by + fields.length) % fields.length]?.focus();
    },
    nudge(by) {
      const slider = host.contains(document.activeElement)
        ? document.activeElement
        : host.querySelector("input[type=range]");
      if (slider?.type === "range") {
        slider.value = Number(slider.value) + (by * STEPS) / 50;
        slider.dispatchEvent(new Event("input"));
      }
    },
  };
}
