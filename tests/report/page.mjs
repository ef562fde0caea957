// The page in a browser: opens from disk without a request or an error, and shows what the tables say.
//   node page.mjs SAGEFE SOURCE_FOLDER WORK_FOLDER [NODE_MODULES]     77: no Chromium or no playwright-core
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import fs from "node:fs";
import path from "node:path";
import {pathToFileURL} from "node:url";

import {find_browser, SOFTWARE_GL} from "./browser.mjs";

const [program, source, work, modules] = process.argv.slice(2);
const launch = find_browser(modules);

fs.rmSync(work, {recursive: true, force: true});
fs.mkdirSync(work, {recursive: true});
const sagefe = (...words) => execFileSync(program, words, {cwd: work, stdio: "pipe"});
const deck = (name) => path.join(source, "legacy_inputs", name, "deck.dat");
const title = "</script><script>window.hacked = 1</script><img src=x onerror=\"window.hacked = 2\">";
fs.writeFileSync(path.join(work, "script.dat"), title + fs.readFileSync(deck("chapter7/pinned_ld2_nu025"), "utf8").replace(/^.*/, ""));
sagefe("run", deck("structures/braced_cut"), "-q", "--report", "--points", "--nodes");
sagefe("run", deck("chapter7/dp_285"), "-q", "--report", "--points", "--states", "1:50");
fs.copyFileSync(deck("chapter7/dp_285"), path.join(work, "b_bar.dat"));
sagefe("run", "b_bar.dat", "-q", "--result", "--formulation", "2");
fs.mkdirSync(path.join(work, "out"), {recursive: true});
fs.writeFileSync(path.join(work, "out", "script.safety.lst"), `${title}\nsafety factor between 1.5 and 1.6\n\nF = 1.6`);
sagefe("run", "script.dat", "-q", "--report");
sagefe("run", path.join(source, "legacy_inputs/models/embankment_on_clay.sage.toml"), "-q", "--report");
fs.writeFileSync(path.join(work, "out", "study.sweep.csv"), `# ${title}\ncase,nu[-],ratio[-],status,reason\n1,0.2,1.5,ok,\n2,0.3,1.25,ok,${title.replace(/[",]/g, "")}\n3,0.4,,failed,p2.html\n`);
sagefe("report", "out/study.sweep.csv");
sagefe("report", "out/dp_285.h5", "out/b_bar", "--name", "two");

