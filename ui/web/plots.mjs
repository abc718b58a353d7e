// Curves over time by uPlot: the force with half of the height, a lane of contacts and events, and
// the signals that were chosen; each run has its colour, each signal of a pane its dash.
import { colour, digits, element, measured, runMark } from "./words.mjs";

const AXIS = 62; // room of the vertical axes [px]
const RIGHT = 14; // beside the curves [px]
const DASHES = [[], [5, 2.2], [1.2, 1.8], [7, 2, 1.4, 2]];
const ENERGIES = [
  "kinetic_energy",
  "strain_energy",
  "motor_work",
  "viscous_loss",
  "friction_loss",
  "damping_loss",
  "impact_loss",
  "energy_residual",
];

// The signals that a pane shows; "energy" has those of the balance.
export function signalsOf(pane) {
  return pane === "energy" ? ENERGIES : [pane];
}

// All that the panes need, and what the rest of the page does.
export function neededSignals(panes) {
  const always = ["time", "force", "contact", "kinetic_energy", "strain_energy"];
  return [...new Set([...always, ...panes.flatMap(signalsOf)])];
}

// Which rows are the last ones of their instant: a common axis has each value once.
function lastOfEach(times) {
  const rows = [];
  for (let i = 0; i < times.length; i++) {
    if (times[i] !== times[i + 1]) {
      rows.push(i);
    }
  }
  return rows;
}

// This run is drawn last, over the others.
function backwards(runs) {
  return [...runs].reverse();
}

// One table for the panes: the instants of all runs, then the signals of each.
function tableOf(runs, names) {
  const tables = backwards(runs).map((run) => {
    const rows = lastOfEach(run.signals.time);
    return ["time", ...names].map((name) => {
      const values = run.signals[name];
      return rows.map((row) => {
        const value = values?.[row];
        return Number.isFinite(value) ? value : null;
      });
    });
  });
  return uPlot.join(tables);
}

