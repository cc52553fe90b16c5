// A row a case: what was swept, then scalars, or curves at one place, with their errors.
import { make, measured, number, symbol, words } from "/web/elements.js";
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

  function cell(table, row, at) {
    const value = row.values[at], error = row.standard_errors[at], theory = row.theory?.[at], other = row.errors?.[at], law = row.law_differences?.[at];
    const notes = [theory !== null && theory !== undefined ? `theory ${number(theory)}` : "", other ? `errors other than statistical up to ${number(other, 2)}` : "", law !== null && law !== undefined ? `the other law of heights: ${law > 0 ? "+" : ""}${measured(law, row.law_standard_errors[at])}` : ""].filter(Boolean).join("; ");
    if (value === null || value === undefined) return make("td", { class: "number" }, "–");
    return make("td", { class: typeof value === "number" ? "number" : null, title: notes || null }, Array.isArray(value) ? value.join(", ") : typeof value === "number" ? measured(value, error) : words(String(value)));
  }

  const heading = (column) => (column.type === "parameter" ? symbol(column.name) : words(column.name));

  function draw(table) {
    const rows = [...table.rows];
    if (order) rows.sort((a, b) => ((a.values[order.at] ?? -Infinity) < (b.values[order.at] ?? -Infinity) ? -1 : 1) * (order.down ? -1 : 1));
    const head = table.columns.map((column, at) => make("th", { scope: "col", "aria-sort": order?.at === at ? (order.down ? "descending" : "ascending") : "none", title: column.unit ? `${column.unit} over ${column.x_label}` : column.pointer ?? column.name },
      make("button", { class: "plain", onclick: () => { order = { at, down: order?.at === at && !order.down }; draw(table); } }, heading(column))));
    place.replaceChildren(make("table", {}, make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "case"), head)),
      make("tbody", {}, rows.map((row) => make("tr", {}, make("td", { class: "number" }, row.case), row.error ? make("td", { colspan: table.columns.length, class: "failed" }, row.error) : table.columns.map((column, at) => cell(table, row, at)))))));
    const unknown = [...new Set(table.columns.flatMap((column) => column.unknown ?? []))];
    message.textContent = `${rows.length} ${rows.length === 1 ? "case" : "cases"}; values ± one standard error.${unknown.length > 0 ? ` Errors not known: ${unknown.join(", ")}.` : ""}`;
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
