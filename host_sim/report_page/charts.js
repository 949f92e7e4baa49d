/* charts.js - angles and node paths over time, by Chart.js, and the gestures on them. */
/* ---------- charts ---------- */
/* Chart.js only draws the curves. Everything that moves lies on a second canvas above, so the cursor can run at
   display rate without redrawing thousands of points. */
let axis = 0;
const few = (from, to) => new Set(to - from < 8 ? range(from, to) : range(0, 7).map(i => Math.round(lerp(from, to, i / 7))));
const range = (from, to) => Array.from({ length: to - from + 1 }, (_, i) => from + i);
let plots = [];
function definePlots() {
  const joints = few(1, N), nodes = few(0, N), jointPlace = j => (j - 1) / N;       // joint 1 sits on the base
  const angle = which => (f, j) => D.angles[(f * N + j - 1) * 2 + which] * DEG;
  plots = [
    { id: 'theta', chosen: joints, place: jointPlace, value: angle(0), room: () => [-0.5, 0.5] },
    { id: 'phi', chosen: joints, place: jointPlace, value: angle(1), room: () => [-0.5, 0.5] },
    { id: 'nodes', chosen: nodes, place: k => k / N, value: (f, k) => nodeValue(f, k, axis), digits: 4,
      room: () => [-0.01, 0.01].map(s => nodeValue(0, 0, axis) + s * D.length) } ];   // rounding noise isn't blown up
  if (solids.length) plots.push({
    id: 'force', chosen: new Set(range(0, solids.length - (solids.length > 1 ? 0 : 1))), place: i => i / solids.length,
    value: forceOf, digits: 2, name: i => i < solids.length ? solids[i].name : 'together', room: () => [0, 0.1] });
  for (const p of plots) {
    p.canvas = $(p.id);
    p.over = el('canvas', { className: 'over' });
    p.canvas.after(p.over);
    p.labels = $(p.id.replace('nodes', 'node') + 'Values');
    bindPlot(p);
  }
  buildChooser($('jointBar'), 'joint', 1, joints, jointPlace, plots.slice(0, 2));
  buildChooser($('nodeBar'), 'node', 0, nodes, k => k / N, [plots[2]]);
}
function chartOptions(p) {
  const tickStyle = { color: theme.muted, font: { size: 11 } }, grid = { color: theme.line, borderColor: theme.line, tickColor: theme.line };
  return {
    parsing: false, normalized: true, animation: false, responsive: true, maintainAspectRatio: false, events: [], onResize: refresh,
    plugins: { legend: { display: false }, tooltip: { enabled: false }, decimation: { enabled: true, algorithm: 'min-max', threshold: 1 } },
    elements: { point: { radius: last < 2 ? 3 : 0 }, line: { borderWidth: p.chosen.size > 16 ? 1 : 1.6 } },
    scales: {
      x: { type: 'linear', grid, ticks: { ...tickStyle, maxRotation: 0, includeBounds: false, callback: v => +v.toFixed(5) + ' s' } },
      y: { grid, ticks: { ...tickStyle, maxTicksLimit: 7 }, afterFit: s => { s.width = 48; } } } };   // equal widths keep the time axes in line
}
function drawCharts() {                       // anew from the theme and the choices
  if (typeof Chart === 'undefined') return plots.forEach(fillChart);     // without Chart.js the rest of the page still serves
  Chart.defaults.locale = 'en-US';
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  for (const p of plots) {
    if (p.chart) p.chart.destroy();
    p.chart = new Chart(p.canvas, { type: 'line', data: { datasets: [] }, options: chartOptions(p) });
  }
  plots.forEach(fillChart);
}
function fillChart(p) {
  const items = [...p.chosen].sort((a, b) => a - b);
  p.labels.replaceChildren(...(items.length > 8 ? [] : items.map(i => el('span', { style: `--c:${ramp(p.place(i))}` }, el('b', {}, `${p.name ? p.name(i) : i} `), ''))));
  p.items = items;
  if (p.chart) {
    p.chart.data.datasets = items.map(i => ({ data: points(p, i), borderColor: ramp(p.place(i)), backgroundColor: ramp(p.place(i)) }));
    p.chart.options.elements.line.borderWidth = items.length > 16 ? 1 : 1.6;
    [p.chart.options.scales.y.suggestedMin, p.chart.options.scales.y.suggestedMax] = p.room();
    zoomChart(p);
  }
  refresh();
}
function points(p, i) { return Array.from({ length: D.frames }, (_, f) => ({ x: f * D.dt, y: p.value(f, i) })); }
function zoomChart(p) {
  [p.chart.options.scales.x.min, p.chart.options.scales.x.max] = state.zoom || [0, Math.max(last, 1) * D.dt];
  p.chart.update('none');
}
function setZoom(zoom) {
  state.zoom = zoom;
  $('resetZoom').hidden = !zoom;
  plots.forEach(p => p.chart && zoomChart(p));
  refresh();
}
function buildChooser(bar, what, first, chosen, place, targets) {       // a small rod whose segments switch the curves
  const all = range(first, N), strip = el('div', { className: 'strip', role: 'group', 'aria-label': `${what}s shown in the charts` });
  const flip = i => pick(chosen.has(i) ? [...chosen].filter(c => c !== i) : [...chosen, i]);
  const buttons = all.map(i => el('button', { title: `${what} ${i}`, 'aria-label': `Show ${what} ${i}`, onclick: () => flip(i) }, all.length <= 18 ? `${i}` : ''));
  const paint = () => buttons.forEach((b, n) => { b.setAttribute('aria-pressed', chosen.has(all[n])); b.style.setProperty('--c', ramp(place(all[n]))); });
  const pick = list => { chosen.clear(); list.forEach(i => chosen.add(i)); paint(); targets.forEach(fillChart); };
  const preset = (label, list) => el('button', { onclick: () => pick(list()), 'aria-label': `Show ${label} ${what}s` }, label);
  strip.append(...buttons);
  const sets = el('div', { className: 'seg' }, preset('all', () => all), ...(all.length > 8 ? [preset('few', () => [...few(first, N)])] : []), preset('none', () => []));
  bar.append(strip, ...(all.length > 1 ? [sets] : []));
  targets[0].paint = paint;
  paint();
}

