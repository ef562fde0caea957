// One view of a run: the mesh with a field, what lies on it, and the probe.
import {bands_of, colour, css, text_of} from "./fields.js";
import {button, file_name, h, save, style_of} from "./dom.js";
import {band_of, CanvasPen, SvgPen} from "./pen.js";
import {make_gl} from "./gl.js";

const most_svg_triangles = 60000, legend_width = 118;

// A view of the plane that several views may share: centre and pixels a length.
export class Camera {
  constructor() { this.x = this.y = 0; this.zoom = 1; }
  fit(box, width, height) {
    this.x = (box[0] + box[2]) / 2;
    this.y = (box[1] + box[3]) / 2;
    this.zoom = Math.min((width - 70) / (box[2] - box[0] || 1), (height - 60) / (box[3] - box[1] || 1));
  }
}

export class View {
  // page: {settings, changed(), probe(view, place), cut(from, to)}
  constructor(run, page) {
    this.run = run;
    this.page = page;
    this.state = run.states.length - 1;
    this.camera = new Camera();
    this.under = h("canvas", {class: "under", "aria-hidden": "true"});
    this.over = h("canvas", {
      class: "over", tabindex: 0, role: "img", "data-run": run.index,
      "aria-label": `Mesh of ${run.title}. Arrow keys move the probe, with Shift the view; plus and minus zoom, 0 shows all, [ and ] change the state, f changes the field.`,
    });
    this.box = h("div", {class: "stage"}, this.under, this.over);
    this.readout = h("div", {class: "probe", "aria-live": "polite"});
    this.caption = h("p", {class: "caption"});
    this.entry = h("input", {type: "number", min: 1, class: "small", "aria-label": "element number", placeholder: "element"});
    this.entry_point = h("input", {type: "number", min: 1, class: "small", "aria-label": "integration point", placeholder: "point"});
    this.root = h("figure", {class: "view"}, this.caption, this.box,
                  h("div", {class: "row"}, h("form", {class: "row", onsubmit: (e) => (e.preventDefault(), this.probe_number())},
                                             h("span", {}, "Probe"), this.entry, this.entry_point, h("button", {type: "submit"}, "Go")),
                    button("SVG", "save this view as an SVG file", () => this.save_svg()),
                    button("PNG", "save this view as a PNG file", () => this.save_png())),
                  this.readout);
    this.gl = null;
    try {
      this.gl = make_gl(this.under);
      if (this.gl) this.gl.set_mesh(run, this.middle);
    } catch (error) {
      this.gl = null;
    }
    if (!this.gl) {
      this.under.remove();
      this.under = h("canvas", {class: "under", "aria-hidden": "true"});
      this.box.prepend(this.under);
      this.box.append(h("span", {class: "still"}, "without WebGL: a still picture, drawn anew after each change"));
    }
    this.listen();
  }
  get middle() { return [(this.run.box[0] + this.run.box[2]) / 2, (this.run.box[1] + this.run.box[3]) / 2]; }
  get choice() { return this.run.choice(this.page.settings.field); }
  get scale() { return this.page.settings.deformed ? this.page.settings.scale : 0; }
  get width() { return this.box.clientWidth || 600; }
  get height() { return this.box.clientHeight || 420; }
  get drawing_width() { return Math.max(100, this.width - legend_width); }

  to_screen(x, y) {
    const c = this.camera;
    return [this.drawing_width / 2 + (x - c.x) * c.zoom, this.height / 2 - (y - c.y) * c.zoom];
  }
  to_plane(px, py) {
    const c = this.camera;
    return [c.x + (px - this.drawing_width / 2) / c.zoom, c.y - (py - this.height / 2) / c.zoom];
  }
  fit() {
    const box = [...this.run.box];
    if (this.scale) {
      const [u, v] = this.run.displaced(this.state);
      for (let i = 0; i < u.length; ++i) {
        const x = this.run.x[i] + this.scale * u[i], y = this.run.y[i] + this.scale * v[i];
        if (x < box[0]) box[0] = x;
        if (y < box[1]) box[1] = y;
        if (x > box[2]) box[2] = x;
        if (y > box[3]) box[3] = y;
      }
    }
    this.camera.fit(box, this.drawing_width, this.height);
  }

