// The page: sections of one or more runs, two of which stand side by side.
import {numbers} from "./decode.js";
import {Chart, TableCard} from "./curves.js";
import {button, check, file_name, h, save, select, table} from "./dom.js";
import {default_choice, nice_step, text_of} from "./fields.js";
import {Run} from "./run.js";
import {View} from "./view.js";

const data = JSON.parse(document.getElementById("data").textContent);

// A lock-off adds the law of its stage as another material of the same number.
const first_of_its_number = (material, i, all) => all.findIndex((other) => other.number === material.number) === i;

class Page {
  constructor() {
    this.all = data.runs.map((json, i) => new Run(json, i));
    this.runs = this.all.slice(0, 2);
    this.settings = {field: default_choice(this.all[0].choices), deformed: false, scale: 1, mesh: true, supports: true, loads: true,
                     diagram: "", linked: true, fixed: false, low: null, high: null, cutting: false};
    this.ranges = new Map();
    this.cut_line = null;
    this.charts = [];
    this.root = document.getElementById("page");
    this.build();
  }

  build() {
    this.views = this.runs.map((run) => new View(run, this));
    for (const view of this.views.slice(1)) if (this.settings.linked) view.camera = this.views[0].camera;
    this.settings.scale = this.usual_scale();
    const sections = [["summary", "Summary", this.summary()], ["views", "Mesh and fields", this.view_section()], ["curves", "Curves", this.curve_section()],
                      ["structures", "Structures", this.structure_section()], ["answers", "Safety and bounds", this.answer_section()],
                      ["pictures", "Pictures", this.picture_section()],
                      ["model", "Model", this.model_section()], ["messages", "Messages", this.message_section()], ["deck", "Deck", this.deck_section()]]
                         .filter(([, , content]) => content);
    const alike = this.all.some((run, i) => this.all.findIndex((other) => other.title === run.title) !== i);
    const titles = this.all.map((run) => (alike ? `${run.name}: ${run.title}` : run.title));
    const shown = titles.map((t) => (titles.length > 1 && t.length > 60 ? t.slice(0, 57) + "..." : t));
    this.root.replaceChildren(
      h("header", {}, h("h1", {title: titles.join(" | ")}, shown[0], ...shown.slice(1).flatMap((t) => [h("span", {class: "beside"}, " | "), t])),
        h("nav", {"aria-label": "sections"}, sections.map(([id, name]) => h("a", {href: "#" + id}, name)),
          button("Dark or light", "change between the dark and the light look", () => this.change_look()), button("Print", "print the page, or save it as PDF", () => window.print()))),
      ...sections.map(([id, name, content]) => h("section", {id, "aria-labelledby": id + "-title"}, h("h2", {id: id + "-title"}, name), content)),
      h("footer", {}, `Written by sagefe ${data.sagefe}. This file holds all its data and makes no request.`));
    this.fit_all();
    for (const card of this.cards) card.draw();
    this.draw_structures();
  }
  per_run(make) {
    return h("div", {class: this.runs.length > 1 ? "pair" : ""}, this.runs.map((run) => h("div", {}, this.runs.length > 1 ? h("h3", {}, run.name) : null, make(run))));
  }

  // Sections.
  summary() {
    const choose = this.all.length > 2 ? h("div", {class: "row"}, [0, 1].map((place) =>
      select(place ? "beside" : "run", this.all.map((r) => [r.index, `${r.name}: ${r.title}`]), this.runs[place].index, (v) => {
        this.runs[place] = this.all[v];
        this.build();
      }))) : null;
    return h("div", {}, choose, this.per_run((run) => h("div", {},
      h("table", {class: "summary"}, h("tbody", {}, run.json.summary.map(([name, text]) =>
        h("tr", {}, h("th", {scope: "row"}, name), h("td", {class: name === "status" && run.json.failed ? "bad" : ""}, text))))),
      run.json.left_out.length ? h("p", {class: "bad"}, "The deck asks for parts that the model lacks: " + run.json.left_out.join("; ")) : null,
      run.json.omitted.length ? h("details", {open: true}, h("summary", {}, "What this page leaves out"), h("ul", {}, run.json.omitted.map((t) => h("li", {}, t)))) : null)));
  }

