// The figures of a report drawn again from their data by uPlot: zoom, values at the pointer, and
// buttons that hide curves. Lines that are comments alone are left out of the page.
'use strict';
// numbers of 32 bits in base64; NaN, a gap, as null
const unpack = text => {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  return Array.from({length: bytes.length / 4}, (_, i) => {
    const v = view.getFloat32(4 * i, true);
    return Number.isFinite(v) ? v : null;
  });
};
// the range [low, high] narrowed k times about the share `at` of it, kept within `whole`
const narrowed = (range, at, k, whole, log) => {
  const to = log ? Math.log : v => v, back = log ? Math.exp : v => v;
  const [a, b] = range.map(to), [least, most] = whole.map(to);
  const width = Math.min((b - a) / k, most - least);
  const low = Math.min(Math.max(a + at * (b - a - width), least), most - width);
  return [back(low), back(low + width)];
};
const dashes = [[], [5, 2.2], [1.2, 1.8], [7, 2, 1.4, 2]];
const darkness = typeof matchMedia === 'function' && matchMedia('(prefers-color-scheme: dark)');
const button = (row, text, act) => {
  const b = document.createElement('button');
  b.type = 'button';
  b.textContent = text;
  b.onclick = () => act(b);
  row.append(b);
  return b;
};
const css = name => getComputedStyle(document.body).getPropertyValue(name).trim();
const inkOf = of => `rgb(${darkness.matches ? of.dark : of.light})`;
const short = v => String(+v.toPrecision(3));
// what a chart draws below its curves: stretches across all panels
const underlay = (u, marks) => {
  const {ctx, bbox} = u, at = v => Math.min(Math.max(u.valToPos(v, 'x', true), bbox.left), bbox.left + bbox.width);
  ctx.fillStyle = css('--wash');
  for (const [from, to] of marks.stretches) { ctx.fillRect(at(from), bbox.top, at(to) - at(from), bbox.height); }
};
// and over them: marks and levels with their words, impulses as arrows above the panel
const overlay = (u, panel, marks, first) => {
  const {ctx, bbox} = u, k = devicePixelRatio, {left, top} = bbox, right = left + bbox.width;
  const line = (from, to, dash) => {
    ctx.setLineDash(dash.map(v => v * k));
    ctx.beginPath();
    ctx.moveTo(...from);
    ctx.lineTo(...to);
    ctx.stroke();
  };
  const seen = v => { const x = u.valToPos(v, 'x', true); return x >= left && x <= right ? x : null; };
  // words from left to right, in the first row where they meet no earlier ones
  const ends = [], words = (text, x, y, step) => {
    const wide = ctx.measureText(text).width, from = x + 4 * k + wide > right ? x - 4 * k - wide : x + 4 * k;
    const row = ends.findIndex(end => end < from), at = row < 0 ? ends.length : row;
    ends[at] = from + wide + 6 * k;
    ctx.fillText(text, from, y + at * step * k);
  };
  ctx.save();
  ctx.font = `${11 * k}px sans-serif`;
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  ctx.lineWidth = k;
  ctx.strokeStyle = ctx.fillStyle = css('--soft');
  for (const m of [...marks.lines].sort((a, b) => a.x - b.x)) {
    const x = seen(m.x);
    if (x !== null) {
      line([x, top], [x, top + bbox.height], [3, 2]);
      if (first) { words(m.label, x, top + 12 * k, 13); }
    }
  }
  for (const level of panel.levels) {
    const y = u.valToPos(level.y, 'y', true);
    line([left, y], [right, y], [4, 3]);
    ctx.fillText(level.label, right - ctx.measureText(level.label).width - 4 * k, y - 4 * k);
  }
  ends.length = 0;
  const largest = Math.max(...panel.impulses.map(p => Math.abs(p.size)));
  for (const p of panel.impulses) {
    const x = seen(p.x), high = (8 + 24 * Math.abs(p.size) / largest) * k, base = top - 4 * k;
    if (x === null) { continue; }
    ctx.strokeStyle = ctx.fillStyle = inkOf(p);
    line([x, base], [x, base - high], []);
    line([x - 3 * k, base - high + 5 * k], [x, base - high], []);
    line([x + 3 * k, base - high + 5 * k], [x, base - high], []);
    words(`${short(p.size)} ${panel.impulse_unit}`, x, base - 20 * k, 13);
  }
  ctx.restore();
};
// one panel as a chart; `moved` is told a new range of the common axis
const chartOf = (panel, marks, first, place, hidden, moved) => {
  let x;
  const tables = panel.series.map(s => [x = s.x ? unpack(s.x) : x, unpack(s.y)]);
  const data = uPlot.join(tables.map(([xs, ys]) => {
    // a common axis has each value once: the last of those at a jump
    const last = xs.map((v, i) => v !== null && v !== xs[i + 1]);
    return [xs.filter((_, i) => last[i]), ys.filter((_, i) => last[i])];
  }));
  const named = (name, unit) => name + (unit ? ' in ' + unit : '');
  const axis = label => ({label, stroke: css('--text'), grid: {stroke: css('--line'), width: 1},
    ticks: {stroke: css('--line'), width: 1}, font: '12px sans-serif', labelFont: '12px sans-serif'});
  const digits = (u, v) => v == null ? '\u2013' : String(+v.toPrecision(5));
  return new uPlot({
    title: panel.heading || undefined, width: place.clientWidth, height: panel.impulses.length ? 300 : 260,
    padding: [panel.impulses.length ? 44 : null, null, null, null], cursor: {sync: {key: place.id}, drag: {x: true, y: false}},
    legend: {live: true},
    scales: {x: {time: false, distr: panel.xlog ? 3 : 1, range: () => place.range},
      y: {distr: panel.ylog ? 3 : 1, range: () => panel.y}},
    axes: [axis(named(panel.xname, panel.xunit)), {...axis(named(panel.name, panel.unit)), size: 64}],
    series: [{label: panel.xname, value: digits}, ...panel.series.map(s => {
      const ink = inkOf(s);
      return {label: s.label, stroke: ink, width: s.line ? 1.6 : 0, show: !hidden.has(s.label),
        dash: dashes[s.style].map(v => 1.6 * v), points: {show: s.points, size: 6, stroke: ink, fill: ink},
        value: digits};
    })],
    hooks: {drawClear: [u => underlay(u, marks)], draw: [u => overlay(u, panel, marks, first)], setSelect: [u => u.select.width > 3 && moved([u.posToVal(u.select.left, 'x'),
      u.posToVal(u.select.left + u.select.width, 'x')])]},
  }, data, place);
};
// a drawing, and below it the buttons that put charts into its place and back
const explore = (figure, index) => {
  const panels = JSON.parse(figure.dataset.panels), marks = JSON.parse(figure.dataset.marks);
  const row = document.createElement('div'), place = document.createElement('div'), hidden = new Set();
  const log = panels[0].xlog, whole = panels[0].x;
  let charts = [];
  row.className = 'buttons';
  place.className = 'charts';
  place.id = 'charts-' + index;
  figure.append(place, row);
  const close = () => { charts.forEach(u => u.destroy()); charts = []; };
  const show = range => {
    place.range = range;
    charts.forEach(u => {
      u.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
      u.setScale('x', {min: range[0], max: range[1]});
    });
  };
  const draw = () => { close(); charts = panels.map((p, i) => chartOf(p, marks, i === 0, place, hidden, show)); };
  const open = button(row, 'Zoom and read values', b => {
    const on = figure.classList.toggle('explored');
    b.textContent = on ? 'Back to the drawing' : 'Zoom and read values';
    steps.hidden = !on;
    place.range = whole;
    if (on) { draw(); } else { close(); }
  });
  const steps = document.createElement('span');
  steps.hidden = true;
  row.append(steps);
  const step = (name, at, k) => button(steps, name, () => show(narrowed(place.range, at, k, whole, log)));
  step('Zoom in', 0.5, 2);
  step('Zoom out', 0.5, 0.5);
  const shift = (name, by) => button(steps, name, () => {
    const to = log ? Math.log : v => v, back = log ? Math.exp : v => v;
    const [a, b] = place.range.map(to), d = by * (b - a);
    show(narrowed([back(a + d), back(b + d)], 0, 1, whole, log));
  });
  shift('Earlier', -0.5);
  shift('Later', 0.5);
  button(steps, 'Whole range', () => show(whole));
  const names = [...new Set(panels.flatMap(p => p.series.map(s => s.label)))];
  for (const name of names.length > 1 ? names : []) {
    const toggle = button(steps, 'Hide ' + name, b => {
      if (!hidden.delete(name)) { hidden.add(name); }
      b.textContent = (hidden.has(name) ? 'Show ' : 'Hide ') + name;
      draw();
    });
    toggle.className = 'curve';
  }
  addEventListener('resize', () => charts.forEach(u => u.setSize({width: place.clientWidth, height: u.height})));
  darkness.addEventListener('change', () => charts.length && draw());
};
// the lab's page in the place of a drawing, where the report holds it
let page = '';
const enliven = figure => {
  const row = document.createElement('div');
  row.className = 'buttons';
  figure.append(row);
  let frame = null;
  button(row, 'Move its knobs', b => {
    const on = frame === null;
    figure.classList.toggle('live', on);
    b.textContent = on ? 'Back to the drawing' : 'Move its knobs';
    if (on) {
      const bytes = () => Uint8Array.from(atob(document.querySelector('#lab').textContent), c => c.charCodeAt(0));
      page = page || URL.createObjectURL(new Blob([bytes()], {type: 'text/html'}));
      frame = document.createElement('iframe');
      frame.title = figure.getAttribute('aria-label');
      frame.src = page + '#' + figure.dataset.live + '&embedded=yes';
      figure.insertBefore(frame, row);
    } else {
      frame.remove();
      frame = null;
    }
  });
};
if (typeof document !== 'undefined') {
  if (document.querySelector('#lab')) { document.querySelectorAll('figure[data-live]').forEach(enliven); }
  document.querySelector('#hint').hidden = false;
  document.querySelectorAll('figure[data-panels]').forEach(explore);
}
