// A row a case: what was swept, then scalars, or curves at one place, with their errors; in an order, and in pages.
import { each, make, measured, number, say, symbol, words } from "/web/elements.js";
import { download, getJson, reasonOf } from "/web/session.js";
import { whereOf } from "/web/sweep.js";

const PAGE = 100; // rows

function notesOf(row, at) {
  const theory = row.theory?.[at], other = row.errors?.[at], law = row.law_differences?.[at];
  const [low, high] = [row.total_low?.[at], row.total_high?.[at]];
  return [low !== null && low !== undefined && low < high ? `the truth is between ${number(low)} and ${number(high)}, to 95 %, by the errors that are known` : "", theory !== null && theory !== undefined ? `theory ${number(theory)}` : "", other ? `errors other than statistical up to ${number(other, 2)}` : "",
    law !== null && law !== undefined ? `the other law of heights: ${law > 0 ? "+" : ""}${measured(law, row.law_standard_errors[at])}` : ""].filter(Boolean).join("; ");
}

function cell(row, at) {
  const value = row.values[at];
  if (value === null || value === undefined) return make("td", { class: "number" }, "–");
  return make("td", { class: typeof value === "number" ? "number" : null, title: notesOf(row, at) || null },
    Array.isArray(value) ? value.join(", ") : typeof value === "number" ? measured(value, row.standard_errors[at]) : words(String(value)));
}

/** Orders by a column's values; what has none comes last, in both directions. */
function ordered(rows, at, down) {
  const sign = down ? -1 : 1, none = (value) => value === null || value === undefined;
  return [...rows].sort(({ values: { [at]: a } }, { values: { [at]: b } }) => (none(a) || none(b) ? none(a) - none(b) : a < b ? -sign : a > b ? sign : 0));
}

export function showTable(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}/table`;
  const message = make("p", { role: "status" }), place = make("div", { class: "scroll" });
  const columns = make("input", { type: "text", size: 40, placeholder: "summit_density, contact_area@0.1", list: "scalars" });
  const cases = new Map(contents.cases.map((one) => [one.case, one])), where = whereOf(contents.cases, () => turnTo(0));
  const names = make("datalist", { id: "scalars" });
  const head = make("tr"), body = make("tbody"), state = { by: null, down: false, page: 0, columns: "" };
  const back = make("button", { onclick: () => turnTo(state.page - 1) }, "‹ before"), on = make("button", { onclick: () => turnTo(state.page + 1) }, "next ›"), range = make("span", { role: "status" });
  const pages = make("div", { class: "tools", hidden: true }, back, range, on);
  let table = null, turn = 0;
  place.append(make("table", {}, make("thead", {}, head), body));

  function query() {
    const parts = [["columns", state.columns], ["where", where.query()]].filter(([, value]) => value !== "");
    return parts.length > 0 ? `?${new URLSearchParams(parts)}` : "";
  }

  function turnTo(page) {
    state.page = page;
    place.scrollTop = 0;
    if (table) draw();
  }
  function orderBy(key) {
    Object.assign(state, { down: state.by === key && !state.down, by: key });
    turnTo(0);
  }

  const keyOf = (column) => (column === null ? "" : `${table.columns.indexOf(column)} ${column.name}`);
  const heading = (column) => make("th", { scope: "col", "aria-sort": state.by !== keyOf(column) ? "none" : state.down ? "descending" : "ascending", title: column.unit ? `${column.unit} over ${column.x_label}` : column.pointer ?? column.name },
    make("button", { class: "plain", onclick: () => orderBy(keyOf(column)) }, column.type === "parameter" ? symbol(column.name) : words(column.name)));
  const rowOf = (row) => make("tr", {}, make("td", { class: "number" }, row.case),
    row.error ? make("td", { colspan: table.columns.length, class: "failed" }, row.error) : table.columns.map((column, at) => cell(row, at)));

  function draw() {
    const at = table.columns.findIndex((column) => keyOf(column) === state.by);
    const found = table.rows.filter((row) => where.matches(cases.get(row.case) ?? { swept: {} })), rows = at < 0 ? found : ordered(found, at, state.down);
    state.page = Math.max(0, Math.min(state.page, Math.ceil(rows.length / PAGE) - 1));
    const first = state.page * PAGE, shown = rows.slice(first, first + PAGE);
    each(head, [null, ...table.columns], keyOf, (column) => (column === null ? make("th", { scope: "col" }, "case") : heading(column)));
    each(body, shown, (row) => row.case, rowOf);
    pages.hidden = rows.length <= PAGE;
    back.disabled = first === 0;
    on.disabled = first + PAGE >= rows.length;
    say(range, `rows ${first + 1} to ${first + shown.length} of ${rows.length}`);
    const lacking = table.columns.filter((column) => column.unknown?.length > 0).map((column) => `${column.unknown.join(", ")} of ${words(column.name)}`);
    say(message, `${rows.length === table.rows.length ? "" : `${rows.length} of `}${table.rows.length} ${table.rows.length === 1 ? "case" : "cases"}; values ± one standard error.${lacking.length > 0 ? ` Errors not known: ${lacking.join("; ")}.` : ""}`);
  }

  function nameColumns({ scalars }) {
    names.append(...scalars.map((name) => make("option", { value: name })));
  }

  /** Asks for the columns that were chosen last; quietly, where the table was there before. */
  async function load(quietly = false) {
    const mine = ++turn;
    if (!table) say(message, "Loading …");
    try {
      const answer = await getJson(path + (state.columns ? `?columns=${encodeURIComponent(state.columns)}` : ""), { signal, headers: { Accept: "application/json" } });
      if (mine !== turn) return;
      table = answer;
      place.hidden = false;
      draw();
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      if (!quietly) {
        table = null;
        place.hidden = pages.hidden = true;
      }
      message.textContent = reasonOf(error);
    }
  }

  root.append(make("form", { class: "tools", onsubmit: (event) => { event.preventDefault(); state.columns = columns.value.replaceAll(" ", ""); load(); } },
    make("label", {}, "Columns ", columns), make("button", {}, "Show"), where.controls,
    make("button", { type: "button", onclick: () => download(path + query(), `${study.name}-table.csv`, "text/csv").catch((error) => { message.textContent = error.message; }) }, "CSV")),
    names, message, pages, place);
  nameColumns(contents);
  load();
  return async () => {
    if (names.childElementCount === 0) await getJson(`/v1/studies/${encodeURIComponent(study.id)}/contents`, { signal }).then(nameColumns, () => {}); // the next results ask again
    await load(true);
  };
}
