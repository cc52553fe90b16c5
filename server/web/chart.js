// Curves drawn by uPlot: bands of error, theory, logarithmic axes, the nearest value in words.
import uPlot from "/web/uplot.js";
import { make, measured, number } from "/web/elements.js";

// Viridis as far as it stands out from the page's ground, by a contrast of 3 at least, for values in an order; Okabe and Ito's colours for the rest. Both are safe for the colour-blind.
const ORDERED = [[68, 1, 84], [70, 50, 127], [54, 92, 141], [39, 127, 142], [31, 161, 135]];
const ORDERED_ON_DARK = [...ORDERED.slice(3), [74, 194, 109], [159, 218, 58], [253, 231, 37]];
const APART = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7f7f7f"];
export const DASHES = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 2, 2, 2, 2, 2]];
const HEIGHT = 420, REACH = 40; // pixels

/** A colour for each of count lines. */
export function colours(count, ordered) {
  if (!ordered && count <= APART.length) return APART.slice(0, count);
  const stops = matchMedia("(prefers-color-scheme: dark)").matches ? ORDERED_ON_DARK : ORDERED;
  return Array.from({ length: count }, (_, i) => {
    const place = count > 1 ? (i / (count - 1)) * (stops.length - 1) : 0;
    const below = Math.min(Math.floor(place), stops.length - 2), part = place - below;
    return `rgb(${stops[below].map((a, k) => Math.round(a + part * (stops[below + 1][k] - a))).join(",")})`;
  });
}

function faint(colour, part) {
  const parts = colour.startsWith("#") ? [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)) : colour.match(/\d+/g);
  return `rgba(${parts.slice(0, 3).join(",")},${part})`;
}

function drawn(values, log) {
  return values.map((value) => (value === null || (log && value <= 0) ? null : value));
}

/** The range of what is drawn, with room; a logarithmic axis ends at whole decades only where it spans some. */
function range(low, high, log) {
  if (low === null || low === undefined || !isFinite(low)) return log ? [0.1, 1] : [0, 1];
  if (low === high) return log ? [low / 2, high * 2] : [low - Math.abs(low) * 0.1 - 1e-12, high + Math.abs(high) * 0.1 + 1e-12];
  if (log) return [low / 1.15, high * 1.15];
  const room = 0.04 * (high - low);
  return [low >= 0 && low < 0.2 * high ? 0 : low - room, high + room];
}

/** How far the y axis follows total intervals, which go on beyond it: by half of what values and inner bands span, and below zero only where these lie there. */
function reach(lines, log) {
  const values = lines.flatMap((line) => [...line.y, ...(line.low ?? []), ...(line.high ?? [])]).filter((y) => y !== null && (!log || y > 0));
  const low = values.reduce((a, b) => Math.min(a, b), Infinity), high = values.reduce((a, b) => Math.max(a, b), -Infinity), half = (high - low) / 2;
  if (!(low < high)) return [log ? 1e-300 : -Infinity, Infinity];
  return log ? [low * Math.sqrt(low / high), high * Math.sqrt(high / low)] : [low >= 0 ? Math.max(0, low - half) : low - half, high + half];
}

/** Where the truth lies by all known errors, in words; "" where nothing is known. */
function truth(line, i) {
  const [low, high] = [line.totalLow?.[i], line.totalHigh?.[i]];
  if (low === null || low === undefined) return "";
  return `; the truth is between ${number(low)} and ${number(high)}, to 95 %${line.unknown?.length > 0 ? `, but for ${line.unknown.join(", ")}` : ""}`;
}

/**
 * Draws lines {label, x, y, low, high, totalLow, totalHigh, total, unknown, error, colour, dash, theory}: low and high (or null) bound a band, and with
 * total totalLow and totalHigh a paler one, with dashed edges where some sources of error are unknown.
 * options: {xLabel, yLabel, xLog, yLog, whole, view}; whole: the y axis goes as far as total intervals do; view: what view() gave of an earlier chart of
 * like lines. Returns {element, plot, view, destroy}; view(): where it is zoomed to and what was read last.
 */
