// The arm and the wall on a canvas: this run, where the other runs are at that instant, and where
// this one was before.
import { colour, digits } from "./words.mjs";

const GHOSTS = 4; // poses before this one
const GHOST_STEP = 0.04; // between them [s]
const MARGIN = 14; // round the picture [px]

// The index of the last instant that is not after `time`.
export function rowAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// The joints of the arm in a pose, from the hub to the tip [m].
function jointsOf(run, time) {
  const { times, angles, links } = run.poses;
  const from = rowAt(times, time) * links;
  const listed = run.scenario.values["arm.link_lengths"];
  const length = run.scenario.values["arm.length"];
  const points = [[0, 0]];
  for (let i = 0; i < links; i++) {
    const [x, y] = points[i];
    const each = listed?.length === links ? listed[i] : length / links;
    points.push([x + each * Math.cos(angles[from + i]), y + each * Math.sin(angles[from + i])]);
  }
  return points;
}

// How far the joints of all runs go across [m], with the wall.
function reach(runs) {
  let low = 0;
  let high = 0;
  for (const run of runs) {
    const length = run.scenario.values["arm.length"];
    const wall = length * Math.sin(run.scenario.values["wall.angle"]);
    low = Math.min(low, wall);
    high = Math.max(high, wall);
    const end = run.poses.times[run.poses.times.length - 1];
    for (let i = 0; i <= 100; i++) {
      const heights = jointsOf(run, (end * i) / 100).map(([, y]) => y);
      low = Math.min(low, ...heights);
      high = Math.max(high, ...heights);
    }
  }
  return { low, high };
}

export function createArm(canvas) {
  let known = null;
  let range = null;

  function draw(runs, time) {
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    const scale = devicePixelRatio || 1;
    canvas.width = width * scale;
    canvas.height = height * scale;
    const pen = canvas.getContext("2d");
    pen.scale(scale, scale);
    if (runs.length === 0) {
      return;
    }
    if (known !== runs) {
      known = runs;
      range = reach(runs);
    }

    // lengths along are as large as there is room, those across up to six times as large
    const length = Math.max(...runs.map((run) => run.scenario.values["arm.length"]));
    const along = (width - 2 * MARGIN) / (1.04 * length);
    const span = Math.max(range.high - range.low, 1e-9);
    const across = Math.min((height - 2 * MARGIN) / span, 6 * along);
    const middle = (range.low + range.high) / 2;
    const place = ([x, y]) => [MARGIN + x * along, height / 2 - (y - middle) * across];

    const polyline = (points) => {
      pen.beginPath();
      points.forEach((point) => pen.lineTo(...place(point)));
      pen.stroke();
    };

    drawWall(pen, runs[0].scenario.values, place);

    // runs beside this one, the ghosts of this one, then the arm itself
    pen.lineJoin = "round";
    for (let i = runs.length - 1; i > 0; i--) {
      pen.strokeStyle = colour(`run${i}`);
      pen.lineWidth = 2;
      polyline(jointsOf(runs[i], time));
    }
    pen.strokeStyle = colour("run0");
    for (let i = GHOSTS; i > 0; i--) {
      pen.globalAlpha = 0.35 / i;
      pen.lineWidth = 2;
      polyline(jointsOf(runs[0], Math.max(0, time - i * GHOST_STEP)));
    }
    pen.globalAlpha = 1;
    pen.lineWidth = 4;
    const joints = jointsOf(runs[0], time);
    polyline(joints);

    pen.fillStyle = colour("ink");
    const shown = joints.length > 12 ? [joints[0], joints.at(-1)] : joints;
    for (const joint of shown) {
      pen.beginPath();
      pen.arc(...place(joint), joint === joints[0] ? 6 : 3, 0, 2 * Math.PI);
      pen.fill();
    }
    pen.fillStyle = colour("faint");
    pen.font = "12px sans-serif";
    pen.fillText(`across x${digits(across / along, 2)}`, MARGIN, height - 4);
  }

  return { draw };
}

// The wall from the hub on, or the point that is fixed in the last link's line.
function drawWall(pen, values, place) {
  const angle = values["wall.angle"];
  const length = values["arm.length"];
  const at = (radius) => place([radius * Math.cos(angle), radius * Math.sin(angle)]);
  if (values["wall.kind"] === "none") {
    return;
  }
  pen.fillStyle = pen.strokeStyle = colour("wall");
  if (values["wall.kind"] === "point") {
    const [x, y] = at(length);
    pen.beginPath();
    pen.moveTo(x, y - 3);
    pen.lineTo(x - 7, y - 15);
    pen.lineTo(x + 7, y - 15);
    pen.fill();
    return;
  }
  pen.lineWidth = 1.5;
  for (let i = 0; i <= 40; i++) {
    const [x, y] = at((length * 1.03 * i) / 40);
    pen.beginPath();
    pen.moveTo(x, y - 3);
    pen.lineTo(x + 6, y - 11);
    pen.stroke();
  }
  pen.beginPath();
  pen.moveTo(...place([0, 0]));
  pen.lineTo(...at(length * 1.03));
  pen.stroke();
}
