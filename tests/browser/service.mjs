// Services and the browser, for the tests of the page and its pictures.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import puppeteer from "puppeteer-core";

const { RUGO, BROWSER } = process.env;
export const folder = mkdtempSync(join(tmpdir(), "rugo-browser-")); // of the databases; end() removes it
export const WAIT_MS = 60000; // at most, for what comes at once on a machine without other work
const servers = [];

/** Starts a service on a port of its own and waits until it answers. */
export async function serve(name, ...options) {
  const server = spawn(RUGO, ["serve", "--db", join(folder, `${name}.db`), "--listen", "127.0.0.1:0", ...options], { stdio: ["ignore", "pipe", "pipe"] });
  servers.push(server);
  const url = await new Promise((found, failed) => {
    let text = "";
    const read = (part) => {
      text += part;
      const match = text.match(/127\.0\.0\.1:(\d+)/);
      if (match && match[1] !== "0") found(`http://127.0.0.1:${match[1]}`);
    };
    server.stdout.on("data", read);
    server.stderr.on("data", read);
    server.on("exit", () => failed(new Error(`rugo serve ended: ${text}`)));
  });
  return url;
}

export async function send(url, method, path, body, token) {
  const headers = { "Content-Type": "application/json", ...(token ? { Authorization: `Bearer ${token}` } : {}) };
  const answer = await fetch(url + path, { method, headers, body: body && JSON.stringify(body) });
  if (!answer.ok) throw new Error(`${method} ${path}: ${answer.status} ${await answer.text()}`);
  return answer.json();
}

export async function finished(url, id) {
  for (const until = Date.now() + 4 * WAIT_MS; ;) {
    if (Date.now() > until) throw new Error(`study ${id} has not ended within ${4 * WAIT_MS} ms`);
    const study = await send(url, "GET", `/v1/studies/${id}`);
    if (!["queued", "running"].includes(study.state)) return study;
    await new Promise((done) => setTimeout(done, 200));
  }
}

export function launch() {
  return puppeteer.launch({ executablePath: BROWSER, timeout: 2 * WAIT_MS, args: ["--no-sandbox", "--disable-dev-shm-usage"] });
}

/** Stops the services and removes what they wrote. */
export function end() {
  for (const server of servers) server.kill();
  rmSync(folder, { recursive: true, force: true });
}
