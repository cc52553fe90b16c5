// Pictures of a sweep, which the service draws: rugo plot's choices as lists. What is left to it is as in the files of run --out.
import { chooser, make, pretty, say, symbol, words } from "/web/elements.js";
import { download, getJson, reasonOf, request } from "/web/session.js";
import { sweptOf, whereOf } from "/web/sweep.js";

const AUTOMATIC = ["", "automatic"];
const AXES = [AUTOMATIC, ["none", "linear"], ["x", "log x"], ["y", "log y"], ["xy", "log x and y"]];
const ERRORS = [["", "total"], ["no", "standard"]];

export function showPicture(root, signal, study, contents) {
  const path = `/v1/studies/${encodeURIComponent(study.id)}`;
  const first = contents.curves.find((curve) => !curve.matrix)?.quantity ?? contents.curves[0]?.quantity ?? contents.scalars[0];
  if (!first) {
    root.append(make("p", { role: "status" }, "There are no results yet."));
    return null;
  }
  const swept = sweptOf(contents.cases).map(({ name }) => [name, symbol(name)]);
  const state = { quantity: first, x: "", at: "", colour: "", dash: "", panel: "", model: "", series: "", level: "", log: "", total: "" };
  const lists = {}, loads = new Map(); // values of x, by quantity
  let turn = 0;
  for (const [name, label] of [["quantity", "Quantity"], ["x", "over"], ["at", "at"], ["colour", "Colour"], ["dash", "Dash"], ["panel", "Panel"], ["model", "Model"], ["series", "Series"], ["level", "Level"], ["log", "Axes"], ["total", "Errors"]])
    lists[name] = chooser(label, (value) => set({ [name]: value }));
  const where = whereOf(contents.cases, () => set({}));
  const message = make("p", { role: "status" }), image = make("img", { class: "picture", alt: "" }), command = make("code");
  const figure = make("div", { class: "scroll sheet", tabindex: "0", role: "figure", "aria-label": "picture", hidden: true }, image);
  root.append(make("div", { class: "tools" }, Object.values(lists).map((one) => one.element)),
    ...(where.controls.length > 0 ? [make("div", { class: "tools" }, make("span", {}, "Where"), where.controls)] : []),
    message, figure, make("div", { class: "tools" }, make("button", { onclick: () => download(address(), `${study.name}-${state.quantity}.svg`).catch((error) => say(message, error.message)) }, "SVG"), make("span", {}, "The same by command: ", command)));

  const about = () => contents.curves.find((curve) => curve.quantity === state.quantity);

  /** What is asked for, by the names that the service and rugo plot share. */
  function asked() {
    const overParameter = about() && state.x !== "";
    const parts = [["quantity", overParameter ? `${state.quantity}@${state.at}` : state.quantity], ["where", where.query()]];
    const names = about()?.matrix ? ["series"] : ["x", "colour", "dash", "panel", "model", "series", "level", "log", "total"];
    return [...parts, ...names.map((name) => [name, state[name]])].filter(([, value]) => value !== "");
  }
  const address = () => `${path}/plot?${new URLSearchParams(asked())}`;

  /** The values of x at which the curves of a quantity are known, of the first case that has any. */
  async function loadsOf(quantity) {
    if (!loads.has(quantity)) {
      const begun = contents.cases.find((one) => one.realisations > 0)?.case ?? 0;
      const document = await getJson(`${path}/curves?case=${begun}&quantity=${encodeURIComponent(quantity)}`, { signal });
      loads.set(quantity, document.cases[0]?.curves?.find((curve) => curve.quantity === quantity)?.x ?? []);
    }
    return loads.get(quantity);
  }

  function write() {
    const curve = about(), values = (all, text = words) => (all?.length > 1 ? [AUTOMATIC, ...all.map((one) => [one, text(String(one))])] : []);
    const over = curve?.matrix ? [] : curve ? [["", pretty(curve.x_label || "x")], ...swept] : [AUTOMATIC, ...swept];
    const channels = curve?.matrix ? [] : [AUTOMATIC, ...swept.filter(([name]) => name !== state.x), ...(curve ? ["model", "series", "level"].filter((name) => (name === "series" ? curve.series : curve[`${name}s`])?.length > 1).map((name) => [name, name]) : [])];
    lists.quantity.set([...contents.curves.map((one) => [one.quantity, words(one.quantity)]), ...contents.scalars.map((one) => [one, words(one)])], state.quantity);
    lists.x.set(over, state.x);
    lists.at.set(curve && state.x !== "" ? (loads.get(state.quantity) ?? []).map((x) => [x, String(x)]) : [], state.at);
    for (const name of ["colour", "dash", "panel"]) lists[name].set(channels, state[name]);
    lists.model.set(curve?.matrix ? [] : values(curve?.models), state.model);
    lists.series.set(values(curve?.series), state.series);
    lists.level.set(curve?.matrix ? [] : values(curve?.levels, (one) => one), state.level);
    lists.log.set(curve?.matrix ? [] : AXES, state.log);
    lists.total.set(curve?.matrix ? [] : ERRORS, state.total);
    say(command, ["rugo plot", study.id, `--server ${location.origin}`, ...asked().map(([name, value]) => `--${name} ${value}`)].join(" "));
  }

  /** Draws what is chosen; quietly, where it was drawn before. */
  async function draw(quietly = false) {
    const mine = ++turn;
    if (!quietly) say(message, "Drawing …");
    try {
      if (about() && state.x !== "") {
        const known = await loadsOf(state.quantity);
        if (mine !== turn) return;
        if (!known.includes(Number(state.at)) || state.at === "") state.at = String(known[Math.floor((known.length - 1) / 2)] ?? "");
        write();
      }
      const svg = await (await request(address(), { signal })).text();
      if (mine !== turn) return;
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
      image.alt = `${words(state.quantity)} of ${study.name}`;
      figure.hidden = false;
      say(message, "");
    } catch (error) {
      if (signal.aborted || mine !== turn) return;
      figure.hidden = true;
      say(message, reasonOf(error));
    }
  }

  function set(change) {
    Object.assign(state, change);
    if ("quantity" in change) Object.assign(state, { x: "", at: "", model: "", series: "", level: "", colour: "", dash: "", panel: "" });
    for (const name of ["colour", "dash", "panel"]) if (state[name] === state.x) state[name] = ""; // x is no line's own
    write();
    draw();
  }
  set({});
  return () => draw(true);
}