  view_section() {
    const s = this.settings, choices = [];
    for (const run of this.runs) for (const c of run.choices) if (!choices.some((o) => o.id === c.id)) choices.push(c);
    const redraw = () => this.redraw();
    this.field_list = select("Field", choices.map((c) => [c.id, c.label + (c.unit ? ` [${c.unit}]` : "")]), s.field, (v) => { s.field = v; this.new_range(); redraw(); });
    this.state_lists = this.views.map((view) => select(this.runs.length > 1 ? `State of ${view.run.name}` : "State",
      view.run.states.map((st, i) => [i, `stage ${st.stage}, increment ${st.increment} (load factor ${text_of(st.load_factor, 4)})`]), view.state,
      (v) => this.set_state(view, Number(v))));
    this.scale_box = h("input", {type: "number", step: "any", value: text_of(s.scale, 3), class: "small", onchange: (e) => { s.scale = Number(e.target.value) || 0; redraw(); }});
    const limit = (name) => h("input", {type: "number", step: "any", class: "small", placeholder: name === "low" ? "least" : "largest", "aria-label": name === "low" ? "least of the colours" : "largest of the colours",
                                        onchange: (e) => { s[name] = e.target.value === "" ? null : Number(e.target.value); this.new_range(); redraw(); }});
    const quantities = this.runs.flatMap((r) => r.quantities).filter((q, i, all) => all.findIndex((o) => o.name === q.name) === i);
    this.cut_box = check("draw a cut", false, (v) => { s.cutting = v; if (!v) this.set_cut(null); });
    const ends = ["x", "y", "x", "y"].map((axis, i) => h("input", {type: "number", step: "any", class: "small", placeholder: `${i < 2 ? "A" : "B"} ${axis}`, "aria-label": `${i < 2 ? "start" : "end"} of the cut, ${axis}`}));
    const cut_form = h("form", {class: "row", onsubmit: (e) => { e.preventDefault(); const v = ends.map((b) => Number(b.value)); this.set_cut([v[0], v[1]], [v[2], v[3]]); }},
                       ends, h("button", {type: "submit"}, "Cut"));
    this.cut_ends = ends;
    this.cut_chart = new Chart(this, {name: "cut", x: "distance from A", y: ""});
    this.cut_card = h("section", {class: "card", hidden: true, id: "cut"}, h("h3", {}, "Along the cut"), h("div", {class: "row"}, this.cut_chart.buttons()), this.cut_chart.box, this.cut_chart.readout);
    return h("div", {},
      h("div", {class: "row controls"}, this.field_list, this.state_lists,
        h("span", {class: "group"}, check("deformed, times", s.deformed, (v) => { s.deformed = v; this.fit_all(); }), this.scale_box),
        h("span", {class: "group"}, "Colours", limit("low"), limit("high"), check("same for all states", s.fixed, (v) => { s.fixed = v; this.new_range(); redraw(); }))),
      h("div", {class: "row controls"},
        quantities.length ? select("Diagram", [["", "none"], ...quantities.map((q) => [q.name, `${q.meaning || q.name} [${q.unit}]`])], s.diagram, (v) => { s.diagram = v; redraw(); }) : null,
        check("mesh", s.mesh, (v) => { s.mesh = v; redraw(); }), check("supports", s.supports, (v) => { s.supports = v; redraw(); }),
        check("loads of the stage", s.loads, (v) => { s.loads = v; redraw(); }),
        this.runs.length > 1 ? check("linked views", s.linked, (v) => this.link(v)) : null,
        button("Show all", "the whole mesh (key 0)", () => this.fit_all()), this.cut_box, cut_form),
      h("div", {class: this.runs.length > 1 ? "pair" : ""}, this.views.map((v) => v.root)), this.cut_card,
      h("p", {class: "hint"}, "Point at the mesh to read values; click to hold the probe, click again to let it go. Drag moves the view, the wheel zooms. With the keyboard (Tab to the mesh): arrows move the probe, Shift and arrows the view, + and - zoom, 0 shows all, [ and ] change the state, f the field."));
  }

