// Line plots by uPlot.  Curves of runs may turn back, so each has its own x (uPlot's mode 2).
import uPlot from "uplot";
import {button, check, file_name, h, save, select, style_of} from "./dom.js";
import {line_colours, nice_step, text_of} from "./fields.js";
import {SvgPen} from "./pen.js";

const dashes = [[], [8, 4], [2, 3], [10, 3, 2, 3]];

// series: [{label, x: [], y: [], steps: [[stage, increment]] or null, run, dash, points}]
export class Chart {
  // page: {step(run, stage, increment, from), chosen(run, stage, increment)}; options: {x, y (labels), log_y, log_x, name}
  constructor(page, options) {
    this.page = page;
    this.options = options;
    this.box = h("div", {class: "chart", tabindex: 0, role: "img", "aria-label": options.name + ". Left and right move the cursor along the first curve."});
    this.readout = h("p", {class: "readout", "aria-live": "polite"});
    this.box.addEventListener("keydown", (e) => {
      const step = {ArrowLeft: -1, ArrowRight: 1}[e.key];
      if (!step || !this.series.length) return;
      e.preventDefault();
      const [s, i] = this.at || [0, -1], last = this.series[s].x.length - 1;
      this.mark(s, Math.min(last, Math.max(0, i + step)), true);
    });
  }
  set(series, options = {}) {
    Object.assign(this.options, options);
    this.series = series.map((s) => ({...s, ...this.clean(s)}));
    this.at = null;
    this.draw();
  }
  // Without what has no place on the axes.
  clean(s) {
    const keep = [];
    for (let i = 0; i < s.x.length; ++i)
      if (Number.isFinite(s.x[i]) && Number.isFinite(s.y[i]) && (!this.options.log_y || s.y[i] > 0) && (!this.options.log_x || s.x[i] > 0)) keep.push(i);
    return {x: keep.map((i) => s.x[i]), y: keep.map((i) => s.y[i]), steps: s.steps ? keep.map((i) => s.steps[i]) : null};
  }
  colour(i) { return line_colours[i % line_colours.length] === "#000000" ? style_of("--ink") : line_colours[i % line_colours.length]; }
  range(axis) {
    let low = Infinity, high = -Infinity;
    for (const s of this.series) for (const v of s[axis]) { low = Math.min(low, v); high = Math.max(high, v); }
    if (!(low <= high)) return [0, 1];
    if (this.options["log_" + axis]) return [10 ** Math.floor(Math.log10(low) + 1e-9), 10 ** Math.ceil(Math.log10(high) - 1e-9 + (low === high ? 1 : 0))];
    if (low === high) return [low - (Math.abs(low) || 1) * 0.1, high + (Math.abs(high) || 1) * 0.1];
    const edge = 0.04 * (high - low);
    return [low === 0 ? 0 : low - edge, high === 0 ? 0 : high + edge];
  }
  draw() {
    if (this.plot) this.plot.destroy();
    const ink = style_of("--ink"), faint = style_of("--grid"), self = this;
    const paths = (u, s) => {
      const line = new Path2D(), [xs, ys] = u.data[s];
      for (let i = 0; i < xs.length; ++i) {
        const x = u.valToPos(xs[i], "x", true), y = u.valToPos(ys[i], "y", true);
        if (i && !this.options.scatter) line.lineTo(x, y);
        else line.moveTo(x, y);
      }
      return {stroke: line, fill: null, clip: null, band: null, gaps: null, flags: 1};
    };
    const few = this.options.scatter || this.series.length * Math.max(1, ...this.series.map((s) => s.x.length)) < 150;
    const points = (u, s) => {
      const [xs, ys] = u.data[s], c = u.ctx;
      c.save();
      c.fillStyle = self.colour(s - 1);
      for (let i = 0; i < xs.length; ++i) {
        c.beginPath();
        c.arc(u.valToPos(xs[i], "x", true), u.valToPos(ys[i], "y", true), 2.4 * devicePixelRatio, 0, 7);
        c.fill();
      }
      c.restore();
    };
    const axis = (label, log) => ({stroke: ink, grid: {stroke: faint, width: 1}, ticks: {stroke: faint, width: 1}, label, labelSize: 20, labelFont: "12px system-ui", font: "11px system-ui",
      values: (u, ticks) => ticks.map((v) => (!log ? text_of(v, 7) : v > 0 && Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-6 ? text_of(v, 3) : ""))});
    const [rx, ry] = [this.range("x"), this.range("y")];
    this.plot = new uPlot({
      mode: 2, width: this.box.clientWidth || 460, height: this.options.height || 260, legend: {show: false}, pxAlign: 0,
      scales: {x: {time: false, auto: false, range: () => rx, distr: this.options.log_x ? 3 : 1}, y: {auto: false, range: () => ry, distr: this.options.log_y ? 3 : 1}},
      axes: [{...axis(this.options.x, this.options.log_x), size: 34}, {...axis(this.options.y, this.options.log_y), size: 62}],
      cursor: {drag: {x: false, y: false}, points: {show: false}, x: true, y: true},
      series: [{}, ...this.series.map((s, i) => ({stroke: this.colour(i), width: 1.8, dash: s.dash || [], paths, points: {show: false}, facets: [{scale: "x"}, {scale: "y"}]}))],
      hooks: {draw: [(u) => { if (few) this.series.forEach((s, i) => points(u, i + 1)); this.draw_mark(u); }]},
    }, [null, ...this.series.map((s) => [s.x, s.y])], this.box);
    this.plot.over.addEventListener("mousemove", (e) => this.hover(e));
    this.plot.over.addEventListener("click", () => {
      if (!this.at) return;
      const [s, i] = this.at, one = this.series[s];
      if (one.steps) this.page.chosen(one.run, ...one.steps[i]);
    });
  }
  hover(e) {
    const box = this.plot.over.getBoundingClientRect(), x = e.clientX - box.left, y = e.clientY - box.top;
    let best = null, least = Infinity;
    this.series.forEach((one, s) => {
      for (let i = 0; i < one.x.length; ++i) {
        const d = Math.hypot(this.plot.valToPos(one.x[i], "x") - x, this.plot.valToPos(one.y[i], "y") - y);
        if (d < least) [least, best] = [d, [s, i]];
      }
    });
    if (best) this.mark(...best, true);
  }
  // A point of a curve; the other charts mark the same increment.
  mark(s, i, tell) {
    this.at = [s, i];
    const one = this.series[s], step = one.steps && one.steps[i];
    this.readout.textContent = `${one.label}: ${this.options.x} ${text_of(one.x[i], 7)}, ${text_of(one.y[i], 7)}` + (step ? ` (stage ${step[0]}, increment ${step[1]})` : "");
    this.plot.redraw(false, false);
    if (tell && step) this.page.step(one.run, ...step, this);
  }
  mark_step(run, stage, increment) {
    const s = this.series.findIndex((one) => one.run === run && one.steps);
    if (s < 0) return;
    const i = this.series[s].steps.findIndex((step) => step[0] === stage && step[1] === increment);
    if (i >= 0) this.mark(s, i, false);
  }
  draw_mark(u) {
    if (!this.at) return;
    const [s, i] = this.at, one = this.series[s], c = u.ctx;
    c.save();
    c.strokeStyle = style_of("--mark");
    c.lineWidth = 2 * devicePixelRatio;
    c.beginPath();
    c.arc(u.valToPos(one.x[i], "x", true), u.valToPos(one.y[i], "y", true), 5 * devicePixelRatio, 0, 7);
    c.stroke();
    c.restore();
  }
  legend() {
    return h("ul", {class: "legend"}, this.series.map((s, i) => {
      const key = h("span", {class: "key"});
      key.style.borderTopColor = this.colour(i);
      key.style.borderTopStyle = (s.dash || []).length ? "dashed" : "solid";
      return h("li", {}, key, s.label);
    }));
  }
  csv() {
    const quote = (t) => (/[",\n]/.test(t) ? `"${t.replace(/"/g, '""')}"` : t), number = (v) => (Number.isFinite(v) ? String(Number(v.toPrecision(10))) : "");
    const rows = [["curve", this.options.x, this.options.y, "stage", "increment"].map(quote).join(",")];
    for (const s of this.series)
      for (let i = 0; i < s.x.length; ++i)
        rows.push([quote(s.label), number(s.x[i]), number(s.y[i]), ...(s.steps ? s.steps[i] : ["", ""])].join(","));
    return rows.join("\n") + "\n";
  }
  svg() {
    const width = 560, height = 360, left = 76, right = 16, top = 34, bottom = 48, ink = style_of("--ink"), grid = style_of("--grid");
    const pen = new SvgPen(width, height, style_of("--paper")), ranges = {x: this.range("x"), y: this.range("y")};
    const part = (axis, v) => {
      const [low, high] = ranges[axis], f = this.options["log_" + axis] ? Math.log10 : (t) => t;
      return (f(v) - f(low)) / (f(high) - f(low));
    };
    const px = (v) => left + part("x", v) * (width - left - right), py = (v) => height - bottom - part("y", v) * (height - top - bottom);
    const ticks = (axis) => {
      const [low, high] = ranges[axis], list = [];
      if (this.options["log_" + axis]) for (let p = Math.round(Math.log10(low)); p <= Math.log10(high) + 1e-9; ++p) list.push(10 ** p);
      else for (let step = nice_step((high - low) / 5), v = Math.ceil(low / step - 1e-9) * step; v <= high + 1e-9 * step; v += step) list.push(Math.abs(v) < 1e-9 * step ? 0 : v);
      return list;
    };
    for (const v of ticks("x")) {
      pen.line([[px(v), top], [px(v), height - bottom]], grid);
      pen.text(px(v), height - bottom + 15, text_of(v, 6), ink, "middle", 11);
    }
    for (const v of ticks("y")) {
      pen.line([[left, py(v)], [width - right, py(v)]], grid);
      pen.text(left - 6, py(v) + 4, text_of(v, 6), ink, "end", 11);
    }
    pen.line([[left, top], [left, height - bottom], [width - right, height - bottom]], ink, 1.2);
    this.series.forEach((s, i) => {
      if (!s.x.length) return;
      const places = s.x.map((x, k) => [px(x), py(s.y[k])]);
      if (!this.options.scatter) return pen.line(places, this.colour(i), 1.8, s.dash || []);
      for (const [x, y] of places) pen.area([[x - 2, y - 2], [x + 2, y - 2], [x + 2, y + 2], [x - 2, y + 2]], this.colour(i));
    });
    this.series.forEach((s, i) => pen.text(left + 10, top + 14 + 15 * i, s.label, this.colour(i), "start", 11));
    pen.text(width / 2, height - 10, this.options.x, ink, "middle", 12);
    pen.text(8, 18, this.options.y, ink, "start", 12);
    return pen.text_of_file();
  }
  buttons() {
    const name = file_name(this.options.name);
    return [button("CSV", "save these curves as a CSV file", () => save(name + ".csv", this.csv(), "text/csv")),
            button("SVG", "save this plot as an SVG file", () => save(name + ".svg", this.svg(), "image/svg+xml")),
            button("PNG", "save this plot as a PNG file", () => this.plot.ctx.canvas.toBlob((blob) => save(name + ".png", blob)))];
  }
}

const full = (column) => column.name + (column.unit && column.unit !== "-" ? ` [${column.unit}]` : "");

// Of one axis with several columns: their common unit once.
function label_of(columns) {
  const units = new Set(columns.map((c) => c.unit)), names = columns.map((c) => c.name).join(", ");
  if (columns.length < 2 || units.size > 1) return columns.map(full).join(", ");
  const unit = columns[0].unit && columns[0].unit !== "-" ? ` [${columns[0].unit}]` : "";
  return (names.length > 30 ? columns.map((c) => c.name.slice(0, 14)).join(", ") : names) + unit;
}

// What a table is best drawn as: names of x and y, and whether y is on a logarithmic axis.
function usual(table) {
  const has = (name) => table.columns.some((c) => c.name === name), names = table.columns.map((c) => c.name);
  if (table.cases) {  // of a sweep: what varies, then what was collected
    const numbers = table.columns.filter((c) => !["case", "same_as", "warnings"].includes(c.name) && new Set(c.values.filter(Number.isFinite)).size > 1);
    return {x: numbers.length ? numbers[0].name : names[0], y: numbers.length ? [numbers[numbers.length - 1].name] : names.slice(0, 1)};
  }
  if (has("axial_strain")) return {x: "axial_strain", y: ["measured_deviator", "correct_deviator"].filter(has)};
  if (has("degree_of_consolidation")) return {x: "time", y: ["degree_of_consolidation"]};
  if (has("relative_force")) return {x: "row", y: ["relative_force"], log_y: true};
  if (has("ux") && has("fx")) {
    const most = (name) => Math.max(0, ...table.columns.find((c) => c.name === name).values.filter(Number.isFinite).map(Math.abs));
    const way = most("uy") >= most("ux") ? "y" : "x";
    return {x: "u" + way, y: ["f" + way]};
  }
  if (has("factor") && has("displacement")) return {x: "row", y: ["factor"]};  // as the search tried them
  if (has("triangles") && has("lower")) return {x: "triangles", y: ["lower", "upper"]};
  const rest = names.filter((n) => n !== "stage" && n !== "increment");
  return {x: "row", y: rest.slice(0, 1)};
}

// A table of one or more runs as a card: curves of its columns.
export class TableCard {
  // tables: [{run, table}] of one name
  constructor(page, name, tables) {
    this.page = page;
    this.tables = tables;
    const columns = tables[0].table.columns, start = usual(tables[0].table);
    this.x = start.x;
    this.y = start.y.length ? start.y : [columns[columns.length - 1].name];
    this.log_y = !!start.log_y;
    this.log_x = false;
    this.chart = new Chart(page, {name, x: "", y: "", scatter: !!tables[0].table.cases, height: tables[0].table.cases ? 420 : 260});
    this.legend = h("div");
    const names = columns.map((c) => c.name);
    this.log_y_box = check("log y", this.log_y, (v) => { this.log_y = v; this.draw(); });
    this.log_x_box = check("log x", false, (v) => { this.log_x = v; this.draw(); });
    const second = h("div", {class: "row"},
      select("x", [["row", "row"], ...names.map((n) => [n, n])], this.x, (v) => { this.x = v; this.draw(); }),
      select("y", names.map((n) => [n, n]), this.y[0], (v) => { this.y[0] = v; this.draw(); }),
      select("and", [["", "none"], ...names.map((n) => [n, n])], this.y[1] || "", (v) => { this.y = v ? [this.y[0], v] : [this.y[0]]; this.draw(); }),
      this.log_x_box, this.log_y_box, ...this.chart.buttons());
    const own = tables[0].table.title, title = !own || own === tables[0].run.title ? name : `${name}: ${own}`;
    this.root = h("section", {class: "card", "data-table": name}, h("h3", {}, title), second, this.chart.box, this.legend, this.chart.readout);
  }
  draw() {
    const series = [];
    for (const {run, table} of this.tables) {
      const find = (name) => table.columns.find((c) => c.name === name), stage = find("stage"), increment = find("increment");
      const rows = table.columns[0].values.length;
      const steps = stage && increment ? Array.from({length: rows}, (_, i) => [stage.values[i], increment.values[i]]) : null;
      const x = this.x === "row" ? Array.from({length: rows}, (_, i) => i + 1) : find(this.x) && [...find(this.x).values];
      this.y.forEach((name, k) => {
        if (!x || !find(name)) return;
        series.push({label: (this.page.runs.length > 1 ? run.name + ": " : "") + name, x, y: [...find(name).values], steps, run, dash: dashes[this.page.runs.indexOf(run) % 4], k});
      });
    }
    const columns = this.tables[0].table.columns, of = (name) => columns.find((c) => c.name === name);
    this.chart.set(series, {x: this.x === "row" ? "row of the table" : full(of(this.x)), y: label_of(this.y.map(of).filter(Boolean)), log_y: this.log_y, log_x: this.log_x});
    this.legend.replaceChildren(this.chart.legend());
  }
}
