/* touch.js - things to touch: how they look, what they hide of the rod, and what touches them. */
let solids = [];                              // kind, name, place, axes, half, radius; in the view's frame
const sub = (a, b) => a.map((v, i) => v - b[i]);
const plus = (a, b, s) => a.map((v, i) => v + s * b[i]);
function loadTouch() {
  const rows = floats(D.contacts || '');      // frame, node, object, force x y z
  solids = (D.objects || []).map(o => ({ ...o, place: toView(o.place), axes: frameOf(o.q) }));
  D.contactsAt = Array.from({ length: D.frames }, () => []);
  for (let i = 0; i + 5 < rows.length; i += 6) {
    const at = D.contactsAt[rows[i]];
    if (at) at.push({ node: rows[i + 1], object: rows[i + 2], force: toView([...rows.subarray(i + 3, i + 6)]) });
  }
  const sizes = D.contactsAt.flat().map(c => Math.hypot(...c.force)).sort((a, b) => a - b);
  D.force_usual = sizes[Math.floor(0.9 * sizes.length)] || 1;
  solids.filter(o => o.kind === 'plane').forEach(laySheet);
}
/* What touches object i pushes the rod so hard in a frame; i = solids.length: all of them together. */
function forceOf(f, i) {
  const own = D.contactsAt[f].filter(c => i === solids.length || c.object === i);
  return Math.hypot(...own.reduce((sum, c) => plus(sum, c.force, 1), [0, 0, 0]));
}
function laySheet(o) {                        // of a plane only a round piece is shown, where the rod comes near it
  const near = D.contactsAt.flatMap((cs, f) => cs.filter(c => solids[c.object] === o).map(c => viewNode(f, c.node)));
  const middle = centre(near.length ? near : samplePoints(false));
  o.centre = plus(middle, o.axes[2], -gapTo(o, middle));
  o.reach = Math.max(0.45 * D.length, near.length ? 0.6 * extent(near) : 0);
}
/* Corners that the camera should see: of large things only what lies near the rod. */
function solidCorners(cloud) {
  const { lo, hi } = bounds(cloud), margin = 0.25 * D.length;
  return solids.filter(o => o.kind !== 'plane').flatMap(o => {
    const size = [0, 1, 2].map(c => o.radius + o.axes.reduce((sum, a, i) => sum + Math.abs(a[c]) * o.half[i], 0));
    return [-1, 1].map(s => o.place.map((v, c) => clamp(v + s * size[c], lo[c] - margin, hi[c] + margin)));
  });
}
function gapTo(o, p) {
  const local = o.axes.map(a => dot(sub(p, o.place), a));
  return o.kind === 'plane' ? local[2] : Math.hypot(...local.map((v, i) => Math.max(Math.abs(v) - o.half[i], 0))) - o.radius;
}
function isHidden(p) {                        // does the way to the eye lead through something?
  const way = sub(plus(eye.target, eye.toward, eye.dist), p), far = Math.hypot(...way), short = 0.01 * D.length;
  return solids.some(o => {
    for (let t = short, n = 0; t < far && n < 40; n++) {
      const gap = gapTo(o, plus(p, way, t / far));
      if (gap < -0.4 * short) return true;
      t += Math.max(gap, short);
    }
    return false;
  });
}

