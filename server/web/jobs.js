// Who computes a study, and who has: jobs by state, the workers that are at it, the hosts and programs of its results.
import { each, make, say, time, words } from "/web/elements.js";
import { getJson } from "/web/session.js";
import { isLive } from "/web/studies.js";

const PERIOD = 3000;
const STATES = ["done", "running", "waiting", "failed", "cancelled"];

function tableOf(title, columns) {
  const body = make("tbody");
  const element = make("table", { hidden: true }, make("caption", {}, title), make("thead", {}, make("tr", {}, columns.map((name) => make("th", { scope: "col" }, name)))), body);
  const fill = (items, keyOf, row) => {
    element.hidden = items.length === 0;
    each(body, items, keyOf, row);
  };
  return { element, fill };
}

const workingRow = ({ worker, job }) => make("tr", {}, make("th", { scope: "row" }, worker), make("td", { class: "number" }, job.case), make("td", { class: "number" }, `${job.done ?? 0} / ${job.count}`), make("td", {}, time(job.since)));
const runRow = (run) => make("tr", {}, make("th", { scope: "row" }, run.host ?? "–"), make("td", {}, run.program ?? "–"), make("td", { class: "number" }, String(run.jobs)), make("td", {}, time(run.first)), make("td", {}, time(run.last)));

export function showJobs(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}`;
  const counts = make("p", { role: "status" }), message = make("p", { role: "alert" });
  const working = tableOf("At work", ["Worker", "Case", "Realisations", "Since"]), runs = tableOf("Results by", ["Host", "Program", "Jobs", "From", "To"]);
  let { provenance } = contents, { revision } = study;
  root.append(counts, message, make("div", { class: "scroll" }, working.element), make("div", { class: "scroll" }, runs.element));

  async function refresh() {
    try {
      const [status, { workers }] = await Promise.all([getJson(path, { signal }), getJson("/v1/workers", { signal })]);
      if (status.revision !== revision) ({ provenance } = await getJson(`${path}/contents`, { signal }));
      ({ revision } = status);
      const jobs = workers.flatMap((worker) => worker.jobs.filter((job) => job.study === study.id).map((job) => ({ worker: worker.name, job })));
      say(counts, `Jobs: ${STATES.filter((state) => status.jobs[state] > 0).map((state) => `${status.jobs[state]} ${words(state)}`).join(", ") || "none"}.`);
      working.fill(jobs, ({ worker, job }) => `${worker} ${job.job}`, workingRow);
      runs.fill(provenance.runs, (run) => `${run.host} ${run.program}`, runRow);
      say(message, isLive(status) && jobs.length === 0 ? "Nobody is at work on it." : "");
    } catch (error) {
      if (signal.aborted) return;
      say(message, error.message);
    }
    if (!signal.aborted) setTimeout(refresh, PERIOD);
  }
  refresh();
  return () => {}; // it looks by itself
}
