/* view.js - the rod in 3-D on a plain canvas: camera, scene, gestures. */
/* ---------- camera ---------- */
const view = $('view'), ctx = view.getContext('2d');
const cam = { az: 0, el: 0, zoom: 1, pan: [0, 0, 0], offset: [0, 0, 0], dist: 1, follow: false };
const home = { az: 0, el: 0.36 };
const lens = { w: 1, h: 1, f: 1 };            // canvas size and focal length, CSS pixels
let cur = [], axes = [];                      // nodes and base axes at the present instant, view frame
let floorZ;                                   // () => height of the floor

function chooseHome() {                       // look across the widest horizontal direction, a little from the side
  let sxx = 0, syy = 0, sxy = 0;
  const cloud = samplePoints(false), mean = centre(cloud);
  for (const p of cloud) { const x = p[0] - mean[0], y = p[1] - mean[1]; sxx += x * x; syy += y * y; sxy += x * y; }
  home.az = 0.5 * Math.atan2(2 * sxy, sxx - syy) - Math.PI / 2 + 0.45;
}
function samplePoints(relative) {             // up to ~300 frames and ~9 nodes of each are enough to frame the motion
  const out = [], df = Math.ceil(D.frames / 300), dk = Math.ceil(N / 8);
  for (let f = 0; f <= last; f += df) {
    const b = viewNode(f, 0);
    for (let k = 0; k <= N; k = k < N ? Math.min(k + dk, N) : N + 1) {
      const p = viewNode(f, k), q = relative ? p.map((v, i) => v - b[i]) : p;
      if (q.every(finite)) out.push(q);
    }
  }
  if (!out.length) out.push([0, 0, 0]);
  return relative ? out : [...out, ...solidCorners(out)];
}
function bounds(points) {
  const lo = [Infinity, Infinity, Infinity], hi = lo.map(v => -v);
  for (const p of points) for (let c = 0; c < 3; c++) { lo[c] = Math.min(lo[c], p[c]); hi[c] = Math.max(hi[c], p[c]); }
  return { lo, hi };
}
const centre = points => { const { lo, hi } = bounds(points); return mix(lo, hi, 0.5); };
const extent = points => { const { lo, hi } = bounds(points); return Math.hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]); };
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
function cameraAxes(az, elev) {
  const ca = Math.cos(az), sa = Math.sin(az), ce = Math.cos(elev), se = Math.sin(elev);
  return { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], toward: [ce * ca, ce * sa, se] };
}
function fitCamera() {                        // the nearest distance at which every point is inside the window, from home
  const cloud = samplePoints(cam.follow), { right, up, toward } = cameraAxes(home.az, home.el);
  const local = cloud.map(p => [dot(p, right), dot(p, up), dot(p, toward)]), m = centre(local);
  cam.offset = [0, 1, 2].map(i => m[0] * right[i] + m[1] * up[i] + m[2] * toward[i]);
  const slopeX = 0.84 * lens.w / 2 / lens.f, slopeY = 0.74 * lens.h / 2 / lens.f;   // margins for triad and captions
  cam.dist = Math.max(0.6 * D.length, ...local.map(p => p[2] - m[2] + Math.max(Math.abs(p[0] - m[0]) / slopeX, Math.abs(p[1] - m[1]) / slopeY)));
}
function placeFloor() {                       // under everything; under the rod itself if the hand climbs far while followed
  const all = bounds(samplePoints(false)), rel = bounds(samplePoints(true));
  floorZ = () => (cam.follow && all.hi[2] - all.lo[2] > 2 * D.length ? cur[0][2] + rel.lo[2] : all.lo[2]) - 0.06 * D.length;
}
function resetView() {
  Object.assign(cam, { az: home.az, el: home.el, zoom: 1, pan: [0, 0, 0] });
  fitCamera();
  refresh();
}
function setFollow(on) { cam.follow = on; $('follow').checked = on; fitCamera(); cam.pan = [0, 0, 0]; refresh(); }
function resizeView() {
  const box = view.getBoundingClientRect(), dpr = devicePixelRatio || 1;
  Object.assign(lens, { w: Math.max(box.width, 1), h: Math.max(box.height, 1), dpr });
  lens.f = 1.6 * Math.max(lens.w, lens.h);    // a calm lens: about 35° across the longer side
  view.width = Math.round(lens.w * dpr); view.height = Math.round(lens.h * dpr);
  fitCamera();
  refresh();
}
let eye;                                      // the camera of the present frame: axes, target, distance
function aimCamera() {
  const base = cam.follow && cur[0].every(finite) ? cur[0] : [0, 0, 0];
  eye = { ...cameraAxes(cam.az, cam.el), dist: cam.dist / cam.zoom, target: [0, 1, 2].map(i => base[i] + cam.offset[i] + cam.pan[i]) };
}
function project(p) {                         // x, y in CSS pixels, s: pixels per metre there; null when behind the eye
  const d = [p[0] - eye.target[0], p[1] - eye.target[1], p[2] - eye.target[2]];
  const depth = eye.dist - dot(d, eye.toward);
  if (!(depth > 0.04 * eye.dist)) return null;        // written so that NaN ends here too
  const s = lens.f / depth;
  return { x: lens.w / 2 + dot(d, eye.right) * s, y: lens.h * 0.51 - dot(d, eye.up) * s, s, depth };
}

