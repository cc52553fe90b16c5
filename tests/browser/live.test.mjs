// Protects: what a person has chosen, typed or zoomed to stays while a study goes on; what the service refuses for a moment, or for one
// case, costs no more than that.
import assert from "node:assert/strict";
import { after, before, test as declare } from "node:test";
import { pick, press, says, tab as openTab } from "./hands.mjs";
import { end, finished, launch, send, serve, WAIT_MS } from "./service.mjs";

const SMALL = { seed: 1, surface: { hurst: 0.5, wavelength_ratio: 4, length_ratio: 4, points_per_wavelength: 8 } };
const RUNNING = { ...SMALL, name: "running", kind: "statistics", realisations: 1000000 };
const CONTACT = { ...SMALL, name: "pressures", kind: "contact", realisations: 2, contact: { model: "halfspace", pressures: { values: [0.05, 0.2] }, pressure_pdf: { at: [0.05, 0.2] } } };
let browser, url;
const LIMIT = { timeout: 5 * WAIT_MS };
const test = (name, body) => declare(name, LIMIT, body);
const tab = (t, expected) => openTab(browser, t, expected);

before(async () => {
  browser = await launch();
  url = await serve("live", "--workers", "1");
}, LIMIT);
after(async () => {
  await browser?.close();
  end();
});

async function run(t, study) {
  const { id } = await send(url, "POST", "/v1/studies", study);
  t.after(() => send(url, "DELETE", `/v1/studies/${id}`).catch(() => {}));
  return id;
}

/** Answers requests whose address matches in place of the service, as long as there is an answer for them. */
async function intercept(page, pattern, answerOf) {
  await page.setRequestInterception(true);
  page.on("request", async (request) => {
    const answer = pattern.test(request.url()) ? await answerOf(request) : null;
    if (answer) request.respond(answer);
    else request.continue();
  });
}

const busy = { status: 503, contentType: "application/problem+json", body: JSON.stringify({ detail: "busy for a moment" }) };
const later = async (page, id) => { // results of two later revisions are drawn
  for (let k = 0; k < 2; k++) await page.waitForResponse((answer) => answer.url().includes(`${id}/curves?`));
  await page.waitForFunction(() => !document.body.innerText.includes("Loading …"));
};

test("zoom and readout stay while results come in", async (t) => {
  const page = await tab(t), id = await run(t, RUNNING);
  await page.goto(`${url}/#/study/${id}/curves`);
  await page.waitForSelector(".uplot .u-over");
  const box = () => page.$eval(".uplot .u-over", (one) => one.getBoundingClientRect().toJSON());
  const read = () => page.$eval(".readout", (one) => Number(one.textContent.match(/ = ([^,]*),/)?.[1]));
  const rightmost = async () => { // the place of the curve that is read at the right edge
    const { right, top, bottom } = await box();
    for (let y = top + 5; y < bottom; y += 20) await page.mouse.move(right - 5, y);
    return read();
  };
  const whole = await rightmost(), { left, top, width, height } = await box();
  let zoomed = whole;
  for (let tries = 0; tries < 5 && !(zoomed < whole); tries++) { // results that come in end a drag
    await page.mouse.move(left + 0.3 * width, top + 0.02 * height);
    await page.mouse.down();
    await page.mouse.move(left + 0.6 * width, top + 0.98 * height, { steps: 5 });
    await page.mouse.up();
    zoomed = await rightmost();
  }
  assert.ok(zoomed < whole, `${zoomed} is the right edge, which was at ${whole}`);
  await page.mouse.move(2, 2);
  await page.focus(".chart");
  for (let k = 0; k < 5; k++) await page.keyboard.press("ArrowRight");
  const walked = await read();
  await later(page, id);
  assert.equal(await read(), walked, "what was read is still read");
  await page.keyboard.press("ArrowRight");
  assert.ok((await read()) > walked, "the next point is the one behind it");
  const still = await rightmost();
  assert.ok(still < whole, `${still} is the right edge; it was ${zoomed} when it was zoomed, ${whole} before`);
});

test("columns that are half typed are not asked for, and the table stays", async (t) => {
  const page = await tab(t), id = await run(t, RUNNING);
  await page.goto(`${url}/#/study/${id}/table`);
  await page.waitForSelector("tbody td.number");
  await press(page, "input[list=scalars]");
  await page.keyboard.type("summit_dens");
  for (let k = 0; k < 2; k++) await page.waitForResponse((answer) => answer.url().includes("/table"));
  assert.ok(await page.$("tbody td.number"));
  assert.equal(await page.$eval("input[list=scalars]", (one) => one.value), "summit_dens");
});

