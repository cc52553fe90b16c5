// The curves of a study: which quantity, cases, models and levels are shown, and how.
import { chooser, each, make, number, patch, pretty, say, tick, words } from "/web/elements.js";
import { download, getJson, request } from "/web/session.js";
import { DASHES, chart, colours } from "/web/chart.js";
import { CASES_FIRST, caseName, whereOf } from "/web/sweep.js";

const CASES_MOST = 256; // drawn together, here and by the service, and listed
const CSV_CASES_MOST = 64; // that the service puts into one table
const DIFFERENT_MOST = 40; // cases offered for differences
const BANDS_MOST = 24; // lines; more bands hide each other
const LISTED_MOST = 12; // curves, in the table of values
const LACKS_MOST = 4; // cases whose failures are listed
const MOST_DASHED = 3; // settings that differ by the dash of their lines alone

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
  return { label, x: curve.x, y: curve.y, error, colour, dash, low: withBand && error ? shifted(-1) : null, high: withBand && error ? shifted(1) : null,
    totalLow: curve.total_low ?? null, totalHigh: curve.total_high ?? null, total: withBand, unknown: curve.unknown_errors ?? [] };
}

export function showCurves(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}`;
  const cases = new Map(contents.cases.map((one) => [one.case, one]));
  const kept = new Map(); // documents by path: their ETag and what they hold
  const first = contents.curves.find((curve) => !curve.matrix) ?? contents.curves[0];
  const state = { quantity: first?.quantity, series: first?.series[0], cases: new Set(contents.cases.slice(0, CASES_FIRST).map((one) => one.case)),
    models: new Set(first?.models ?? []), level: "finest", xLog: false, yLog: false, band: true, theory: true, difference: null };
  let shown = null, turn = 0, changed = true; // changed: something else was chosen than what is shown
  if (!first) {
    root.append(make("p", { role: "status" }, "There are no curves yet."));
    return null;
  }
  const controls = make("div", { class: "tools" }), figure = make("div"), message = make("p", { role: "status" });
  const legend = make("ul", { class: "legend" }), listed = make("table");
  const values = make("details", { hidden: true, ontoggle: () => drawValues(drawn) }, make("summary", {}, "Values as a table"), make("div", { class: "scroll" }, listed));
  let drawn = []; // lines
  root.append(controls, message, figure, legend, values);

  const about = () => contents.curves.find((curve) => curve.quantity === state.quantity);
  const query = () => `quantity=${encodeURIComponent(state.quantity)}${state.difference ? `&difference=${state.difference.join(",")}` : ""}`;
  /** The density that is shown: of the first case that is chosen, which may have some for summits and for pits. */
  const densityOf = () => `plot?${query()}&case=${[...state.cases][0] ?? 0}${state.series ? `&series=${encodeURIComponent(state.series)}` : ""}`;

  async function part(asked) {
    const before = kept.get(asked);
    const answer = await request(`${path}/curves?${asked}`, { signal, headers: before ? { "If-None-Match": before.tag } : {} });
    if (answer.status !== 304) kept.set(asked, { tag: answer.headers.get("ETag") ?? "", document: await answer.json() });
    return kept.get(asked).document;
  }

  async function fetched() {
    if (state.difference) return (await part(query())).cases;
    const documents = await Promise.all([...state.cases].map((one) => part(`case=${one}&${query()}`).catch((error) => {
      if (error.status !== 422) throw error;
      return { cases: [{ case: one, error: error.message }] }; // the others are shown beside its reason
    })));
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
      const loads = new Set(found.map((curve) => curve.pressure)).size > 1;
      found.forEach((curve, k) => {
        const load = loads ? `at p/(E* h′) = ${number(curve.pressure)}` : "";
        const more = [about().models.length > 1 ? curve.model : "", state.level === "all" && curve.level ? `${curve.level} points` : "", load].filter(Boolean).join(", ");
        lines.push(lineOf(curve, more ? `${label}; ${more}` : label, look[c].colour, DASHES[(look[c].dash + groups * k) % DASHES.length], state.band));
        if (!state.theory || state.difference) return;
        for (const [name, y] of Object.entries(curve.theory ?? {})) {
          const key = name + JSON.stringify(y), same = theories.get(key);
          if (same) same.cases.add(c);
          else theories.set(key, { cases: new Set([c]), line: { x: curve.x, y, colour: look[c].colour, dash: DASHES[1 + (Object.keys(curve.theory).indexOf(name) % 4)], theory: true }, name, label, load });
        }
      });
    });
    for (const { cases: of, line, name, label, load } of theories.values()) { // one line where cases share it
      const shared = results.length === 1 || of.size > 1;
      lines.push({ ...line, label: `${words(name)} (${["theory", shared ? "" : label, load].filter(Boolean).join(", ")})`, colour: shared ? "#7f7f7f" : line.colour });
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
    if (!values.open) return;
    const heads = make("tr", {}, ["curve", "x", "y", "standard error", "total low", "total high", "without"].map((name) => make("th", { scope: "col" }, name)));
    const rows = lines.filter((line) => !line.theory).slice(0, LISTED_MOST).flatMap((line) => line.x.map((x, i) => make("tr", {},
      make("td", {}, line.label), make("td", { class: "number" }, number(x, 6)), make("td", { class: "number" }, number(line.y[i], 6)), make("td", { class: "number" }, number(line.error?.[i], 2)),
      make("td", { class: "number" }, number(line.totalLow?.[i], 6)), make("td", { class: "number" }, number(line.totalHigh?.[i], 6)), make("td", {}, line.unknown.join(", ")))));
    patch(listed, make("table", {}, make("thead", {}, heads), make("tbody", {}, rows)));
  }

  function endChart() {
    shown?.destroy();
    shown = null;
  }

  async function drawMatrix(mine) {
    const one = [...state.cases][0] ?? 0;
    const svg = await (await request(`${path}/${densityOf()}`, { signal })).text();
    if (mine !== turn || signal.aborted) return;
    const picture = make("div", { class: "scroll", tabindex: "0", role: "figure", "aria-label": words(state.quantity) },
      make("img", { class: "picture", alt: `${words(state.quantity)} of case ${one}`, src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` }));
    endChart();
    if (figure.querySelector("img.picture")) patch(figure.firstChild, picture);
    else figure.replaceChildren(picture);
    legend.replaceChildren();
    values.hidden = true;
    message.textContent = state.cases.size > 1 ? `Of ${caseName(cases.get(one))}: a density is shown of one case.` : "";
    changed = false;
  }

  /** Draws what is chosen; quietly, where it was drawn before. */
  async function draw(quietly = false) {
    const mine = ++turn;
    if (!quietly) message.textContent = "Loading …";
    try {
      if (about().matrix) return await drawMatrix(mine);
      const results = await fetched();
      if (mine !== turn || signal.aborted) return;
      const lines = linesOf(results), banded = lines.filter((line) => line.low).length <= BANDS_MOST;
      if (!banded) for (const line of lines) Object.assign(line, { low: null, high: null, total: false });
      const curve = results.flatMap((one) => one.curves ?? []).find((one) => one.quantity === state.quantity);
      const view = changed ? null : shown?.view(); // zoom and place stay while results come in
      endChart();
      shown = chart(lines, { xLabel: pretty(curve?.x_label || "x"), yLabel: pretty(curve?.y_label || words(state.quantity)), xLog: state.xLog, yLog: state.yLog, whole: Boolean(state.difference) && !state.yLog, view });
      const held = figure.contains(document.activeElement);
      figure.replaceChildren(shown.element);
      if (held) shown.element.focus({ preventScroll: true });
      drawLegend(lines);
      drawn = lines;
      changed = false;
      values.hidden = false;
      drawValues(lines);
      const lacks = results.map(lackOf).filter(Boolean);
      const dashed = [...new Set(lines.filter((line) => line.total).flatMap((line) => line.unknown))];
      message.textContent = lacks.length > 0 ? lacks.slice(0, LACKS_MOST).join("; ") + (lacks.length > LACKS_MOST ? `; and ${lacks.length - LACKS_MOST} more` : "")
        : lines.length === 0 ? "Nothing is like what is chosen." : !state.band ? "" : banded ? `Bands are two standard errors wide to each side; in pale bands lies the truth, to 95 %${dashed.length > 0 ? `, but for what is not known where edges are dashed: ${dashed.join(", ")}` : ""}.` : `No bands of more than ${BANDS_MOST} lines.`;
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      message.textContent = error.message;
      if (!changed) return;
      endChart();
      figure.replaceChildren(); // what was shown before is not what is asked for
      legend.replaceChildren();
      values.hidden = true;
    }
  }

  function set(change) {
    Object.assign(state, change);
    changed = true;
    writeControls();
    draw();
  }

  /** Saves all cases, or of more than the service puts into one file, `most`, the first that is chosen: the name says which, and the message. */
  const save = (text, part, ending, most, accept) => make("button", { onclick: () => {
    const [first] = state.cases, one = !state.difference && contents.cases.length > most;
    if (one && first === undefined) {
      message.textContent = `${text} has ${most} cases at most: choose one of the ${contents.cases.length}.`;
      return;
    }
    if (one) message.textContent = `${text} has ${most} cases at most: of ${contents.cases.length}, that of ${caseName(cases.get(first))} is saved.`;
    download(`${path}/${part()}${one ? `&case=${first}` : ""}`, `${study.name}-${state.quantity}${one ? `-case-${first}` : ""}.${ending}`, accept).catch((error) => { message.textContent = error.message; });
  } }, text);
  const quantityOf = chooser("Quantity", (quantity) => {
    const next = contents.curves.find((curve) => curve.quantity === quantity);
    set({ quantity, series: next.series.includes(state.series) ? state.series : next.series[0], models: new Set(next.models), level: "finest", ...(next.matrix ? { difference: null } : {}) }); // densities have no differences
  });
  const seriesOf = chooser("by", (series) => set({ series })), meshOf = chooser("Mesh", (level) => set({ level })), modelsOf = make("span", { class: "models" });
  const differenceOf = [0, 1].map((place) => chooser(place === 0 ? "Difference:" : "less", (value) => {
    const both = state.difference?.slice() ?? ["", ""];
    both[place] = value;
    set({ difference: value === "" ? null : both.map((one, k) => (one === "" ? String(contents.cases.find((other) => String(other.case) !== both[1 - k]).case) : one)) });
  }));
  const like = () => contents.cases.filter(where.matches);
  const chosen = (all) => set({ cases: new Set(all.map((one) => one.case)), difference: null });
  const where = whereOf(contents.cases, () => chosen(like().slice(0, CASES_FIRST)));
  const count = make("summary"), grid = make("div", { class: "grid" }), more = make("p");
  const casesOf = make("details", { class: "cases", hidden: contents.cases.length < 2 }, count,
    make("div", { class: "tools" }, where.controls, make("button", { onclick: () => chosen(like().slice(0, CASES_MOST)) }, "all"), make("button", { onclick: () => chosen([]) }, "none")), grid, more);
  controls.append(quantityOf.element, seriesOf.element, meshOf.element, modelsOf,
    ...[["log x", "xLog"], ["log y", "yLog"], ["error bands", "band"], ["theory", "theory"]].map(([label, key]) => tick(label, state[key], (on) => set({ [key]: on }))),
    ...differenceOf.map((one) => one.element), casesOf,
    make("span", { class: "links" }, save("JSON", () => `curves?${query()}`, "json", Infinity), " ", save("CSV", () => `curves?${query()}`, "csv", CSV_CASES_MOST, "text/csv"), " ",
      save("SVG", () => (about().matrix ? densityOf() : `plot?${query()}`), "svg", CASES_MOST)));

  /** Shows in the controls what is chosen, and what can be. */
  function writeControls() {
    const one = about(), cases = like(), shownCases = cases.slice(0, CASES_MOST);
    quantityOf.set(contents.curves.map((curve) => [curve.quantity, words(curve.quantity)]), state.quantity);
    seriesOf.set(one.series.map((series) => [series, words(series)]), state.series);
    meshOf.set(one.levels.length > 1 ? [["finest", "finest"], ["all", "all"], ...one.levels.map((level) => [level, `${level} points`])] : [], state.level);
    each(modelsOf, one.models.length > 1 ? one.models : [], (model) => model, (model) => tick(model, state.models.has(model), (on) => {
      if (on) state.models.add(model);
      else state.models.delete(model);
      set({});
    }));
    const named = contents.cases.length > 1 && !one.matrix ? contents.cases.slice(0, DIFFERENT_MOST).map((other) => [other.case, caseName(other)]) : [];
    differenceOf[0].set(named.length > 0 ? [["", "no difference"], ...named] : [], state.difference?.[0]);
    differenceOf[1].set(state.difference ? named : [], state.difference?.[1]);
    say(count, `Cases: ${state.cases.size} of ${contents.cases.length}`);
    each(grid, shownCases, (of) => of.case, (of) => tick(caseName(of), state.cases.has(of.case), (on) => {
      if (on) state.cases.add(of.case);
      else state.cases.delete(of.case);
      set({ difference: null });
    }));
    say(more, cases.length > shownCases.length ? `The first ${CASES_MOST} of ${cases.length} cases: choose fewer by their parameters.` : "");
  }

  signal.addEventListener("abort", endChart);
  writeControls();
  draw();
  return () => draw(true);
}
