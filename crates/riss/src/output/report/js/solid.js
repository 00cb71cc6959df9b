// The body of a solid with its cracks in space: turned by mouse, touch and keys, a step at a time, values under the cursor.

const { viridis } = readJson("view");
const scenes = readJson("scenes");
const canvas = byId("view-canvas");
const [slider, play, opening, status, fieldChoice, bodyChoice] =
  ["step", "play", "opening", "status", "field", "body"].map((name) => byId(`view-${name}`));
const axisNames = [...document.querySelectorAll(".axis")];

/** Oranges of ColorBrewer: the opening of cracks, apart from the fields. */
const ORANGES = [
  [255, 245, 235], [254, 236, 217], [253, 224, 194], [253, 208, 162], [253, 184, 122], [253, 160, 85], [250, 134, 50],
  [241, 105, 19], [224, 83, 8], [196, 65, 2], [140, 45, 4],
];
const FRONT = "#d55e00";

/** Least corner, middle and diagonal of the box around points. */
function box(lists) {
  const [lower, upper] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const points of lists) {
    for (let i = 0; i < points.length; i++) {
      lower[i % 3] = Math.min(lower[i % 3], points[i]);
      upper[i % 3] = Math.max(upper[i % 3], points[i]);
    }
  }
  const middle = lower.map((v, k) => 0.5 * (v + upper[k]));
  return { lower, middle, size: Math.hypot(...lower.map((v, k) => upper[k] - v)) || 1 };
}

const edges = scenes[0].body;
const crackPoints = scenes.flatMap((s) => s.cracks.map((c) => c.points));
const whole = box([edges, ...crackPoints]);
const cracked = crackPoints.length ? box(crackPoints) : whole;
const largest = Math.max(0, ...scenes.flatMap((s) => s.cracks.flatMap((c) => c.gaps)));
const UNIT = (kind) => (UNITS ? ` ${UNITS[kind]}` : "");
/** Five digits, as in the tables. */
const digits = (v) => (v === null || v === undefined || Number.isNaN(v) ? "–" : Number(v).toPrecision(5));

let view;
let step = scenes.length - 1;
let boundary;
/** What values are known of, in pixels. */
let known = [];

/** Ends of the color scale of a quantity, the same in all steps. */
function range(name) {
  const ends = scenes.map((s) => s.boundary.ranges[name]);
  return [Math.min(...ends.map((e) => e[0])), Math.max(...ends.map((e) => e[1]))];
}

function drawBoundary() {
  const [low, high] = range(fieldChoice.value);
  const shares = () => {
    const values = boundary.values(fieldChoice.value);
    return Float32Array.from(values, (v) => (Number.isFinite(v) ? Math.min(1, Math.max(0, (v - low) / (high - low || 1))) : -1));
  };
  const arrays = () => ({ positions: boundary.positions, shares: shares(), triangles: boundary.triangles });
  view.surface("boundary", `${step} ${fieldChoice.value}`, arrays, viridis, bodyChoice.value, 0.3);
}

/** Both faces of a crack, opened; `stretch` times half the opening each. */
function crackArrays(crack, stretch) {
  const n = crack.gaps.length;
  const sides = stretch > 0 ? [1, -1] : [1];
  const positions = sides.flatMap((side) => crack.points.map((p, i) => p + side * stretch * crack.openings[i]));
  const shares = sides.flatMap(() => crack.gaps.map((gap) => (largest > 0 ? Math.min(1, Math.max(0, gap / largest)) : 0)));
  const triangles = sides.flatMap((_, s) => crack.triangles.map((v) => v + s * n));
  return { positions: Float32Array.from(positions), shares: Float32Array.from(shares), triangles: Uint32Array.from(triangles) };
}

function drawCracks(scene) {
  const stretch = largest > 0 ? (0.5 * Number(opening.value) * 0.12 * cracked.size) / largest : 0;
  scene.cracks.forEach((crack, c) => {
    if (!crack.triangles.length) return;
    view.surface(`crack ${c}`, `${step} ${stretch}`, () => crackArrays(crack, stretch), ORANGES, "both", 0.25);
    crack.gaps.forEach((_, i) => {
      const at = [0, 1, 2].map((k) => crack.points[3 * i + k] + stretch * crack.openings[3 * i + k]);
      known.push({ at: view.seen(...at), crack, index: i });
    });
  });
}

function drawFronts(scene) {
  const corners = [];
  for (const front of scene.fronts) {
    const at = front.points.map((p) => view.seen(...p.position));
    corners.push(view.ribbon(front.closed ? [...at, at[0]] : at, 2 * view.width), ...at.map((p) => view.dot(p, 2.5 * view.width)));
    at.forEach((p, index) => known.push({ at: p, front, index }));
  }
  view.over(corners.flat(), tintOf(FRONT));
}

