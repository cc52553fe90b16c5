// The curves of a study: which quantity, cases, models and levels are shown, and how.
import { choice, lastName, make, number, pretty, replace, symbol, tick, words } from "/web/elements.js";
import { download, getJson, request } from "/web/session.js";
import { DASHES, chart, colours } from "/web/chart.js";

const CASES_FIRST = 12; // shown before anything is chosen
const BANDS_MOST = 24; // lines; more bands hide each other
const LACKS_MOST = 4; // cases whose failures are listed
const MOST_DASHED = 3; // settings that differ by the dash of their lines alone

/** "H = 0.8, C = 1": what distinguishes a case from the others. */
export function caseName(one) {
  const parts = Object.entries(one.swept).map(([pointer, value]) => (typeof value === "string" ? words(value)
    : `${symbol(lastName(pointer))} = ${Array.isArray(value) ? `(${value.length})` : number(value)}`));
  return parts.length > 0 ? parts.join(", ") : `case ${one.case}`;
}

/**
 * How cases are distinguished, in their order: {colour, dash} each. Where they differ in a number, its values have colours in
 * their order, and the rest dashes; where that are more than MOST_DASHED settings, each case has a colour.
 */
function looks(all) {
  const valuesOf = (key) => new Set(all.map((one) => JSON.stringify(one.swept[key])));
  const varied = Object.keys(all[0]?.swept ?? {}).filter((key) => valuesOf(key).size > 1);
  const leading = varied.filter((key) => all.every((one) => typeof one.swept[key] === "number")).sort((a, b) => valuesOf(b).size - valuesOf(a).size)[0];
  const restOf = (one) => JSON.stringify(varied.filter((key) => key !== leading).map((key) => one.swept[key]));
  const rest = [...new Set(all.map(restOf))];
  if (leading === undefined || rest.length > MOST_DASHED) return colours(all.length, false).map((colour) => ({ colour, dash: 0 }));
  const values = [...new Set(all.map((one) => one.swept[leading]))].sort((a, b) => a - b), ofValue = colours(values.length, true);
  return all.map((one) => ({ colour: ofValue[values.indexOf(one.swept[leading])], dash: rest.indexOf(restOf(one)) }));
}

function lineOf(curve, label, colour, dash, withBand) {
  const error = curve.standard_error;
  const shifted = (sign) => curve.y.map((y, i) => (y === null || error?.[i] === null || error?.[i] === undefined ? null : y + sign * 2 * error[i]));
  return { label, x: curve.x, y: curve.y, error, colour, dash, low: withBand && error ? shifted(-1) : null, high: withBand && error ? shifted(1) : null };
}

