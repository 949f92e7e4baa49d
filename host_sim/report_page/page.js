/* page.js - texts, tables, controls, and the start of it all. */
/* ---------- texts and tables ---------- */
function fillHeader() {
  document.title = `${D.track} – limber replay report`;
  $('title').textContent = D.track;
  $('lead').textContent = `Replay of a rod of ${N} link${N > 1 ? 's' : ''}, its base driven by a recorded hand motion`;
  const whole = v => v.toLocaleString('en-US').replace(/,/g, '\u202f');
  const copy = el('button', { onclick: () => copyHash(copy), 'aria-label': 'Copy the hash' }, 'Copy');
  const facts = [['preset', D.preset], ['model', D.model], ['scheme', D.scheme], ['first mode', finite(D.first_mode_hz) && `${+D.first_mode_hz.toPrecision(3)} Hz`], ['links', N], ['length', metres(D.length)],
    ['rate', `${whole(D.rate_hz)} Hz`], ['steps', whole(D.steps)], ['duration', num(D.steps / D.rate_hz, 2) + ' s'],
    ['hash', D.hash && el('span', {}, el('code', { id: 'hash' }, D.hash), copy)]];
  $('facts').append(...facts.filter(([, v]) => v).map(([k, v]) => el('div', {}, el('dt', {}, k), el('dd', {}, v))));
  $('warnings').append(...D.warnings.map(w => el('li', {}, w)));
  $('warnings').hidden = !D.warnings.length;
  $('foot').textContent = `${D.program} · one frame every ${D.frame_step} steps (${num(D.dt * 1e3, 2)} ms), ${whole(D.frames)} frames · world ${D.up || 'z'} is up · ` +
    'on the charts: click seeks, drag zooms in time, dragging the cursor or the time axis scrubs, double-click shows all · keys: space plays, ← → step a frame';
}
async function copyHash(button) {
  try { await navigator.clipboard.writeText(D.hash); }
  catch { getSelection().selectAllChildren($('hash')); document.execCommand('copy'); }   // older browsers, from file://
  button.textContent = 'Copied';
  setTimeout(() => { button.textContent = 'Copy'; }, 1500);
}
function table(head, rows) {
  const tr = (tag, cells) => el('tr', {}, ...cells.map(c => c instanceof HTMLTableCellElement ? c : el(tag, {}, c)));
  return el('table', {}, ...(head ? [el('thead', {}, tr('th', head))] : []), el('tbody', {}, ...rows.map(r => tr('td', r))));
}
function angleCell(rad, peak) {               // degrees, radians, and a bar relative to the largest of its column
  if (!finite(rad)) return el('td', {}, '—');
  const cell = el('td', {}, num(rad * DEG, 2) + '° ', el('small', {}, num(rad, 4)));
  if (peak > 0) cell.append(el('span', { className: 'meter', style: `width:${100 * Math.abs(rad) / peak}%` }));
  return cell;
}
function fillJoints() {
  const keys = ['peak_theta_rad', 'peak_phi_rad', 'rms_theta_rad', 'rms_phi_rad'], joints = D.joints || [];
  const peaks = keys.map(k => Math.max(...joints.map(j => Math.abs(j[k]) || 0)));
  const rows = joints.map((j, n) => [
    el('td', {}, el('span', { className: 'dot' }, '● '), `${n + 1}`),
    ...keys.map((k, i) => angleCell(j[k], peaks[i])),
    num(j.lag_deg, 1) + (finite(j.lag_deg) ? '°' : ''),
    el('td', { className: j.limit_share > 0 ? 'hot' : '' }, finite(j.limit_share) ? num(100 * j.limit_share, 1) + ' %' : '—')]);
  const head = ['joint', 'peak θ (rad)', 'peak φ (rad)', 'RMS θ (rad)', 'RMS φ (rad)', 'phase lag', D.model === 'elastic' ? 'beyond limit' : 'on stops'];
  $('jointTable').replaceChildren(table(head.map(t => el('th', { scope: 'col' }, t)), rows));
  [...$('jointTable').querySelectorAll('tbody tr')].forEach((r, n) => r.style.setProperty('--c', ramp(n / N)));
}
function valueCell({ values, unit }) {
  const v = [].concat(values).map(x => finite(x) ? String(+x.toPrecision(6)).replace('-', '−') : String(x ?? '—')), tail = unit ? ' ' + unit : '';
  if (v.every(x => x === v[0])) return el('td', { className: 'wrap' }, v[0] + tail);
  const text = v.length <= 4 ? v.join(', ') + tail : el('details', {}, el('summary', {}, `${v[0]} … ${v[v.length - 1]}${tail}`), v.join(', '));
  const top = Math.max(...values.map(x => Math.abs(x) || 0)), bar = (x, n) => el('span', { style: `height:${100 * Math.abs(x) / top}%;background:${ramp(n / v.length)}` });
  return el('td', { className: 'wrap' }, text, ...(values.every(finite) ? [el('span', { className: 'profile', 'aria-hidden': true }, ...values.map(bar))] : []));
}
function fillTables() {
  fillJoints();
  const name = p => el('td', { className: 'wrap' }, p.name + ' ', ...(p.symbol ? [el('i', {}, p.symbol)] : []));
  $('parameterTable').replaceChildren(table(null, (D.parameters || []).map(p => [name(p), valueCell(p)])));
  $('summaryTable').replaceChildren(table(null, (D.summary || []).map(([k, v]) => [el('td', {}, k), el('td', { className: 'wrap' }, v)])));
}