  curve_section() {
    this.cards = [];
    const names = [];
    for (const run of this.runs) for (const t of run.tables) if (!names.includes(t.name)) names.push(t.name);
    const rank = (n) => (n.startsWith("report") ? 0 : n === "increments" ? 1 : 2);
    names.sort((a, b) => rank(a) - rank(b) || a.localeCompare(b, "en", {numeric: true}));
    for (const name of names)
      this.cards.push(new TableCard(this, name, this.runs.map((run) => ({run, table: run.tables.find((t) => t.name === name)})).filter((p) => p.table)));
    this.charts = this.cards.map((c) => c.chart);
    if (!names.length) return h("p", {}, "No tables lie beside the result file.");
    return h("div", {}, h("p", {class: "hint"}, "The cursors move together: point at a curve to mark the same increment in all, click to see its state (or the nearest one kept) in the mesh."),
             h("div", {class: "cards"}, this.cards.map((c) => c.root)));
  }

  structure_section() {
    const list = [];
    for (const run of this.runs) for (const {group, ends} of run.ends(run.states.length - 1)) if (ends.length > 2) list.push({run, group});
    const any = this.runs.some((run) => run.quantities.length && run.json.envelope.length);
    this.structure_charts = [];
    if (!any) return null;
    const rows = [];
    for (const run of this.runs) {
      const groups = new Map();
      for (const row of run.json.envelope)
        run.quantities.forEach((q, k) => {
          if (row.low[k] === null) return;
          const key = `${row.group} ${q.name}`, before = groups.get(key) || {group: run.groups[row.group], q, low: Infinity, high: -Infinity};
          if (row.low[k] < before.low) [before.low, before.low_at] = [row.low[k], row];
          if (row.high[k] > before.high) [before.high, before.high_at] = [row.high[k], row];
          groups.set(key, before);
        });
      for (const one of groups.values())
        rows.push([...(this.runs.length > 1 ? [run.name] : []), `${one.group.number} ${one.group.name}`, `${one.q.name} [${one.q.unit}]`, text_of(one.low, 5),
                   String(one.group.numbers[one.low_at.element]), text_of(one.high, 5), String(one.group.numbers[one.high_at.element])]);
    }
    const head = [...(this.runs.length > 1 ? ["run"] : []), "group", "quantity", "least", "element", "largest", "element"];
    const cards = list.map(({run, group}) => {
      const quantities = run.quantities.filter((q) => run.json.envelope.some((r) => r.group === group.index && r.low[run.quantities.indexOf(q)] !== null));
      const start = quantities.find((q) => q.name === "bending_moment") || quantities[0];
      const chart = new Chart(this, {name: `${run.name} group ${group.number}`, x: `distance along the structure${run.json.units.length ? ` [${run.json.units.length}]` : ""}`, y: ""}), legend = h("div");
      const item = {run, group, chart, legend, q: start};
      this.structure_charts.push(item);
      return h("section", {class: "card"}, h("h3", {}, `${this.runs.length > 1 ? run.name + ": " : ""}group ${group.number} ${group.name}`),
        h("div", {class: "row"}, select("Quantity", quantities.map((q) => [q.name, `${q.meaning || q.name} [${q.unit}]`]), start.name, (v) => { item.q = quantities.find((q) => q.name === v); this.draw_structures(); }), chart.buttons()),
        chart.box, legend, chart.readout);
    });
    return h("div", {}, h("p", {class: "hint"}, `Forces and moments at the ends of elements, ${this.runs[0].json.units.structures_per}; axial force compression positive. The envelope is of the ends of all stages. The diagram over the mesh is drawn with "Diagram" above.`),
             table(head, rows, {class: "list"}), h("div", {class: "cards"}, cards));
  }
  draw_structures() {
    for (const item of this.structure_charts) {
      const {run, group, chart, legend, q} = item, k = run.quantities.indexOf(q), view = this.views.find((v) => v.run === run);
      const now = run.ends(view.state).find((g) => g.group === group), lengths = this.along(run, group);
      const series = [];
      const s = run.states[view.state];
      if (now) series.push({label: `stage ${s.stage}, increment ${s.increment}`, x: now.ends.map((e) => lengths.at(e.element, e.end)), y: now.ends.map((e) => e.values[k]), run});
      const rows = run.json.envelope.filter((r) => r.group === group.index);
      for (const [name, part] of [["least of all stages", "low"], ["largest of all stages", "high"]])
        series.push({label: name, x: rows.map((r) => lengths.at(r.element, r.end)), y: rows.map((r) => (r[part][k] === null ? NaN : r[part][k])), run, dash: [6, 4]});
      for (const one of series) {
        const order = one.x.map((_, i) => i).sort((a, b) => one.x[a] - one.x[b] || a - b);
        [one.x, one.y] = [order.map((i) => one.x[i]), order.map((i) => one.y[i])];
      }
      chart.set(series, {y: `${q.name} [${q.unit}]`});
      legend.replaceChildren(chart.legend());
    }
  }
  // Distance of each end from the group's first node, element after element.
  along(run, group) {
    const at = [];
    let length = 0;
    for (let e = 0; e < group.elements; ++e) {
      const start = length;
      for (let i = 0; i + 1 < group.line.length; ++i) {
        const a = group.node(e, group.line[i]), b = group.node(e, group.line[i + 1]);
        length += Math.hypot(run.x[b] - run.x[a], run.y[b] - run.y[a]);
      }
      at.push([start, length]);
    }
    return {at: (e, end) => at[e][end - 1]};
  }