function drawAxes() {
  const corners = [];
  const from = view.seen(...whole.lower);
  const ratio = canvas.width / canvas.clientWidth;
  axisNames.forEach((name, k) => {
    const end = whole.lower.slice();
    end[k] += 0.18 * whole.size;
    const to = view.seen(...end);
    corners.push(view.ribbon([from, to], 1.2 * view.width));
    const [x, y] = [to[0] / ratio + 3, to[1] / ratio - 18];
    name.hidden = x < 0 || y < 0 || x > canvas.clientWidth - 12 || y > canvas.clientHeight - 18;
    name.style.transform = `translate(${x}px, ${y}px)`;
  });
  view.over(corners.flat(), tintOf("text"));
}

function draw() {
  const scene = scenes[step];
  known = [];
  view.begin();
  if (boundary && bodyChoice.value !== "none") drawBoundary();
  drawCracks(scene);
  view.lines("edges", "edges", edges, tintOf("quiet"));
  drawFronts(scene);
  drawAxes();
  legends();
  byId("view-label").textContent = scene.label;
  slider.value = step;
  slider.setAttribute("aria-valuetext", scene.label);
  canvas.dataset.drawn = step;
}

function legends() {
  const quantity = SOLID_QUANTITIES.find((q) => q.name === fieldChoice.value);
  const [low, high] = range(quantity.name);
  byId("view-field-legend").textContent = `${quantity.title}: ${short(low)} to ${short(high)}`;
  byId("view-field-scale").hidden = bodyChoice.value === "none";
  byId("view-legend").textContent = `opening 0 to ${digits(largest)}${UNIT("length")}`;
  ["opening-scale", "opening-label"].forEach((name) => { byId(`view-${name}`).hidden = !crackPoints.length; });
}

/** The nearest point of the drawn boundary at a pixel, with its value. */
function onBoundary(x, y) {
  if (!boundary || bodyChoice.value === "none") return null;
  const { positions, triangles, n } = boundary;
  const at = Array.from({ length: n }, (_, i) => view.seen(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]));
  const values = boundary.values(fieldChoice.value);
  let best = null;
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [triangles[t], triangles[t + 1], triangles[t + 2]];
    const [a, b, c] = corners.map((v) => at[v]);
    // Pixels count downwards: what turns towards the eye has a negative area.
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    if (area === 0 || (bodyChoice.value === "far" && area < 0)) continue;
    const wb = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / area;
    const wc = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / area;
    if (wb < 0 || wc < 0 || wb + wc > 1) continue;
    const weights = [1 - wb - wc, wb, wc];
    const near = weights[0] * a[2] + wb * b[2] + wc * c[2];
    if (best && near <= best.near) continue;
    const mean = (of) => corners.reduce((sum, v, k) => sum + weights[k] * of(v), 0);
    best = { near, value: mean((v) => values[v]), position: [0, 1, 2].map((k) => mean((v) => positions[3 * v + k])) };
  }
  return best;
}

/** What is known at a pixel, in words. */
function probe(x, y) {
  let [least, nearest] = [14 * (canvas.width / canvas.clientWidth), null];
  const wall = onBoundary(x, y);
  for (const place of known) {
    const hidden = wall && wall.near > place.at[2] + 1e-3 * whole.size;
    const distance = Math.hypot(place.at[0] - x, place.at[1] - y) * (place.front ? 0.7 : 1);
    if (!hidden && distance < least) [least, nearest] = [distance, place];
  }
  const at = (position) => `(${position.map(digits).join(", ")})${UNIT("length")}`;
  if (nearest?.front) {
    const p = nearest.front.points[nearest.index];
    const [k1, k2, k3] = [p.K_I, p.K_II, p.K_III].map(digits);
    return `front of ${nearest.front.crack} at ${at(p.position)}: ` +
      `K_I ${k1}, K_II ${k2}, K_III ${k3}, ± ${digits(p.K_uncertainty)}${UNIT("factor")}`;
  }
  if (nearest) {
    const { crack, index } = nearest;
    return `${crack.name} at ${at(crack.points.slice(3 * index, 3 * index + 3))}: opening ${digits(crack.gaps[index])}${UNIT("length")}`;
  }
  if (!wall) return "";
  const { title } = SOLID_QUANTITIES.find((q) => q.name === fieldChoice.value);
  return `boundary at ${at(wall.position)}: ${title} ${digits(wall.value)}`;
}

async function show(number) {
  step = Math.min(scenes.length - 1, Math.max(0, number));
  const wanted = step;
  const found = canReadFields ? await readBoundary(scenes[wanted].boundary) : null;
  if (wanted !== step) return;
  boundary = found;
  draw();
}
