// Puts the page together: reads the data, fills it in, and joins the parts.

const results = readJson("results");
const run = readJson("run");
const histories = tipHistories(results);
const map = new FieldMap(byId("map"), results, run.stepsWithFields, run.viridis);
const curves = new Curves(results, histories);
const timeline = new Timeline(results.steps, showStep);
let pointer = null;

function showSummary() {
  const parts = [results.method.replaceAll("-", " "), `${results.nodes.toLocaleString("en")} nodes`];
  if (results.steps.length > 1) parts.push(`${results.steps.length} steps`);
  if (results.growth_end) parts.push(`growth ended: ${results.growth_end.reason}`);
  const chip = element("span", { class: `chip ${results.status}` }, results.status);
  byId("summary").replaceChildren(chip, parts.join(" · "));
  byId("warnings").hidden = results.warnings.length === 0;
  byId("warning-list").replaceChildren(...results.warnings.map((w) => element("li", {}, w)));
}

function showAbout() {
  const { source } = run;
  const last = results.steps.at(-1);
  const rows = [
    ["riss", results.riss],
    ["method", results.method],
    ["case file", source?.case_file],
    ["started", source && new Date(1000 * source.started_unix_s).toLocaleString()],
    ["platform", source && `${source.platform}, ${source.threads} threads`],
    ["wall time", results.wall_time_s !== null && `${number(results.wall_time_s, 4)} s`],
    ["memory", results.peak_memory_bytes && `${number(results.peak_memory_bytes / 2 ** 20, 4)} MiB at most`],
    ["nodes", results.nodes],
    ["unknowns", results.unknowns],
    ["integration points", results.integration_points],
    ["units", results.units && `${results.units.length}, ${results.units.force}, ${results.units.stress}`],
    [withUnit("strain energy", "energy"), last && results.strain_energy !== null && number(results.strain_energy)],
    ["energy error", results.energy_error !== null && `${number(100 * results.energy_error, 4)} %`],
    ["residual", results.residual !== null && number(results.residual, 3)],
  ];
  const shown = rows.filter(([, value]) => value !== null && value !== undefined && value !== false);
  byId("about").replaceChildren(...shown.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, String(value))]));
  byId("case").hidden = !source;
  byId("case-text").textContent = source?.case_text ?? "";
  byId("overrides").replaceChildren(...(source?.overrides ?? []).map((o) => element("li", {}, `set beside the file: ${o}`)));
}

function showLegend() {
  if (!map.fields) return;
  const [low, high] = map.range();
  const narrow = matchMedia("(max-width: 820px)").matches && !matchMedia("print").matches;
  byId("legend-title").textContent = map.quantity.title;
  byId("legend-bar").style.background = gradient(map.stops(), map.bands, narrow ? "to right" : "to top");
  const ticks = Array.from({ length: narrow ? 4 : 7 }, (_, k, n = narrow ? 3 : 6) => short(low + ((high - low) * k) / n));
  byId("legend-ticks").replaceChildren(...ticks.map((t) => element("li", {}, t)));
  byId("deformation-label").textContent = `× ${number(map.deformation(), 4)}`;
}

function showNote() {
  const wanted = map.fieldsStep(map.step);
  const head = map.heads.get(wanted);
  const notes = [];
  if (wanted === undefined) notes.push("no fields were written: crack paths only");
  else if (!canReadFields) notes.push("this browser cannot unpack fields (it has no DecompressionStream): crack paths only");
  else if (wanted !== map.step) notes.push(`fields of step ${wanted}`);
  else if (head.n_vertices < head.n_computed) notes.push(`thinned to ${head.n_vertices.toLocaleString("en")} of ${head.n_computed.toLocaleString("en")} points`);
  byId("map-note").textContent = notes.join(", ");
  byId("map-note").hidden = notes.length === 0;
}

/** Values at the pointer, or at the cross in the middle when the keyboard moves the map. */
function showProbe() {
  const at = pointer ?? (map.cross ? [0.5 * map.canvas.clientWidth, 0.5 * map.canvas.clientHeight] : null);
  const found = at && map.probe(...at);
  const entry = (name, value, quantity, chosen) =>
    element("div", { class: chosen ? "chosen" : null }, element("dt", {}, name), element("dd", { "data-quantity": quantity, "data-value": value }, typeof value === "number" ? number(value) : value));
  const entries = [];
  if (found?.tip) {
    const { crack, tip } = found.tip;
    entries.push(entry("tip", `${crack.name} ${tip.end}`, "tip", true), entry(withUnit("K_I", "factor"), tip.K_I, "K_I"), entry(withUnit("K_II", "factor"), tip.K_II, "K_II"), entry("±", tip.K_uncertainty, "K_uncertainty"));
  } else if (found) {
    entries.push(entry(withUnit("x", "length"), found.x, "x"), entry(withUnit("y", "length"), found.y, "y"));
    const others = QUANTITIES.filter((q) => q !== map.quantity);
    entries.push(...[map.quantity, ...others].map((q) => entry(q.title, found.value(q.name), q.name, q === map.quantity)));
  }
  byId("probe").replaceChildren(...(entries.length ? entries : [element("div", {}, element("dt", {}, "Point at the body to read values."))]));
}

