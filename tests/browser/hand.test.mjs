// Protects: what a person does by real keys and clicks while the page goes on by itself: nothing that is typed, chosen or pressed is
// lost, and what a study lacks is said where it is looked for.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test as declare } from "node:test";
import { pick, press, retype, says, tab as openTab } from "./hands.mjs";
import { end, finished, launch, send, serve, WAIT_MS } from "./service.mjs";

const { PICTURES } = process.env;
let browser, url;
const LIMIT = { timeout: 5 * WAIT_MS };
const test = (name, body) => declare(name, LIMIT, body);
const tab = (t, expected) => openTab(browser, t, expected);
const picture = async (page, name) => PICTURES && page.screenshot({ path: join(PICTURES, `${name}.png`) });

// Steep profiles are not brought to the load: their case has no values.
const STEEP = { name: "steep", kind: "contact", seed: 1, realisations: 2,
  surface: { dimension: 1, hurst: 0.8, wavelength_ratio: 2, length_ratio: 2, points_per_wavelength: 6, rms_slope: [0.1, 1.9] },
  contact: { model: "full", levels: [3, 6], block_height: { lengths: 1 }, time_limit: 0.01, pressures: { values: [5] } } };
const TARGET = { name: "target", kind: "contact", seed: 1, target: { error: 0.02 }, surface: { dimension: 1, hurst: 0.8, wavelength_ratio: 2 },
  contact: { model: "halfspace", pressures: { values: [0.1, 0.2] } } };
const PATCHES = { name: "patches", kind: "contact", seed: 1, realisations: 1,
  surface: { dimension: 2, hurst: 0.8, wavelength_ratio: 4, length_ratio: 4, points_per_wavelength: 8 },
  contact: { model: "halfspace", pressures: { values: [0.1] } } };
const SWEEP = { name: "sweep", kind: "contact", seed: 1, realisations: 2,
  surface: { dimension: 1, hurst: [0.1, 0.3, 0.5, 0.7, 0.9], wavelength_ratio: [2, 3, 4, 5], length_ratio: [2, 3, 4], points_per_wavelength: 4 },
  contact: { model: "halfspace", pressures: { values: [0.1, 0.2, 0.3] } } };
const LONG = { name: "a long one", kind: "statistics", seed: 1, realisations: 1000000,
  surface: { hurst: 0.5, wavelength_ratio: 4, length_ratio: 4, points_per_wavelength: 8 } };

before(async () => {
  browser = await launch();
  url = await serve("hand", "--workers", "1");
}, LIMIT);
after(async () => {
  await browser?.close();
  end();
});

const focused = (page) => page.evaluate(() => document.activeElement.dataset.pointer ?? document.activeElement.localName);
const field = (pointer) => `[data-pointer="${pointer}"]`;
const written = async (page) => JSON.parse(await page.$eval("textarea", (one) => one.value));

test("the form keeps focus, caret and scroll, and takes what is typed in one field after another", async (t) => {
  const page = await tab(t, [422]);
  await page.goto(`${url}/#/new`);
  await says(page, "1 case of 1000 realisations");
  await retype(page, field("/name"), "typed");
  await page.keyboard.press("Tab");
  const next = await focused(page);
  assert.ok(next.startsWith("/") && next !== "/name", `Tab leads to the next field, not to ${next}`);
  await retype(page, field("/surface/hurst"), "0.5");
  await retype(page, field("/surface/wavelength_ratio"), "4, 8");
  const study = await written(page);
  assert.deepEqual([study.name, study.surface.hurst, study.surface.wavelength_ratio], ["typed", 0.5, [4, 8]]);
  await says(page, "2 cases of 1000 realisations");
  const hurst = await page.$(field("/surface/hurst"));
  await retype(page, field("/surface/hurst"), "14");
  await page.keyboard.press("ArrowLeft"); // the caret stays between the digits while the answers come
  await says(page, "This cannot run yet");
  await page.waitForFunction(() => document.querySelector('[data-fault="/surface/hurst"]').textContent.length > 0);
  assert.equal(await focused(page), "/surface/hurst");
  await page.keyboard.press("Backspace");
  await page.keyboard.type("0.");
  await says(page, "2 cases of 1000 realisations");
  assert.equal((await written(page)).surface.hurst, 0.4);
  assert.ok(await hurst.evaluate((one) => one.isConnected), "the field is the one that was there");
  const last = await page.evaluate(() => [...document.querySelectorAll(".fields details[open] [data-pointer]")].pop().dataset.pointer);
  await press(page, field(last)); // the fields scroll to it
  const top = () => page.$eval(".fields", (one) => one.scrollTop), place = await top();
  assert.ok(place > 0, "the fields have scrolled");
  await page.keyboard.type("1");
  await page.waitForNetworkIdle({ idleTime: 600 });
  assert.equal(await top(), place);
  await picture(page, "form");
  const kept = await written(page), asked = [];
  page.on("dialog", (dialog) => (asked.push(dialog.message()) === 1 ? dialog.dismiss() : dialog.accept()));
  await pick(page, "Begin from", "contact-demo");
  assert.deepEqual([asked.length, await written(page)], [1, kept], "what was typed stays where the question is answered no");
  await pick(page, "Begin from", "contact-demo");
  await page.waitForFunction(() => JSON.parse(document.querySelector("textarea").value).name === "contact-demo");
  assert.equal(asked.length, 2);
});