  answer_section() {
    if (!this.runs.some((run) => run.json.answers.length)) return null;
    return this.per_run((run) => h("div", {}, run.json.answers.flatMap((a) => [h("h3", {}, `sagefe ${a.name}`), h("pre", {class: "answer"}, a.text)])));
  }
  picture_section() {
    if (!this.runs.some((run) => run.json.pictures.length)) return null;
    return this.per_run((run) => h("div", {class: "pictures"}, run.json.pictures.map((p) => h("figure", {class: "picture"}, h("img", {src: run.picture_url(p), alt: p.name}), h("figcaption", {}, p.name)))));
  }

  model_section() {
    return this.per_run((run) => h("div", {},
      h("h3", {}, "Groups"),
      table(["number", "name", "element", "elements", "points", "material"], run.groups.map((g) => [g.number, g.name, g.element, g.elements, g.elements * g.points,
        `${run.json.materials[g.material].number} ${run.json.materials[g.material].name}`].map(String)), {class: "list"}),
      h("h3", {}, "Materials"),
      h("div", {class: "materials"}, run.json.materials.filter(first_of_its_number).map((m) => h("details", {open: true}, h("summary", {}, `${m.number} ${m.name}: ${m.law}`),
        table(["parameter", "value", "unit", "meaning"], [...m.parameters.map((p) => [p.name, text_of(p.value, 8), p.unit, p.meaning]),
          ...(m.unit_weight ? [["unit_weight", text_of(m.unit_weight, 8), m.weight_unit, m.weight_unit ? "unit weight" : "weight, as the listing describes it"]] : [])], {class: "list"})))),
      h("h3", {}, "Stages, loads and water"),
      run.json.stages.map((s, i) => h("details", {open: true}, h("summary", {}, `Stage ${i + 1}: ${s.title}`),
        h("pre", {}, s.text), h("p", {}, this.load_words(run, s), s.line ? h("a", {href: `#deck-${run.index}-${s.line}`}, ` Line ${s.line} of the deck.`) : null)))));
  }
  load_words(run, stage) {
    const parts = [], force = run.json.units.force, loads = stage.loads;
    const sum = loads.nodes.reduce((t, l) => [t[0] + l[1], t[1] + l[2]], [0, 0]);
    if (loads.nodes.length) parts.push(`${loads.nodes.length} nodal loads, together ${text_of(sum[0], 6) || 0} and ${text_of(sum[1], 6) || 0} ${force} along the axes`);
    if (loads.edges.length) {
      const all = loads.edges.flatMap((l) => [l[2], l[3]]);
      parts.push(`pressures on ${loads.edges.length} edges, from ${text_of(Math.min(...all), 6)} to ${text_of(Math.max(...all), 6)} ${run.json.units.stress}`);
    }
    const moved = stage.fixities.filter((f) => f[3] || f[4]);
    if (moved.length) parts.push(`${moved.length} nodes moved by their supports`);
    return parts.length ? parts.join("; ") + "." : "";
  }