function refresh() {
  map.draw();
  showLegend();
  showProbe();
}

async function showStep(index) {
  const step = results.steps[index];
  byId("now-step").textContent = step.step;
  tipTable(step, histories);
  reactionTable(step);
  markHistory(results, step.step);
  curves.show(step.step);
  await map.show(step.step);
  showLegend();
  showNote();
  showProbe();
  map.canvas.setAttribute("aria-label", `${map.quantity.title} on the deformed body, ${timeline.label(step)}`);
}

function attachControls() {
  const quantity = byId("quantity");
  QUANTITIES.forEach((q, k) => quantity.append(element("option", { value: k }, q.title)));
  quantity.addEventListener("change", () => { map.quantity = QUANTITIES[quantity.value]; refresh(); });
  byId("range").addEventListener("change", (event) => {
    [byId("own-low").value, byId("own-high").value] = map.range().map((v) => Number(v.toPrecision(4)));
    map.rangeKind = event.target.value;
    byId("own-range").hidden = map.rangeKind !== "own";
    readOwnRange();
  });
  ["own-low", "own-high"].forEach((id) => byId(id).addEventListener("input", readOwnRange));
  byId("bands").addEventListener("change", (event) => { map.bands = event.target.checked; refresh(); });
  byId("deformation").addEventListener("input", (event) => { map.exaggeration = Number(event.target.value); refresh(); });
  byId("zoom-in").addEventListener("click", () => { map.zoom(ZOOM_STEP); refresh(); });
  byId("zoom-out").addEventListener("click", () => { map.zoom(1 / ZOOM_STEP); refresh(); });
  byId("fit").addEventListener("click", () => { map.setView(null); refresh(); });
}

function readOwnRange() {
  map.ownRange = [Number(byId("own-low").value), Number(byId("own-high").value)];
  refresh();
}

/** Keys that work wherever they are not needed by what has the focus. */
function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const focus = document.activeElement;
  const types = focus.matches("select, input[type=number], textarea");
  const slides = focus.matches("input[type=range]");
  const presses = focus.matches("button, input[type=checkbox], a");
  const pan = { ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40] }[event.key];
  const actions = {
    ArrowLeft: () => { timeline.stop(); timeline.go(timeline.index - 1); },
    ArrowRight: () => { timeline.stop(); timeline.go(timeline.index + 1); },
    Home: () => timeline.go(0),
    End: () => timeline.go(results.steps.length - 1),
    " ": () => timeline.toggle(),
    "+": () => map.zoom(ZOOM_STEP),
    "=": () => map.zoom(ZOOM_STEP),
    "-": () => map.zoom(1 / ZOOM_STEP),
    0: () => map.setView(null),
  };
  const inMap = focus === map.canvas;
  if (types || (slides && !"+-=0 ".includes(event.key)) || (presses && event.key === " ")) return;
  if ((event.key === "Home" || event.key === "End") && !inMap) return;
  const action = event.shiftKey && pan ? () => map.pan(...pan) : actions[event.key];
  if (!action) return;
  event.preventDefault();
  map.cross = inMap;
  if (inMap) pointer = null;
  action();
  refresh();
}

/** Paper is white, whatever the screen is. */
function onAppearance() {
  refresh();
  curves.redraw();
}

function start() {
  showSummary();
  showAbout();
  stageTable(results);
  settingsTable(run.source);
  historyTable(results, null);
  attachControls();
  for (const [id, name] of [["tips", "crack tips"], ["history", "all steps"], ["settings-table", "settings"]]) {
    addCopyButton(byId(id), name, byId(id).closest("section").querySelector(".section-head"));
  }
  attachPointer(map, (...at) => {
    pointer = at.length ? at : null;
    if (map.cross && pointer) { map.cross = false; map.draw(); }
    showProbe();
  });
  document.addEventListener("keydown", onKey);
  map.canvas.addEventListener("blur", () => { map.cross = false; refresh(); });
  new ResizeObserver(refresh).observe(map.canvas);
  for (const query of ["(prefers-color-scheme: dark)", "print"]) matchMedia(query).addEventListener("change", onAppearance);
  byId("picture").querySelectorAll(".legend, .deformation").forEach((e) => { e.hidden = run.stepsWithFields.length === 0; });
  return results.steps.length ? timeline.go(results.steps.length - 1) : undefined;
}

Promise.resolve()
  .then(start)
  .then(() => document.documentElement.setAttribute("data-ready", ""))
  .catch((error) => {
    byId("problem").textContent = `This report could not be shown: ${error.message}`;
    byId("problem").hidden = false;
    console.error(error);
  });