test("a case without values is no plain success: state, curves and report say why", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", STEEP);
  const study = await finished(url, id);
  assert.equal(study.cases_valueless, 1, "of the steep case the solver does not reach the load");
  const page = await tab(t, [422]);
  await page.goto(`${url}/#/study/${id}`);
  await says(page, "done, 1 case without values");
  await says(page, study.valueless_note);
  assert.equal(await page.$("dd .done"), null);
  await page.waitForFunction(() => document.querySelector("section p[role=status]")?.textContent.includes("no values"));
  await picture(page, "valueless");
  await page.goto(`${url}/#/study/${id}/report`);
  await page.waitForFunction(() => [...document.querySelectorAll("section li")].some((one) => one.textContent.includes("realisation 0: ")));
  await picture(page, "valueless-report");
  await page.goto(`${url}/#/`);
  const inList = await page.waitForSelector("tbody td.lacking");
  assert.deepEqual(await inList.evaluate((one) => [one.textContent, one.title]), ["done, 1 case without values", study.valueless_note]);
  assert.equal(await page.$("tbody td.done"), null, "no other study is there yet");
  await picture(page, "valueless-list");
});

test("a target shows one error: in its state, in its sources by size, and where its picture stands", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", TARGET);
  const { error_reached: reached } = await finished(url, id);
  const page = await tab(t);
  await page.goto(`${url}/#/study/${id}/report`);
  const text = `${(100 * reached).toPrecision(3)} %`;
  await says(page, `asked 2 %, reached ${Number.parseFloat(text)} %: `);
  assert.ok((await page.$eval(".facts", (one) => one.textContent)).includes(`asked 2 %, reached ${Number.parseFloat(text)} %`));
  const line = await page.$eval(".reached li", (one) => one.textContent), sizes = [...line.split(": ").pop().matchAll(/ ([0-9.e-]+) %/g)].map((one) => Number(one[1]));
  assert.ok(line.includes("solver") && line.includes("statistical"));
  assert.ok(sizes.length >= 3 && sizes.every((size, k) => k === 0 || size <= sizes[k - 1]), line);
  assert.ok(Math.abs(Math.hypot(...sizes) / (100 * reached) - 1) < 0.01, "the sources make up the error");
  const svg = decodeURIComponent((await page.$eval("img.picture", (one) => one.src)).split(",").slice(1).join(","));
  assert.ok(!svg.includes("level nan"), "the legend has no level where there is none");
  await picture(page, "target");
});

test("pressures are white where there is no contact, beside a scale with ends and unit, in the dark too", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", PATCHES);
  await finished(url, id);
  const page = await tab(t), scale = () => page.$$eval(".ends span", (all) => all.map((one) => Number(one.textContent)));
  const open = () => page.$eval("canvas.map", (one) => {
    const { data } = one.getContext("2d").getImageData(0, 0, one.width, one.height);
    return data.filter((_, k) => k % 4 === 3 && data[k] === 0).length / (data.length / 4);
  });
  await page.goto(`${url}/#/study/${id}/realisation`);
  await page.waitForSelector("canvas.map");
  assert.equal(await open(), 0);
  await pick(page, "Field", "pressure");
  await says(page, "% of the points are in contact");
  await says(page, "pressure in E* h′");
  const share = Number.parseFloat(await page.$eval("main p[role=status]:not(:empty)", (one) => one.textContent)) / 100;
  assert.ok(Math.abs(1 - share - await open()) < 1e-3 && share > 0.05, `${share} in contact`);
  const [low, high] = await scale();
  assert.ok(low > 0 && low < high, `from ${low} to ${high}`);
  await picture(page, "pressure");
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await page.setViewport({ width: 390, height: 844, isMobile: true });
  await pick(page, "Field", "gap");
  await says(page, "white where there is contact");
  await pick(page, "Field", "pressure");
  await says(page, "white where there is no contact");
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth) <= 390);
  await picture(page, "pressure-dark");
});

