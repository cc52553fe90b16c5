// A new study: a form of what the schema knows beside its JSON, checked as it is written, with the ready studies to begin from.
import { choice, duration, lastName, make, number, words } from "/web/elements.js";
import { getJson, makeKey, sendJson } from "/web/session.js";

const WAIT = 400; // milliseconds of silence before a check

function at(document, pointer) {
  return pointer.split("/").slice(1).reduce((node, name) => (node !== null && typeof node === "object" ? node[name] : undefined), document);
}

function put(document, pointer, value) {
  const names = pointer.split("/").slice(1), last = names.pop();
  let node = document;
  for (const name of names) {
    if (node[name] === null || typeof node[name] !== "object") {
      if (value === undefined) return;
      node[name] = {};
    }
    node = node[name];
  }
  if (value === undefined) delete node[last];
  else node[last] = value;
}

/** The words that a value may be, alone or in a list, each once. */
function choicesOf(schema) {
  return [...new Set([...(schema.enum ?? []), ...(schema.anyOf ?? []).flatMap(choicesOf), ...(schema.items ? choicesOf(schema.items) : [])])];
}

/** All members that a study of this kind may have: pointer, description, default, choices. */
function membersOf(schema, kind) {
  const found = [];
  const walk = (node, prefix) => {
    for (const [name, member] of Object.entries(node.properties ?? {})) {
      const pointer = `${prefix}/${name}`;
      if (member.properties) walk(member, pointer);
      else if (member.description) found.push({ pointer, member, choices: choicesOf(member) });
    }
  };
  walk({ properties: schema.properties }, "");
  const then = schema.allOf.find((one) => one.if?.properties?.kind?.const === kind)?.then;
  if (then) walk(then, "");
  return found.filter((one) => one.pointer !== "/kind");
}

/** What people type: JSON, or else text; nothing takes the member out. */
function typed(text) {
  if (text.trim() === "") return undefined;
  try {
    return JSON.parse(text);
  } catch {
    return text.trim();
  }
}

let offered = null; // a study that another view made, to begin from

/** Opens the form with a study, of whatever was looked at before. */
export function beginFrom(study) {
  offered = study;
  location.hash = "#/new";
}

