// Who works, on what, and how fast; what waits.
import { each, make, number, say, time } from "/web/elements.js";
import { getJson } from "/web/session.js";

const PERIOD = 3000;

export function showWorkers(root, signal) {
  document.title = "Workers – Rugo";
  const message = make("p", { role: "status" }, "Loading …"), queue = make("p"), body = make("tbody");
  const table = make("table", { hidden: true }, make("thead", {}, make("tr", {}, ["Worker", "Runs", "Case", "Realisations", "Since", "Last seen", "Jobs in the last hour"].map((name) => make("th", { scope: "col" }, name)))), body);

  function row(worker) {
    const job = worker.jobs[0];
    return make("tr", {}, make("th", { scope: "row" }, worker.name),
      make("td", {}, job ? make("a", { href: `#/study/${encodeURIComponent(job.study)}` }, job.name) : "–"),
      make("td", { class: "number" }, job ? job.case : "–"),
      make("td", { class: "number" }, job ? `${job.done ?? 0} / ${job.count}` : "–"),
      make("td", {}, job ? time(job.since) : "–"), make("td", {}, time(worker.last_seen)), make("td", { class: "number" }, number(worker.jobs_last_hour)));
  }

  async function refresh() {
    try {
      const { workers, waiting } = await getJson("/v1/workers", { signal });
      each(body, workers, (worker) => worker.name, row);
      table.hidden = workers.length === 0;
      say(queue, `${waiting} jobs wait.`);
      say(message, workers.length === 0 ? "No worker was seen in the last hour. Start one with rugo work, or rugo serve --workers 2." : "");
    } catch (error) {
      if (signal.aborted) return;
      message.textContent = error.message;
    }
    if (!signal.aborted) setTimeout(refresh, PERIOD);
  }
  root.append(make("h1", {}, "Workers"), message, queue, make("div", { class: "scroll" }, table));
  refresh();
}
