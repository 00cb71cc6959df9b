// Tables: `fillTable`, `tipTable`, `reactionTable`, `historyTable`, `stageTable`,
// `settingsTable`.

const column = (title, of, kind) => ({ title, of, kind });

/** Fills a table from columns and rows; the cells keep all digits for the clipboard. */
function fillTable(table, columns, rows, isCurrent = () => false) {
  const cells = (row) => columns.map(({ of, kind }) => {
    const value = of(row);
    const text = typeof value === "number" || value === null || value === undefined ? number(value, kind === "error" ? 3 : 6) : value;
    return element("td", { class: kind, "data-value": value ?? "" }, text);
  });
  const head = element("tr", {}, ...columns.map((c) => element("th", { class: c.kind, scope: "col" }, c.title)));
  const body = rows.map((row) => element("tr", { class: isCurrent(row) ? "current" : null }, ...cells(row)));
  table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...body));
}

const TIP_COLUMNS = [
  column("crack", (r) => r.crack.name, "text"),
  column("end", (r) => r.tip.end, "text"),
  column(withUnit("x", "length"), (r) => r.tip.position[0]),
  column(withUnit("y", "length"), (r) => r.tip.position[1]),
  column(withUnit("a", "length"), (r) => pathLength(r.crack.path)),
  column(withUnit("K_I", "factor"), (r) => r.tip.K_I),
  column(withUnit("K_II", "factor"), (r) => r.tip.K_II),
  column(withUnit("± K", "factor"), (r) => r.tip.K_uncertainty, "error"),
  column(withUnit("J", "force per length"), (r) => r.tip.J),
  column(withUnit("T", "stress"), (r) => r.tip.T),
  column("status", (r) => r.tip.status, "text"),
];
const GROWTH_COLUMNS = [
  column(withUnit("K equivalent", "factor"), (r) => r.tip.K_equivalent),
  column("kink °", (r) => r.tip.kink_angle_deg),
  column(withUnit("increment", "length"), (r) => r.tip.increment),
  column(withUnit("da/dN", "rate"), (r) => r.tip.growth_rate),
];
const REASON = column("reason", (r) => r.tip.reason, "text long");
const STEP_COLUMNS = [
  column("step", (r) => r.step.step),
  column("cycles N", (r) => r.step.cycles),
  column("load factor", (r) => r.step.load_factor),
];

const tipRows = (step) => step.cracks.flatMap((crack) => crack.tips.map((tip) => ({ step, crack, tip })));

/** Columns in which any row has something to say. */
const used = (columns, rows) => columns.filter((c) => rows.some((r) => c.of(r) !== null && c.of(r) !== undefined));

function tipTable(step, histories) {
  const rows = tipRows(step);
  const columns = [...TIP_COLUMNS.slice(0, -1), ...used(GROWTH_COLUMNS, rows), TIP_COLUMNS.at(-1), ...used([REASON], rows)];
  fillTable(byId("tips"), columns, rows);
  if (!rows.length) byId("tips").replaceChildren(element("caption", {}, "There is no crack tip in this step."));
  [...byId("tips").querySelectorAll("tbody tr")].forEach((line, k) => {
    const { crack, tip } = rows[k];
    const color = histories.find((h) => h.name === `${crack.name} ${tip.end}`)?.color;
    const swatch = element("span", { class: "swatch" });
    swatch.style.background = color;
    line.cells[0].prepend(swatch);
  });
}

function reactionTable(step) {
  const rows = Object.entries(step.reactions);
  const component = (k) => (r) => r[1]?.[k] ?? null;
  fillTable(byId("reactions"), [column("reaction of", (r) => r[0], "text"), column(withUnit("x", "force"), component(0)), column(withUnit("y", "force"), component(1))], rows);
  byId("reactions").parentElement.hidden = rows.length === 0;
}

function historyTable(results, current) {
  const rows = results.steps.flatMap(tipRows);
  byId("all-steps").hidden = results.steps.length < 2 || rows.length === 0;
  const steps = STEP_COLUMNS.filter((c) => c.title !== "load factor" || rows.some((r) => r.step.load_factor !== 1));
  const columns = [...used(steps, rows), ...TIP_COLUMNS.slice(0, -1), ...used(GROWTH_COLUMNS, rows), TIP_COLUMNS.at(-1)];
  fillTable(byId("history"), columns, rows, (r) => r.step.step === current);
}

/** Marks the rows of a step without making the table anew. */
function markHistory(results, current) {
  const rows = results.steps.flatMap(tipRows);
  [...byId("history").querySelectorAll("tbody tr")].forEach((line, k) => line.classList.toggle("current", rows[k].step.step === current));
}

function stageTable(results) {
  const rows = Object.entries(results.stage_time_s).sort((a, b) => b[1] - a[1]);
  fillTable(byId("stages"), [column("stage", (r) => r[0], "text"), column("seconds", (r) => r[1]), column("", () => "", "bar")], rows);
  const longest = Math.max(...rows.map((r) => r[1]), 1e-9);
  [...byId("stages").querySelectorAll("td.bar")].forEach((cell, k) => {
    const bar = element("span");
    bar.style.width = `${(100 * rows[k][1]) / longest}%`;
    cell.append(bar);
  });
}

function settingsTable(source) {
  const rows = source?.settings ?? [];
  byId("settings").hidden = rows.length === 0;
  fillTable(byId("settings-table"), [column("key", (r) => r[0], "text"), column("value", (r) => r[1], "text")], rows);
}