test("a sweep of sixty cases is a picture with the choices of rugo plot, and a table to order and filter", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", SWEEP);
  assert.equal((await finished(url, id)).cases, 60);
  const page = await tab(t);
  const shown = (text) => page.waitForFunction((wanted) => decodeURIComponent(document.querySelector("img.picture")?.src ?? "").includes(wanted), {}, text);
  const command = () => page.$eval("main code:last-of-type", () => [...document.querySelectorAll("main code")].pop().textContent);
  await page.goto(`${url}/#/study/${id}`);
  await page.waitForFunction(() => document.querySelector("img.picture")?.naturalWidth > 100);
  assert.equal(await page.$eval(".tabs [aria-current]", (one) => one.textContent), "Pictures");
  assert.equal(await command(), `rugo plot ${id} --server ${url} --quantity contact_area`, "nothing is chosen but what run --out draws");
  await picture(page, "sweep");
  await pick(page, "over", "H"); // a value over a parameter, at a load
  await page.waitForFunction(() => [...document.querySelectorAll("main code")].pop().textContent.includes("@0.2 --x hurst"));
  await pick(page, "Colour", "L/");
  await pick(page, "Panel", "λ");
  await shown("hurst");
  assert.equal(await page.evaluate(() => document.activeElement.closest("label").textContent.startsWith("Panel")), true);
  await page.waitForFunction(() => document.querySelector("main p[role=status]").textContent === "");
  assert.ok((await command()).endsWith("--x hurst --colour length_ratio --panel wavelength_ratio"), await command());
  await picture(page, "sweep-hurst");
  await pick(page, "H", "0.5");
  await page.waitForFunction(() => document.querySelector("main p[role=status]").textContent !== "Drawing …");
  assert.ok((await command()).includes("--where hurst=0.5"));
  await press(page, `a[href$="/table"]`);
  await says(page, "60 cases; values");
  await pick(page, "H", "0.5");
  await says(page, "12 of 60 cases");
  await press(page, "thead th:nth-child(4) button"); // wavelengths, lengths: the last that is swept
  await press(page, "thead th:nth-child(4) button");
  const column = await page.$$eval("tbody tr", (all) => all.map((one) => Number(one.cells[3].textContent)));
  assert.deepEqual(column, [4, 4, 4, 4, 3, 3, 3, 3, 2, 2, 2, 2]);
  await picture(page, "sweep-table");
  await press(page, `a[href$="/curves"]`);
  await page.waitForSelector(".uplot canvas");
  await press(page, ".cases summary");
  await pick(page, "λ", "3");
  await page.waitForFunction(() => document.querySelector(".cases summary").textContent === "Cases: 12 of 60" && document.querySelectorAll(".cases .grid label").length === 15);
  await picture(page, "sweep-curves");
});