/* ---------- cursor and gestures on the charts ---------- */
function drawCursors() {
  const f = Math.floor(state.pos), g = Math.min(f + 1, last), u = state.pos - f;
  for (const p of plots) {
    const values = p.items.map(i => lerp(p.value(f, i), p.value(g, i), u));
    [...p.labels.children].forEach((s, n) => { s.lastChild.data = num(values[n], p.digits || (Math.abs(values[n]) < 10 ? 2 : 1)); });
    if (p.chart) drawCursor(p, values);
  }
}
function drawCursor(p, values) {
  const { chartArea: area, scales, width, height } = p.chart, dpr = devicePixelRatio || 1, c = p.over.getContext('2d');
  const w = Math.round(width * dpr), h = Math.round(height * dpr);
  if (p.over.width !== w || p.over.height !== h) Object.assign(p.over, { width: w, height: h });
  c.setTransform(dpr, 0, 0, dpr, 0, 0);
  c.clearRect(0, 0, width, height);
  if (p.select) {
    const [a, b] = p.select.map(x => clamp(x, area.left, area.right));
    c.globalAlpha = 0.18; c.fillStyle = theme.accent;
    c.fillRect(a, area.top, b - a, area.bottom - area.top);
    c.globalAlpha = 1;
  }
  p.cursorX = scales.x.getPixelForValue(now_s());
  if (p.cursorX < area.left - 1 || p.cursorX > area.right + 1) return;
  c.fillStyle = theme.text;
  c.fillRect(p.cursorX - 0.6, area.top, 1.2, area.bottom - area.top + 5);
  if (values.length > 16) return;
  values.forEach((v, n) => {
    const y = scales.y.getPixelForValue(v);
    if (!(y > area.top - 4 && y < area.bottom + 4)) return;
    c.beginPath(); c.arc(p.cursorX, y, 3.6, 0, TAU);
    c.fillStyle = ramp(p.place(p.items[n])); c.strokeStyle = theme.panel; c.lineWidth = 1.5;
    c.fill(); c.stroke();
  });
}
/* A click seeks. A drag that starts on the cursor or on the time axis moves the cursor; any other drag selects a
   stretch of time for all charts. A double click shows the whole time again and undoes the seek of its first click. */
function bindPlot(p) {
  let from = null, mode = '', undo = null;
  const grabs = e => e.offsetY > p.chart.chartArea.bottom || Math.abs(e.offsetX - p.cursorX) < (e.pointerType === 'touch' ? 16 : 7);
  const seekTo = x => seek(p.chart.scales.x.getValueForPixel(clamp(x, p.chart.chartArea.left, p.chart.chartArea.right)) / D.dt);
  const finish = () => { from = null; p.select = null; refresh(); };
  p.over.addEventListener('pointerdown', e => {
    if (!p.chart || e.button) return;
    if (!undo || e.timeStamp - undo.at > 500) undo = { at: e.timeStamp, pos: state.pos };
    from = e.offsetX; mode = grabs(e) ? 'seek' : 'select'; state.held = mode === 'seek';
    p.over.setPointerCapture(e.pointerId);
    if (mode === 'seek') seekTo(from);
  });
  p.over.addEventListener('pointermove', e => {
    if (!p.chart) return;
    if (from === null) { p.over.style.cursor = grabs(e) ? 'ew-resize' : 'crosshair'; return; }
    if (mode === 'seek') seekTo(e.offsetX);
    else { p.select = Math.abs(e.offsetX - from) > 4 ? [from, e.offsetX].sort((a, b) => a - b) : null; refresh(); }
  });
  p.over.addEventListener('pointerup', e => {
    if (from === null) return;
    if (mode === 'select' && p.select) {
      const t = p.select.map(x => clamp(p.chart.scales.x.getValueForPixel(x), 0, last * D.dt));
      if (t[1] - t[0] >= 3 * D.dt) { setZoom(t); if (now_s() < t[0] || now_s() > t[1]) seek(t[0] / D.dt); }
    } else if (mode === 'select') seekTo(e.offsetX);
    finish();
  });
  p.over.addEventListener('pointercancel', finish);
  p.over.addEventListener('dblclick', () => { setZoom(null); if (undo) seek(undo.pos); });
}
