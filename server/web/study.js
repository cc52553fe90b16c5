// One study: its state and what can be done with it, and its parts: curves, table, report, realisations, document.
import { bar, duration, make, replace, time } from "/web/elements.js";
import { events, getJson, request, sendJson } from "/web/session.js";
import { isLive, share } from "/web/studies.js";
import { showCurves } from "/web/curves.js";
import { showTable } from "/web/table.js";
import { showRealisation } from "/web/realisation.js";

const PARTS = [["curves", "Curves"], ["table", "Table"], ["report", "Speed and error"], ["realisation", "Realisations"], ["document", "Document"]];

/** The report's picture and its notes. */
async function showReport(root, signal, study) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}/report`;
  root.append(make("p", {}, "Cost against error of every model and mesh; circles are where the study stands."));
  const [answer, report] = await Promise.all([request(path, { signal, headers: { Accept: "image/svg+xml" } }), getJson(path, { signal })]);
  root.append(make("div", { class: "scroll", tabindex: "0", role: "figure", "aria-label": "speed and error" },
    make("img", { class: "picture", alt: "relative error over processor time, a line for each model and mesh", src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(await answer.text())}` })));
  const notes = report.cases.flatMap((one) => (one.notes ?? []).map((note) => `case ${one.case}: ${typeof note === "string" ? note : note.text ?? JSON.stringify(note)}`));
  if (notes.length > 0) root.append(make("h3", {}, "Notes"), make("ul", {}, notes.slice(0, 50).map((note) => make("li", {}, note))));
}

async function showDocument(root, signal, study) {
  const document = await getJson(`/v1/studies/${encodeURIComponent(study.id)}/study`, { signal });
  root.append(make("p", {}, "As it was submitted. ", make("a", { href: `#/new/${encodeURIComponent(study.id)}` }, "Copy it as a new study")),
    make("pre", { tabindex: "0" }, JSON.stringify(document, null, 2)));
}

function asks(root, text, action, refresh) {
  return async () => {
    if (text && !confirm(text)) return;
    const message = root.querySelector(".actions-message");
    message.textContent = "";
    try {
      const next = await action();
      if (next !== "gone") refresh();
    } catch (error) {
      message.textContent = error.message;
    }
  };
}

// Of a study that waits: its place, and when it starts where a worker is at work.
function line(study) {
  if (!study.place) return null;
  return study.starts_in === null ? `${study.place}` : `${study.place}, starts in ${duration(study.starts_in)}`;
}

function failures(study) {
  if (!study.failures?.length) return null;
  return make("details", { open: true }, make("summary", {}, `${study.failures.length} failures`),
    make("ul", {}, study.failures.slice(0, 50).map((one) => make("li", {}, `case ${one.case}, job ${one.job}: ${one.reason}`, one.worker ? ` (${one.worker})` : ""))));
}

export async function showStudy(root, signal, id, part = "curves") {
  const path = `/v1/studies/${encodeURIComponent(id)}`;
  const head = make("div"), tabs = make("nav", { class: "tabs", "aria-label": "Parts of the study" }), body = make("section");
  root.append(make("p", { role: "status", class: "waiting" }, "Loading …"));
  let study, redraw = null, contents = null, following = false;

  function drawHead() {
    document.title = `${study.name} – Rugo`;
    const { done, total, failed } = study.realisations;
    const live = isLive(study), called = `study “${study.name}”`;
    const refresh = () => getJson(path, { signal }).then(update);
    const extend = async () => {
      const more = prompt(`How many realisations a case shall ${called} have?`, String(2 * Math.round(total / Math.max(1, study.cases))));
      if (more === null) return "gone";
      return sendJson("POST", `${path}/extend`, { realisations: Number(more) });
    };
    const remove = async () => {
      await sendJson("DELETE", `${path}?results=true`);
      location.hash = "#/";
      return "gone";
    };
    const actions = make("div", { class: "tools" },
      live ? make("button", { onclick: asks(root, `Cancel ${called}?`, () => sendJson("DELETE", path), refresh) }, "Cancel") : null,
      study.jobs.failed + study.jobs.cancelled > 0 || study.cases_failed > 0 ? make("button", { onclick: asks(root, null, () => sendJson("POST", `${path}/retry`), refresh) }, "Retry") : null,
      study.state === "done" ? make("button", { onclick: asks(root, null, extend, refresh) }, "Extend …") : null,
      live ? null : make("button", { class: "danger", onclick: asks(root, `Delete ${called} and its results for ever?`, remove, refresh) }, "Delete …"),
      make("a", { class: "button", href: `#/new/${encodeURIComponent(id)}` }, "Copy as a new study"),
      make("span", { class: "actions-message", role: "alert" }));
    const facts = [["State", make("span", { class: study.state }, study.state)], ["Position in line", line(study)], ["Kind", study.kind], ["Owner", study.owner], ["Priority", study.priority || null], ["Seed", study.seed], ["Cases", study.cases],
      ["Realisations", `${done} / ${total}${failed ? `, ${failed} failed` : ""}`], ["CPU time", duration(study.cpu_seconds)], ["Workers", live ? study.workers : null],
      ["Time left", live ? duration(study.seconds_left) : null], ["Cases without values", study.cases_valueless || null], ["Error reached", study.error_reached ? `${(100 * study.error_reached).toPrecision(3)} %` : null],
      ["Created", time(study.created)], ["Finished", study.finished ? time(study.finished) : null], ["Program", study.program], ["Id", make("code", {}, study.id)]];
    replace(head, make("h1", {}, study.name), live ? bar(share(study), `progress of ${study.name}`) : "",
      make("dl", { class: "facts" }, facts.filter(([, value]) => value !== null && value !== undefined && value !== "").map(([name, value]) => make("div", {}, make("dt", {}, name), make("dd", {}, value)))),
      actions, failures(study) ?? "");
  }

  function update(next) {
    const before = study?.revision;
    study = next;
    drawHead();
    follow();
    if (before === next.revision) return;
    if (contents && contents.curves.length === 0) fill();
    else if (redraw) redraw();
  }

  /** Shows the part; again where there were no results the last time. */
  async function fill() {
    try {
      contents = await getJson(`${path}/contents`, { signal });
      body.replaceChildren();
      redraw = ({ table: showTable, realisation: showRealisation }[part] ?? showCurves)(body, signal, study, contents);
    } catch (error) {
      if (!signal.aborted) body.replaceChildren(make("p", { role: "alert" }, error.message));
    }
  }

  /** Follows the study until it ends; once at a time, again where it goes on. */
  async function follow() {
    if (following) return;
    following = true;
    while (!signal.aborted && isLive(study)) {
      try {
        await events(`${path}/events`, update, signal);
        update(await getJson(path, { signal }));
      } catch (error) {
        if (!signal.aborted) await new Promise((done) => setTimeout(done, 3000));
      }
    }
    following = false;
  }

  try {
    study = await getJson(path, { signal });
    root.replaceChildren(head, tabs, body);
    tabs.append(...PARTS.map(([key, label]) => make("a", { href: `#/study/${encodeURIComponent(id)}/${key}`, "aria-current": key === part ? "page" : null }, label)));
    drawHead();
    if (part === "report") await showReport(body, signal, study);
    else if (part === "document") await showDocument(body, signal, study);
    else await fill();
  } catch (error) {
    if (signal.aborted) return;
    if (study) body.append(make("p", { role: "alert" }, error.message));
    else root.replaceChildren(make("p", { role: "alert" }, error.message), make("a", { href: "#/" }, "Back to the studies"));
  }
  if (study) follow();
}