export function createPlots(host, units, onSeek) {
  let plots = [];
  let shape = "";
  let shown = { runs: [], time: 0 };
  const lane = element("canvas", { className: "lane", role: "img" });
  lane.setAttribute("aria-label", "Contacts and events over time");

  // Impulses as arrows with their numbers, and the command with its band.
  function drawOnForce(plot) {
    const pen = plot.ctx;
    const scale = devicePixelRatio || 1;
    pen.save();
    pen.font = `${11 * scale}px sans-serif`;
    pen.textAlign = "left";
    const { values } = shown.runs[0]?.scenario ?? { values: {} };
    if (values["control.law"] && values["control.law"] !== "none") {
      const wanted = values["control.force"];
      const [high, low] = [1.05, 0.95].map((k) => plot.valToPos(k * wanted, "y", true));
      pen.fillStyle = colour("band");
      pen.fillRect(plot.bbox.left, high, plot.bbox.width, low - high);
    }
    for (let i = shown.runs.length - 1; i >= 0; i--) {
      pen.fillStyle = pen.strokeStyle = colour(`run${i}`);
      pen.lineWidth = 1.5 * scale;
      let free = -Infinity;
      for (const event of shown.runs[i].result.events) {
        if (event.kind === "impact") {
          free = drawArrow(plot, event, scale, i, free);
        }
      }
    }
    pen.restore();
  }

  // The range of the forces, with room for the numbers of the arrows above the largest.
  function roomAbove(plot, least, most) {
    const [low, high] = uPlot.rangeNum(least, most, 0.1, true);
    const lines = 13 * Math.max(1, shown.runs.length) + 10;
    const share = lines / (plot.bbox.height / (devicePixelRatio || 1) || 190);
    return [low, Math.max(high, low + (most - low) / Math.max(1 - share, 0.5))];
  }

  // Returns where the next number has room.
  function drawArrow(plot, event, scale, line, free) {
    const pen = plot.ctx;
    const x = plot.valToPos(event.t_s, "x", true);
    const { top, height } = plot.bbox;
    const tip = top + (16 + 13 * line) * scale;
    pen.beginPath();
    pen.moveTo(x, top + height);
    pen.lineTo(x, tip);
    pen.moveTo(x - 3 * scale, tip + 6 * scale);
    pen.lineTo(x, tip);
    pen.lineTo(x + 3 * scale, tip + 6 * scale);
    pen.stroke();
    const text = measured(event.impulse_Ns, "N s");
    if (x < free) {
      return free;
    }
    pen.fillText(text, x + 5 * scale, tip + 6 * scale);
    return x + 10 * scale + pen.measureText(text).width;
  }

  function optionsOf(pane, runs, names, width, height, last) {
    const ink = colour("ink");
    const rule = { stroke: colour("line"), width: 1 };
    const axis = { stroke: ink, grid: rule, ticks: rule, font: "12px sans-serif" };
    const unit = units[signalsOf(pane)[0]];
    const title = pane.replaceAll("_", " ");
    const series = backwards(runs).flatMap((_, place) =>
      names.map((name) => {
        const run = runs.length - 1 - place;
        const own = signalsOf(pane).indexOf(name);
        const stroke = colour(`run${pane === "energy" ? own : run}`);
        return {
          label: name,
          show: own >= 0 && (pane !== "energy" || run === 0),
          stroke,
          width: run === 0 ? 2 : 1.4,
          dash: pane === "energy" ? DASHES[own % DASHES.length] : [],
          spanGaps: true,
          points: { show: false },
        };
      }),
    );
    return {
      width,
      height,
      padding: [6, RIGHT, 0, 0],
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, y: false, points: { show: false } },
      scales:
        pane === "force" ? { x: { time: false }, y: { range: roomAbove } } : { x: { time: false } },
      axes: [
        { ...axis, size: last ? 38 : 8, label: last ? "time in s" : null, labelSize: 16 },
        {
          ...axis,
          size: AXIS,
          label: unit ? `${title}, ${unit}` : title,
          labelSize: 18,
          labelFont: "11px sans-serif",
          values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : digits(tick, 5))),
        },
      ].map((a, i) => (i === 0 && !last ? { ...a, values: () => [] } : a)),
      series: [{}, ...series],
      hooks: {
        draw: pane === "force" ? [drawOnForce] : [],
        ready: [(plot) => followPointer(plot)],
      },
    };
  }

  // Dragging over a pane moves the instant.
  function followPointer(plot) {
    const mark = element("div", { className: "now" });
    plot.over.append(mark);
    plot.now = mark;
    const seek = (event) => {
      const { left } = plot.over.getBoundingClientRect();
      onSeek(plot.posToVal(event.clientX - left, "x"));
    };
    plot.over.addEventListener("pointerdown", (event) => {
      plot.over.setPointerCapture(event.pointerId);
      seek(event);
    });
    plot.over.addEventListener("pointermove", (event) => {
      if (event.buttons > 0) {
        seek(event);
      }
    });
  }

  // Contact as bars, one line a run, and labels of this run's impacts and releases.
  function drawLane() {
    const width = host.clientWidth;
    const scale = devicePixelRatio || 1;
    const line = 7;
    const height = 16 + line * shown.runs.length;
    lane.style.height = `${height}px`;
    lane.width = width * scale;
    lane.height = height * scale;
    const pen = lane.getContext("2d");
    pen.scale(scale, scale);
    pen.font = "11px sans-serif";
    const run = shown.runs[0];
    if (run === undefined) {
      return;
    }
    const { min, max } = plots[0].scales.x;
    const left = plots[0].bbox.left / scale;
    const share = plots[0].bbox.width / scale / (max - min);
    const place = (time) => left + (time - min) * share;
    shown.runs.forEach(({ signals }, i) => {
      pen.fillStyle = colour(`run${i}`);
      for (let row = 0; row + 1 < signals.time.length; row++) {
        if (signals.contact[row] > 0) {
          const from = place(signals.time[row]);
          pen.fillRect(from, i * line + 1, place(signals.time[row + 1]) - from + 0.5, 5);
        }
      }
    });
    pen.fillStyle = colour("ink");
    let free = -Infinity;
    const words = { impact: "hit", release: "off", change: "change", push: "push" };
    for (const { t_s, kind } of run.result.events) {
      const text = `${words[kind]} ${digits(t_s)}`;
      const x = place(t_s);
      if (kind in words && x > free && x + pen.measureText(text).width < width) {
        pen.fillText(text, x, height - 4);
        free = x + pen.measureText(text).width + 8;
      }
    }
  }

  function build(panes, runs, names) {
    plots.forEach((plot) => plot.destroy());
    host.replaceChildren();
    const width = host.clientWidth;
    plots = panes.map((pane, i) => {
      const place = element("div", { className: "pane" });
      host.append(place);
      if (i === 0) {
        host.append(lane);
      }
      const [high, low] = width < 500 ? [190, 116] : [250, 136];
      const height = pane === "force" ? high : low;
      const last = i === panes.length - 1;
      const options = optionsOf(pane, runs, names, width, height + (last ? 30 : 0), last);
      const plot = new uPlot(options, null, place);
      if (pane === "energy") {
        place.append(energyKey());
      }
      return plot;
    });
  }

  function energyKey() {
    const words = ENERGIES.map((name, i) =>
      element("span", {}, runMark(i), name.replaceAll("_", " ")),
    );
    return element("p", { className: "key" }, ...words);
  }

  // Draws runs, this one first, in panes below the force.
  function draw(runs, extra, time) {
    const panes = ["force", ...extra.filter((pane) => pane !== "force")];
    const names = [...new Set(panes.flatMap(signalsOf))];
    const wanted = [panes, runs.length, host.clientWidth, colour("ink")].join("|");
    const duration = Math.max(...runs.map((run) => run.signals.time.at(-1)));
    shown = { runs, time };
    if (wanted !== shape) {
      shape = wanted;
      build(panes, runs, names);
    }
    const data = tableOf(runs, names);
    for (const plot of plots) {
      plot.batch(() => {
        plot.setData(data, true);
        plot.setScale("x", { min: 0, max: duration || 1 });
      });
    }
    drawLane();
    mark(time);
  }

  // Moves the line of the instant.
  function mark(time) {
    for (const plot of plots) {
      plot.now.style.transform = `translateX(${plot.valToPos(time, "x")}px)`;
    }
  }

  // The pictures of all panes, from above.
  function canvases() {
    const drawn = plots.map((plot) => plot.ctx.canvas);
    return drawn.length > 0 ? [drawn[0], lane, ...drawn.slice(1)] : [];
  }

  return { draw, mark, canvases };
}