export async function showNew(root, signal, from) {
  document.title = "New study – Rugo";
  const message = make("p", { role: "status" }, "Loading …"), fields = make("div", { class: "fields" }), faults = make("ul", { class: "faults", role: "alert" });
  const editor = make("textarea", { rows: 24, spellcheck: "false", "aria-label": "The study as JSON" });
  const cost = make("p", { role: "status" }), submit = make("button", { disabled: true }, "Submit");
  root.append(make("h1", {}, "New study"), message);
  let schema, templates, study = { name: "my study", kind: "statistics", surface: { hurst: 0.8, wavelength_ratio: 8 } }, timer = 0, turn = 0;
  try {
    [schema, templates] = await Promise.all([getJson("/v1/study.schema.json", { signal }), getJson("/v1/templates", { signal })]);
    if (offered && !from) study = offered;
    offered = null;
    if (from) study = await getJson(`/v1/studies/${encodeURIComponent(from)}/study`, { signal });
  } catch (error) {
    message.textContent = error.message;
    return;
  }
  message.textContent = "";

  function input({ pointer, member, choices }) {
    const value = at(study, pointer);
    const text = value === undefined ? "" : typeof value === "string" ? value : JSON.stringify(value);
    const id = `field${pointer.replaceAll("/", "-")}`;
    const usual = member.default !== undefined ? `default ${JSON.stringify(member.default)}` : member.examples ? `e.g. ${JSON.stringify(member.examples[0])}` : "";
    const control = make("input", { id, value: text, placeholder: usual, list: choices.length > 0 ? `${id}-list` : null, "aria-describedby": `${id}-help`, "data-pointer": pointer,
      onchange: (event) => { put(study, pointer, typed(event.target.value)); write(); } });
    return make("div", { class: "field" }, make("label", { for: id }, words(lastName(pointer))), control,
      choices.length > 0 ? make("datalist", { id: `${id}-list` }, choices.map((one) => make("option", { value: one }))) : null,
      make("small", { id: `${id}-help` }, member.description, choices.some((one) => !member.description.includes(one)) ? ` (${choices.join(", ")})` : ""), make("small", { class: "fault", "data-fault": pointer }));
  }

  function form() {
    const groups = new Map();
    for (const one of membersOf(schema, study.kind)) {
      const group = one.pointer.split("/").slice(1, -1).join(" · ") || "study";
      groups.set(group, [...(groups.get(group) ?? []), one]);
    }
    const opened = new Set([...fields.querySelectorAll("details[open]")].map((one) => one.dataset.group));
    const simple = groups.size > 0 && opened.size === 0;
    fields.replaceChildren(choice("Kind", ["statistics", "contact"], study.kind, (kind) => { study.kind = kind; write(); }),
      ...[...groups].map(([group, members]) => make("details", { "data-group": group, open: simple ? ["study", "surface"].includes(group) : opened.has(group) },
        make("summary", {}, group), members.map(input))));
    showFaults([]);
  }

  function showFaults(list) {
    for (const place of fields.querySelectorAll("[data-fault]")) place.textContent = list.filter((fault) => fault.pointer === place.dataset.fault).map((fault) => fault.detail).join("; ");
    for (const control of fields.querySelectorAll("[data-pointer]")) control.setAttribute("aria-invalid", String(list.some((fault) => fault.pointer === control.dataset.pointer)));
    faults.replaceChildren(...list.map((fault) => make("li", {}, make("code", {}, fault.pointer || "/"), ` ${fault.detail}`)));
  }

  async function check() {
    const mine = ++turn;
    submit.disabled = true;
    try {
      const plan = await sendJson("POST", "/v1/check", study);
      if (mine !== turn) return;
      showFaults([]);
      const realisations = plan.realisations ? ` of ${plan.realisations} realisations` : "";
      cost.textContent = `${plan.cases.length} ${plan.cases.length === 1 ? "case" : "cases"}${realisations}: about ${duration(plan.seconds)} of CPU time, ${number(plan.memory_bytes / 2 ** 20, 2)} MiB a worker, expected error ${number(100 * Math.max(...plan.cases.map((one) => one.relative_error)), 2)} %`;
      submit.disabled = false;
    } catch (error) {
      if (mine !== turn || signal.aborted) return;
      cost.textContent = error.faults?.length ? "This cannot run yet:" : error.message;
      showFaults(error.faults ?? []);
    }
  }

  function later() {
    clearTimeout(timer);
    timer = setTimeout(check, WAIT);
  }
  function write() {
    editor.value = JSON.stringify(study, null, 2);
    form();
    later();
  }
  editor.addEventListener("input", () => {
    try {
      study = JSON.parse(editor.value);
      form();
      later();
    } catch (error) {
      submit.disabled = true;
      cost.textContent = `This is no JSON yet: ${error.message}`;
    }
  });
  let sent = {}; // what was submitted without an answer, and its key: the same again is the same study
  submit.addEventListener("click", async () => {
    submit.disabled = true;
    const text = JSON.stringify(study);
    if (sent.text !== text) sent = { text, key: makeKey() };
    try {
      const made = await sendJson("POST", "/v1/studies", study, sent.key);
      sent = {};
      location.hash = `#/study/${encodeURIComponent(made.id)}`;
    } catch (error) {
      cost.textContent = error.message;
      showFaults(error.faults ?? []);
      submit.disabled = false;
    }
  });
  root.append(make("div", { class: "tools" }, choice("Begin from", [["", "…"], ...templates.map((one, k) => [k, one.name])], "", (k) => { if (k !== "") { study = structuredClone(templates[k]); write(); } })),
    make("p", {}, "A list in place of a value sweeps: a case for each of its values."),
    make("div", { class: "columns" }, fields, make("div", {}, editor, cost, faults, submit)));
  write();
}
