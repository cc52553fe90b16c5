// What tests of the page do as a person does: tabs, real keys and clicks, reading.
import assert from "node:assert/strict";
import { WAIT_MS } from "./service.mjs";

const CLICK_MS = 90; // a person holds the button so long

/** A tab whose errors fail the test: scripts, requests that the test does not expect, refused contents. */
export async function tab(browser, t, expected = []) {
  const page = await browser.newPage(), faults = [];
  page.setDefaultTimeout(WAIT_MS);
  await page.setViewport({ width: 1300, height: 1100 });
  page.on("pageerror", (error) => faults.push(error.message));
  page.on("console", (message) => message.type() === "error" && !message.text().startsWith("Failed to load resource") && faults.push(message.text()));
  page.on("response", (answer) => answer.status() >= 400 && !expected.includes(answer.status()) && faults.push(`${answer.status()} ${answer.url()}`));
  t.after(async () => {
    await page.close();
    assert.deepEqual(faults, []);
  });
  return page;
}

export function says(page, text) {
  return page.waitForFunction((wanted) => document.body.innerText.includes(wanted), { timeout: WAIT_MS }, text);
}

/** Presses the mouse on what a selector finds, for as long as a person does. */
export async function press(page, selector, options = {}) {
  const element = await page.waitForSelector(selector, { visible: true });
  await element.scrollIntoView();
  await element.click({ delay: CLICK_MS, ...options });
}

/** Replaces what a field holds by keys. */
export async function retype(page, selector, text) {
  await press(page, selector, { count: 3 });
  await page.keyboard.type(text);
}

/** Chooses the option of a list whose text begins so, by the arrow keys. */
export async function pick(page, label, text) {
  const list = await page.waitForFunction((name) => [...document.querySelectorAll("label.choice")].find((one) => one.textContent.startsWith(name) && one.offsetParent)?.querySelector("select"), {}, label);
  await list.focus();
  const far = await list.evaluate((one, wanted) => [...one.options].findIndex((option) => option.textContent.startsWith(wanted)) - one.selectedIndex, text);
  for (let k = 0; k < Math.abs(far); k++) await page.keyboard.press(far > 0 ? "ArrowDown" : "ArrowUp");
}