/* ---------- start ---------- */
function segmented(box, options, picked, onPick) {
  options.forEach(([label, value]) => box.append(el('button', { onclick: e => { mark(e.currentTarget); onPick(value); }, 'aria-pressed': value === picked }, label)));
  const mark = b => [...box.children].forEach(c => c.setAttribute('aria-pressed', c === b));
}
function bindPlayer() {
  $('play').onclick = () => setPlaying(!state.playing);
  $('prev').onclick = () => step(-1);
  $('next').onclick = () => step(1);
  $('scrub').max = last;
  for (const id of ['play', 'prev', 'next', 'scrub']) $(id).disabled = last === 0;
  $('scrub').oninput = e => seek(+e.target.value);
  $('scrub').onpointerdown = () => { state.held = true; };
  for (const type of ['pointerup', 'pointercancel']) addEventListener(type, () => { state.held = false; });
  $('resetZoom').onclick = () => setZoom(null);
  segmented($('speed'), [['0.1×', 0.1], ['0.25×', 0.25], ['1×', 1], ['2×', 2]], 1, v => { state.speed = v; });
  segmented($('axis'), [['x', 0], ['y', 1], ['z', 2]], 0, v => { axis = v; fillChart(plots[2]); });
  document.addEventListener('keydown', onKey);
  /* A button clicked with the mouse gives the focus back, so that space keeps meaning play. */
  document.addEventListener('click', e => { const c = e.detail && e.target.closest('button, input[type=checkbox]'); if (c) c.blur(); });
}
function onKey(e) {
  if (e.ctrlKey || e.metaKey || e.altKey || e.shiftKey) return;
  const on = e.target.closest('button, input, summary, .scroll'), slider = e.target === $('scrub');
  if (e.key === ' ' && (!on || slider)) setPlaying(!state.playing);
  else if (/^Arrow(Left|Right)$/.test(e.key) && (!on || slider || on.tagName === 'BUTTON')) step(e.key === 'ArrowLeft' ? -1 : 1);
  else return;                                // links, check boxes and scrolling tables keep their own keys
  e.preventDefault();
}
function layout() {                           // the first screen holds header, cockpit and player, whatever the header's height
  document.documentElement.style.setProperty('--top', $('cockpit').getBoundingClientRect().top + scrollY + 'px');
}
function retheme() {
  readTheme();
  plots.forEach(p => p.paint && p.paint());
  fillTables();
  drawCharts();
}
function start() {
  load();
  readTheme();
  fillHeader();
  fillTables();
  loadTouch();
  $('touch').hidden = !solids.length;
  instant();
  chooseHome();
  placeFloor();
  const handPath = range(0, last).map(f => viewNode(f, 0)).filter(p => p.every(finite));
  cam.follow = $('follow').checked = extent(handPath) > 6 * D.length;    // else the rod would be too small to see bend
  layout();
  resizeView();
  resetView();
  definePlots();
  drawCharts();
  bindView();
  bindPlayer();
  darkQuery.addEventListener('change', retheme);
  addEventListener('resize', layout);
  setPlaying(!matchMedia('(prefers-reduced-motion: reduce)').matches);
}
try { start(); } catch (error) {
  $('warnings').replaceChildren(el('li', {}, `This report can't be shown: ${error.message}.`));
  $('warnings').hidden = false;
  document.querySelectorAll('main > section, main > .dock').forEach(e => { e.hidden = true; });
  throw error;
}