test("what is chosen of realisations stays while there are no results, and a busy service is asked again", async (t) => {
  const page = await tab(t, [503]), id = await run(t, { ...RUNNING, surface: { ...RUNNING.surface, hurst: [0.4, 0.6] } });
  let refused = 0, empty = true;
  await intercept(page, /\/map\?|\/contents$/, async (request) => {
    if (request.url().includes("/map?")) return refused++ < 2 ? busy : null;
    return { contentType: "application/json", body: JSON.stringify({ ...(await send(url, "GET", `/v1/studies/${id}/contents`)), ...(empty ? { curves: [], scalars: [] } : {}) }) };
  });
  await page.goto(`${url}/#/study/${id}/realisation`);
  await pick(page, "Case", "H = 0.6");
  await page.waitForSelector("canvas.map");
  assert.ok(refused > 2, "it was refused, and came");
  const { revision } = await send(url, "GET", `/v1/studies/${id}`);
  for (const until = Date.now() + WAIT_MS; (await send(url, "GET", `/v1/studies/${id}`)).revision < revision + 2 && Date.now() < until;) await new Promise((done) => setTimeout(done, 100));
  await new Promise((done) => setTimeout(done, 500)); // for what the page would do with it
  assert.equal(await page.$eval("label.choice select", (one) => one.selectedOptions[0].textContent), "H = 0.6");
  empty = false;
});

test("a case that cannot be shown leaves the others, and is named", async (t) => {
  const page = await tab(t, [422]), id = await run(t, { ...RUNNING, realisations: 20, surface: { ...RUNNING.surface, hurst: [0.4, 0.6] } });
  await finished(url, id);
  await intercept(page, /curves\?case=1&/, () => ({ status: 422, contentType: "application/problem+json", body: JSON.stringify({ detail: "block 3 is damaged" }) }));
  await page.goto(`${url}/#/study/${id}/curves`);
  await says(page, "H = 0.6: block 3 is damaged");
  assert.ok((await page.$$eval(".legend li", (all) => all.map((one) => one.textContent))).some((text) => text.includes("H = 0.4")));
});

test("densities of pressure at two loads have names of their own", async (t) => {
  const page = await tab(t), id = await run(t, CONTACT);
  await finished(url, id);
  await page.goto(`${url}/#/study/${id}/curves`);
  await page.waitForSelector(".uplot canvas");
  await pick(page, "Quantity", "contact pressure PDF");
  await says(page, "at p/(E* h′) = 0.05");
  await says(page, "at p/(E* h′) = 0.2");
});

test("a state is asked for where events are refused, and the report comes with the results", async (t) => {
  const page = await tab(t, [404, 422, 503]), id = await run(t, { ...CONTACT, realisations: 400 });
  await intercept(page, /\/events$/, () => busy);
  await page.goto(`${url}/#/study/${id}/report`);
  await finished(url, id);
  await says(page, "400 / 400");
  await page.waitForSelector("section .picture");
});

test("the form submits nothing while the text beside it is no study", async (t) => {
  const page = await tab(t, [422]);
  await page.goto(`${url}/#/new`);
  const isReady = () => [...document.querySelectorAll("main button")].some((one) => one.textContent === "Submit" && !one.disabled);
  await page.waitForFunction(isReady);
  await page.focus("textarea");
  await page.keyboard.down("Control");
  await page.keyboard.press("End");
  await page.keyboard.up("Control");
  await page.keyboard.type(" "); // it is a study still, and is to be checked
  await page.keyboard.type("x");
  await page.waitForNetworkIdle({ idleTime: 1000 });
  await says(page, "This is no JSON yet");
  assert.ok(!(await page.evaluate(isReady)));
  assert.ok(await page.$eval(".fields", (one) => one.inert));
  await page.keyboard.press("Backspace");
  await page.waitForFunction(isReady);
});

test("whole numbers have all their digits", async (t) => {
  const page = await tab(t);
  await page.goto(`${url}/#/new`);
  const texts = await page.evaluate(async () => (({ number }) => [12345, 16384, 1234567, 0.123456, 0].map((value) => number(value)))(await import("/web/elements.js")));
  assert.deepEqual(texts, ["12345", "16384", "1.235e+6", "0.1235", "0"]);
});