test("a table of ten thousand cases is drawn in pages", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...SWEEP, name: "few", surface: { ...SWEEP.surface, wavelength_ratio: 2, length_ratio: 2 } });
  await finished(url, id);
  const few = { contents: await send(url, "GET", `/v1/studies/${id}/contents`), table: await send(url, "GET", `/v1/studies/${id}/table`) };
  const at = few.table.columns.findIndex((one) => one.name === "hurst"), hurst = (k) => (k % 100) / 100;
  few.contents.cases = Array.from({ length: 10000 }, (_, k) => ({ ...few.contents.cases[k % 5], case: k, swept: { "/surface/hurst": hurst(k) } }));
  few.table.rows = few.contents.cases.map(({ case: k }) => ({ ...few.table.rows[k % 5], case: k, values: few.table.rows[k % 5].values.map((value, c) => (c === at ? hurst(k) : value)) }));
  const page = await tab(t);
  await page.setRequestInterception(true);
  page.on("request", (request) => {
    const part = request.url().match(/\/(contents|table)$/)?.[1];
    if (part) request.respond({ contentType: "application/json", body: JSON.stringify(few[part]) });
    else request.continue();
  });
  await page.goto(`${url}/#/study/${id}/table`);
  await says(page, "rows 1 to 100 of 10000");
  assert.equal(await page.$$eval("tbody tr", (all) => all.length), 100);
  const began = Date.now();
  await press(page, `thead th:nth-child(${at + 2}) button`);
  await page.waitForFunction((nth) => document.querySelectorAll("thead th")[nth].getAttribute("aria-sort") === "ascending", {}, at + 1);
  t.diagnostic(`ordered within ${Date.now() - began} ms`);
  assert.deepEqual(await page.$$eval("tbody tr", (all, nth) => [...new Set(all.map((one) => one.cells[nth].textContent))], at + 1), ["0"]);
  await page.evaluate(() => [...document.querySelectorAll("button")].find((one) => one.textContent.startsWith("next")).focus());
  await page.keyboard.press("Enter");
  await says(page, "rows 101 to 200 of 10000");
  assert.ok((await page.evaluate(() => document.activeElement.textContent)).startsWith("next"));
  await pick(page, "H", "0.42");
  await says(page, "100 of 10000 cases");
  await picture(page, "many-table");
});

test("an open table of values, a control's focus and the curves' own stay while results come in", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...LONG, name: "live" });
  t.after(() => send(url, "DELETE", `/v1/studies/${id}`));
  const page = await tab(t);
  const revision = async () => (await send(url, "GET", `/v1/studies/${id}`)).revision;
  const later = async () => { // results of a later revision are drawn
    const now = await revision();
    await page.waitForResponse(async (answer) => answer.url().includes("/curves?") && (await revision()) > now);
    await page.waitForFunction(() => !document.body.innerText.includes("Loading …"));
  };
  await page.goto(`${url}/#/study/${id}`);
  await page.waitForSelector(".uplot canvas");
  const box = await page.waitForFunction(() => [...document.querySelectorAll("label.tick")].find((one) => one.textContent.trim() === "log y").querySelector("input"));
  await press(page, "details:not([hidden]) > summary");
  await page.waitForSelector("details[open] tbody tr");
  await box.focus();
  await later();
  assert.ok(await box.evaluate((one) => one === document.activeElement));
  assert.ok(await page.$("details[open] tbody tr"));
  await page.keyboard.press("Space");
  await page.focus(".chart");
  await later();
  assert.ok(await page.evaluate(() => document.activeElement.className === "chart"));
  assert.ok(await box.evaluate((one) => one.checked && one.isConnected));
});

test("the first results are drawn once, however many come in while they are fetched", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...LONG, name: "first" });
  t.after(() => send(url, "DELETE", `/v1/studies/${id}`));
  const page = await tab(t), path = `/v1/studies/${id}`;
  let asked = 0, under = 0, most = 0;
  await page.setRequestInterception(true);
  page.on("request", async (request) => {
    if (!request.url().endsWith("/contents")) return request.continue();
    const first = asked++ === 0;
    most = Math.max(most, ++under);
    const answer = await send(url, "GET", `${path}/contents`), { revision } = await send(url, "GET", path);
    if (!first) // until two more revisions are there
      for (const until = Date.now() + WAIT_MS; (await send(url, "GET", path)).revision < revision + 2 && Date.now() < until;) await new Promise((done) => setTimeout(done, 100));
    under--;
    request.respond({ contentType: "application/json", body: JSON.stringify(first ? { ...answer, curves: [], scalars: [] } : answer) });
  });
  await page.goto(`${url}/#/study/${id}/curves`);
  await page.waitForSelector(".uplot canvas");
  assert.equal(most, 1, "one list of what there is under way at a time");
});

