// One realisation: its heights, and the gap and pressures at a load, computed when asked for and coloured here.
import { choice, make, number } from "/web/elements.js";
import { latest, reasonOf, requestWhenFree } from "/web/session.js";
import { caseName } from "/web/sweep.js";
import { chart } from "/web/chart.js";

// Stops of the colour map inferno, dark to light, as in server/show/map/map_png.c.
const STOPS = [[0, 0, 4], [40, 11, 84], [101, 21, 110], [159, 42, 99], [212, 72, 66], [245, 125, 21], [250, 193, 39], [252, 255, 164]];
const SIDE = 512; // pixels of a map
const UNITS = { pressure: " in E* h′" }; // heights and gaps are in units of the study
const labelOf = (field) => `${field}${UNITS[field] ?? ""}`;
const BLANK = { gap: "white where there is contact", pressure: "white where there is no contact" };

/** Reads a little-endian npy of doubles (NumPy's format 1): {shape, values}. */
export function readNpy(buffer) {
  const view = new DataView(buffer);
  if (view.getUint32(0) !== 0x934e554d) throw new Error("The server sent no npy file.");
  const length = view.getUint16(8, true), header = new TextDecoder().decode(new Uint8Array(buffer, 10, length));
  const shape = header.match(/'shape': \(([^)]*)\)/)[1].split(",").filter((part) => part.trim()).map(Number);
  if (!header.includes("<f8")) throw new Error("The server sent no doubles.");
  return { shape, values: new Float64Array(buffer.slice(10 + length)) };
}

function colour(share) {
  const place = Math.max(0, Math.min(1, share)) * (STOPS.length - 1), below = Math.min(Math.floor(place), STOPS.length - 2), part = place - below;
  return STOPS[below].map((a, k) => a + part * (STOPS[below + 1][k] - a));
}

/** Draws a map of rows x columns, y upwards as in all pictures: row 0 is the lowest. Of gaps and pressures what is not above 0 is left out, and white, and the scale begins at the least of the rest. */
function mapOf({ shape, values }, field) {
  const [rows, columns] = shape, isBlank = (value) => field !== "height" && !(value > 0);
  let low = Infinity, high = -Infinity;
  for (const value of values) {
    if (isBlank(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  const about = labelOf(field), ends = [low, high].map((value) => number(isFinite(value) ? value : null));
  const canvas = make("canvas", { width: columns, height: rows, class: "map", role: "img", "aria-label": `${about}, ${rows} by ${columns} points, from ${ends[0]} to ${ends[1]}` });
  const context = canvas.getContext("2d"), image = context.createImageData(columns, rows);
  for (let j = 0; j < rows; j++)
    for (let i = 0; i < columns; i++) {
      const value = values[j * columns + i];
      if (!isBlank(value)) image.data.set([...colour(high > low ? (value - low) / (high - low) : 0), 255], 4 * ((rows - 1 - j) * columns + i));
    }
  context.putImageData(image, 0, 0);
  canvas.style.width = `${SIDE * Math.min(1, columns / rows)}px`;
  const scale = make("canvas", { width: 256, height: 1, class: "scale", "aria-hidden": "true" });
  const line = scale.getContext("2d").createImageData(256, 1);
  for (let i = 0; i < 256; i++) line.data.set([...colour(i / 255), 255], 4 * i);
  scale.getContext("2d").putImageData(line, 0, 0);
  return make("figure", {}, canvas, make("figcaption", { class: "tools" }, make("span", {}, about), make("span", { class: "ends" }, make("span", {}, ends[0]), scale, make("span", {}, ends[1])), BLANK[field] ? make("span", {}, BLANK[field]) : null));
}

export function showRealisation(root, signal, study, contents) {
  const state = { case: contents.cases[0]?.case ?? 0, realisation: 0, field: "height", load: "0.1" };
  const message = make("p", { role: "status" }), place = make("div");
  const fields = study.kind === "contact" ? ["height", "gap", "pressure"] : ["height"];
  const signalOf = latest(signal);
  let shown = null, turn = 0;

  async function draw() {
    const mine = ++turn;
    message.textContent = "Computing …";
    const load = state.field === "height" ? "" : `&load=${encodeURIComponent(state.load)}`;
    try {
      const answer = await requestWhenFree(`/v1/studies/${encodeURIComponent(study.id)}/cases/${state.case}/realisations/${state.realisation}/map?field=${state.field}${load}`,
        { signal: signalOf(), headers: { Accept: "application/octet-stream" } });
      const map = readNpy(await answer.arrayBuffer());
      if (mine !== turn) return;
      shown?.destroy();
      shown = null;
      if (map.shape.length === 1 || map.shape[0] === 1) {
        const y = Array.from(map.values);
        shown = chart([{ label: state.field, x: y.map((_, i) => i), y, colour: "#0072b2" }], { xLabel: "point", yLabel: labelOf(state.field) });
        place.replaceChildren(shown.element);
      } else place.replaceChildren(mapOf(map, state.field));
      const touching = state.field === "pressure" ? map.values.reduce((sum, p) => sum + (p > 0), 0) / map.values.length : null;
      message.textContent = touching === null ? "" : `${(100 * touching).toPrecision(3)} % of the points are in contact.`;
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      shown?.destroy();
      shown = null;
      place.replaceChildren(); // what was shown before is not what is asked for
      message.textContent = reasonOf(error);
    }
  }

  const set = (key) => (value) => { state[key] = value; load.hidden = state.field === "height"; draw(); };
  const load = make("label", { hidden: true }, "Load p/(E* h′) ", make("input", { type: "number", min: 0, step: "any", value: state.load, onchange: (event) => set("load")(event.target.value) }));
  root.append(make("div", { class: "tools" },
    contents.cases.length > 1 ? choice("Case", contents.cases.map((one) => [one.case, caseName(one)]), state.case, set("case")) : null,
    make("label", {}, "Realisation ", make("input", { type: "number", min: 0, value: 0, onchange: (event) => set("realisation")(event.target.value) })),
    fields.length > 1 ? choice("Field", fields, state.field, set("field")) : null, load), message, place);
  signal.addEventListener("abort", () => shown?.destroy());
  draw();
  return () => {}; // it depends on no results
}
