// Numbers and elements: `number`, `short`, `element`, `byId`, `readJson`, `withUnit`.

/** Six significant digits; a dash for what is not known. */
function number(value, digits = 6) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-4 && size < 1e6) return String(Number(value.toPrecision(digits)));
  return value.toExponential(digits - 1).replace(/\.?0+e/, "e").replace("e+", "e");
}

/** Three significant digits, for scales. */
const short = (value) => number(value, 3);

const byId = (id) => document.getElementById(id);

/** An element; text goes in as text, so that no title of a case is ever markup. */
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== null && value !== false) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((c) => c !== null && c !== undefined));
  return made;
}

/** A color of the style sheet. */
const themeColor = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();

const readJson = (id) => JSON.parse(byId(id).textContent);

/** Units of the case by what they measure; none where the case does not say them. */
const UNITS = ((names) => names && {
  ...names,
  factor: `${names.stress}√${names.length}`,
  "force per length": `${names.force}/${names.length}`,
  energy: `${names.force}·${names.length}`,
  rate: `${names.length}/cycle`,
})(readJson("units"));

/** A title with its unit in brackets. */
const withUnit = (title, kind) => (UNITS && kind ? `${title} [${UNITS[kind]}]` : title);