test("Cancel is pressed while events come in, and its button stays what it is", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", LONG);
  const page = await tab(t);
  let asked = 0;
  page.on("dialog", (dialog) => (++asked < 20 ? dialog.dismiss() : dialog.accept()));
  await page.goto(`${url}/#/study/${id}`);
  await page.waitForSelector("dd .running");
  const button = await page.waitForSelector(".tools button");
  assert.equal(await button.evaluate((one) => one.textContent), "Cancel");
  const share = () => page.$eval("main progress", (one) => one.value);
  const began = await share();
  for (let k = 1; k <= 20; k++) {
    await button.click({ delay: 90 });
    for (const until = Date.now() + WAIT_MS / 6; asked < k && Date.now() < until;) await new Promise((done) => setTimeout(done, 20)); // the dialog is reported apart from the click
    assert.equal(asked, k, "each click asks");
  }
  await page.waitForSelector("dd .cancelled");
  t.diagnostic(`share ${began} before, ${await share()} behind`);
});

test("a density that comes late does not replace what was chosen after it", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...LONG, name: "late", realisations: 4 });
  await finished(url, id);
  const page = await tab(t);
  let late = null;
  await page.setRequestInterception(true);
  page.on("request", (request) => {
    if (late === null && request.url().includes("/plot?quantity=summit_joint_pdf")) late = request;
    else request.continue();
  });
  await page.goto(`${url}/#/study/${id}/curves`);
  await page.waitForSelector(".uplot canvas");
  await pick(page, "Quantity", "summit joint PDF");
  for (const until = Date.now() + WAIT_MS; late === null && Date.now() < until;) await new Promise((done) => setTimeout(done, 20));
  await pick(page, "Quantity", "height PDF");
  await page.waitForFunction(() => document.querySelector(".chart")?.getAttribute("aria-label").includes("over"));
  await page.waitForFunction(() => document.querySelectorAll(".legend li").length > 0 && !document.body.innerText.includes("Loading …"));
  const answer = page.waitForResponse((one) => one.url().includes("/plot?quantity=summit_joint_pdf"));
  late.continue();
  await (await answer).text();
  await new Promise((done) => setTimeout(done, 500)); // for what the page would do with it
  assert.equal(await page.$("img.picture"), null);
  assert.ok(await page.$(".uplot canvas"));
});

test("a density of pits is shown and saved as such", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...LONG, name: "pits", realisations: 4, surface: { ...LONG.surface, hurst: [0.4, 0.6], heights: { distribution: "weibull_min", shape: 1.5, tolerance: 0.05 } } });
  await finished(url, id);
  const page = await tab(t), asked = [];
  page.on("request", (request) => request.url().includes("/plot?") && asked.push(new URL(request.url()).searchParams));
  await page.goto(`${url}/#/study/${id}/curves`);
  await page.waitForSelector(".uplot canvas");
  await press(page, ".cases summary");
  await press(page, ".cases .grid label:first-child input"); // the second case alone is left
  await pick(page, "Quantity", "summit joint PDF");
  await page.waitForFunction(() => document.querySelector("img.picture")?.naturalWidth > 100);
  await pick(page, "by", "pits");
  await page.waitForFunction(() => !document.body.innerText.includes("Loading …"));
  await page.evaluate(() => { HTMLAnchorElement.prototype.click = function () { globalThis.saved = this.download; }; });
  await page.evaluate(() => [...document.querySelectorAll(".links button")].find((one) => one.textContent === "SVG").click());
  await page.waitForFunction(() => globalThis.saved);
  assert.deepEqual(asked.map((one) => [one.get("case"), one.get("series")]), [["1", null], ["1", "pits"], ["1", "pits"]]);
});

test("a study that is deleted elsewhere is said to be, and no longer asked for", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", { ...LONG, name: "gone" });
  t.after(() => send(url, "DELETE", `/v1/studies/${id}`));
  const page = await tab(t);
  let asked = 0;
  await page.setRequestInterception(true);
  page.on("request", (request) => {
    asked += request.url().includes(id);
    if (request.url().endsWith("/events")) request.respond({ contentType: "text/event-stream", body: "event: deleted\ndata: {}\n\n" });
    else request.continue();
  });
  await page.goto(`${url}/#/study/${id}/jobs`);
  await says(page, "Study “gone” was deleted.");
  assert.deepEqual(await page.$$eval("main button", (all) => all.map((one) => one.textContent)), []);
  assert.ok(!(await page.title()).includes("undefined"), await page.title());
  const before = asked;
  await new Promise((done) => setTimeout(done, 4000)); // views ask every 3 s
  assert.equal(asked, before);
});
