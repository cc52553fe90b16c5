"use strict";
// Lists the studies and their progress; asks again every two seconds. A token, where one is needed, stays in
// this page's memory.

const body = document.querySelector("tbody");
const message = document.getElementById("message");
const form = document.getElementById("token-form");
let token = "";

function cell(row, content, className) {
  const td = row.insertCell();
  if (content instanceof Node) td.append(content);
  else td.textContent = content; // never as markup: names are the users'
  if (className) td.className = className;
}

function duration(seconds) {
  if (seconds === null) return "–";
  if (seconds < 100) return `${seconds.toFixed(0)} s`;
  if (seconds < 6000) return `${(seconds / 60).toFixed(0)} min`;
  return `${(seconds / 3600).toFixed(1)} h`;
}

function bar(share) {
  const progress = document.createElement("progress");
  progress.max = 1;
  progress.value = share;
  progress.title = `${(100 * share).toFixed(1)} %`;
  return progress;
}

function links(id) {
  const span = document.createElement("span");
  for (const what of ["curves", "report"]) {
    const link = document.createElement("a");
    link.href = `/v1/studies/${encodeURIComponent(id)}/${what}`;
    link.textContent = what;
    span.append(link, " ");
  }
  return span;
}

function show(studies) {
  body.replaceChildren();
  for (const study of studies.reverse()) {
    const row = body.insertRow();
    const { done, total } = study.realisations;
    const name = document.createElement("span");
    name.textContent = study.name;
    name.title = study.id;
    cell(row, name);
    cell(row, study.kind);
    cell(row, study.state, study.state);
    cell(row, bar(study.share));
    cell(row, `${done} / ${total}`, "number");
    cell(row, ["queued", "running"].includes(study.state) ? duration(study.seconds_left) : "–", "number");
    cell(row, study.created.replace("T", " ").replace("Z", ""));
    cell(row, links(study.id));
  }
  document.querySelector("table").hidden = studies.length === 0;
  message.textContent = studies.length ? "" : "No study yet: POST one to /v1/studies, or rugo submit.";
}

async function page(after) {
  const headers = token ? { Authorization: `Bearer ${token}` } : {};
  const answer = await fetch(`/v1/studies?limit=1000${after ? `&after=${after}` : ""}`, { headers });
  if (answer.status === 401) {
    form.hidden = false;
    throw new Error("A token is needed.");
  }
  if (!answer.ok) throw new Error((await answer.json()).detail);
  return answer.json();
}

async function refresh() {
  try {
    let studies = [];
    let next = "";
    do {
      const list = await page(next);
      studies = studies.concat(list.studies);
      next = list.next;
    } while (next);
    show(studies);
  } catch (error) {
    message.textContent = error.message;
  }
  setTimeout(refresh, 2000);
}

form.addEventListener("submit", (event) => {
  event.preventDefault();
  token = document.getElementById("token").value;
  form.hidden = true;
});
refresh();