  message_section() {
    const title = {error: "Error", warning: "Warning", note: "Note"};
    return this.per_run((run) => run.json.messages.length ? h("ol", {class: "messages"}, run.json.messages.map((m) =>
      h("li", {class: m.severity}, h("p", {}, h("strong", {}, `${title[m.severity]} ${m.code}`), " ", m.text, " ",
        m.line ? h("a", {href: `#deck-${run.index}-${m.line}`}, `line ${m.line}`) : null),
        m.cause ? h("details", {}, h("summary", {}, "Cause and cure"), h("p", {}, m.cause), h("p", {}, m.cure)) : null))) : h("p", {}, "The run has no warnings and no notes."));
  }

  deck_section() {
    return this.per_run((run) => {
      const lines = run.json.deck.split("\n"), marked = new Set(run.json.messages.map((m) => m.line));
      if (lines[lines.length - 1] === "") lines.pop();
      return h("details", {open: lines.length < 400, class: "deck-box"}, h("summary", {}, `${lines.length} lines`),
               h("div", {class: "deck", tabindex: 0, role: "region", "aria-label": "deck of " + run.name}, lines.map((text, i) =>
                 h("div", {id: `deck-${run.index}-${i + 1}`, class: marked.has(i + 1) ? "marked" : ""}, h("span", {class: "no"}, String(i + 1)), h("code", {}, text)))));
    });
  }

