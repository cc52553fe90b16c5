// One study: its state and what can be done with it, and its parts: curves, table, report, realisations, document.
import { bar, duration, each, make, number, patch, say, time } from "/web/elements.js";
import { events, getJson, latest, reasonOf, request, sendJson } from "/web/session.js";
import { isLive, share, stateClass, stateText } from "/web/studies.js";
import { showCurves } from "/web/curves.js";
import { showPicture } from "/web/picture.js";
import { CASES_FIRST } from "/web/sweep.js";
import { showTable } from "/web/table.js";
import { showJobs } from "/web/jobs.js";
import { showRealisation } from "/web/realisation.js";

const PARTS = [["curves", "Curves"], ["picture", "Pictures"], ["table", "Table"], ["report", "Speed and error"], ["realisation", "Realisations"], ["jobs", "Jobs"], ["document", "Document"]];

const NOTED_MOST = 50, FAILURES_MOST = 50; // cases with notes, and failures, that are listed
const PERIOD = 3000; // milliseconds between questions where events are refused

/** What went wrong or is remarkable in a case, by realisation. */
function notesOf(one) {
  const kept = one.notes?.kept ?? [], more = (one.notes?.count ?? 0) - kept.length;
  const parts = kept.map((note) => `realisation ${note.realisation}: ${note.text}`);
  return [...(one.error ? [one.error] : []), ...parts, ...(more > 0 ? [`${more} more`] : [])];
}

const PARTS_OF_ERROR = [["error_chance", "statistical"], ["error_mesh", "mesh"], ["error_cell", "cell"], ["error_model", "model"], ["error_solver", "solver"]];
const percent = (error) => `${number(100 * error, 3)} %`;

/** The error that a study asks for, beside the largest of its cases so far. */
function targetText(asked, reached) {
  return [asked ? `asked ${percent(asked)}` : "", reached ? `reached ${percent(reached)}` : asked ? "none known yet" : ""].filter(Boolean).join(", ");
}

/** What a case asks for and has reached, and its sources, the largest first; null of a study that asks for no error. */
function reachedOf({ scalars }) {
  const value = (name) => scalars?.[name]?.value;
  if (!value("error_reached") || !value("error_asked")) return null;
  const parts = PARTS_OF_ERROR.map(([key, name]) => [value(key) ?? 0, name]).filter(([error]) => error > 0).sort((a, b) => b[0] - a[0]);
  const cost = value("work") > 0 && value("plain_work") > 0 ? `; ${number(value("work") / value("plain_work"), 2)} times the work of plain sampling` : "";
  return `${targetText(value("error_asked"), value("error_reached"))}: ${parts.map(([error, name]) => `${name} ${percent(error)}`).join(", ")}${cost}`;
}

/** The report's picture, where cost and error are known, and its notes. */
async function showReport(root, signal, study) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}/report`;
  root.append(make("p", {}, "Cost against error of every model and mesh; circles are where the study stands."));
  const reached = make("ul", { class: "reached" }), figure = make("div"), notes = make("div");
  root.append(reached, figure, notes);
  const picture = request(path, { signal, headers: { Accept: "image/svg+xml" } }).then((answer) => answer.text()).then((svg) =>
    figure.append(make("div", { class: "scroll", tabindex: "0", role: "figure", "aria-label": "speed and error" },
      make("img", { class: "picture", alt: "relative error over processor time, a line for each model and mesh", src: `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}` }))),
  (error) => figure.append(make("p", { role: "alert" }, `There is no picture: ${error.message}`)));
  const report = await getJson(path, { signal });
  reached.append(...report.cases.map((one) => [one.case, reachedOf(one)]).filter(([, text]) => text).slice(0, NOTED_MOST).map(([of, text]) => make("li", {}, `case ${of}: ${text}`)));
  const cases = report.cases.filter((one) => notesOf(one).length > 0);
  if (cases.length > 0) notes.append(make("h3", {}, "Notes"), make("ul", {}, cases.slice(0, NOTED_MOST).map((one) =>
    make("li", {}, `case ${one.case}`, make("ul", {}, notesOf(one).map((note) => make("li", {}, note)))))));
  if (cases.length > NOTED_MOST) notes.append(make("p", {}, `and ${cases.length - NOTED_MOST} more cases with notes`));
  await picture;
}

async function showDocument(root, signal, study) {
  const document = await getJson(`/v1/studies/${encodeURIComponent(study.id)}/study`, { signal });
  root.append(make("p", {}, "As it was submitted. ", make("a", { href: `#/new/${encodeURIComponent(study.id)}` }, "Copy it as a new study")),
    make("pre", { tabindex: "0" }, JSON.stringify(document, null, 2)));
}

