// Requests to the service. The token, where one is needed, is kept for this tab alone.

const KEY = "rugo-token";
const listeners = new Set();

export class Problem extends Error {
  constructor(status, document) {
    super(document?.detail ?? `The server answered ${status}.`);
    this.status = status;
    this.faults = document?.errors ?? [];
  }
}

/** What went wrong in words, with each fault that the server names. */
export function reasonOf(error) {
  return [error.message, ...(error.faults ?? []).map((fault) => `${fault.pointer}: ${fault.detail}`)].join("; ");
}

/** Calls back when a token is needed or refused, with what to say. */
export function onTokenNeeded(listener) {
  listeners.add(listener);
}

export function setToken(token) {
  if (token) sessionStorage.setItem(KEY, token);
  else sessionStorage.removeItem(KEY);
}

export function hasToken() {
  return sessionStorage.getItem(KEY) !== null;
}

/** fetch with the token; throws a Problem for any answer but 2xx and 304. */
export async function request(path, options = {}) {
  const headers = new Headers(options.headers);
  const token = sessionStorage.getItem(KEY);
  if (token) headers.set("Authorization", `Bearer ${token}`);
  let answer;
  try {
    answer = await fetch(path, { ...options, headers });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Error("The server cannot be reached.");
  }
  if (answer.ok || answer.status === 304) return answer;
  const document = answer.headers.get("Content-Type")?.includes("json") ? await answer.json().catch(() => null) : null;
  if (answer.status === 401) {
    const text = token ? "The server does not know this token." : "This server asks for a token.";
    for (const listener of listeners) listener(text);
  }
  throw new Problem(answer.status, document);
}

/** Gives a signal for each request of a view that takes the place of the one before: it ends that, and ends with the view. */
export function latest(signal) {
  let last = new AbortController();
  signal.addEventListener("abort", () => last.abort());
  return () => {
    last.abort();
    last = new AbortController();
    return last.signal;
  };
}

/** As request; where the server is busy (503), asks again until it is not, for a minute. */
export async function requestWhenFree(path, options) {
  for (let tries = 0; ; tries++) {
    try {
      return await request(path, options);
    } catch (error) {
      if (error.status !== 503 || tries >= 60) throw error;
      await new Promise((done) => setTimeout(done, 1000));
      options.signal.throwIfAborted();
    }
  }
}

export async function getJson(path, options) {
  return (await request(path, options)).json();
}

/** A key that nobody else has: a request that is sent again with it is done once. */
export function makeKey() {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, "0")).join("");
}

export async function sendJson(method, path, body, key = makeKey()) {
  const headers = { "Idempotency-Key": key, ...(body === undefined ? {} : { "Content-Type": "application/json" }) };
  const answer = await request(path, { method, headers, body: body === undefined ? undefined : JSON.stringify(body) });
  return answer.status === 204 ? null : answer.json();
}

/** Downloads as a file, with the token that a link could not carry. */
export async function download(path, name, accept) {
  const answer = await request(path, { headers: accept ? { Accept: accept } : {} });
  const link = document.createElement("a");
  link.href = URL.createObjectURL(await answer.blob());
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Reads server-sent events, which EventSource could not ask for with a token: calls back with data and name of each; ends with the stream or the signal. */
export async function events(path, onevent, signal) {
  const answer = await request(path, { signal, headers: { Accept: "text/event-stream" } });
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let waiting = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    const parts = (waiting + value).split("\n\n");
    waiting = parts.pop();
    for (const part of parts) {
      const valuesOf = (field) => part.split("\n").filter((line) => line.startsWith(`${field}:`)).map((line) => line.slice(field.length + 1).trim());
      const data = valuesOf("data");
      if (data.length > 0) onevent(JSON.parse(data.join("\n")), valuesOf("event").pop());
    }
  }
}
