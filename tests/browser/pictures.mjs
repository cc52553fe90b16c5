// Draws the page as the README shows it: small parts of two ready studies, into the folder PICTURES.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { end, finished, launch, send, serve } from "./service.mjs";

const { PICTURES, STUDIES } = process.env;
const read = (name) => JSON.parse(readFileSync(join(STUDIES, `${name}.json`)));

const contact = read("rce-weibull-2d"), statistics = read("gaussian-nayak");
Object.assign(contact.surface, { hurst: 0.8, wavelength_ratio: 8 });
Object.assign(contact.contact, { model: "layered" });
Object.assign(statistics, { realisations: 60 });
statistics.statistics.bins.height = [-4, 6, 100];
Object.assign(statistics.surface, { wavelength_ratio: [8, 16] });

async function shoot(page, name) {
  await page.waitForNetworkIdle({ idleTime: 300 });
  await page.evaluate(() => { document.activeElement.blur(); scrollTo(0, 0); });
  await page.screenshot({ path: join(PICTURES, `page-${name}.png`), fullPage: true });
}

let browser;
try {
  const url = await serve("pictures", "--workers", "2");
  browser = await launch();
  const page = await browser.newPage();
  await page.setViewport({ width: 1200, height: 800 });
  for (const study of [contact, statistics]) {
    study.id = (await send(url, "POST", "/v1/studies", study)).id;
    const { state } = await finished(url, study.id);
    if (state !== "done") throw new Error(`${study.name} is ${state}`);
    await page.goto(`${url}/#/study/${study.id}/curves`);
    await page.waitForSelector(".uplot canvas");
    if (study === statistics) await page.select("label.choice select", "summit_height_pdf");
    await shoot(page, study.name);
  }
} finally {
  await browser?.close();
  end();
}