export function chart(lines, options) {
  const text = getComputedStyle(document.body).getPropertyValue("--text").trim();
  const grid = { stroke: getComputedStyle(document.body).getPropertyValue("--line").trim(), width: 1 };
  const [least, most] = options.whole ? [-Infinity, Infinity] : reach(lines, options.yLog);
  const tables = lines.map((line) => {
    const kept = line.x.map((x, i) => i).filter((i) => line.x[i] !== null && (!options.xLog || line.x[i] > 0)).sort((a, b) => line.x[a] - line.x[b]);
    const pick = (values) => (values ? drawn(kept.map((i) => values[i]), options.yLog) : kept.map(() => null));
    const total = (values) => pick(line.total && values ? (options.yLog ? values.map((value) => (value === null ? null : Math.max(least, value))) : values) : null);
    return [kept.map((i) => line.x[i]), pick(line.y), pick(line.low), pick(line.high), total(line.totalLow), total(line.totalHigh)];
  });
  const series = [{ label: options.xLabel }], bands = [];
  lines.forEach((line, i) => {
    const at = 1 + 5 * i;
    series.push({ label: line.label, stroke: line.colour, dash: line.dash ?? [], width: line.theory ? 1 : 2, spanGaps: true,
      points: { show: !line.theory && line.x.length <= 60, size: 5 } });
    for (const edge of ["low", "high"])
      series.push({ label: `${line.label}, ${edge}`, stroke: "transparent", width: 0, spanGaps: true, points: { show: false } });
    const dashed = line.total && line.unknown?.length > 0;
    for (const edge of ["total low", "total high"])
      series.push({ label: `${line.label}, ${edge}`, stroke: dashed ? faint(line.colour, 0.6) : "transparent", width: dashed ? 0.7 : 0, dash: [4, 3], spanGaps: true, points: { show: false } });
    if (line.total && line.totalLow) bands.push({ series: [at + 4, at + 3], fill: faint(line.colour, 0.09) });
    if (line.low) bands.push({ series: [at + 2, at + 1], fill: faint(line.colour, 0.2) });
  });
  const axis = (label, size) => ({ label, stroke: text, grid, ticks: grid, font: "13px system-ui, sans-serif", labelFont: "14px system-ui, sans-serif", labelSize: 28, size });
  const place = make("div", { class: "plot" });
  const readout = make("output", { class: "readout", "aria-live": "polite" }, "Point at a curve for its values, or walk along it by the arrow keys.");
  const element = make("div", { class: "chart", tabindex: "0", role: "figure",
    "aria-label": `${options.yLabel} over ${options.xLabel}, ${lines.length} curves; arrow keys walk along them` }, place, readout);

  let read = null, zoomed = false; // the line and point in the readout

  function tell(line, i) {
    read = { line: lines.indexOf(line), i };
    const [x, y] = [line.x[i], line.y[i]];
    readout.textContent = `${line.label}: ${options.xLabel} = ${number(x)}, ${options.yLabel} = ${measured(y, line.error?.[i])}${truth(line, i)}`;
  }
  function nearest(plot) {
    const { left, top } = plot.cursor;
    let best = null;
    if (left >= 0)
      lines.forEach((line) => line.x.forEach((x, i) => {
        if (line.y[i] === null || x === null || (options.xLog && x <= 0) || (options.yLog && line.y[i] <= 0)) return;
        const far = Math.hypot(plot.valToPos(x, "x") - left, plot.valToPos(line.y[i], "y") - top);
        if (far < (best?.far ?? REACH)) best = { far, line, i };
      }));
    if (best) tell(best.line, best.i);
  }
  const scale = (log, least = -Infinity, most = Infinity) => ({ distr: log ? 3 : 1,
    range: (plot, low, high) => range(low === null || low === undefined ? low : Math.max(low, least), Math.min(high, most), log) });
  const plot = new uPlot({
    width: 600, height: HEIGHT, series, bands,
    scales: { x: { ...scale(options.xLog), time: false }, y: scale(options.yLog, least, most) },
    axes: [axis(options.xLabel, 34), axis(options.yLabel, 64)],
    legend: { show: false },
    cursor: { points: { show: false }, drag: { x: true, y: true, uni: 20 } },
    hooks: { setCursor: [nearest], setSelect: [({ select }) => { zoomed ||= select.width > 0 || select.height > 0; }] },
  }, uPlot.join(tables.length ? tables : [[[], []]]), place);

  place.addEventListener("dblclick", () => { zoomed = false; });
  const walk = { line: 0, i: -1 };
  const view = () => ({ zoom: zoomed ? ["x", "y"].map((key) => [key, { min: plot.scales[key].min, max: plot.scales[key].max }]) : null, walk: { ...walk }, read });
  const before = options.view, isThere = (at) => at && lines[at.line] && at.i >= 0 && at.i < lines[at.line].x.length;
  if (before?.zoom) {
    zoomed = true;
    for (const [key, limits] of before.zoom) plot.setScale(key, limits);
  }
  if (isThere(before?.walk)) Object.assign(walk, before.walk);
  if (isThere(before?.read)) tell(lines[before.read.line], before.read.i);
  element.addEventListener("keydown", (event) => {
    const step = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0] }[event.key];
    if (!step || lines.length === 0 || event.altKey || event.ctrlKey || event.metaKey) return; // such keys are the browser's
    event.preventDefault();
    walk.line = (walk.line + step[0] + lines.length) % lines.length;
    const line = lines[walk.line];
    walk.i = Math.max(0, Math.min(line.x.length - 1, walk.i + step[1]));
    plot.setCursor({ left: plot.valToPos(line.x[walk.i], "x"), top: plot.valToPos(line.y[walk.i], "y") });
    tell(line, walk.i);
  });
  const watch = new ResizeObserver(() => {
    const width = Math.floor(place.clientWidth);
    if (width > 0 && width !== plot.width) plot.setSize({ width, height: HEIGHT });
  });
  watch.observe(place);
  return { element, plot, view, destroy: () => { watch.disconnect(); plot.destroy(); } };
}