// Of a study that waits: its place, and when it starts where a worker is at work.
function line(study) {
  if (!study.place) return null;
  return study.starts_in === null ? `${study.place}` : `${study.place}, starts in ${duration(study.starts_in)}`;
}

function factsOf(study, asked) {
  const { done, total, failed } = study.realisations, live = isLive(study);
  return [["State", make("span", { class: stateClass(study) }, stateText(study))], ["Position in line", line(study)], ["Kind", study.kind],
    ["Owner", study.owner], ["Priority", study.priority || null], ["Seed", study.seed], ["Cases", study.cases],
    ["Realisations", `${done} / ${total}${failed ? `, ${failed} failed` : ""}`], ["CPU time", duration(study.cpu_seconds)], ["Workers", live ? study.workers : null],
    ["Time left", live ? duration(study.seconds_left) : null], ["Error", targetText(asked, study.error_reached)],
    ["Created", time(study.created)], ["Finished", study.finished ? time(study.finished) : null], ["Program", study.program], ["Id", make("code", {}, study.id)],
    ["Why there are no values", study.valueless_note]]
    .filter(([, value]) => value !== null && value !== undefined && value !== "");
}

/** The state of a study and what can be done with it: {element, update}. Its elements stay what they are while the study goes on. */
function headOf(id, refresh) {
  const path = `/v1/studies/${encodeURIComponent(id)}`;
  const title = make("h1"), progress = bar(0, ""), facts = make("dl", { class: "facts" }), message = make("span", { class: "actions-message", role: "alert" });
  const count = make("summary"), list = make("ul"), failures = make("details", { open: true, hidden: true }, count, list);
  let study, asked = null, extendable = false; // asked: the error; extendable: unless a target chooses the realisations

  const called = () => `study “${study.name}”`;
  const asks = (question, action) => async () => {
    if (question && !confirm(question())) return;
    message.textContent = "";
    try {
      if ((await action()) !== "gone") await refresh();
    } catch (error) {
      message.textContent = reasonOf(error);
    }
  };
  async function extend() {
    const more = prompt(`How many realisations a case shall ${called()} have?`, String(2 * Math.round(study.realisations.total / Math.max(1, study.cases))));
    return !more?.trim() ? "gone" : sendJson("POST", `${path}/extend`, { realisations: Number(more) });
  }
  async function remove() {
    await sendJson("DELETE", `${path}?results=true`);
    location.hash = "#/";
    return "gone";
  }
  const buttons = [
    [make("button", { onclick: asks(() => `Cancel ${called()}?`, () => sendJson("DELETE", path)) }, "Cancel"), isLive],
    [make("button", { onclick: asks(null, () => sendJson("POST", `${path}/retry`)) }, "Retry"), ({ jobs, cases_failed: failed }) => jobs.failed + jobs.cancelled > 0 || failed > 0],
    [make("button", { onclick: asks(null, extend) }, "Extend …"), ({ state }) => state === "done" && extendable],
    [make("button", { class: "danger", onclick: asks(() => `Delete ${called()} and its results for ever?`, remove) }, "Delete …"), (one) => !isLive(one)],
  ];

  function update(next) {
    study = next;
    document.title = `${study.name} – Rugo`;
    say(title, study.name);
    patch(progress, bar(share(study), `progress of ${study.name}`));
    progress.hidden = !isLive(study);
    each(facts, factsOf(study, asked), ([name]) => name, ([name, value]) => make("div", {}, make("dt", {}, name), make("dd", {}, value)));
    for (const [button, isShown] of buttons) button.hidden = !isShown(study);
    const failed = study.failures ?? [];
    failures.hidden = failed.length === 0;
    say(count, `${failed.length} failures`);
    each(list, failed.slice(0, FAILURES_MOST), (one) => `${one.case} ${one.job}`, (one) => make("li", {}, `case ${one.case}, job ${one.job}: ${one.reason}`, one.worker ? ` (${one.worker})` : ""));
  }
  const actions = make("div", { class: "tools" }, buttons.map(([button]) => button), make("a", { class: "button", href: `#/new/${encodeURIComponent(id)}` }, "Copy as a new study"), message);
  const element = make("div", {}, title, actions, progress, facts, failures); // what grows is below the buttons: they do not move under the pointer
  getJson(`${path}/study`).catch(() => ({})).then((document) => { // without it, the facts lack what was asked for
    asked = document.target?.error ?? null;
    extendable = !document.target;
    if (study) update(study);
  });
  return { element, update };
}