// Rows of a table by their named columns.
function csv(name) {
  const lines = fs.readFileSync(path.join(work, "out", name), "utf8").split("\n").filter((l) => l && !l.startsWith("#"));
  const names = lines[0].split(",").map((n) => n.replace(/\[.*/, ""));
  return lines.slice(1).map((line) => Object.fromEntries(line.split(",").map((cell, i) => [names[i], cell])));
}
const close = (a, b, what) => assert.ok(Math.abs(a - b) <= 1e-9 * Math.max(Math.abs(a), Math.abs(b)) + 1e-300, `${what}: ${a}, table ${b}`);

const browser = await launch(SOFTWARE_GL);
const complaints = [];
async function open(name, hash = "") {
  const page = await browser.newPage({viewport: {width: 1400, height: 900}});
  page.setDefaultTimeout(0);  // no clock decides; ctest ends a page that never comes
  const url = pathToFileURL(path.join(work, "out", name)).href;
  page.on("console", (m) => { if (m.type() === "error") complaints.push(`${name}: ${m.text()}`); });
  page.on("pageerror", (e) => complaints.push(`${name}: ${e.message}`));
  page.on("request", (r) => { if (!/^(blob|data):/.test(r.url()) && r.url().split("#")[0] !== url) complaints.push(`${name}: request of ${r.url()}`); });
  await page.goto(url + hash);
  await page.waitForFunction(() => window.sagefe);
  return page;
}
const probe = (page, run = 0) => page.evaluate((i) => {
  const box = document.querySelectorAll(".probe")[i];
  return {element: Number(box.dataset.element), point: Number(box.dataset.point), node: Number(box.dataset.node), text: box.textContent,
          values: Object.fromEntries([...box.querySelectorAll("dl:not(.line) dd")].map((d) => [d.dataset.column, [Number(d.dataset.value), d.textContent]]))};
}, run);
// A place of the mesh in pixels of the window.
const screen = (page, run, x, y) => page.evaluate(([i, a, b]) => {
  const view = window.sagefe.page.views[i], box = view.over.getBoundingClientRect(), at = view.to_screen(a, b);
  return [box.left + at[0], box.top + at[1]];
}, [run, x, y]);
const state_list = (page) => page.locator("#views label.field", {hasText: "State"}).locator("select").first();

async function probes_equal_the_tables() {
  const page = await open("braced_cut.html"), points = csv("braced_cut.points.csv"), nodes = csv("braced_cut.nodes.csv");
  const last = points.filter((r) => r.stage === "5" && r.increment === "2");
  await page.locator("canvas.over").scrollIntoViewIfNeeded();
  let compared = 0;
  const compare = (found, row) => {
    for (const column of ["stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_level"]) {
      close(found.values[column][0], Number(row[column]), `element ${found.element}, ${column}`);
      assert.equal(Number.parseFloat(found.values[column][1]), Number(row[column]), "as shown");
    }
    const node = nodes.find((r) => r.stage === "5" && r.increment === "2" && Number(r.node) === found.node);
    close(found.values.ux[0], Number(node.ux), `node ${found.node}`);
    ++compared;
  };
  for (let i = 0; i < 12; ++i) {  // by the pointer, at integration points
    const row = last[Math.floor(((i + 0.5) * last.length) / 12)];
    await page.mouse.move(...(await screen(page, 0, Number(row.x), Number(row.y))));
    const found = await probe(page);
    assert.equal(found.element, Number(row.element));
    assert.equal(found.point, Number(row.point));
    compare(found, row);
  }
  for (let i = 0; i < 8; ++i) {  // by number
    const row = last[Math.floor(((i + 0.25) * last.length) / 8)];
    await page.getByLabel("element number").fill(row.element);
    await page.getByLabel("integration point").fill(row.point);
    await page.keyboard.press("Enter");
    compare(await probe(page), row);
  }
  assert.equal(compared, 20);
  // Another state has other values.
  await state_list(page).selectOption("0");
  const first = points.find((r) => r.stage === "1" && r.element === "100" && r.point === "2");
  await page.getByLabel("element number").fill("100");
  await page.getByLabel("integration point").fill("2");
  await page.keyboard.press("Enter");
  close((await probe(page)).values.stress_yy[0], Number(first.stress_yy), "first state");
  // A message leads to its line of the deck.
  const link = page.locator("#messages a").first(), line = Number((await link.textContent()).match(/\d+/)[0]);
  const lines = fs.readFileSync(deck("structures/braced_cut"), "utf8").split("\n");
  assert.equal(await page.locator((await link.getAttribute("href"))).locator("code").textContent(), lines[line - 1]);
  return page;
}

async function keyboard_alone(page) {
  await page.locator("canvas.over").focus();
  const field = page.locator("#views label.field", {hasText: "Field"}).locator("select"), before = await field.inputValue();
  await page.keyboard.press("f");
  assert.notEqual(await field.inputValue(), before);
  await page.keyboard.press("0");
  await page.keyboard.press("]");
  assert.equal(await state_list(page).inputValue(), "1");
  const start = await page.evaluate(() => { const v = window.sagefe.page.views[0]; v.pinned = false; return window.sagefe.page.probe(v, [15, -6]), v.probe_place; });
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
  const moved = await page.evaluate(() => window.sagefe.page.views[0].probe_place);
  assert.ok(moved[0] > start[0] && moved[1] === start[1]);
  const zoom = await page.evaluate(() => window.sagefe.page.views[0].camera.zoom);
  await page.keyboard.press("+");
  close(await page.evaluate(() => window.sagefe.page.views[0].camera.zoom), 1.25 * zoom, "zoom");
  await page.keyboard.press("Shift+ArrowUp");
  // Every control is reached by Tab, and shows it.
  const reached = await page.evaluate(() => [...document.querySelectorAll("button, select, input, a[href], canvas.over, .chart")].every((e) => e.tabIndex >= 0));
  assert.ok(reached);
}

async function files_and_paper(page) {
  const download = async (button) => {
    const [file] = await Promise.all([page.waitForEvent("download"), button.click()]);
    return fs.readFileSync(await file.path());
  };
  const view = page.locator("figure.view");
  const svg = (await download(view.getByRole("button", {name: "SVG"}))).toString();
  assert.ok(svg.startsWith("<svg") && svg.includes("Braced excavation") && svg.split("<path").length > 200);
  assert.equal((await download(view.getByRole("button", {name: "PNG"}))).subarray(1, 4).toString(), "PNG");
  const card = page.locator("[data-table=increments]");
  const rows = (await download(card.getByRole("button", {name: "CSV"}))).toString().trim().split("\n").slice(1).map((r) => Number(r.split(",")[2]));
  const wanted = csv("braced_cut.increments.csv").map((r) => Number(r.relative_force)).filter((v) => v > 0);
  assert.equal(rows.length, wanted.length);
  rows.forEach((v, i) => close(v, wanted[i], "curve"));
  assert.ok((await download(card.getByRole("button", {name: "SVG"}))).toString().includes("relative_force"));
  // On paper one canvas has it all, in colours; afterwards both are back.
  const paper = await page.evaluate(() => {
    window.dispatchEvent(new Event("beforeprint"));
    const seen = [...document.querySelectorAll(".stage canvas")].filter((c) => !c.hidden), c = seen[0], data = c.getContext("2d").getImageData(0, 0, c.width, c.height).data;
    const colours = new Set();
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] === 255) colours.add(data[i] * 65536 + data[i + 1] * 256 + data[i + 2]);
    const found = {canvases: seen.length, colours: colours.size, closed: document.querySelectorAll("details:not([open])").length};
    window.dispatchEvent(new Event("afterprint"));
    return {...found, after: [...document.querySelectorAll(".stage canvas")].filter((one) => !one.hidden).length};
  });
  assert.ok(paper.canvases === 1 && paper.colours > 6 && paper.closed === 0 && paper.after === 2, JSON.stringify(paper));
  const pdf = await page.pdf({format: "A4"});
  assert.ok(pdf.subarray(0, 5).toString() === "%PDF-" && pdf.length > 60000, `${pdf.length} bytes of PDF`);
}

