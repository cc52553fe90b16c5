// A row a case: what was swept, then scalars, or curves at one place, with their errors.
import { lastName, make, measured, number, symbol, words } from "/web/elements.js";
import { download, getJson } from "/web/session.js";

export function showTable(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}/table`;
  const message = make("p", { role: "status" }), place = make("div", { class: "scroll" });
  const columns = make("input", { type: "text", size: 40, placeholder: "summit_density, contact_area@0.1", list: "scalars" });
  const where = make("input", { type: "text", size: 20, placeholder: "hurst=0.8" });
  let order = null;

  function query() {
    const parts = [];
    if (columns.value.trim()) parts.push(`columns=${encodeURIComponent(columns.value.replaceAll(" ", ""))}`);
    if (where.value.trim()) parts.push(`where=${encodeURIComponent(where.value.trim())}`);
    return parts.length > 0 ? `?${parts.join("&")}` : "";
  }

  function cell(column, value) {
    if (value === null || value === undefined) return make("td", { class: "number" }, "–");
    if (typeof value === "object" && !Array.isArray(value)) return make("td", { class: "number" }, measured(value.value, value.standard_error));
    return make("td", { class: typeof value === "number" ? "number" : null }, Array.isArray(value) ? value.join(", ") : number(value));
  }

  function plain(value) {
    const of = value !== null && typeof value === "object" && !Array.isArray(value) ? value.value : value;
    return of ?? -Infinity;
  }

  function draw(table) {
    const rows = [...table.rows];
    if (order) rows.sort((a, b) => (plain(a[order.at]) < plain(b[order.at]) ? -1 : 1) * (order.down ? -1 : 1));
    const head = table.columns.map((column, at) => make("th", { scope: "col", "aria-sort": order?.at === at ? (order.down ? "descending" : "ascending") : "none", title: column.unit ?? column.name },
      make("button", { class: "plain", onclick: () => { order = { at, down: order?.at === at && !order.down }; draw(table); } }, column.parameter ? symbol(lastName(column.name)) : words(column.name))));
    place.replaceChildren(make("table", {}, make("thead", {}, make("tr", {}, head)), make("tbody", {}, rows.map((one) => make("tr", {}, one.map((value, at) => cell(table.columns[at], value)))))));
    message.textContent = `${rows.length} cases; values ± one standard error`;
  }

  async function load() {
    message.textContent = "Loading …";
    try {
      draw(await getJson(path + query(), { signal, headers: { Accept: "application/json" } }));
    } catch (error) {
      if (signal.aborted) return;
      place.replaceChildren();
      message.textContent = [error.message, ...(error.faults ?? []).map((fault) => `${fault.pointer}: ${fault.detail}`)].join("; ");
    }
  }

  root.append(make("form", { class: "tools", onsubmit: (event) => { event.preventDefault(); load(); } },
    make("label", {}, "Columns ", columns), make("label", {}, "Where ", where), make("button", {}, "Show"), " ",
    make("button", { type: "button", onclick: () => download(path + query(), `${study.name}-table.csv`, "text/csv").catch((error) => { message.textContent = error.message; }) }, "CSV")),
    make("datalist", { id: "scalars" }, contents.scalars.map((name) => make("option", { value: name }))), message, place);
  load();
  return load;
}