/* ---------- the scene ---------- */
function line(a, b) { if (a && b) { ctx.moveTo(a.x, a.y); ctx.lineTo(b.x, b.y); } }
function stroke(style, width, opacity, path) {
  ctx.globalAlpha = opacity; ctx.strokeStyle = style; ctx.lineWidth = width;
  ctx.beginPath(); path(); ctx.stroke();
  ctx.globalAlpha = 1;
}
function polyline(points) {                   // one path as far as the points can be seen, so that its corners join
  points.forEach((p, i) => { if (p) points[i - 1] ? ctx.lineTo(p.x, p.y) : ctx.moveTo(p.x, p.y); });
}
function disc(p, r, fill) { ctx.fillStyle = fill; ctx.beginPath(); ctx.arc(p.x, p.y, r, 0, TAU); ctx.fill(); }

function instant() {                          // nodes between two frames are interpolated, for smooth slow motion
  const f = Math.floor(state.pos), g = Math.min(f + 1, last), u = state.pos - f;
  cur = [];
  for (let k = 0; k <= N; k++) cur.push(u ? mix(viewNode(f, k), viewNode(g, k), u) : viewNode(f, k));
  const a = bodyAxes(f), b = bodyAxes(g);
  axes = a.map((v, i) => { const m = mix(v, b[i], u), n = Math.hypot(...m) || 1; return m.map(c => c / n); });
}
function drawView() {
  instant();
  aimCamera();
  ctx.setTransform(lens.dpr, 0, 0, lens.dpr, 0, 0);
  ctx.clearRect(0, 0, lens.w, lens.h);
  ctx.lineCap = ctx.lineJoin = 'round';
  const floor = floorZ();
  drawFloor(floor);
  drawShadow(floor);
  drawHandPath();
  drawTrail(0);
  drawTrail(N);
  drawGhost();
  drawTriad(false);
  drawRod(true);
  drawSolids();
  drawRod(false);
  drawContacts();
  drawTriad(true);
  showHud();
}
function niceStep(v) { const p = 10 ** Math.floor(Math.log10(v)), m = v / p; return p * (m < 2 ? 1 : m < 5 ? 2 : 5); }
function drawFloor(z) {                       // lines at round world coordinates, fading away from the middle
  const cell = niceStep(eye.dist / 9), n = 12, cx = Math.round(eye.target[0] / cell), cy = Math.round(eye.target[1] / cell);
  const corner = (i, j) => project([(cx + i) * cell, (cy + j) * cell, z]);
  const rows = [], bands = Array.from({ length: 8 }, () => []);
  for (let i = -n; i <= n; i++) { rows.push([]); for (let j = -n; j <= n; j++) rows[i + n].push(corner(i, j)); }
  const add = (i, j, a, b) => {
    const r = Math.hypot((cx + i) * cell - eye.target[0], (cy + j) * cell - eye.target[1]) / (n * cell);
    if (r < 1) bands[Math.floor(r * bands.length)].push([a, b]);
  };
  for (let i = -n; i <= n; i++) for (let j = -n; j <= n; j++) {
    if (i < n) add(i + 0.5, j, rows[i + n][j + n], rows[i + n + 1][j + n]);
    if (j < n) add(i, j + 0.5, rows[i + n][j + n], rows[i + n][j + n + 1]);
  }
  bands.forEach((band, b) => stroke(theme.grid, 1, 0.42 * (1 - b / bands.length) ** 1.4, () => band.forEach(([p, q]) => line(p, q))));
  $('gridNote').textContent = `grid ${cell >= 1 ? cell + ' m' : cell >= 0.01 ? +(cell * 100).toFixed(1) + ' cm' : +(cell * 1000).toFixed(3) + ' mm'}`;
}
function drawShadow(z) {
  const pts = cur.map(p => project([p[0], p[1], z]));
  stroke('#000', Math.max(2, 0.016 * D.length * (pts[0] ? pts[0].s : 1)), theme.shade, () => polyline(pts));
}
function drawHandPath() {                     // the whole recorded path, hardly visible: where the hand will go
  const pts = [], df = Math.ceil(D.frames / 500);
  for (let f = 0; f <= last; f += df) pts.push(project(viewNode(f, 0)));
  stroke(theme.ghost, 1, 0.28, () => polyline(pts));
}
function drawTrail(k) {                       // the last 1.2 s of one node, in chunks of rising strength
  const end = Math.floor(state.pos), span = Math.max(2, Math.round(1.2 / D.dt)), from = Math.max(0, end - span);
  const df = Math.max(1, Math.ceil(span / 240)), pts = [];
  for (let f = end - (end % df); f >= from; f -= df) pts.push({ p: project(viewNode(f, k)), age: (state.pos - f) / span });
  pts.unshift({ p: project(cur[k]), age: 0 });
  ctx.lineCap = 'butt';                       // round ends would show as beads where chunks overlap
  for (let i = 0; i + 1 < pts.length; i += 6) {
    const fresh = (1 - clamp(pts[i].age, 0, 1)) ** 1.5;
    stroke(ramp(k / N), 0.8 + 2 * fresh, 0.75 * fresh, () => polyline(pts.slice(i, i + 7).map(q => q.p)));
  }
  ctx.lineCap = 'round';
}
const along = (axis, length) => cur[0].map((v, i) => v + axis[i] * length);
function drawGhost() {
  ctx.setLineDash([5, 6]);
  stroke(theme.ghost, 1.4, 0.6, () => line(project(cur[0]), project(along(axes[2], D.length))));
  ctx.setLineDash([]);
}
function drawTriad(lettersOnly) {             // the letters come last, else the rod hides its own axis's
  const o = project(cur[0]);
  if (!o) return;
  const reach = Math.max(0.17 * D.length, 26 / o.s);  // never too small to read
  ctx.font = '600 12px system-ui, sans-serif'; ctx.textAlign = 'center'; ctx.textBaseline = 'middle';
  axes.forEach((a, i) => {
    const tip = project(along(a, reach)), far = tip && Math.hypot(tip.x - o.x, tip.y - o.y);
    if (!tip) return;
    if (!lettersOnly) return stroke(theme.axes[i], 2.6, 1, () => line(o, tip));
    ctx.fillStyle = theme.axes[i];
    const ux = (tip.x - o.x) / far, uy = (tip.y - o.y) / far, aside = i === 2 ? 15 : 0;     // z lies under the rod: letter beside it
    if (far > 10) ctx.fillText('xyz'[i], tip.x + 10 * ux + aside * uy, tip.y + 10 * uy - aside * ux);
  });
}
function taper(a, b, ra, rb, shift = 0) {     // a quad of half-widths ra, rb around the line a–b, moved sideways by shift
  const len = Math.hypot(b.x - a.x, b.y - a.y) || 1;
  let nx = -(b.y - a.y) / len, ny = (b.x - a.x) / len;
  if (ny > 0 || (ny === 0 && nx > 0)) { nx = -nx; ny = -ny; }          // the normal that points up, to the light
  const at = (p, r, side) => [p.x + nx * (side * r + shift * r), p.y + ny * (side * r + shift * r)];
  ctx.beginPath();
  ctx.moveTo(...at(a, ra, 1)); ctx.lineTo(...at(b, rb, 1)); ctx.lineTo(...at(b, rb, -1)); ctx.lineTo(...at(a, ra, -1));
  ctx.closePath();
}
function drawRod(hidden) {                    // the links behind something, or those in front of all
  const pts = cur.map(project);
  pts.forEach((p, k) => { if (p) p.r = Math.max(lerp(3, 1.4, k / N), p.s * D.length * lerp(0.0125, 0.0038, k / N)); });
  const order = [...Array(N).keys()].filter(k => pts[k] && pts[k + 1] && isHidden(mix(cur[k], cur[k + 1], 0.5)) === hidden).sort((i, j) => pts[j].depth + pts[j + 1].depth - pts[i].depth - pts[i + 1].depth);
  for (const k of order) {                    // painter's order, far links first; joint k+1 sits at node k
    const a = pts[k], b = pts[k + 1], body = ctx.createLinearGradient(a.x, a.y, b.x, b.y || b.y + 1e-6);
    body.addColorStop(0, ramp(k / N)); body.addColorStop(1, ramp((k + 1) / N));
    ctx.fillStyle = body;
    taper(a, b, a.r, b.r); ctx.fill();
    disc(b, b.r, ramp((k + 1) / N));          // rounds the bend on the outside
    ctx.fillStyle = 'rgba(0,0,0,.2)'; taper(a, b, a.r * 0.45, b.r * 0.45, -1.2); ctx.fill();
    ctx.fillStyle = 'rgba(255,255,255,.38)'; taper(a, b, a.r * 0.26, b.r * 0.26, 1.3); ctx.fill();
    drawJoint(a, k);
  }
  const tip = pts[N];
  if (tip && isHidden(cur[N]) === hidden) { disc(tip, tip.r * 2.6 + 2, ramp(1, 0.22)); disc(tip, tip.r * 1.3 + 1, ramp(1)); }
}
function drawJoint(p, k) {                    // with many links the dots shrink, or they would hide the rod
  const r = p.r * (N <= 12 ? 1.25 : N <= 32 ? 0.9 : 0.6) + (N <= 12 ? 0.8 : 0);
  disc(p, r, ramp(k / N));
  ctx.globalAlpha = N <= 12 ? 1 : 0.6;
  disc(p, r * 0.58, theme.panel);
  ctx.globalAlpha = 1;
}
function showHud() {
  const tip = Math.hypot(...along(axes[2], D.length).map((v, i) => v - cur[N][i]));
  $('hud').replaceChildren('tip deflection ', el('b', {}, metres(tip)), finite(tip) ? ` · ${num(100 * tip / D.length, 1)} % of length` : '', ...touchText());
}