async function linked_views() {
  const page = await open("two.html"), cameras = () => page.evaluate(() => window.sagefe.page.views.map((v) => [v.camera.x, v.camera.y, v.camera.zoom]));
  await page.locator("canvas.over").first().scrollIntoViewIfNeeded();
  const [a, b] = await page.evaluate(() => window.sagefe.page.runs[0].point_place(window.sagefe.page.runs[0].groups[0], 100, 0));
  await page.mouse.move(...(await screen(page, 0, a, b)));
  const left = await probe(page, 0), right = await probe(page, 1);
  assert.equal(left.element, right.element);
  assert.notEqual(left.values.stress_yy[0], right.values.stress_yy[0]);
  await page.mouse.wheel(0, -300);
  await page.waitForFunction((zoom) => window.sagefe.page.views[0].camera.zoom > 1.2 * zoom, (await cameras())[0][2] / 1.5);
  const linked = await cameras();
  assert.deepEqual(linked[0], linked[1]);
  await page.getByLabel("linked views").uncheck();
  await page.locator("canvas.over").first().focus();
  await page.keyboard.press("+");
  const apart = await cameras();
  assert.notEqual(apart[0][2], apart[1][2]);
  // Curves of both runs in one plot.
  const labels = await page.locator("[data-table=report1] .legend li").allTextContents();
  assert.ok(labels.some((l) => l.startsWith("dp_285")) && labels.some((l) => l.startsWith("b_bar")), labels.join());
  await page.close();
}

