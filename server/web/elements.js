// Elements of the page, and how it writes numbers. What users wrote goes in as text, never as markup.

/** Makes an element: attributes by name, listeners as onclick, then its content. */
export function make(name, attributes = {}, ...content) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (typeof value === "boolean") element.toggleAttribute(key, value);
    else if (value !== undefined && value !== null) element.setAttribute(key, value);
  }
  element.append(...content.flat().filter((part) => part !== null && part !== undefined && part !== ""));
  return element;
}

/** Sets the text of an element where it differs, so that a selection in it stays. */
export function say(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Makes an element look like a newer copy of it and stay itself: focus, selection, clicks under way and its listeners survive. */
export function patch(element, copy) {
  for (const name of element.getAttributeNames()) if (!copy.hasAttribute(name)) element.removeAttribute(name);
  for (const name of copy.getAttributeNames()) if (element.getAttribute(name) !== copy.getAttribute(name)) element.setAttribute(name, copy.getAttribute(name));
  if (element.localName === "input") element.checked = copy.checked;
  const there = [...element.childNodes], wanted = [...copy.childNodes];
  wanted.forEach((node, k) => {
    if (there[k] === undefined) element.append(node);
    else if (there[k].nodeName !== node.nodeName) there[k].replaceWith(node);
    else if (node.nodeType === Node.ELEMENT_NODE) patch(there[k], node);
    else if (there[k].data !== node.data) there[k].data = node.data;
  });
  for (const node of there.slice(wanted.length)) node.remove();
}

const kept = new WeakMap(); // children by key, of the elements that each() has filled

/** Gives an element a child for each item, in their order. One whose key was there before is patched by what makes a new one. */
export function each(element, items, keyOf, create) {
  const before = kept.get(element) ?? new Map(), now = new Map(), held = document.activeElement;
  for (const item of items) {
    const key = keyOf(item), child = create(item);
    if (before.has(key)) patch(before.get(key), child);
    now.set(key, before.get(key) ?? child);
  }
  for (const [key, child] of before) if (!now.has(key)) child.remove();
  let at = element.firstChild;
  for (const child of now.values())
    if (child === at) at = at.nextSibling;
    else element.insertBefore(child, at);
  kept.set(element, now);
  if (held !== document.activeElement && element.contains(held)) held.focus({ preventScroll: true }); // it was moved
}

/** Seconds in words. */
export function duration(seconds) {
  if (seconds === null || seconds === undefined || !isFinite(seconds)) return "–";
  if (seconds < 0.1) return `${number(1000 * seconds, 2)} ms`;
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 100) return `${seconds.toFixed(0)} s`;
  if (seconds < 6000) return `${(seconds / 60).toFixed(0)} min`;
  if (seconds < 360000) return `${(seconds / 3600).toFixed(1)} h`;
  return `${(seconds / 86400).toFixed(1)} days`;
}

/** A number with so many digits as mean something, without an exponent where it reads well; whole numbers with all digits. */
export function number(value, digits = 4) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  const size = Math.abs(value);
  if (Number.isInteger(value) && size < 1e6) return String(value); // counts, and parameters as they were given
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(digits - 1) : String(Number(value.toPrecision(digits)));
}

/** A value and its standard error to the error's two digits: 0.1234 ± 0.0012. */
export function measured(value, error) {
  if (value === null || value === undefined) return "–";
  if (!error) return number(value);
  const decimals = Math.max(0, Math.min(12, 1 - Math.floor(Math.log10(error))));
  const size = Math.abs(value);
  if (decimals >= 12 || size >= 1e6) return `${number(value)} ± ${number(error, 2)}`;
  return `${value.toFixed(decimals)} ± ${error.toFixed(decimals)}`;
}

export function time(text) {
  return text ? new Date(text).toLocaleString() : "–";
}

/** "hurst" of "/surface/hurst". */
export function lastName(pointer) {
  return pointer.slice(pointer.lastIndexOf("/") + 1);
}

const SYMBOLS = {
  hurst: "H", nayak_alpha: "α", shape: "C", wavelength_ratio: "λₗ/λₛ", length_ratio: "L/λₗ", poisson: "ν", rms_slope: "h′",
};
/** "H" of "hurst", where people have a symbol for it. */
export function symbol(name) {
  return SYMBOLS[name] ?? name.replaceAll("_", " ");
}

/** "mean gap" of "mean_gap", with the capitals of people and of abbreviations. */
export function words(name) {
  return name.replaceAll("_", " ").replace(/\b(?:persson|nayak|weibull|gaussian|archard)\b/g, (one) => one[0].toUpperCase() + one.slice(1)).replace("gw mccool", "GW–McCool").replace(/\b(?:gw|bgt|pdf|cdf|psd|acf)\b/g, (one) => one.toUpperCase());
}

/** A label as people write it: "√m₀" of "sqrt(m0)". */
export function pretty(label) {
  return label.replace(/sqrt\(([^()]*)\)/g, "√$1").replaceAll("h'_rms", "h′").replace(/\bm0\b/g, "m₀").replace(/\bm2\b/g, "m₂").replace(/\bm4\b/g, "m₄")
    .replace(/\bA0\b/g, "A₀").replaceAll("lambda_s", "λₛ").replaceAll("lambda_l", "λₗ").replaceAll("^2", "²");
}

export function bar(share, label) {
  return make("progress", { max: 1, value: share, "aria-label": label, title: `${(100 * share).toFixed(1)} %` });
}

/** A list to choose from; options are values, or pairs of value and text. */
export function choice(label, options, value, onchange) {
  const list = make("select", { onchange: (event) => onchange(event.target.value) },
    options.map((option) => {
      const [key, text] = Array.isArray(option) ? option : [option, words(String(option))];
      return make("option", { value: key, selected: String(key) === String(value) }, text);
    }));
  return make("label", { class: "choice" }, `${label} `, list);
}

/** A list whose options change, as pairs of value and text: {element, set(options, value)}; hidden where there is nothing to choose. */
export function chooser(label, onchange) {
  const element = choice(label, [], "", onchange), select = element.querySelector("select");
  let held = "";
  const set = (options, value) => {
    const text = JSON.stringify(options);
    if (text !== held) select.replaceChildren(...options.map(([key, name]) => make("option", { value: key }, name)));
    held = text;
    select.value = value ?? "";
    element.hidden = options.length < 2;
  };
  return { element, set };
}

export function tick(label, checked, onchange) {
  return make("label", { class: "tick" }, make("input", { type: "checkbox", checked, onchange: (event) => onchange(event.target.checked) }), ` ${label}`);
}
