// Numbers and small tables as people read them.

// Three digits, and no more zeros than needed.
export function digits(value, count = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return "–";
  }
  if (value === 0) {
    return "0";
  }
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3
    ? value.toExponential(count - 1)
    : String(Number(value.toPrecision(count)));
}

// With its unit; what is small in units that have a thousandth is told in those.
export function measured(value, unit, count = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return "–";
  }
  const small = value !== 0 && Math.abs(value) < 0.1 && /^(N s|J|m|s)$/.test(unit);
  return small
    ? `${digits(1e3 * value, count)} m${unit}`
    : `${digits(value, count)} ${unit}`.trim();
}

// The last word of a parameter's path, with its group where others are called like it.
export function shortName(path, parameters) {
  const words = path.split(".");
  const last = `.${words.at(-1)}`;
  const alike = parameters.filter((row) => row.path.endsWith(last)).length > 1;
  return words
    .slice(alike ? -2 : -1)
    .join(" ")
    .replaceAll("_", " ");
}

// An element with attributes and content.
export function element(name, attributes = {}, ...content) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in made && key !== "list") {
      made[key] = value;
    } else {
      made.setAttribute(key, value);
    }
  }
  made.append(...content);
  return made;
}

// Fills a table: a row of headings, then rows of cells, each a text or an element.
export function fillTable(table, headings, rows) {
  const head = element("tr", {}, ...headings.map((text) => element("th", { scope: "col" }, text)));
  const body = rows.map((cells) =>
    element("tr", {}, ...cells.map((cell) => element("td", {}, cell))),
  );
  table.replaceChildren(element("thead", {}, head), element("tbody", {}, ...body));
}

// A colour of the style by its name.
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// A line in the colour of a run: 0 is this one, then the reference and those that are kept.
export function runMark(run) {
  return element("span", { style: `color: var(--run${run})` }, "━ ");
}