/** Shows a study, and of it the part that the address names: else its curves, or, where these are too many to tell apart, a picture of the sweep. */
export async function showStudy(root, left, id, part) {
  const path = `/v1/studies/${encodeURIComponent(id)}`, stop = new AbortController(), { signal } = stop; // it ends where the view is left, or the study deleted
  left.addEventListener("abort", () => stop.abort());
  const head = headOf(id, () => getJson(path, { signal }).then(update)), tabs = make("nav", { class: "tabs", "aria-label": "Parts of the study" }), body = make("section");
  const streamOf = latest(signal);
  document.addEventListener("visibilitychange", streamOf, { signal }); // it ends the stream
  const lost = make("p", { role: "alert", hidden: true });
  root.append(make("p", { role: "status", class: "waiting" }, "Loading …"));
  let study, redraw = null, contents = null, following = false, drawing = false, again = false;

  function update(next) {
    const before = study?.revision;
    study = next;
    head.update(study);
    follow();
    if (before === next.revision) return;
    drawLast();
  }

  /** Draws what has come in, one drawing after another: where some come while one is drawn, the last of them is drawn next. */
  async function drawLast() {
    again = true;
    if (drawing) return;
    drawing = true;
    while (again && !signal.aborted) {
      again = false;
      await (redraw ? redraw() : fill());
    }
    drawing = false;
  }

  /** Shows the part; what of it cannot draw itself again, as it has no results yet, or could not be shown, is filled again. */
  async function fill() {
    try {
      const whole = { report: showReport, document: showDocument }[part], fresh = make("section");
      if (whole) {
        await whole(fresh, signal, study);
        body.replaceChildren(...fresh.childNodes);
        if (part === "document") redraw = () => {}; // it stays
        return;
      }
      contents = await getJson(`${path}/contents`, { signal });
      body.replaceChildren();
      redraw = ({ picture: showPicture, table: showTable, realisation: showRealisation, jobs: showJobs }[part] ?? showCurves)(body, signal, study, contents);
    } catch (error) {
      if (!signal.aborted) body.replaceChildren(make("p", { role: "alert" }, error.message));
    }
  }

  /** Says that the study was deleted, in place of what was shown of it. */
  function sayDeleted() {
    stop.abort();
    root.replaceChildren(make("p", { role: "alert" }, `Study “${study.name}” was deleted. `, make("a", { href: "#/" }, "Back to the studies")));
  }

  /** Asks for the state; false, and the reason is said, where there is no answer. */
  async function look() {
    try {
      update(await getJson(path, { signal }));
      lost.hidden = true;
      return true;
    } catch (error) {
      if (!signal.aborted && error.status === 404) sayDeleted();
      say(lost, `This may be out of date: ${error.message}`);
      lost.hidden = false;
      return false;
    }
  }

  /** Follows the study until it ends or is deleted; once at a time, again where it goes on. A hidden page holds no connection. */
  async function follow() {
    if (following) return;
    following = true;
    while (!signal.aborted && isLive(study)) {
      const stream = streamOf();
      let refused = false;
      try {
        if (!document.hidden) await events(`${path}/events`, (data, name) => (name === "deleted" ? sayDeleted() : update(data)), stream);
      } catch {
        refused = !stream.aborted; // its state is asked for, from time to time
      }
      if (document.hidden) await new Promise((done) => document.addEventListener("visibilitychange", done, { once: true, signal }));
      if (!(await look()) || refused) await new Promise((done) => setTimeout(done, PERIOD));
    }
    following = false;
  }

  try {
    study = await getJson(path, { signal });
    part ??= study.cases > CASES_FIRST ? "picture" : "curves";
    root.replaceChildren(head.element, lost, tabs, body);
    tabs.append(...PARTS.map(([key, label]) => make("a", { href: `#/study/${encodeURIComponent(id)}/${key}`, "aria-current": key === part ? "page" : null }, label)));
    head.update(study);
    await drawLast();
  } catch (error) {
    if (signal.aborted) return;
    if (study) body.append(make("p", { role: "alert" }, error.message));
    else root.replaceChildren(make("p", { role: "alert" }, error.message), make("a", { href: "#/" }, "Back to the studies"));
  }
  if (study) follow();
}
