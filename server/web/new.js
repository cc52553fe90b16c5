// A new study: a form of what the schema knows beside its JSON, checked as it is written, with the ready studies to begin from.
import { choice, duration, each, lastName, make, number, say, words } from "/web/elements.js";
import { getJson, makeKey, sendJson } from "/web/session.js";

const WAIT = 400; // milliseconds of silence before a check
const KINDS = ["statistics", "contact"];

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

/** What people type: JSON, a list with or without brackets, or else text; nothing takes the member out. */
function typed(text, { member, choices }) {
  if (text.trim() === "") return undefined;
  if (member.type === "string") return text.trim();
  for (const json of [text, `[${text}]`]) {
    try {
      return JSON.parse(json);
    } catch { /* it may be the next, or text */ }
  }
  const names = text.split(",").map((one) => one.trim());
  return names.length > 1 && names.every((one) => choices.includes(one)) ? names : text.trim();
}

function shown(value) {
  return value === undefined ? "" : typeof value === "string" ? value : JSON.stringify(value);
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
  const forms = new Map(); // by kind
  const kindField = choice("Kind", KINDS, "", (kind) => { study.kind = kind; write(); }), kindOf = kindField.querySelector("select");
  fields.append(kindField);
  let schema, templates, study = { name: "my study", kind: "statistics", surface: { hurst: 0.8, wavelength_ratio: 8 } }, timer = 0, turn = 0, broken = false; // broken: what the editor holds is no study
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

  function input(kind, { pointer, member, choices }) {
    const id = `field-${kind}${pointer.replaceAll("/", "-")}`;
    const usual = member.default !== undefined ? `default ${JSON.stringify(member.default)}` : member.examples ? `e.g. ${JSON.stringify(member.examples[0])}` : "";
    const control = make("input", { id, placeholder: usual, list: choices.length > 0 ? `${id}-list` : null, "aria-describedby": `${id}-help`, "data-pointer": pointer,
      oninput: (event) => { put(study, pointer, typed(event.target.value, { member, choices })); writeEditor(); later(); } });
    return make("div", { class: "field" }, make("label", { for: id }, words(lastName(pointer))), control,
      choices.length > 0 ? make("datalist", { id: `${id}-list` }, choices.map((one) => make("option", { value: one }))) : null,
      make("small", { id: `${id}-help` }, member.description, choices.some((one) => !member.description.includes(one)) ? ` (${choices.join(", ")})` : ""), make("small", { class: "fault", "data-fault": pointer }));
  }

  /** The fields of a kind, made once: what is typed in them is never taken away. */
  function formOf(kind) {
    const groups = new Map();
    for (const one of membersOf(schema, kind)) {
      const group = one.pointer.split("/").slice(1, -1).join(" · ") || "study";
      groups.set(group, [...(groups.get(group) ?? []), one]);
    }
    return make("div", {}, [...groups].map(([group, members]) => make("details", { open: ["study", "surface"].includes(group) }, make("summary", {}, group), members.map((one) => input(kind, one)))));
  }

  /** Shows the study in the fields of its kind; the one that is typed in holds what was typed. */
  function writeFields() {
    const kind = KINDS.includes(study.kind) ? study.kind : KINDS[0];
    if (!forms.has(kind)) {
      forms.set(kind, formOf(kind));
      fields.append(forms.get(kind));
    }
    for (const [of, form] of forms) form.hidden = of !== kind;
    kindOf.value = kind;
    for (const control of forms.get(kind).querySelectorAll("[data-pointer]")) {
      const text = shown(at(study, control.dataset.pointer));
      if (control !== document.activeElement && control.value !== text) control.value = text;
    }
  }

  function writeEditor() {
    const top = editor.scrollTop, text = JSON.stringify(study, null, 2);
    if (editor.value !== text) editor.value = text;
    editor.scrollTop = top;
    setBroken(false);
  }

  /** While the editor holds no JSON, the form would write over it, and what is checked and submitted would be another study. */
  function setBroken(now) {
    broken = fields.inert = now;
    if (!now) return;
    clearTimeout(timer);
    turn++;
    submit.disabled = true;
  }

  function showFaults(list) {
    for (const place of fields.querySelectorAll("[data-fault]")) say(place, list.filter((fault) => fault.pointer === place.dataset.fault).map((fault) => fault.detail).join("; "));
    for (const control of fields.querySelectorAll("[data-pointer]")) control.setAttribute("aria-invalid", String(list.some((fault) => fault.pointer === control.dataset.pointer)));
    each(faults, list, (fault) => `${fault.pointer} ${fault.detail}`, (fault) => make("li", {}, make("code", {}, fault.pointer || "/"), ` ${fault.detail}`));
  }

  async function check() {
    const mine = ++turn;
    try {
      const plan = await sendJson("POST", "/v1/check", study);
      if (mine !== turn) return;
      showFaults([]);
      const realisations = plan.realisations ? ` of ${plan.realisations} realisations` : "";
      const range = plan.seconds_most ? ` (${duration(plan.seconds_least)} to ${duration(plan.seconds_most)})` : "";
      cost.textContent = `${plan.cases.length} ${plan.cases.length === 1 ? "case" : "cases"}${realisations}: about ${duration(plan.seconds)}${range} of CPU time, ${number(plan.memory_bytes / 2 ** 20, 2)} MiB a worker, expected error ${number(100 * Math.max(...plan.cases.map((one) => one.relative_error)), 2)} %`;
      submit.disabled = false;
    } catch (error) {
      if (mine !== turn || signal.aborted) return;
      submit.disabled = true;
      cost.textContent = error.faults?.length ? "This cannot run yet:" : error.message;
      showFaults(error.faults ?? []);
    }
  }

  let begun = JSON.stringify(study); // what was typed since is asked for before it is replaced
  const ready = choice("Begin from", [["", "…"], ...templates.map((one, k) => [k, one.name])], "", (k) => {
    if (k === "") return;
    if ((broken || JSON.stringify(study) !== begun) && !confirm("Replace what was typed by this study?")) {
      ready.querySelector("select").value = "";
      return;
    }
    study = structuredClone(templates[k]);
    begun = JSON.stringify(study);
    write();
  });
  function later() {
    clearTimeout(timer);
    timer = setTimeout(check, WAIT);
  }
  function write() {
    writeEditor();
    writeFields();
    later();
  }
  editor.addEventListener("input", () => {
    try {
      const read = JSON.parse(editor.value);
      if (read === null || typeof read !== "object") throw new Error("a study is an object");
      study = read;
      setBroken(false);
      writeFields();
      later();
    } catch (error) {
      setBroken(true);
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
  root.append(make("div", { class: "tools" }, ready),
    make("p", {}, "A list in place of a value sweeps: a case for each of its values."),
    make("div", { class: "columns" }, fields, make("div", {}, editor, cost, faults, submit)));
  write();
}
