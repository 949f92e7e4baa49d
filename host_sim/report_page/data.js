/* data.js - the report's data, its clock, and what all parts of the page share. */
'use strict';
const $ = id => document.getElementById(id);
const DEG = 180 / Math.PI, TAU = 2 * Math.PI;
const clamp = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
const lerp = (a, b, u) => a + (b - a) * u;
const finite = v => typeof v === 'number' && Number.isFinite(v);

/* ---------- small helpers for the page ---------- */
function el(tag, props = {}, ...kids) {       // text only ever enters as text nodes, so data can't become markup
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(props)) k in e ? e[k] = v : e.setAttribute(k, v);
  e.append(...kids);
  return e;
}
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const num = (v, digits) => !finite(v) ? '—' : v.toFixed(digits).replace(/^-(0\.?0*)$/, '$1').replace('-', '−');
function metres(v) {
  if (!finite(v)) return '—';
  const a = Math.abs(v);
  return a < 1e-9 ? '0 mm' : a < 0.01 ? num(v * 1e3, 2) + ' mm' : a < 1 ? num(v * 1e2, 1) + ' cm' : num(v, 2) + ' m';
}

/* One palette everywhere: place 0 is the base (cool, deep), 1 the tip (warm, light). Even steps of OKLCH
   lightness and hue, so the order along the rod reads from the colour alone, in grey too. */
const RAMPS = {
  light: ['#0a46b9', '#6340c1', '#973db3', '#c33e93', '#e24868', '#f26227', '#e48f05'],
  dark: ['#3c79f0', '#8c70f4', '#c369e0', '#ee67bb', '#fe7b8e', '#fe9671', '#fead4c'] };
const darkQuery = matchMedia('(prefers-color-scheme: dark)');
const theme = {};
function readTheme() {
  theme.ramp = RAMPS[darkQuery.matches ? 'dark' : 'light'].map(h => [1, 3, 5].map(i => parseInt(h.slice(i, i + 2), 16)));
  for (const name of ['text', 'muted', 'line', 'panel', 'grid', 'ghost', 'accent']) theme[name] = css('--' + name);
  theme.solid = darkQuery.matches ? [92, 106, 126] : [186, 197, 211];
  theme.axes = darkQuery.matches ? ['#ff6b64', '#55cf7e', '#69a3ff'] : ['#d3322b', '#1d9448', '#2463dd'];
  theme.shade = darkQuery.matches ? 0.42 : 0.15;
}
function ramp(place, alpha = 1) {
  const x = clamp(place, 0, 1) * (theme.ramp.length - 1), i = Math.min(Math.floor(x), theme.ramp.length - 2);
  const rgb = theme.ramp[i].map((c, n) => Math.round(lerp(c, theme.ramp[i + 1][n], x - i)));
  return `rgba(${rgb},${alpha})`;
}

/* ---------- data ---------- */
let D, N, last;                               // the report, its links, its last frame
function floats(base64) {
  const text = atob(base64), bytes = new Uint8Array(text.length & ~3);
  for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
  return new Float32Array(bytes.buffer);
}
function load() {
  D = JSON.parse($('data').textContent);
  N = D.links;
  for (const key of ['angles', 'nodes', 'base_q']) D[key] = floats(D[key]);
  const held = [D.angles.length / (2 * N), D.nodes.length / (3 * (N + 1)), D.base_q.length / 4].map(Math.floor);
  D.warnings = D.warnings || [];
  if (held.some(n => n !== D.frames)) D.warnings.push(`The report announces ${D.frames} frames, but its arrays hold ${held.join(', ')}.`);
  if (typeof Chart === 'undefined') D.warnings.push('Chart.js is missing from this file, so the plots are empty.');
  D.frames = Math.min(D.frames, ...held);
  if (!(D.frames >= 1)) throw new Error('the report holds no frames');
  last = D.frames - 1;
  D.dt = D.frame_dt_s || 1 / D.rate_hz;
  D.length = rodLength();
}
function rodLength() {                        // links are rigid, so the first sound frame tells
  for (let f = 0; f <= last; f++) {
    let sum = 0;
    for (let k = 0; k < N; k++) sum += Math.hypot(...[0, 1, 2].map(c => nodeValue(f, k + 1, c) - nodeValue(f, k, c)));
    if (sum > 0 && finite(sum)) return sum;
  }
  return 1;
}
const nodeValue = (f, k, c) => D.nodes[(f * (N + 1) + k) * 3 + c];
/* The 3-D view always has z up; a y-up world is turned about x. */
const toView = v => D.up === 'y' ? [v[0], -v[2], v[1]] : v;
const viewNode = (f, k) => toView([nodeValue(f, k, 0), nodeValue(f, k, 1), nodeValue(f, k, 2)]);
const mix = (a, b, u) => [lerp(a[0], b[0], u), lerp(a[1], b[1], u), lerp(a[2], b[2], u)];
const bodyAxes = f => frameOf(D.base_q.subarray(4 * f, 4 * f + 4));
function frameOf([x, y, z, w]) {              // the columns of a rotation matrix, in the view's frame
  return [[1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
          [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
          [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]].map(toView);
}

/* ---------- player ---------- */
const state = { pos: 0, playing: false, held: false, speed: 1, zoom: null };     // pos: frame, with a fraction
let raf = 0, lastNow = 0;
const now_s = () => state.pos * D.dt;
function refresh() { if (!raf) raf = requestAnimationFrame(tick); }
function tick(now) {
  raf = 0;
  if (state.playing && !state.held) advance(Math.min((now - lastNow) / 1000, 0.1));  // a tab that slept doesn't leap
  lastNow = now;
  drawView();
  drawCursors();
  showClock();
  if (state.playing) refresh();
}
function advance(seconds) {                   // loops over what the charts show
  const [from, to] = (state.zoom || [0, last * D.dt]).map(t => clamp(t / D.dt, 0, last));
  const before = state.pos;
  state.pos += Math.max(seconds, 0) * state.speed / D.dt;
  if ((before <= to && state.pos > to) || state.pos > last) state.pos = from;
}
function seek(frame) { state.pos = clamp(frame, 0, last); refresh(); }
function step(by) { setPlaying(false); seek(Math.round(state.pos) + by); }
function setPlaying(on) {
  state.playing = on && last > 0;
  lastNow = performance.now();
  $('play').setAttribute('aria-label', state.playing ? 'Pause' : 'Play');
  $('play').title = state.playing ? 'Pause (space)' : 'Play (space)';
  $('play').querySelector('path').setAttribute('d', state.playing ? 'M3 2h4v12H3zM9 2h4v12H9z' : 'M4 1.5v13l11-6.5z');
  refresh();
}
function showClock() {
  const f = Math.round(state.pos), digits = D.dt * last < 100 ? 3 : 2;
  $('scrub').value = f;
  $('scrub').setAttribute('aria-valuetext', num(now_s(), 3) + ' seconds');
  $('clock').replaceChildren(`${num(now_s(), digits)} s `, el('small', {}, `/ ${num(last * D.dt, digits)} s · step ${f * (D.frame_step || 1)}`));
}