  // What views ask for.
  usual_scale() {
    const sizes = this.views.map((v) => v.run.largest_displacement(v.state) / v.run.size), most = Math.max(...sizes);
    return most > 0 ? nice_step(0.04 / most) : 1;
  }
  fit_all() {
    this.views[0].fit();
    if (this.views.length > 1 && this.settings.linked) {
      const box = this.views.map((v) => v.run.box);
      this.views[0].camera.fit([Math.min(...box.map((b) => b[0])), Math.min(...box.map((b) => b[1])), Math.max(...box.map((b) => b[2])), Math.max(...box.map((b) => b[3]))],
                               this.views[0].drawing_width, this.views[0].height);
    } else for (const view of this.views.slice(1)) view.fit();
    this.redraw();
  }
  link(on) {
    this.settings.linked = on;
    for (const view of this.views.slice(1)) {
      view.camera = on ? this.views[0].camera : Object.assign(Object.create(Object.getPrototypeOf(view.camera)), view.camera);
    }
    this.redraw();
  }
  redraw() { for (const view of this.views) view.draw(); }
  // A view's camera has moved.  Without WebGL the picture waits until it rests.
  moved(view) {
    const list = this.settings.linked ? this.views : [view];
    for (const one of list) {
      if (one.gl) one.draw();
      else one.draw_over();
    }
    if (list.some((v) => !v.gl)) {
      clearTimeout(this.still);
      this.still = setTimeout(() => this.redraw(), 250);
    }
  }
  probe(view, place) {
    for (const one of this.settings.linked ? this.views : [view]) {
      if (one !== view) one.pinned = view.pinned;
      one.show_probe(place);
      one.draw_over();
    }
  }
  set_state(view, state) {
    view.state = Math.min(Math.max(state, 0), view.run.states.length - 1);
    const list = this.state_lists[this.views.indexOf(view)].querySelector("select");
    list.value = view.state;
    if (!this.settings.fixed) this.new_range();
    this.redraw();
    if (view.probe_place) view.show_probe(view.probe_place);
    this.draw_structures();
    if (this.cut_line) this.draw_cut();
  }
  step_state(view, by) {
    for (const one of this.settings.linked ? this.views : [view]) this.set_state(one, one.state + by);
  }
  next_field() {
    const list = this.field_list.querySelector("select");
    list.selectedIndex = (list.selectedIndex + 1) % list.options.length;
    this.settings.field = list.value;
    this.new_range();
    this.redraw();
  }
  new_range() { this.ranges.clear(); }
  // Of the colours: common to both views, so that they can be compared.
  range(choice) {
    if (!choice) return null;
    if (this.ranges.has(choice.id)) return this.ranges.get(choice.id);
    let range = null;
    for (const view of this.views) {
      const own = view.run.choice(choice.id);
      if (!own) continue;
      const states = this.settings.fixed ? view.run.states.map((_, i) => i) : [view.state];
      for (const state of states) {
        const one = view.run.range(state, own);
        if (one) range = range ? [Math.min(range[0], one[0]), Math.max(range[1], one[1]), Math.min(range[2], one[2]), Math.max(range[3], one[3])] : one;
      }
    }
    const {low, high} = this.settings;
    if (range && low !== null) range = [low, Math.max(range[1], low + 1e-12), Math.min(range[2], range[0]), range[3]];
    if (range && high !== null && high > range[0]) range = [range[0], high, range[2], Math.max(range[3], range[1])];
    this.ranges.set(choice.id, range);
    return range;
  }

  // The same increment in all charts of the run.
  step(run, stage, increment, from) {
    for (const chart of this.charts) if (chart !== from) chart.mark_step(run, stage, increment);
  }
  chosen(run, stage, increment) {
    const view = this.views.find((v) => v.run === run);
    let best = 0, least = Infinity;
    run.states.forEach((s, i) => {
      const d = Math.abs(s.stage - stage) * 1e6 + Math.abs(s.increment - increment);
      if (d < least) [least, best] = [d, i];
    });
    this.set_state(view, best);
  }

  set_cut(from, to) {
    this.cut_line = from && to ? [from, to] : null;
    this.cut_card.hidden = !this.cut_line;
    if (this.cut_line) {
      [...from, ...to].forEach((v, i) => (this.cut_ends[i].value = text_of(v, 5)));
      this.draw_cut();
    }
    for (const view of this.views) view.draw_over();
  }
  draw_cut() {
    const [a, b] = this.cut_line, length = Math.hypot(b[0] - a[0], b[1] - a[1]), count = 200, series = [];
    for (const view of this.views) {
      const choice = view.choice;
      if (!choice) continue;
      const x = [], y = [];
      for (let i = 0; i <= count; ++i) {
        const t = i / count, found = view.run.hit(view.state, view.scale, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), choice);
        x.push(t * length);
        y.push(found ? found.value : NaN);
      }
      series.push({label: view.run.name, x, y, run: view.run, dash: series.length ? [8, 4] : []});
    }
    const choice = this.views[0].choice || this.views[1].choice;
    this.cut_chart.set(series, {x: `distance from A${this.runs[0].json.units.length ? ` [${this.runs[0].json.units.length}]` : ""}`, y: choice.id + (choice.unit ? ` [${choice.unit}]` : "")});
  }

  change_look() {
    const root = document.documentElement, dark = root.dataset.look ? root.dataset.look === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.look = dark ? "light" : "dark";
    this.repaint();
  }
  repaint() {
    this.redraw();
    for (const card of this.cards) card.draw();
    this.draw_structures();
    if (this.cut_line) this.draw_cut();
  }
}