export function showCurves(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}`;
  const cases = new Map(contents.cases.map((one) => [one.case, one]));
  const kept = new Map(); // documents by path: their ETag and what they hold
  const first = contents.curves.find((curve) => !curve.matrix) ?? contents.curves[0];
  const state = { quantity: first?.quantity, series: first?.series[0], cases: new Set(contents.cases.slice(0, CASES_FIRST).map((one) => one.case)),
    models: new Set(first?.models ?? []), level: "finest", xLog: false, yLog: false, band: true, theory: true, difference: null };
  let shown = null, turn = 0;
  if (!first) {
    root.append(make("p", { role: "status" }, "There are no curves yet."));
    return null;
  }
  const controls = make("div", { class: "tools" }), figure = make("div"), message = make("p", { role: "status" });
  const legend = make("ul", { class: "legend" }), values = make("div");
  root.append(controls, message, figure, legend, values);

  const about = () => contents.curves.find((curve) => curve.quantity === state.quantity);

  async function part(query) {
    const before = kept.get(query);
    const answer = await request(`${path}/curves?${query}`, { signal, headers: before ? { "If-None-Match": before.tag } : {} });
    if (answer.status !== 304) kept.set(query, { tag: answer.headers.get("ETag") ?? "", document: await answer.json() });
    return kept.get(query).document;
  }

  async function fetched() {
    const quantity = `quantity=${encodeURIComponent(state.quantity)}`;
    if (state.difference) return (await part(`difference=${state.difference.join(",")}&${quantity}`)).cases;
    const documents = await Promise.all([...state.cases].map((one) => part(`case=${one}&${quantity}`)));
    return documents.flatMap((document) => document.cases);
  }

  /** The lines of what is chosen; a dash also distinguishes models and levels. */
  function linesOf(results) {
    const look = looks(results.map((one) => cases.get(one.case) ?? { swept: {} }));
    const groups = 1 + Math.max(0, ...look.map((one) => one.dash));
    const lines = [], theories = new Map();
    results.forEach((one, c) => {
      const label = one.less !== undefined && one.less !== null ? `${caseName(cases.get(one.case))} less ${caseName(cases.get(one.less))}` : caseName(cases.get(one.case));
      let found = (one.curves ?? []).filter((curve) => curve.quantity === state.quantity && (curve.series || "") === (state.series || "") &&
        (!curve.model || state.models.has(curve.model)));
      const finest = (model) => Math.max(...found.filter((curve) => curve.model === model).map((curve) => curve.level ?? 0));
      if (state.level === "finest") found = found.filter((curve) => (curve.level ?? 0) === finest(curve.model));
      else if (state.level !== "all") found = found.filter((curve) => String(curve.level ?? "") === state.level);
      found.forEach((curve, k) => {
        const more = [about().models.length > 1 ? curve.model : "", state.level === "all" && curve.level ? `${curve.level} points` : ""].filter(Boolean).join(", ");
        lines.push(lineOf(curve, more ? `${label}; ${more}` : label, look[c].colour, DASHES[(look[c].dash + groups * k) % DASHES.length], state.band));
        if (!state.theory || state.difference) return;
        for (const [name, y] of Object.entries(curve.theory ?? {})) {
          const key = name + JSON.stringify(y), same = theories.get(key);
          if (same) same.cases.add(c);
          else theories.set(key, { cases: new Set([c]), line: { x: curve.x, y, colour: look[c].colour, dash: DASHES[1 + (Object.keys(curve.theory).indexOf(name) % 4)], theory: true }, name, label });
        }
      });
    });
    for (const { cases: of, line, name, label } of theories.values()) { // one line where cases share it
      const shared = results.length === 1 || of.size > 1;
      lines.push({ ...line, label: `${words(name)} (theory${shared ? "" : `, ${label}`})`, colour: shared ? "#7f7f7f" : line.colour });
    }
    return lines;
  }

  /** What a case lacks, and why: an error, no values at all, or notes of some realisations. */
  function lackOf(one) {
    const called = caseName(cases.get(one.case) ?? { case: one.case, swept: {} });
    if (one.error) return `${called}: ${one.error}`;
    if (!one.notes?.count) return null;
    const without = (one.curves ?? []).every((curve) => curve.y.every((y) => y === null)), [note] = one.notes.kept;
    return `${called}: ${without ? "no values" : `${one.notes.count} failures in ${one.realisations} realisations`}${note ? `; realisation ${note.realisation}: ${note.text}` : ""}`;
  }

  function drawLegend(lines) {
    const names = new Set();
    legend.replaceChildren(...lines.filter((line) => !names.has(line.label + line.colour) && names.add(line.label + line.colour)).map((line) => {
      const swatch = document.createElementNS("http://www.w3.org/2000/svg", "svg");
      const stroke = document.createElementNS("http://www.w3.org/2000/svg", "line");
      for (const [key, value] of Object.entries({ width: 30, height: 10, "aria-hidden": "true" })) swatch.setAttribute(key, value);
      for (const [key, value] of Object.entries({ x1: 0, x2: 30, y1: 5, y2: 5, stroke: line.colour, "stroke-width": line.theory ? 1 : 2.5, "stroke-dasharray": (line.dash ?? []).join(" ") }))
        stroke.setAttribute(key, value);
      swatch.append(stroke);
      return make("li", {}, swatch, " ", line.label);
    }));
  }

  function drawValues(lines) {
    const table = () => make("div", { class: "scroll" }, make("table", {}, make("thead", {}, make("tr", {}, ["curve", "x", "y", "standard error"].map((name) => make("th", { scope: "col" }, name)))),
      make("tbody", {}, lines.filter((line) => !line.theory).slice(0, 12).flatMap((line) => line.x.map((x, i) => make("tr", {},
        make("td", {}, line.label), make("td", { class: "number" }, number(x, 6)), make("td", { class: "number" }, number(line.y[i], 6)), make("td", { class: "number" }, number(line.error?.[i], 2))))))));
    const details = make("details", {}, make("summary", {}, "Values as a table"));
    details.addEventListener("toggle", () => { if (details.open && details.childElementCount === 1) details.append(table()); });
    values.replaceChildren(details);
  }

  async function drawMatrix() {
    const one = [...state.cases][0] ?? 0;
    const svg = await (await request(`${path}/plot?quantity=${encodeURIComponent(state.quantity)}&case=${one}`, { signal })).text();
    figure.replaceChildren(make("div", { class: "scroll", tabindex: "0", role: "figure", "aria-label": words(state.quantity) },
      make("img", { class: "picture", alt: `${words(state.quantity)} of case ${one}`, src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` })));
    legend.replaceChildren();
    values.replaceChildren();
    message.textContent = state.cases.size > 1 ? `Of ${caseName(cases.get(one))}: a density is shown of one case.` : "";
  }

  async function draw() {
    const mine = ++turn;
    message.textContent = "Loading …";
    try {
      if (about().matrix) return await drawMatrix();
      const results = await fetched();
      if (mine !== turn || signal.aborted) return;
      const lines = linesOf(results), banded = lines.filter((line) => line.low).length <= BANDS_MOST;
      if (!banded) for (const line of lines) line.low = line.high = null;
      const curve = results.flatMap((one) => one.curves ?? []).find((one) => one.quantity === state.quantity);
      shown?.destroy();
      shown = chart(lines, { xLabel: pretty(curve?.x_label || "x"), yLabel: pretty(curve?.y_label || words(state.quantity)), xLog: state.xLog, yLog: state.yLog });
      figure.replaceChildren(shown.element);
      drawLegend(lines);
      drawValues(lines);
      const lacks = results.map(lackOf).filter(Boolean);
      message.textContent = lacks.length > 0 ? lacks.slice(0, LACKS_MOST).join("; ") + (lacks.length > LACKS_MOST ? `; and ${lacks.length - LACKS_MOST} more` : "")
        : lines.length === 0 ? "Nothing is like what is chosen." : !state.band ? "" : banded ? "Bands are two standard errors wide to each side." : `No bands of more than ${BANDS_MOST} lines.`;
    } catch (error) {
      if (!signal.aborted && mine === turn) message.textContent = error.message;
    }
  }

  function set(change) {
    Object.assign(state, change);
    controlsOf();
    draw();
  }

  function pickCases() {
    const names = contents.cases.map((one) => tick(caseName(one), state.cases.has(one.case), (on) => {
      if (on) state.cases.add(one.case);
      else state.cases.delete(one.case);
      set({ difference: null });
    }));
    return make("details", { class: "cases", open: pickCases.open, ontoggle: (event) => { pickCases.open = event.target.open; } },
      make("summary", {}, `Cases: ${state.cases.size} of ${contents.cases.length}`),
      make("button", { onclick: () => set({ cases: new Set(contents.cases.map((one) => one.case)), difference: null }) }, "all"), " ",
      make("button", { onclick: () => set({ cases: new Set(), difference: null }) }, "none"),
      make("div", { class: "grid" }, names));
  }
  pickCases.open = false;

  function pickDifference() {
    const options = [["", "no difference"]];
    for (const a of contents.cases.slice(0, 40)) options.push([a.case, caseName(a)]);
    const [a, b] = state.difference ?? ["", ""];
    const choose = (place) => (value) => {
      const both = [a, b];
      both[place] = value;
      if (value === "") set({ difference: null });
      else set({ difference: both.map((one, k) => (one === "" ? String(contents.cases.find((other) => String(other.case) !== both[1 - k]).case) : one)) });
    };
    return [choice("Difference:", options, a, choose(0)), state.difference ? choice("less", options.slice(1), b, choose(1)) : null];
  }

  function controlsOf() {
    const one = about();
    replace(controls,
      choice("Quantity", contents.curves.map((curve) => [curve.quantity, words(curve.quantity)]), state.quantity, (quantity) => {
        const next = contents.curves.find((curve) => curve.quantity === quantity);
        set({ quantity, series: next.series.includes(state.series) ? state.series : next.series[0], models: new Set(next.models), level: "finest" });
      }),
      ...(one.series.length > 1 ? [choice("by", one.series, state.series, (series) => set({ series }))] : []),
      ...(one.levels.length > 1 ? [choice("Mesh", [["finest", "finest"], ["all", "all"], ...one.levels.map((level) => [level, `${level} points`])], state.level, (level) => set({ level }))] : []),
      ...(one.models.length > 1 ? one.models.map((model) => tick(model, state.models.has(model), (on) => {
        if (on) state.models.add(model);
        else state.models.delete(model);
        set({});
      })) : []),
      tick("log x", state.xLog, (xLog) => set({ xLog })), tick("log y", state.yLog, (yLog) => set({ yLog })),
      tick("error bands", state.band, (band) => set({ band })), tick("theory", state.theory, (theory) => set({ theory })),
      ...(contents.cases.length > 1 ? [...pickDifference().filter(Boolean), pickCases()] : []),
      make("span", { class: "links" },
        make("button", { onclick: () => download(`${path}/curves?quantity=${encodeURIComponent(state.quantity)}`, `${study.name}-${state.quantity}.json`) }, "JSON"), " ",
        make("button", { onclick: () => download(`${path}/curves?quantity=${encodeURIComponent(state.quantity)}${contents.cases.length > 64 ? `&case=${[...state.cases][0] ?? 0}` : ""}`, `${study.name}-${state.quantity}.csv`, "text/csv") }, "CSV"), " ",
        make("button", { onclick: () => download(`${path}/plot?quantity=${encodeURIComponent(state.quantity)}${contents.cases.length > 64 ? `&case=${[...state.cases][0] ?? 0}` : ""}`, `${study.name}-${state.quantity}.svg`) }, "SVG")));
  }

  signal.addEventListener("abort", () => shown?.destroy());
  controlsOf();
  draw();
  return draw;
}
