// Shows the view that the address names, and asks for a token where the server wants one.
import { make } from "/web/elements.js";
import { hasToken, onTokenNeeded, setToken } from "/web/session.js";
import { showStudies } from "/web/studies.js";
import { showStudy } from "/web/study.js";
import { showNew } from "/web/new.js";
import { showSurface } from "/web/surface.js";
import { showWorkers } from "/web/workers.js";

const main = document.getElementById("main");
const signIn = document.getElementById("sign-in");
const signOut = document.getElementById("sign-out");
let leave = () => {}; // ends what the last view still does

const VIEWS = [
  [/^#?\/?$/, showStudies],
  [/^#\/new$/, showNew],
  [/^#\/new\/([^/]+)$/, showNew],
  [/^#\/surface$/, showSurface],
  [/^#\/workers$/, showWorkers],
  [/^#\/study\/([^/]+)(?:\/([a-z]+))?$/, showStudy],
];

/** Parts of the address as they were before they were escaped; null where they cannot have been. */
function unescaped(parts) {
  try {
    return parts.filter((part) => part !== undefined).map(decodeURIComponent);
  } catch {
    return null;
  }
}

function show() {
  leave();
  const stop = new AbortController();
  leave = () => stop.abort();
  const root = make("div");
  main.replaceChildren(root);
  signOut.hidden = !hasToken();
  for (const link of document.querySelectorAll("nav a"))
    if (link.getAttribute("href") === (location.hash || "#/")) link.setAttribute("aria-current", "page");
    else link.removeAttribute("aria-current");
  for (const [pattern, view] of VIEWS) {
    const found = location.hash.match(pattern), parts = found ? unescaped(found.slice(1)) : null;
    if (parts) {
      view(root, stop.signal, ...parts);
      return;
    }
  }
  root.append(make("p", {}, "There is no such page. ", make("a", { href: "#/" }, "Back to the studies")));
}

onTokenNeeded((text) => {
  document.getElementById("sign-in-message").textContent = text;
  if (!signIn.hidden) return;
  signIn.hidden = false;
  document.getElementById("token").focus();
});
signIn.addEventListener("submit", (event) => {
  event.preventDefault();
  setToken(document.getElementById("token").value.trim());
  document.getElementById("token").value = "";
  signIn.hidden = true;
  show();
});
signOut.addEventListener("click", () => {
  setToken(null);
  show();
});
document.querySelector(".skip").addEventListener("click", (event) => { // its address is no view
  event.preventDefault();
  main.focus();
});
window.addEventListener("hashchange", () => {
  show();
  main.focus({ preventScroll: true }); // what had the focus may be gone; readers of the screen go on here
});
show();