// A table of cases: points over any column, and the rows.  A row's file, where it names one, is a link.
class TablePage {
  constructor() {
    const packed = data.table, run = {name: data.name, title: packed.title};
    const own = {...packed, cases: true, columns: packed.columns.map((c) => ({...c, values: numbers(c.values)}))};
    this.runs = [run];
    this.cards = [new TableCard(this, data.name, [{run, table: own}])];
    const count = own.columns.length ? own.columns[0].values.length : 0, shown = Math.min(count, 2000), words = new Map();
    for (const [row, column, text] of own.words) words.set(row * own.columns.length + column, text);
    const rows = Array.from({length: shown}, (_, r) => own.columns.map((c, k) => {
      const word = words.get(r * own.columns.length + k);
      return word !== undefined ? ((c.name === "page" ? /^[^:?#]+\.html$/ : /^[^:?#\s]+\.html$/).test(word) ? h("a", {href: encodeURI(word)}, c.name === "page" ? "page" : word) : word) : text_of(c.values[r], 8);
    }));
    document.getElementById("page").replaceChildren(
      h("header", {}, h("h1", {}, packed.title || data.name), h("nav", {}, button("Dark or light", "change between the dark and the light look", () => Page.prototype.change_look.call(this)), button("Print", "print the page, or save it as PDF", () => window.print()))),
      h("section", {id: "cases"}, h("h2", {}, `${count} cases`), h("div", {class: "cards wide"}, this.cards[0].root)),
      h("section", {id: "rows"}, h("h2", {}, "Table"), shown < count ? h("p", {}, `The first ${shown} of ${count} rows.`) : null,
        h("div", {class: "wide-table"}, table(own.columns.map((c) => c.name + (c.unit && c.unit !== "-" ? ` [${c.unit}]` : "")), rows, {class: "list"}))),
      h("footer", {}, `Written by sagefe ${data.sagefe}. This file holds all its data and makes no request.`));
    this.views = [];
    this.settings = {};
    this.repaint();
  }
  repaint() { for (const card of this.cards) card.draw(); }
  step() {}
  chosen() {}
}

const page = data.table ? new TablePage() : new Page();
window.sagefe = {page, save, file_name};
let resized;
window.addEventListener("resize", () => {
  clearTimeout(resized);
  resized = setTimeout(() => page.repaint(), 150);
});
// On paper: light, as wide as a sheet, and everything open.
let before_print = null;
window.addEventListener("beforeprint", () => {
  const root = document.documentElement, closed = [...document.querySelectorAll("details:not([open])")];
  before_print = {look: root.dataset.look, closed, cameras: page.views.map((v) => ({...v.camera})), widths: page.views.map((v) => v.drawing_width)};
  for (const one of closed) one.open = true;
  root.dataset.look = "light";
  root.classList.add("paper");
  // What fitted the screen fits the sheet.
  page.views.forEach((v, i) => { if (i === 0 || !page.settings.linked) v.camera.zoom *= v.drawing_width / before_print.widths[i]; });
  page.repaint();
  for (const view of page.views) view.to_paper();
});
window.addEventListener("afterprint", () => {
  if (!before_print) return;
  const root = document.documentElement;
  for (const one of before_print.closed) one.open = false;
  if (before_print.look) root.dataset.look = before_print.look;
  else delete root.dataset.look;
  root.classList.remove("paper");
  page.views.forEach((v, i) => { Object.assign(v.camera, before_print.cameras[i]); v.from_paper(); });
  before_print = null;
  page.repaint();
});
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.repaint());