/* ---------- drawing ---------- */
const tone = (light, alpha = 1) => `rgba(${theme.solid.map(c => Math.round(clamp(c * light, 0, 255)))},${alpha})`;
function drawSolids() {
  const touched = new Set(D.contactsAt[Math.floor(state.pos)].map(c => c.object));
  const depth = o => dot(sub(o.centre || o.place, eye.target), eye.toward) - (o.centre ? 1e6 : 0);
  const order = [...solids.keys()].sort((i, j) => depth(solids[i]) - depth(solids[j]));
  for (const i of order) {
    const o = solids[i], path = o.centre ? sheetOf(o) : outlineOf(o);
    if (!path) continue;
    ctx.fillStyle = o.centre ? tone(1, 0.22) : bodyStyle(o);
    ctx.beginPath(); polyline(path); ctx.closePath(); ctx.fill();
    if (o.kind === 'box') drawFaces(o);
    if (o.centre) drawSheetLines(o);
    stroke(touched.has(i) ? theme.accent : theme.ghost, touched.has(i) ? 2 : 1, 0.9, () => { polyline(path); ctx.closePath(); });
  }
}
const round = (n, at) => range(0, n - 1).map(k => at(Math.cos(TAU * k / n), Math.sin(TAU * k / n)));
const onSheet = (o, x, y) => plus(plus(o.centre, o.axes[0], x * o.reach), o.axes[1], y * o.reach);
function sheetOf(o) {
  const path = round(64, (x, y) => project(onSheet(o, x, y)));
  return path.every(Boolean) && path;
}
function drawSheetLines(o) {
  stroke(theme.grid, 1, 0.35, () => range(-3, 3).forEach(k => {
    const at = k / 4, end = Math.sqrt(1 - at * at);
    line(project(onSheet(o, at, -end)), project(onSheet(o, at, end)));
    line(project(onSheet(o, -end, at)), project(onSheet(o, end, at)));
  }));
}
/* Sphere, capsule and box are one thing, a box with a rounding all round: the hull of circles about its corners. */
function outlineOf(o) {
  const signs = i => o.half[i] > 0 ? [-1, 1] : [0], points = [];
  for (const a of signs(0)) for (const b of signs(1)) for (const c of signs(2)) {
    const p = project([a, b, c].reduce((at, s, i) => plus(at, o.axes[i], s * o.half[i]), o.place));
    if (!p) return null;
    points.push(...round(48, (x, y) => ({ x: p.x + x * p.s * o.radius, y: p.y + y * p.s * o.radius })));
  }
  return hull(points);
}
function hull(points) {                       // Andrew's monotone chain
  const sorted = points.sort((a, b) => a.x - b.x || a.y - b.y), turns = (a, b, c) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  const half = list => list.reduce((chain, p) => {
    while (chain.length > 1 && !turns(chain[chain.length - 2], chain[chain.length - 1], p)) chain.pop();
    return [...chain, p];
  }, []).slice(0, -1);
  return [...half(sorted), ...half([...sorted].reverse())];
}
function bodyStyle(o) {                       // light from the upper left
  const p = project(o.place);
  if (!p || o.kind === 'box') return tone(0.8);
  const r = p.s * o.radius, end = project(plus(o.place, o.axes[2], o.half[2]));
  let style;
  if (o.kind === 'sphere' || !end) style = ctx.createRadialGradient(p.x - 0.35 * r, p.y - 0.4 * r, 0.1 * r, p.x, p.y, 1.05 * r);
  else {
    const far = Math.hypot(end.x - p.x, end.y - p.y) || 1, side = (end.x - p.x < 0 ? -1 : 1) * r / far;
    const nx = (end.y - p.y) * side, ny = -(end.x - p.x) * side;
    style = ctx.createLinearGradient(p.x + nx, p.y + ny, p.x - nx, p.y - ny);
  }
  style.addColorStop(0, tone(1.2)); style.addColorStop(1, tone(0.68));
  return style;
}
function drawFaces(o) {
  const from = plus(eye.target, eye.toward, eye.dist), light = [0.2, -0.45, 0.87];
  for (let i = 0; i < 3; i++) for (const s of [-1, 1]) {
    const normal = o.axes[i].map(v => s * v), middle = plus(o.place, normal, o.half[i] + o.radius);
    if (dot(sub(from, middle), normal) <= 0) continue;
    const [j, k] = [(i + 1) % 3, (i + 2) % 3];
    const quad = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => project(plus(plus(middle, o.axes[j], a * o.half[j]), o.axes[k], b * o.half[k])));
    if (!quad.every(Boolean)) continue;
    ctx.fillStyle = tone(0.92 + 0.2 * dot(normal, light));
    ctx.beginPath(); polyline(quad); ctx.closePath(); ctx.fill();
  }
}
function drawContacts() {                     // each force as an arrow from the node it pushes
  for (const c of D.contactsAt[Math.floor(state.pos)]) {
    const size = Math.hypot(...c.force), reach = Math.min(0.2 * D.length * size / D.force_usual, 0.3 * D.length);
    const p = project(cur[c.node]), tip = project(plus(cur[c.node], c.force, reach / (size || 1)));
    if (!p || !tip) continue;
    disc(p, 5, theme.panel); disc(p, 3.5, theme.accent);
    const far = Math.hypot(tip.x - p.x, tip.y - p.y), ux = (tip.x - p.x) / far, uy = (tip.y - p.y) / far;
    if (far < 6) continue;
    stroke(theme.accent, 2.2, 1, () => line(p, tip));
    stroke(theme.accent, 2.2, 1, () => [-1, 1].forEach(s => line(tip, { x: tip.x - 7 * ux + 4 * s * uy, y: tip.y - 7 * uy - 4 * s * ux })));
  }
}
function touchText() {                        // a line of its own for each thing that is touched
  const f = Math.floor(state.pos), touched = [...solids.keys()].filter(i => D.contactsAt[f].some(c => c.object === i));
  return touched.flatMap(i => [el('br'), `touches ${solids[i].name} `, el('b', {}, `${num(forceOf(f, i), 2)} N`)]);
}
