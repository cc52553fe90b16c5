// The list of studies: search, filter, order, progress as it happens.
import { bar, choice, duration, each, make, say, time } from "/web/elements.js";
import { getJson } from "/web/session.js";

const COLUMNS = [
  ["name", "Study", (a) => a.name.toLowerCase()],
  ["kind", "Kind", (a) => a.kind],
  ["owner", "Owner", (a) => a.owner ?? ""],
  ["state", "State", (a) => a.state],
  ["progress", "Progress", (a) => share(a)],
  ["realisations", "Realisations", (a) => a.realisations.total],
  ["left", "Time left", (a) => a.seconds_left ?? 0],
  ["cost", "CPU time", (a) => a.cpu_seconds ?? 0],
  ["created", "Created", (a) => a.created],
];
export const STATES = ["queued", "running", "done", "failed", "cancelled"];
const ORDER = { by: "created", down: true }; // kept while the tab is open
const PERIOD = 2000;

export function share(study) {
  return study.share ?? (study.realisations.total > 0 ? study.realisations.done / study.realisations.total : 0);
}

export function isLive(study) {
  return study.state === "queued" || study.state === "running";
}

/** "done, 3 cases without values": the state, and what it does not say. */
export function stateText(study) {
  const cases = (count) => (count === study.cases ? (count === 1 ? "its case" : "all cases") : `${count} ${count === 1 ? "case" : "cases"}`);
  return [study.state, study.place ? `place ${study.place}` : "", study.cases_valueless > 0 ? `${cases(study.cases_valueless)} without values` : "",
    study.cases_failed > 0 ? `${cases(study.cases_failed)} not merged` : ""].filter(Boolean).join(", ");
}

export function stateClass(study) {
  return study.state === "done" && (study.cases_valueless > 0 || study.cases_failed > 0) ? "lacking" : study.state;
}

async function all(signal) {
  let studies = [], next = "";
  do {
    const page = await getJson(`/v1/studies?limit=1000${next ? `&after=${encodeURIComponent(next)}` : ""}`, { signal });
    studies = studies.concat(page.studies);
    next = page.next;
  } while (next);
  return studies;
}

function row(study) {
  const { done, total } = study.realisations;
  return make("tr", {},
    make("th", { scope: "row" }, make("a", { href: `#/study/${encodeURIComponent(study.id)}`, title: study.id }, study.name)),
    make("td", {}, study.kind),
    make("td", {}, study.owner ?? ""),
    make("td", { class: stateClass(study), title: study.valueless_note }, stateText(study)),
    make("td", {}, bar(share(study), `progress of ${study.name}`)),
    make("td", { class: "number" }, `${done} / ${total}`),
    make("td", { class: "number" }, isLive(study) ? duration(study.seconds_left) : "–"),
    make("td", { class: "number" }, duration(study.cpu_seconds)),
    make("td", {}, time(study.created)));
}

export function showStudies(root, signal) {
  document.title = "Rugo";
  let studies = [], text = "", state = "all";
  const message = make("p", { role: "status" }, "Loading …");
  const body = make("tbody");
  const heads = COLUMNS.map(([key, label]) => make("th", { scope: "col", "data-key": key },
    make("button", { class: "plain", onclick: () => { Object.assign(ORDER, { down: ORDER.by === key && !ORDER.down, by: key }); draw(); } }, label)));
  const table = make("table", { hidden: true }, make("thead", {}, make("tr", {}, heads)), body);

  function draw() {
    const of = COLUMNS.find(([key]) => key === ORDER.by)[2];
    const found = studies.filter((study) => (state === "all" || study.state === state) &&
      `${study.name} ${study.id} ${study.owner ?? ""}`.toLowerCase().includes(text));
    found.sort((a, b) => (of(a) < of(b) ? -1 : of(a) > of(b) ? 1 : 0) * (ORDER.down ? -1 : 1));
    for (const head of heads)
      head.setAttribute("aria-sort", head.dataset.key !== ORDER.by ? "none" : ORDER.down ? "descending" : "ascending");
    each(body, found, (study) => study.id, row);
    table.hidden = found.length === 0;
    table.classList.toggle("ownerless", !studies.some((study) => study.owner));
    say(message, studies.length === 0 ? "No study yet. Begin with “New study”, or rugo submit."
      : found.length === 0 ? "No study is like that." : `${found.length} of ${studies.length} studies`);
  }

  async function refresh() {
    try {
      studies = await all(signal);
      draw();
    } catch (error) {
      if (signal.aborted) return;
      message.textContent = error.message;
    }
    if (!signal.aborted) setTimeout(refresh, PERIOD);
  }

  root.append(make("h1", {}, "Studies"),
    make("div", { class: "tools" },
      make("label", {}, "Search ", make("input", { type: "search", oninput: (event) => { text = event.target.value.toLowerCase(); draw(); } })),
      choice("State", ["all", ...STATES], state, (value) => { state = value; draw(); })),
    message, make("div", { class: "scroll" }, table));
  refresh();
}
