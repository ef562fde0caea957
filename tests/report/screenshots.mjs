// Pictures of docs/gallery.md: the fields of each page, in Debian's Chromium.
//   node screenshots.mjs PAGES OUT NODE_MODULES
import path from "node:path";
import {pathToFileURL} from "node:url";

import {find_browser, SOFTWARE_GL} from "./browser.mjs";

const [pages, out, modules] = process.argv.slice(2);
const launch = find_browser(modules);
// Page: field, state (0 is the first; none: the last), diagram.
const shown = {
  footing: {field: "displacement", deformed: true}, anchored_excavation: {field: "displacement", diagram: "bending_moment"},
  slope: {field: "stress_level"}, earth_dam: {field: "head"}, embankment_on_clay: {field: "excess_pressure", state: 3},
  locking: {field: "mean_stress"}, culvert_slipping: {field: "stress_yy", diagram: "bending_moment"}, pile: {field: "stress_xy"},
};

const browser = await launch(SOFTWARE_GL);
for (const [name, look] of Object.entries(shown)) {
  const page = await browser.newPage({viewport: {width: name === "locking" ? 1100 : 900, height: 800}});
  await page.goto(pathToFileURL(path.join(pages, `${name}.html`)).href);
  await page.waitForFunction(() => window.sagefe);
  const list = (label) => page.locator("#views label.field", {hasText: label}).locator("select").first();
  await list("Field").selectOption(look.field);
  if (look.state !== undefined) await list("State").selectOption(String(look.state));
  if (look.diagram) await list("Diagram").selectOption(look.diagram);
  if (look.deformed) await page.getByLabel("deformed").first().check();
  await page.waitForTimeout(500);
  const box = await page.evaluate(() => {
    const boxes = [...document.querySelectorAll(".stage")].map((e) => e.getBoundingClientRect()), head = document.querySelector("#views").getBoundingClientRect();
    return {x: 0, y: head.top + scrollY, width: innerWidth, height: Math.max(...boxes.map((b) => b.bottom)) - head.top + 8};
  });
  await page.screenshot({path: path.join(out, `${name}.png`), fullPage: true, clip: box});
  await page.close();
}
await browser.close();