  listen() {
    const over = this.over;
    const at = (e) => {
      const box = over.getBoundingClientRect();
      return [e.clientX - box.left, e.clientY - box.top];
    };
    over.addEventListener("pointerdown", (e) => {
      const from = at(e);
      this.drag = {from, camera: [this.camera.x, this.camera.y], moved: false, cut: this.page.settings.cutting};
      over.setPointerCapture(e.pointerId);
    });
    over.addEventListener("pointermove", (e) => {
      const now = at(e);
      if (this.drag && this.drag.cut) {
        this.page.set_cut(this.to_plane(...this.drag.from), this.to_plane(...now));
      } else if (this.drag) {
        const dx = now[0] - this.drag.from[0], dy = now[1] - this.drag.from[1];
        if (Math.hypot(dx, dy) > 3) this.drag.moved = true;
        if (!this.drag.moved) return;
        this.camera.x = this.drag.camera[0] - dx / this.camera.zoom;
        this.camera.y = this.drag.camera[1] + dy / this.camera.zoom;
        this.page.moved(this);
      } else if (!this.pinned) {
        this.page.probe(this, this.to_plane(...now));
      }
    });
    over.addEventListener("pointerup", (e) => {
      const drag = this.drag;
      this.drag = null;
      if (!drag || drag.moved || drag.cut) return this.page.redraw();
      this.pinned = !this.pinned;
      this.page.probe(this, this.to_plane(...at(e)));
    });
    over.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom_at(...at(e), Math.exp(-e.deltaY * 0.0015));
    }, {passive: false});
    over.addEventListener("keydown", (e) => this.key(e));
    over.addEventListener("dblclick", () => this.page.fit_all());
  }
  zoom_at(px, py, factor) {
    const [x, y] = this.to_plane(px, py);
    this.camera.zoom *= factor;
    const [nx, ny] = this.to_plane(px, py);
    this.camera.x += x - nx;
    this.camera.y += y - ny;
    this.page.moved(this);
  }
  key(e) {
    const steps = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[e.key];
    if (e.ctrlKey || e.metaKey || e.altKey) return;
    if (steps && e.shiftKey) {
      this.camera.x += (40 * steps[0]) / this.camera.zoom;
      this.camera.y += (40 * steps[1]) / this.camera.zoom;
      this.page.moved(this);
    } else if (steps) {
      const place = this.probe_place || [this.camera.x, this.camera.y];
      this.page.probe(this, [place[0] + (6 * steps[0]) / this.camera.zoom, place[1] + (6 * steps[1]) / this.camera.zoom]);
    } else if (e.key === "+" || e.key === "=") this.zoom_at(this.drawing_width / 2, this.height / 2, 1.25);
    else if (e.key === "-") this.zoom_at(this.drawing_width / 2, this.height / 2, 0.8);
    else if (e.key === "0") this.page.fit_all();
    else if (e.key === "[" || e.key === "]") this.page.step_state(this, e.key === "]" ? 1 : -1);
    else if (e.key === "f") this.page.next_field();
    else if (e.key === "Enter") this.page.probe(this, this.probe_place || [this.camera.x, this.camera.y]);
    else return;
    e.preventDefault();
  }

  // The probe at a place of the drawing.
  show_probe(place) {
    this.probe_place = place;
    const found = this.run.hit(this.state, this.scale, ...place, this.choice);
    if (!found) {
      const lines = this.lines_near(place);
      for (const name of ["element", "point", "node"]) delete this.readout.dataset[name];
      return this.show_rows([], lines.length ? "" : "nothing is there", lines);
    }
    const {group, element} = found, home = this.undisplaced(group, element, place);
    const node = this.run.nearest_node(group, element, this.state, this.scale, ...place);
    this.show_found(this.run.probe_element(this.state, group, element, home), node, found.value, this.lines_near(place));
  }
  // Interfaces and structures within some pixels of a place: {words, rows} each.
  lines_near(place) {
    const run = this.run, at = this.to_screen(...place), list = [];
    for (const group of run.groups) {
      if (group.area || !group.line || !run.active(this.state, group)) continue;
      let best = null, least = 7;
      for (let e = 0; e < group.elements; ++e) {
        const line = group.line.map((i) => this.node_at(group.node(e, i)));
        for (let i = 0; i < Math.max(1, line.length - 1); ++i) {
          const a = line[i], b = line[Math.min(i + 1, line.length - 1)], dx = b[0] - a[0], dy = b[1] - a[1];
          const t = Math.min(1, Math.max(0, ((at[0] - a[0]) * dx + (at[1] - a[1]) * dy) / (dx * dx + dy * dy || 1)));
          const d = Math.hypot(a[0] + t * dx - at[0], a[1] + t * dy - at[1]);
          if (d < least) [least, best] = [d, {element: e, second: (i + t) / Math.max(1, line.length - 1) > 0.5}];
        }
      }
      if (!best) continue;
      const name = `group ${group.number} ${group.name}`;
      if (group.kind === "interface") {
        const probe = run.probe_element(this.state, group, best.element, place);
        list.push({words: `Interface element ${group.numbers[best.element]} (${name}), point ${probe.point + 1}`, rows: probe.rows});
      } else {
        const own = run.ends(this.state).find((g) => g.group === group), ends = own ? own.ends.filter((end) => end.element === best.element) : [];
        const end = ends[best.second && ends.length > 1 ? 1 : 0];
        if (end) list.push({words: `Structure element ${group.numbers[best.element]} (${name}), end ${end.end} at node ${run.number[end.node]}`,
                            rows: run.quantities.map((q, k) => ({column: q.name, unit: q.unit, value: end.values[k]}))});
      }
    }
    return list;
  }
  // Where the drawing's place was before it was displaced, about: through the nearest integration point as drawn.
  undisplaced(group, e, place) {
    if (!this.scale) return place;
    let best = place, least = Infinity;
    const [u, v] = this.run.displaced(this.state);
    for (let p = 0; p < group.points; ++p) {
      let x = 0, y = 0, dx = 0, dy = 0;
      for (let i = 0; i < group.nodes; ++i) {
        const w = group.weights[p * group.nodes + i], node = group.node(e, i);
        x += w * this.run.x[node];
        y += w * this.run.y[node];
        dx += w * u[node];
        dy += w * v[node];
      }
      const d = Math.hypot(x + this.scale * dx - place[0], y + this.scale * dy - place[1]);
      if (d < least) [least, best] = [d, [x, y]];
    }
    return best;
  }
  probe_number() {
    const number = Number(this.entry.value), point = Number(this.entry_point.value) || 1;
    const found = this.run.find_element(number);
    if (!found) return this.show_rows([], `there is no element ${number}`);
    const {group, element} = found;
    const probe = this.run.probe_element(this.state, group, element, point);
    this.pinned = true;
    this.probe_place = group.area ? this.displaced_point(group, element, probe.point) : probe.place;
    this.show_found(probe, group.node(element, 0), NaN);
    this.draw_over();
  }
  displaced_point(group, e, p) {
    const at = this.run.point_place(group, e, p), [u, v] = this.run.displaced(this.state);
    for (let i = 0; i < group.nodes; ++i) {
      const w = group.weights[p * group.nodes + i], node = group.node(e, i);
      at[0] += w * this.scale * u[node];
      at[1] += w * this.scale * v[node];
    }
    return at;
  }
  show_found(probe, node, shown, lines = []) {
    const {group, element} = probe, run = this.run, axes = run.json.axes, unit = run.json.units.length;
    const material = run.json.materials[group.material];
    const place = (p) => `${axes[0]} ${text_of(p[0], 7)}, ${axes[1]} ${text_of(p[1], 7)} ${unit}`;
    const of_node = run.probe_node(this.state, node);
    const words = `Element ${group.numbers[element]} (group ${group.number} ${group.name}, ${material.name}), ` +
                  (probe.means ? "mean of its points" : `point ${probe.point + 1}`) + ` at ${place(probe.place)}`;
    const value = Number.isFinite(shown) ? `. ${this.choice.label} as drawn here: ${text_of(shown, 5)} ${this.choice.unit}` : "";
    this.readout.dataset.element = group.numbers[element];
    this.readout.dataset.point = probe.point + 1;
    this.readout.dataset.node = of_node.number;
    this.show_rows([...probe.rows, ...of_node.rows.map((r) => ({...r, node: true}))], words + value,
                   lines, `Node ${of_node.number} at ${place(of_node.place)}`);
  }
  show_rows(rows, words, lines = [], node_words = "") {
    const cells = (list, name = "values") => h("dl", {class: name}, list.filter((r) => !Number.isNaN(r.value)).map((r) =>
      h("div", {}, h("dt", {}, r.column), h("dd", {"data-column": r.column, "data-value": String(r.value)},
                                            r.word ?? (text_of(r.value, this.run.digits) + (r.unit && r.unit !== "-" ? " " + r.unit : "")) ))));
    this.readout.replaceChildren(words ? h("p", {}, words) : "", cells(rows.filter((r) => !r.node)),
                                 ...lines.flatMap((line) => [h("p", {}, line.words), cells(line.rows, "values line")]),
                                 ...(node_words ? [h("p", {}, node_words), cells(rows.filter((r) => r.node))] : []));
  }

  // Everything, where state, field or look have changed.
  draw() {
    const run = this.run, choice = this.choice, state = run.states[this.state];
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    for (const [canvas, width] of [[this.under, this.drawing_width], [this.over, this.width]]) {
      canvas.style.width = width + "px";
      canvas.style.height = this.height + "px";
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(this.height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(this.height * ratio);
      }
    }
    this.ratio = ratio;
    const title = this.page.runs.length > 1 ? `${run.name}: ${run.title}` : run.title;
    this.caption.textContent = `${title}: stage ${state.stage}, increment ${state.increment} of ${state.increments}, load factor ${text_of(state.load_factor, 6)}`;
    this.draw_under(choice);
    this.draw_over();
  }
  get bands() {
    const range = this.page.range(this.choice, this);
    return range ? bands_of(range[0], range[1]) : bands_of(0, 1);
  }
  colours(bands) {
    return Array.from({length: bands.count}, (_, i) => colour(bands.count > 1 ? i / (bands.count - 1) : 0.5));
  }
  // Groups that are there, those with values last: they are drawn over the others.
  drawn_groups(values) {
    const there = this.run.groups.filter((g) => g.area && this.run.active(this.state, g));
    return [...there.filter((g) => !values || !values[g.index]), ...there.filter((g) => values && values[g.index])];
  }
  mesh_colour() { return this.page.settings.mesh ? (this.zoomed_in() ? 0.45 : 0.2) : 0; }
  zoomed_in() {
    const elements = this.run.groups.reduce((sum, g) => sum + (g.area ? g.elements : 0), 0);
    return (this.run.size * this.camera.zoom) / Math.sqrt(elements || 1) > 9;
  }
  draw_under(choice) {
    const values = choice ? this.run.values(this.state, choice) : null, bands = this.bands;
    if (!this.gl) return this.paint_under(new CanvasPen(this.context_of(this.under)), values, bands);
    const key = `${this.state}`, value_key = `${this.state} ${choice ? choice.id : ""}`;
    if (this.moved_key !== key) {
      this.gl.set_displaced(this.run, this.state);
      this.moved_key = key;
    }
    if (this.value_key !== value_key) {
      this.gl.set_values(this.run, values || this.run.groups.map(() => null));
      this.value_key = value_key;
    }
    const c = this.camera, middle = this.middle, alpha = this.mesh_colour();
    const dark = style_of("--mesh").split(",").map(Number);
    this.gl.draw({
      centre: [c.x - middle[0], c.y - middle[1]], scale: [(2 * c.zoom) / this.drawing_width, (2 * c.zoom) / this.height],
      times: this.scale, bands, colours: this.colours(bands), groups: this.drawn_groups(values).map((g) => g.index),
      mesh: alpha && this.zoomed_in() ? [dark[0] / 255, dark[1] / 255, dark[2] / 255, alpha] : null,
    });
  }
  context_of(canvas) {
    const context = canvas.getContext("2d");
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    return context;
  }
  // The same without WebGL, and for SVG: bands of colour as polygons.
  paint_under(pen, values, bands) {
    const colours = this.colours(bands).map(css), last = bands.count - 1;
    for (const group of this.drawn_groups(values)) {
      const own = values && values[group.index];
      for (let e = 0; e < group.elements; ++e) {
        const places = this.run.lattice_places(group, e, this.state, this.scale).map(([x, y]) => this.to_screen(x, y));
        if (!own) {
          for (const side of [this.outline(group, e)]) pen.area(side, "rgb(153,153,153)");
          continue;
        }
        for (let t = 0; t < group.triangles.length; t += 3) {
          const corners = [0, 1, 2].map((k) => {
            const place = group.triangles[t + k];
            return [...places[place], own[e * group.places + place]];
          });
          if (corners.some((p) => Number.isNaN(p[2]))) continue;
          const band = (v) => Math.min(last, Math.max(0, Math.floor((v - bands.low) / bands.step + 1e-4)));
          const of = corners.map((p) => band(p[2])), low = Math.min(...of), high = Math.max(...of);
          for (let b = low; b <= high; ++b) {
            const part = low === high ? corners
              : band_of(corners, b === 0 ? -Infinity : bands.low + b * bands.step, b === last ? Infinity : bands.low + (b + 1) * bands.step);
            if (part.length > 2) pen.area(part, colours[b]);
          }
        }
      }
    }
    if (this.mesh_colour() && this.zoomed_in()) {
      const flat = [];
      for (const group of this.drawn_groups(values))
        for (let e = 0; e < group.elements; ++e)
          for (const side of group.sides)
            for (let i = 0; i + 1 < side.length; ++i) flat.push(...this.node_at(group.node(e, side[i])), ...this.node_at(group.node(e, side[i + 1])));
      pen.lines(flat, `rgba(${style_of("--mesh")},${this.mesh_colour()})`, 0.6);
    }
  }
  outline(group, e) { return group.sides.flatMap((side) => side.slice(0, -1).map((i) => this.node_at(group.node(e, i)))); }
  node_at(node) { return this.to_screen(...this.run.place(node, this.state, this.scale)); }

  draw_over() { this.paint_over(new CanvasPen(this.context_of(this.over)), false); }
  paint_over(pen, for_file) {
    const ink = style_of("--ink"), settings = this.page.settings;
    this.paint_outline(pen, ink);
    this.paint_lines(pen, ink);
    if (settings.supports) this.paint_supports(pen, ink);
    if (settings.loads) this.paint_loads(pen);
    this.paint_water(pen);
    if (settings.diagram) this.paint_diagram(pen, settings.diagram, ink);
    this.paint_legend(pen, ink);
    this.paint_scale(pen, ink);
    const cut = this.page.cut_line;
    if (cut) {
      const ends = cut.map((p) => this.to_screen(...p));
      pen.line(ends, style_of("--mark"), 2, [6, 3]);
      pen.text(ends[0][0] + 4, ends[0][1] - 4, "A", style_of("--mark"));
      pen.text(ends[1][0] + 4, ends[1][1] - 4, "B", style_of("--mark"));
    }
    if (this.probe_place && !for_file) {
      const [x, y] = this.to_screen(...this.probe_place), mark = style_of("--mark"), paper = style_of("--paper");
      for (const [colour, width] of [[paper, 4], [mark, 1.6]]) {
        pen.line([[x - 8, y], [x + 8, y]], colour, width);
        pen.line([[x, y - 8], [x, y + 8]], colour, width);
      }
    }
  }
  // Sides that belong to one element alone, or lie between groups.
  outline_sides() {
    const key = this.run.states[this.state].active.join("");
    if (this.outline_key === key) return this.outline_kept;
    const sides = new Map(), n = this.run.x.length;
    for (const group of this.run.groups) {
      if (!group.area || !this.run.active(this.state, group)) continue;
      for (let e = 0; e < group.elements; ++e)
        for (const side of group.sides) {
          const a = group.node(e, side[0]), b = group.node(e, side[side.length - 1]), id = Math.min(a, b) * n + Math.max(a, b);
          const before = sides.get(id);
          if (before) before.of.push(group.index);
          else sides.set(id, {nodes: side.map((i) => group.node(e, i)), of: [group.index]});
        }
    }
    this.outline_key = key;
    // Where water and soil have elements on one another, the soil decides.
    const soil = (list) => {
      const solid = list.filter((g) => this.run.groups[g].kind === "solid");
      return solid.length ? solid : list;
    };
    this.outline_kept = [...sides.values()].map((s) => ({nodes: s.nodes, of: soil(s.of)})).filter((s) => s.of.length === 1 || s.of.some((g) => g !== s.of[0]))
                            .map((s) => ({nodes: s.nodes, outer: s.of.length === 1}));
    return this.outline_kept;
  }
  paint_outline(pen, ink) {
    const outer = [], inner = [];
    for (const side of this.outline_sides())
      for (let i = 0; i + 1 < side.nodes.length; ++i)
        (side.outer ? outer : inner).push(...this.node_at(side.nodes[i]), ...this.node_at(side.nodes[i + 1]));
    pen.lines(inner, ink, 0.7);
    pen.lines(outer, ink, 1.4);
  }
  paint_lines(pen, ink) {
    const choice = this.choice, bands = this.bands, colours = this.colours(bands).map(css), shown = new Set();
    if (choice)
      for (const {group, element, values} of this.run.line_values(this.state, choice)) {
        shown.add(group.index);
        const line = group.line.map((i) => this.node_at(group.node(element, i)));
        const mean = values.reduce((a, b) => a + b, 0) / values.length;
        const band = Math.min(bands.count - 1, Math.max(0, Math.floor((mean - bands.low) / bands.step)));
        pen.line(line, ink, 6);
        pen.line(line, Number.isFinite(mean) ? colours[band] : "#999", 4.4);
      }
    for (const group of this.run.groups) {
      if (group.area || !group.line || !this.run.active(this.state, group) || shown.has(group.index)) continue;
      const structure = group.kind === "structure";
      for (let e = 0; e < group.elements; ++e) {
        const line = group.line.map((i) => this.node_at(group.node(e, i)));
        if (line.length === 1) pen.line([[line[0][0] - 3, line[0][1]], [line[0][0] + 3, line[0][1]]], style_of("--steel"), 6);
        else pen.line(line, structure ? style_of("--steel") : style_of("--joint"), structure ? 3.4 : 1.6, structure ? [] : [5, 3]);
      }
    }
  }
  // What holds nodes in the stage of the state: 1 held, 0 free.
  held() {
    const held = new Map();
    const enter = (list) => {
      for (const [node, x, y] of list) {
        const now = held.get(node) || [0, 0];
        [x, y].forEach((code, c) => { if (code) now[c] = code === 1 ? 1 : 0; });
        held.set(node, now);
      }
    };
    enter(this.run.json.fixities);
    for (let s = 0; s < this.run.states[this.state].stage; ++s) enter(this.run.json.stages[s].fixities);
    return held;
  }
  paint_supports(pen, ink) {
    const middle = this.middle, there = this.run.active_nodes(this.state);
    let last = [-99, -99];
    for (const [node, [x, y]] of this.held()) {
      if ((!x && !y) || !there[node]) continue;
      const at = this.node_at(node);
      if (Math.hypot(at[0] - last[0], at[1] - last[1]) < 7) continue;
      last = at;
      const size = 5, left = this.run.x[node] <= middle[0] ? -1 : 1, down = this.run.y[node] <= middle[1] ? 1 : -1;
      if (x) pen.line([at, [at[0] + left * size, at[1] - 3], [at[0] + left * size, at[1] + 3], at], ink, 1);
      if (y) pen.line([at, [at[0] - 3, at[1] + down * size], [at[0] + 3, at[1] + down * size], at], ink, 1);
    }
  }
  paint_loads(pen) {
    const loads = this.run.json.stages[this.run.states[this.state].stage - 1].loads, colour = style_of("--load");
    const arrow = (x, y, dx, dy) => {
      const d = Math.hypot(dx, dy), ux = dx / d, uy = dy / d, from = [x - dx, y - dy];
      pen.line([from, [x, y]], colour, 1.4);
      pen.line([[x - 6 * ux + 3 * uy, y - 6 * uy - 3 * ux], [x, y], [x - 6 * ux - 3 * uy, y - 6 * uy + 3 * ux]], colour, 1.4);
    };
    let most = 0;
    for (const [, x, y] of loads.nodes) most = Math.max(most, Math.hypot(x, y));
    for (const [node, x, y] of loads.nodes) {
      const size = Math.hypot(x, y);
      if (size) arrow(...this.node_at(node), ((12 + 22 * (size / most)) * x) / size, (-(12 + 22 * (size / most)) * y) / size);
    }
    most = 0;
    for (const [, , a, b] of loads.edges) most = Math.max(most, Math.abs(a), Math.abs(b));
    let last = [-99, -99];
    for (const [first, second, p1, p2] of loads.edges) {
      const a = this.node_at(first), b = this.node_at(second), d = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
      const middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], p = (p1 + p2) / 2;
      if (!p || Math.hypot(middle[0] - last[0], middle[1] - last[1]) < 9) continue;
      last = middle;
      const size = ((10 + 18 * (Math.abs(p) / most)) * Math.sign(p)) / d;
      arrow(...middle, (b[1] - a[1]) * size, -(b[0] - a[0]) * size);
    }
  }
  paint_water(pen) {
    let lines = [];
    for (let s = 0; s < this.run.states[this.state].stage; ++s) if (this.run.json.stages[s].water.length) lines = this.run.json.stages[s].water;
    for (const line of lines) {
      const on_screen = line.map(([x, y]) => this.to_screen(x, y));
      pen.line(on_screen, style_of("--water"), 2, [9, 4]);
    }
  }
  paint_diagram(pen, name, ink) {
    const q = this.run.quantities.findIndex((one) => one.name === name);
    if (q < 0) return;
    const groups = this.run.ends(this.state), colour = style_of("--diagram");
    let most = 0;
    for (const {ends} of groups) for (const end of ends) if (Number.isFinite(end.values[q])) most = Math.max(most, Math.abs(end.values[q]));
    if (!most) return;
    const offset = 55 / most;
    for (const {group, ends} of groups) {
      const extremes = [null, null];
      for (let i = 0; i + 1 < ends.length; i += 2) {
        const pair = [ends[i], ends[i + 1]].map((end) => ({value: end.values[q], at: this.node_at(end.node)}));
        if (group.line.length < 2 || pair.some((p) => !Number.isFinite(p.value))) continue;
        const [a, b] = pair.map((p) => p.at), d = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
        const normal = [-(b[1] - a[1]) / d, (b[0] - a[0]) / d];
        const tips = pair.map((p) => [p.at[0] + normal[0] * p.value * offset, p.at[1] + normal[1] * p.value * offset]);
        pen.line([a, tips[0], tips[1], b], colour, 1.5);
        pair.forEach((p, k) => {
          if (!extremes[0] || p.value < extremes[0].value) extremes[0] = {value: p.value, at: tips[k]};
          if (!extremes[1] || p.value > extremes[1].value) extremes[1] = {value: p.value, at: tips[k]};
        });
      }
      const written = extremes[0] && extremes[0].value === extremes[1].value ? [extremes[1]] : extremes;
      for (const one of written)
        if (one && Math.abs(one.value) > 0.02 * most) pen.text(one.at[0] + 4, one.at[1] - 3, text_of(one.value, 4), ink, "start", 11);
    }
  }
  paint_legend(pen, ink) {
    const choice = this.choice, x = this.drawing_width + 8, width = 16;
    if (!choice) {
      pen.text(x, 22, "this run has", ink, "start", 11);
      pen.text(x, 36, "no such field", ink, "start", 11);
      return;
    }
    const range = this.page.range(choice, this);
    if (!range) return pen.text(x, 22, "no values here", ink, "start", 11);
    const bands = bands_of(range[0], range[1]), colours = this.colours(bands).map(css);
    const top = 44, height = Math.min(this.height - top - 50, 24 * bands.count), each = height / bands.count;
    const name = choice.id.length > 17 ? choice.id.slice(0, 16) + "…" : choice.id;
    pen.text(x, 16, name, ink, "start", 12);
    pen.text(x, 31, choice.unit ? `[${choice.unit}]` : "", ink, "start", 11);
    for (let b = 0; b < bands.count; ++b) {
      const y = top + height - (b + 1) * each;
      pen.area([[x, y], [x + width, y], [x + width, y + each], [x, y + each]], colours[b]);
    }
    const digits = Math.max(2, Math.ceil(Math.log10(Math.max(Math.abs(bands.low), Math.abs(bands.low + bands.count * bands.step)) / bands.step)) + 2);
    for (let b = 0; b <= bands.count; ++b)
      pen.text(x + width + 5, top + height - b * each + 4, text_of(bands.low + b * bands.step + 0, Math.min(digits, 8)) || "0", ink, "start", 11);
    const rare = range[2] < range[0] || range[3] > range[1];
    const y = top + height + 20;
    if (rare) {
      pen.text(x, y, "in all", ink, "start", 10.5);
      pen.text(x, y + 13, `${text_of(range[2], 4)} to`, ink, "start", 10.5);
      pen.text(x, y + 26, text_of(range[3], 4), ink, "start", 10.5);
    }
  }
  paint_scale(pen, ink) {
    const want = 90 / this.camera.zoom, power = 10 ** Math.floor(Math.log10(want));
    const length = (want / power >= 5 ? 5 : want / power >= 2 ? 2 : 1) * power, px = length * this.camera.zoom, y = this.height - 12;
    pen.line([[12, y - 4], [12, y], [12 + px, y], [12 + px, y - 4]], ink, 1.3);
    const times = this.scale ? `, displacements × ${text_of(this.scale, 3)}` : "";
    pen.text(12 + px + 6, y, `${text_of(length, 3)} ${this.run.json.units.length}${times}`, ink, "start", 11);
  }

  // On paper a canvas of WebGL is empty, and one canvas covers another: all is painted on one, as sharp as the curves.
  to_paper() {
    if (this.copy) return;
    this.copy = h("canvas", {width: this.over.width, height: this.over.height});
    this.copy.style.width = this.over.style.width;
    this.copy.style.height = this.over.style.height;
    const context = this.context_of(this.copy), pen = new CanvasPen(context);
    if (this.triangles > most_svg_triangles) context.drawImage(this.under, 0, 0, this.drawing_width, this.height);
    else this.paint_under(pen, this.choice ? this.run.values(this.state, this.choice) : null, this.bands);
    this.paint_over(pen, true);
    this.box.append(this.copy);
    this.under.hidden = this.over.hidden = true;
  }
  from_paper() {
    if (this.copy) this.copy.remove();
    this.copy = null;
    this.under.hidden = this.over.hidden = false;
  }

  // Files.
  get file() {
    const s = this.run.states[this.state];
    return file_name(`${this.run.name}_${this.choice ? this.choice.id : "mesh"}_${s.stage}_${s.increment}`);
  }
  get triangles() { return this.run.groups.reduce((n, g) => n + (g.area ? (g.elements * g.triangles.length) / 3 : 0), 0); }
  svg() {
    const pen = new SvgPen(this.width, this.height, style_of("--paper"));
    const choice = this.choice, values = choice ? this.run.values(this.state, choice) : null;
    if (this.triangles > most_svg_triangles) pen.image(this.under.toDataURL("image/png"), 0, 0, this.drawing_width, this.height);
    else this.paint_under(pen, values, this.bands);
    this.paint_over(pen, true);
    pen.text(8, 16, this.caption.textContent, style_of("--ink"), "start", 12);
    return pen.text_of_file();
  }
  save_svg() { save(this.file + ".svg", this.svg(), "image/svg+xml"); }
  save_png() {
    const all = h("canvas", {width: this.over.width, height: this.over.height}), c = all.getContext("2d");
    c.fillStyle = style_of("--paper");
    c.fillRect(0, 0, all.width, all.height);
    c.drawImage(this.under, 0, 0);
    c.drawImage(this.over, 0, 0);
    c.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    new CanvasPen(c).text(8, 16, this.caption.textContent, style_of("--ink"), "start", 12);
    all.toBlob((blob) => save(this.file + ".png", blob));
  }
}
