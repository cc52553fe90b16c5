// Protects: what a person does by real keys and clicks while the page goes on by itself: nothing that is typed, chosen or pressed is
// lost, and what a study lacks is said where it is looked for.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test as declare } from "node:test";
import { press, retype, says, tab as openTab } from "./hands.mjs";
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
  contact: { model: "full", levels: [3, 6], block_height: { lengths: 1 }, pressures: { values: [5] } } };
const TARGET = { name: "target", kind: "contact", seed: 1, target: { error: 0.02 }, surface: { dimension: 1, hurst: 0.8, wavelength_ratio: 2 },
  contact: { model: "halfspace", pressures: { values: [0.1, 0.2] } } };
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
});

test("a target shows one error: in its state, in its sources by size, and where its picture stands", async (t) => {
  const { id } = await send(url, "POST", "/v1/studies", TARGET);
  const { error_reached: reached } = await finished(url, id);
  const page = await tab(t);
  await page.goto(`${url}/#/study/${id}/report`);
  const text = `${(100 * reached).toPrecision(3)} %`;
  await says(page, `asked 2 %, reached ${Number.parseFloat(text)} %: `);
  assert.ok((await page.$eval(".facts", (one) => one.textContent)).includes(text));
  const line = await page.$eval(".reached li", (one) => one.textContent), sizes = [...line.split(": ").pop().matchAll(/ ([0-9.e-]+) %/g)].map((one) => Number(one[1]));
  assert.ok(line.includes("solver") && line.includes("statistical"));
  assert.ok(sizes.length >= 3 && sizes.every((size, k) => k === 0 || size <= sizes[k - 1]), line);
  assert.ok(Math.abs(Math.hypot(...sizes) / (100 * reached) - 1) < 0.01, "the sources make up the error");
  const svg = decodeURIComponent((await page.$eval("img.picture", (one) => one.src)).split(",").slice(1).join(","));
  assert.ok(!svg.includes("level nan"), "the legend has no level where there is none");
  await picture(page, "target");
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
    assert.equal(asked, k, "each click asks");
  }
  await page.waitForSelector("dd .cancelled");
  t.diagnostic(`share ${began} before, ${await share()} behind`);
});