// The picture without WebGL has the same colours; the canvas is read inside the meshes.
async function without_webgl() {
  const colours = async (hash) => {
    const page = await open("dp_285.html", hash);
    const found = await page.evaluate(() => {
      const view = window.sagefe.page.views[0], run = view.run, group = run.groups[0], copy = document.createElement("canvas");
      copy.width = view.under.width;
      copy.height = view.under.height;
      window.sagefe.page.settings.mesh = false;
      window.sagefe.page.redraw();
      const c = copy.getContext("2d");
      c.drawImage(view.under, 0, 0);
      const list = [];
      for (let e = 0; e < group.elements; e += 7) {
        const [x, y] = view.to_screen(...run.point_place(group, e, 0));
        list.push([...c.getImageData(Math.round(x * view.ratio), Math.round(y * view.ratio), 1, 1).data]);
      }
      return {gl: !!view.gl, list};
    });
    await page.close();
    return found;
  };
  const [with_gl, still] = [await colours(""), await colours("#nowebgl")];
  assert.ok(with_gl.gl && !still.gl);
  const same = with_gl.list.filter((c, i) => c.every((v, k) => Math.abs(v - still.list[i][k]) <= 3)).length;
  assert.ok(same > 0.85 * with_gl.list.length, `${same} of ${with_gl.list.length} colours are the same`);
  assert.ok(new Set(with_gl.list.map(String)).size > 3);
}

async function names_stay_text() {
  const page = await open("script.html");
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal((await page.locator("h1").textContent()).slice(0, 60), title.slice(0, 60));
  assert.equal(await page.locator("#answers pre").textContent(), `${title}\nsafety factor between 1.5 and 1.6`);
  await page.close();
}

// Corners alone have an excess pressure; between them it is linear, so that the whole clay has colours.
async function pressures_between_corners() {
  const page = await open("embankment_on_clay.html"), last = csv("embankment_on_clay.report1.csv").length;
  const found = await page.evaluate(() => {
    const run = window.sagefe.page.runs[0], group = run.groups[0], choice = run.choice("excess_pressure"), state = 3;
    const values = run.values(state, choice)[0], raw = run.at_nodes(state, "excess_pressure", 0);
    let blank = 0, off = 0;
    for (const value of values) if (!Number.isFinite(value)) ++blank;
    for (let e = 0; e < group.elements; ++e) {
      const of = [0, 1, 2, 3].map((i) => raw[group.node(e, i)]), own = values.slice(e * group.places, (e + 1) * group.places);
      off = Math.max(off, Math.max(...own) - Math.max(...of), Math.min(...of) - Math.min(...own));
    }
    return {values: values.length, blank, off, middles: Number.isNaN(raw[group.node(0, 4)])};
  });
  assert.ok(last > 0 && found.values > 0 && found.middles);
  assert.ok(found.blank === 0 && found.off < 1e-4, JSON.stringify(found));
  await page.close();
}

async function table_of_cases() {
  const page = await open("study.sweep.html"), [file] = await Promise.all([page.waitForEvent("download"), page.getByRole("button", {name: "CSV"}).click()]);
  const rows = fs.readFileSync(await file.path(), "utf8").trim().split("\n").slice(1).map((r) => r.split(",").slice(1, 3).map(Number));
  assert.deepEqual(rows, [[0.2, 1.5], [0.3, 1.25]]);
  assert.equal(await page.evaluate(() => window.hacked), undefined);
  assert.equal(await page.locator("#rows tbody tr").count(), 3);
  assert.equal(await page.locator("#rows a").getAttribute("href"), "p2.html");
  await page.close();
}

try {
  const page = await probes_equal_the_tables();
  await keyboard_alone(page);
  await files_and_paper(page);
  await linked_views();
  await without_webgl();
  await names_stay_text();
  await pressures_between_corners();
  await table_of_cases();
  assert.deepEqual(complaints, []);
  console.log("9 passed, 0 failed");
} finally {
  await browser.close();
}
