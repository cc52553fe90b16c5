// A measured surface: the files that are dropped or chosen are sent, and shown as the page for print and as a table; several are maps of one surface.
import { choice, make, measured, number, tick, words } from "/web/elements.js";
import { beginFrom } from "/web/new.js";
import { latest, requestWhenFree } from "/web/session.js";

const LINES = ["none", "mean", "median", "linear", "quadratic"];
const DETRENDS = ["auto", "none", "mean", "plane", "quadratic"];
const BOUNDARIES = ["auto", "open", "periodic"];
const COLUMNS = ["auto", "xz", "xyz", "map"];
const LARGE = 2 ** 23; // bytes: a server that refuses so much may hang up before its answer is read
const kept = { files: [], options: { detrend: "auto", boundary: "auto" } }; // while the tab is open

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

/** "a.x3p", "a.x3p and b.sdf", "a.x3p and 2 more". */
function named(files) {
  const [first, second] = files;
  if (files.length < 2) return first.name;
  return files.length === 2 ? `${first.name} and ${second.name}` : `${first.name} and ${files.length - 1} more`;
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
  const signalOf = latest(signal);
  let turn = 0;

  async function look() {
    if (kept.files.length === 0) return;
    const mine = ++turn, { files } = kept;
    message.textContent = `Looking at ${named(files)} …`;
    fault.textContent = "";
    try {
      const svg = await (await send(files, "svg", signalOf())).text();
      if (mine === turn) show(files, svg);
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      place.replaceChildren();
      tell(error, files);
    }
  }

  /** One file is sent as it is, several as a form: maps of one surface. */
  function send(files, format, until, more = {}) {
    const [first] = files, several = files.length > 1;
    const query = new URLSearchParams({ ...(several ? { together: "true" } : { name: first.name }), format, ...more });
    for (const [name, value] of Object.entries(kept.options)) if (value && value !== "auto") query.set(name, value);
    const form = new FormData();
    for (const file of several ? files : []) form.append("map", file);
    return requestWhenFree(`/v1/characterise?${query}`, { method: "POST", signal: until, ...(several ? { body: form } : { body: first, headers: { "Content-Type": "application/octet-stream" } }) });
  }

  function tell(error, files) {
    message.textContent = "";
    const cut = error.status === undefined && files.reduce((size, file) => size + file.size, 0) > LARGE ? " It may take no files as large as these." : "";
    fault.textContent = [error.message + cut, ...(error.faults ?? []).map((one) => `${one.pointer}: ${one.detail}`)].join("; ");
  }

  /** The new-study form, filled with surfaces like this one, or with surfaces that hold it and go on. */
  async function begin(files, more = {}) {
    message.textContent = "Fitting …";
    fault.textContent = "";
    try {
      beginFrom(await (await send(files, "study", signal, more)).json());
    } catch (error) {
      if (!signal.aborted) tell(error, files);
    }
  }

  function show(files, svg) {
    const found = numbersOf(svg), [file] = files, one = files.length === 1;
    const base = file.name.replace(/\.[^.]*$/, "") + (one ? "" : "-together");
    message.textContent = "";
    place.replaceChildren(make("div", { class: "tools" },
      make("button", { onclick: () => save(svg, "image/svg+xml", `${base}.svg`) }, "Save the page (SVG)"),
      make("button", { onclick: () => save(JSON.stringify(found, null, 1), "application/json", `${base}.json`) }, "Save the numbers (JSON)"),
      make("button", { onclick: () => begin(files) }, `Make a study of surfaces like ${one ? "this" : "these"}`),
      one ? make("button", { onclick: () => begin(files, { hold: "true" }) }, "Make a study of surfaces that hold this") : ""),
      make("div", { class: "scroll sheet", tabindex: "0", role: "figure", "aria-label": `page about ${named(files)}` },
        make("img", { class: "picture", alt: one ? `map, heights, spectrum and scales of ${file.name}, with the main parameters` : `spectra of ${named(files)}, and the law that fits them together`, src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` })),
      make("details", {}, make("summary", {}, "All values"), (found.map ?? found.together)?.unit === "m" ? make("p", {}, "Lengths are in metres.") : "", tableOf(found)));
  }

  function take(files) {
    if (files.length === 0) return;
    kept.files = [...files];
    drop.querySelector("b").textContent = named(kept.files);
    look();
  }
  const set = (name) => (value) => { kept.options[name] = value.trim(); look(); };
  const text = (label, name, hint) => make("label", { class: "choice" }, `${label} `,
    make("input", { value: kept.options[name] ?? "", placeholder: hint, size: 12, onchange: (event) => set(name)(event.target.value) }));

  const over = (event) => { event.preventDefault(); drop.classList.add("over"); };
  const drop = make("label", { class: "drop", ondragenter: over, ondragover: over, ondragleave: () => drop.classList.remove("over"),
    ondrop: (event) => { event.preventDefault(); drop.classList.remove("over"); take(event.dataTransfer.files); } },
    make("b", {}, kept.files.length > 0 ? named(kept.files) : "Drop a file here, or choose one"),
    make("small", {}, "X3P, SDF, GWY, NumPy, or heights as text; several at once are maps of one surface; nothing of it is kept"),
    make("input", { type: "file", multiple: true, "aria-label": "Files of a measured surface", onchange: (event) => take(event.target.files) }));
  root.append(make("h1", {}, "Measured surface"), drop,
    make("div", { class: "tools" }, choice("Trend", DETRENDS, kept.options.detrend, set("detrend")), choice("Boundary", BOUNDARIES, kept.options.boundary, set("boundary")),
      text("Layer", "layer", "the first"), choice("Columns", COLUMNS, kept.options.columns, set("columns")), text("Spacing", "dx", "0.5um"), text("Unit of x and y", "unit", "um"), text("Unit of heights", "z_unit", "nm"), text("Heights of missing points", "missing", "-9999"), text("Part", "crop", "x,y,width,height"),
      choice("Scan lines", LINES, kept.options.lines, set("lines")), text("Spikes, deviations", "despike", "8"), text("Tip", "deconvolve", "tip=10nm"), text("Turn, degrees", "rotate", "30"), tick("exchange x and y", kept.options.transpose === "true", (on) => set("transpose")(on ? "true" : "")),
      text("Filters", "filter", "S=2um,L=50um"), text("Trust wavelengths from", "trust_from", "50um"), text("Trust them to", "trust_to", "2um"), tick("fill holes", kept.options.fill === "true", (on) => set("fill")(on ? "true" : ""))),
    message, fault, place);
  look();
}
