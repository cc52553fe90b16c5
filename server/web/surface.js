// A measured surface: a file that is dropped or chosen is sent, and shown as the page for print and as a table.
import { choice, make, measured, number, tick, words } from "/web/elements.js";
import { beginFrom } from "/web/new.js";
import { request } from "/web/session.js";

const LINES = ["none", "mean", "median", "linear", "quadratic"];
const DETRENDS = ["auto", "none", "mean", "plane", "quadratic"];
const BOUNDARIES = ["auto", "open", "periodic"];
const COLUMNS = ["auto", "xz", "xyz", "map"];
const LARGE = 2 ** 23; // bytes: a server that refuses so much may hang up before its answer is read
const kept = { file: null, options: { detrend: "auto", boundary: "auto" } }; // while the tab is open

const ENTITIES = { "&lt;": "<", "&gt;": ">", "&quot;": '"', "&amp;": "&" };

/** What the page holds for programs: the characterisation. A parser of XML would apply the page's styles, which this policy refuses. */
function numbersOf(svg) {
  return JSON.parse(svg.match(/<metadata>([^<]*)<\/metadata>/)[1].replace(/&(?:lt|gt|quot|amp);/g, (one) => ENTITIES[one]));
}

function save(content, type, name) {
  const link = make("a", { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** A value with what is known of its error. */
function shown(group, name) {
  const value = group[name], low = group[`${name}_low`], high = group[`${name}_high`];
  if (typeof value !== "number") return value ?? "–";
  if (typeof low === "number" && typeof high === "number") return `${number(value)} [${number(low, 3)}, ${number(high, 3)}]`;
  return measured(value, group[`${name}_error`]);
}

function isError(group, name) {
  return /_(error|low|high)$/.test(name) && name.replace(/_(error|low|high)$/, "") in group;
}

/** Groups of single values; columns are in the picture and in the file of numbers. */
function tableOf(found) {
  const groups = Object.entries(found).filter(([, group]) => Object.values(group).some((value) => !Array.isArray(value)));
  return make("div", { class: "groups" }, groups.map(([title, group]) => make("table", {}, make("caption", {}, words(title)),
    make("tbody", {}, Object.keys(group).filter((name) => !Array.isArray(group[name]) && !isError(group, name)).map((name) =>
      make("tr", {}, make("th", { scope: "row" }, /^S[a-z]{1,2}$/.test(name) ? name : words(name)), make("td", { class: "number" }, String(shown(group, name)))))))));
}

export function showSurface(root, signal) {
  document.title = "Measured surface – Rugo";
  const message = make("p", { role: "status" }), fault = make("p", { role: "alert" }), place = make("div");
  let turn = 0;

  async function look() {
    if (!kept.file) return;
    const mine = ++turn, { file } = kept;
    message.textContent = `Looking at ${file.name} …`;
    fault.textContent = "";
    try {
      const svg = await (await send(file, "svg")).text();
      if (mine === turn) show(file, svg);
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      place.replaceChildren();
      tell(error, file);
    }
  }

  function send(file, format, more = {}) {
    const query = new URLSearchParams({ name: file.name, format, ...more });
    for (const [name, value] of Object.entries(kept.options)) if (value && value !== "auto") query.set(name, value);
    return request(`/v1/characterise?${query}`, { method: "POST", body: file, signal, headers: { "Content-Type": "application/octet-stream" } });
  }

  function tell(error, file) {
    message.textContent = "";
    const cut = error.status === undefined && file.size > LARGE ? " It may take no file as large as this one." : "";
    fault.textContent = [error.message + cut, ...(error.faults ?? []).map((one) => `${one.pointer}: ${one.detail}`)].join("; ");
  }

  /** The new-study form, filled with surfaces like this one, or with surfaces that hold it and go on. */
  async function begin(file, more = {}) {
    message.textContent = "Fitting …";
    fault.textContent = "";
    try {
      beginFrom(await (await send(file, "study", more)).json());
    } catch (error) {
      if (!signal.aborted) tell(error, file);
    }
  }

  function show(file, svg) {
    const found = numbersOf(svg), base = file.name.replace(/\.[^.]*$/, "");
    message.textContent = "";
    place.replaceChildren(make("div", { class: "tools" },
      make("button", { onclick: () => save(svg, "image/svg+xml", `${base}.svg`) }, "Save the page (SVG)"),
      make("button", { onclick: () => save(JSON.stringify(found, null, 1), "application/json", `${base}.json`) }, "Save the numbers (JSON)"),
      make("button", { onclick: () => begin(file) }, "Make a study of surfaces like this"),
      make("button", { onclick: () => begin(file, { hold: "true" }) }, "Make a study of surfaces that hold this")),
      make("div", { class: "scroll sheet", tabindex: "0", role: "figure", "aria-label": `page about ${file.name}` },
        make("img", { class: "picture", alt: `map, heights, spectrum and scales of ${file.name}, with the main parameters`, src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` })),
      make("details", {}, make("summary", {}, "All values"), found.map?.unit === "m" ? make("p", {}, "Lengths are in metres.") : "", tableOf(found)));
  }

  function take(files) {
    if (files.length === 0) return;
    [kept.file] = files;
    drop.querySelector("b").textContent = kept.file.name;
    look();
  }
  const set = (name) => (value) => { kept.options[name] = value.trim(); look(); };
  const text = (label, name, hint) => make("label", { class: "choice" }, `${label} `,
    make("input", { value: kept.options[name] ?? "", placeholder: hint, size: 12, onchange: (event) => set(name)(event.target.value) }));

  const over = (event) => { event.preventDefault(); drop.classList.add("over"); };
  const drop = make("label", { class: "drop", ondragenter: over, ondragover: over, ondragleave: () => drop.classList.remove("over"),
    ondrop: (event) => { event.preventDefault(); drop.classList.remove("over"); take(event.dataTransfer.files); } },
    make("b", {}, kept.file?.name ?? "Drop a file here, or choose one"),
    make("small", {}, "X3P, SDF, GWY, NumPy, or heights as text; nothing of it is kept"),
    make("input", { type: "file", "aria-label": "File of a measured surface", onchange: (event) => take(event.target.files) }));
  root.append(make("h1", {}, "Measured surface"), drop,
    make("div", { class: "tools" }, choice("Trend", DETRENDS, kept.options.detrend, set("detrend")), choice("Boundary", BOUNDARIES, kept.options.boundary, set("boundary")),
      text("Layer", "layer", "the first"), choice("Columns", COLUMNS, kept.options.columns, set("columns")), text("Spacing", "dx", "0.5um"), text("Unit of x and y", "unit", "um"), text("Unit of heights", "z_unit", "nm"), text("Part", "crop", "x,y,width,height"),
      choice("Scan lines", LINES, kept.options.lines, set("lines")), text("Spikes, deviations", "despike", "8"), text("Tip", "deconvolve", "tip=10nm"), text("Turn, degrees", "rotate", "30"), tick("exchange x and y", kept.options.transpose === "true", (on) => set("transpose")(on ? "true" : "")),
      text("Filters", "filter", "S=2um,L=50um"), text("Trust wavelengths from", "trust_from", "50um"), text("Trust them to", "trust_to", "2um"), tick("fill holes", kept.options.fill === "true", (on) => set("fill")(on ? "true" : ""))),
    message, fault, place);
  look();
}