/* ---------- orbit, zoom, pan ---------- */
const fingers = new Map();
function onViewMove(e) {
  const was = fingers.get(e.pointerId);
  if (!was) return;
  const dx = e.clientX - was.x, dy = e.clientY - was.y, other = [...fingers].find(([id]) => id !== e.pointerId);
  if (other) {                                // pinch: the ratio of the distances to the finger that rests
    const o = other[1];
    zoomView(Math.hypot(e.clientX - o.x, e.clientY - o.y) / Math.max(Math.hypot(was.x - o.x, was.y - o.y), 1));
  } else if (e.shiftKey || e.buttons & 4) {
    const perPixel = eye.dist / lens.f;
    cam.pan = cam.pan.map((v, i) => v + (eye.up[i] * dy - eye.right[i] * dx) * perPixel);
  } else {
    cam.az -= dx * 0.008;
    cam.el = clamp(cam.el + dy * 0.008, -1.5, 1.5);
  }
  fingers.set(e.pointerId, { x: e.clientX, y: e.clientY });
  refresh();
}
function zoomView(factor) { cam.zoom = clamp(cam.zoom * factor, 0.15, 200); refresh(); }
function bindView() {
  view.addEventListener('pointerdown', e => { fingers.set(e.pointerId, { x: e.clientX, y: e.clientY }); view.setPointerCapture(e.pointerId); });
  view.addEventListener('pointermove', onViewMove);
  for (const type of ['pointerup', 'pointercancel', 'lostpointercapture']) view.addEventListener(type, e => fingers.delete(e.pointerId));
  view.addEventListener('wheel', e => { e.preventDefault(); zoomView(Math.exp(-clamp(e.deltaY * (e.deltaMode ? 20 : 1), -200, 200) * 0.0018)); }, { passive: false });
  view.addEventListener('dblclick', resetView);
  $('resetView').onclick = resetView;
  $('follow').onchange = e => setFollow(e.target.checked);
  new ResizeObserver(() => { resizeView(); drawView(); }).observe(view);   // now: the next frame is too late not to flicker
}
