// Curves in the figures of a report: values at the pointer, zoom, and buttons that hide curves.
// Lines that are comments alone are left out of the page.
'use strict';
for (const fig of document.querySelectorAll('figure[data-panels]')) {
  const svg = fig.querySelector('svg'), panels = JSON.parse(fig.dataset.panels);
  const whole = svg.getAttribute('viewBox').split(' ').map(Number);
  let view = whole.slice();
  // the points of a path on the page, gaps as NaN
  const points = p => {
    const out = [], d = p.getAttribute('d').match(/[A-Za-z]|-?\d*\.?\d+/g) || [];
    for (let i = 0, c = ''; i < d.length; i += 2) {
      while (i < d.length && /[A-Za-z]/.test(d[i])) { c = d[i++]; }
      if (c === 'M') { out.push([NaN, NaN]); }
      if (i < d.length) { out.push([+d[i], +d[i + 1]]); }
    }
    return out;
  };
  const near = (a, b) => a.every((v, i) => Math.abs(v - b[i]) < 4);
  const inkOf = p => (getComputedStyle(p).stroke.match(/[\d.]+/g) || []).map(Number);
  const lines = [...svg.querySelectorAll('path')].filter(
    p => getComputedStyle(p).fill === 'none' && /M/.test(p.getAttribute('d')));
  for (const panel of panels) {
    const [x, y, w, h] = panel.box;
    for (const s of panel.series) {
      s.paths = lines.filter(p => {
        const b = p.getBBox(), ink = inkOf(p);
        return ink.length > 2 && near(ink.slice(0, 3), s.ink) && b.width > 0.05 * w &&
          b.x > x - 6 && b.x + b.width < x + w + 6 && b.y > y - 6 && b.y + b.height < y + h + 6 &&
          (getComputedStyle(p).strokeDasharray === 'none') !== s.dashed;
      });
      s.points = s.paths.filter(p => points(p).length > 3).flatMap(points);
    }
  }
  // a button for each curve, by its name in all panels
  const row = document.createElement('div');
  row.className = 'curves';
  const names = [...new Set(panels.flatMap(p => p.series.map(s => s.label)))];
  for (const name of names.length > 1 ? names : []) {
    const button = document.createElement('button');
    button.textContent = name;
    button.type = 'button';
    button.setAttribute('aria-pressed', 'true');
    button.onclick = () => {
      const on = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', on);
      for (const s of panels.flatMap(p => p.series).filter(s => s.label === name)) {
        s.off = !on;
        s.paths.forEach(p => p.style.opacity = on ? '' : '0.06');
      }
    };
    row.append(button);
  }
  const tip = document.createElement('output');
  fig.append(row, tip);
  const show = () => svg.setAttribute('viewBox', view.join(' '));
  const at = e => {
    const m = svg.getScreenCTM().inverse();
    return [m.a * e.clientX + m.e, m.d * e.clientY + m.f];
  };
  const value = (share, range, log) => log
    ? range[0] * Math.pow(range[1] / range[0], share)
    : range[0] + share * (range[1] - range[0]);
  const digits = v => String(+v.toPrecision(4));
  // values at the pointer, interpolated linearly
  svg.addEventListener('mousemove', e => {
    const [px, py] = at(e);
    const panel = panels.find(p => px >= p.box[0] && px <= p.box[0] + p.box[2] &&
      py >= p.box[1] && py <= p.box[1] + p.box[3]);
    if (!panel) { tip.textContent = ''; return; }
    const [x, y, w, h] = panel.box;
    const said = [panel.xname + ' ' + digits(value((px - x) / w, panel.x, panel.xlog))];
    for (const s of panel.series.filter(s => !s.off)) {
      for (let i = 1; i < s.points.length; i++) {
        const [a, b] = [s.points[i - 1], s.points[i]];
        if (a[0] <= px && px <= b[0]) {
          const v = b[0] > a[0] ? a[1] + (px - a[0]) / (b[0] - a[0]) * (b[1] - a[1]) : b[1];
          said.push(s.label + ' ' + digits(value((y + h - v) / h, panel.y, panel.ylog)) +
            (panel.unit ? ' ' + panel.unit : ''));
          break;
        }
      }
    }
    tip.textContent = said.join('   ');
  });
  svg.addEventListener('mouseleave', () => { tip.textContent = ''; });
  // the wheel with Ctrl or Shift zooms, so that a page still scrolls; dragging moves
  svg.addEventListener('wheel', e => {
    if (!e.ctrlKey && !e.shiftKey) { return; }
    e.preventDefault();
    const [px, py] = at(e), by = Math.exp((e.deltaY || e.deltaX) / 400);
    const k = Math.min(whole[2] / view[2], Math.max(by, 0.02 * whole[2] / view[2]));
    view = [px - k * (px - view[0]), py - k * (py - view[1]), k * view[2], k * view[3]];
    show();
  }, {passive: false});
  svg.addEventListener('mousedown', e => {
    const from = at(e);
    const move = f => {
      const to = at(f);
      view = [view[0] + from[0] - to[0], view[1] + from[1] - to[1], view[2], view[3]];
      show();
    };
    const end = () => { removeEventListener('mousemove', move); removeEventListener('mouseup', end); };
    addEventListener('mousemove', move);
    addEventListener('mouseup', end);
  });
  svg.addEventListener('dblclick', () => { view = whole.slice(); show(); });
}
