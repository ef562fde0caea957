// The site of scripts/docs in a browser, from disk: no request leaves it, no error, equations are drawn, search finds.
//   node site.mjs SITE [NODE_MODULES]     77: no Chromium or no playwright-core
import assert from "node:assert/strict";
import path from "node:path";
import {pathToFileURL} from "node:url";

import {find_browser} from "./browser.mjs";

const [site, modules] = process.argv.slice(2);
const launch = find_browser(modules);

const browser = await launch();
const complaints = [];
const address = (name) => pathToFileURL(path.join(site, name.split("?")[0])).href + name.slice(name.split("?")[0].length);
async function open(name) {
  const page = await browser.newPage({viewport: {width: 1300, height: 900}});
  page.on("console", (m) => { if (m.type() === "error") complaints.push(`${name}: ${m.text()}`); });
  page.on("pageerror", (e) => complaints.push(`${name}: ${e.message}`));
  page.on("request", (r) => { if (!/^(file|blob|data):/.test(r.url())) complaints.push(`${name}: request of ${r.url()}`); });
  await page.goto(address(name));
  return page;
}

try {
  for (const name of ["index.html", "docs/tutorial/footing.html", "docs/manual/messages.html", "docs/verification.html", "docs/gallery.html"]) {
    const page = await open(name);
    assert.ok((await page.locator("h1").first().textContent()).length > 3, name);
    const broken = await page.evaluate(() => [...document.images].filter((i) => i.complete && i.naturalWidth === 0).map((i) => i.src));
    assert.deepEqual(broken, [], name);
    await page.close();
  }
  const theory = await open("docs/theory/large_strain.html");
  await theory.waitForSelector(".katex-display");
  assert.ok((await theory.locator(".katex").count()) > 10);
  assert.equal(await theory.locator(".katex-error").count(), 0);
  const search = await open("search.html?q=prestress");
  await search.waitForSelector("#search-results li a");
  const found = await search.locator("#search-results li a").evaluateAll((links) => links.map((l) => l.href));
  assert.ok(found.some((link) => link.includes("docs/manual/structures.html")), found.join());
  await search.locator("#search-results li a").first().click();
  await search.waitForSelector("h1");
  assert.deepEqual(complaints, []);
  console.log("site: pages, equations and search work from disk, no request");
} finally {
  await browser.close();
}
