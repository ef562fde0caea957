// A run: its mesh, its states, and what is at a place.
import {bytes, numbers, remembered} from "./decode.js";
import {choices} from "./fields.js";

class Group {
  constructor(json, index, nodes) {
    Object.assign(this, json);
    this.index = index;
    this.connect = numbers(json.connect);
    this.numbers = numbers(json.numbers);
    this.area = json.lattice !== undefined && json.lattice.length > 0;
    if (json.entries) this.entries = numbers(json.entries);
    else if (this.area) this.entries = this.connect.map((node) => node + json.material * nodes);
    this.places = this.area ? json.lattice.length / json.nodes : 0;
  }
  node(e, i) { return this.connect[e * this.nodes + i]; }
}

export class Run {
  constructor(json, index) {
    this.json = json;
    this.index = index;
    this.name = json.name;
    this.title = json.title;
    this.x = numbers(json.nodes.x);
    this.y = numbers(json.nodes.y);
    this.number = numbers(json.nodes.number);
    this.groups = json.groups.map((g, i) => new Group(g, i, this.x.length));
    this.entries = json.groups.some((g) => g.entries) ? json.entries : this.x.length * json.materials.length;
    this.states = json.states;
    this.fields = json.fields;
    this.choices = choices(json.fields);
    this.quantities = json.quantities;
    this.digits = json.exact ? 10 : 7;
    this.tables = json.tables.map((t) => ({...t, columns: t.columns.map((c) => ({...c, values: numbers(c.values)}))}));
    this.box = this.bounds();
    this.kept_values = remembered(12, (key, state, choice) => this.make_values(state, choice));
    this.kept_raw = remembered(60, (key, p) => numbers(p));
    this.displaced = remembered(6, (state) => this.make_displaced(state));
  }

  bounds() {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = 0; i < this.x.length; ++i) {
      box[0] = Math.min(box[0], this.x[i]);
      box[1] = Math.min(box[1], this.y[i]);
      box[2] = Math.max(box[2], this.x[i]);
      box[3] = Math.max(box[3], this.y[i]);
    }
    return box;
  }
  get size() { return Math.max(this.box[2] - this.box[0], this.box[3] - this.box[1]) || 1; }
  choice(id) { return this.choices.find((c) => c.id === id); }
  active(state, group) { return this.states[state].active[group.index] === 1; }

  // Numbers of a component at nodes; null where the page has none.
  at_nodes(state, field, component) {
    const all = this.states[state].values[field];
    return all ? this.kept_raw(`${state} ${field} ${component}`, all[component]) : null;
  }
  at_points(state, group, field, component) {
    const all = this.states[state].values[field];
    const own = all && all[group.index];
    return own ? this.kept_raw(`${state} ${field} ${group.index} ${component}`, own[component]) : null;
  }
  components(field) { return this.fields.find((f) => f.name === field).columns.length; }

  // Displacements of nodes: [x, y]; 0 where nothing is known.
  make_displaced(state) {
    const of = [0, 1].map((c) => this.at_nodes(state, "displacement", c));
    return of.map((list) => Float64Array.from(this.x, (_, i) => (list && Number.isFinite(list[i]) ? list[i] : 0)));
  }
  largest_displacement(state) {
    const [u, v] = this.displaced(state);
    let most = 0;
    for (let i = 0; i < u.length; ++i) most = Math.max(most, Math.hypot(u[i], v[i]));
    return most;
  }

  // A flag for each node that an active element has.
  active_nodes(state) {
    const key = this.states[state].active.join("");
    if (this.active_key !== key) {
      this.active_key = key;
      this.active_kept = new Uint8Array(this.x.length);
      for (const group of this.groups) if (this.active(state, group)) for (const node of group.connect) this.active_kept[node] = 1;
    }
    return this.active_kept;
  }

  // Of each group that fills an area: a value at every place of every element's lattice; null = it has none.
  values(state, choice) { return this.kept_values(`${state} ${choice.id}`, state, choice); }
  make_values(state, choice) {
    return choice.place === "node" ? this.values_of_nodes(state, choice) : this.values_of_points(state, choice);
  }
  on_lattice(group, parts, n, index, of) {
    const values = new Float32Array(group.elements * group.places), c = new Array(n);
    for (let e = 0, at = 0; e < group.elements; ++e)
      for (let v = 0; v < group.places; ++v, ++at) {
        for (let k = 0; k < n; ++k) {
          let sum = 0;
          for (let i = 0; i < group.nodes; ++i) sum += group.lattice[v * group.nodes + i] * parts[k][index[e * group.nodes + i]];
          c[k] = sum;
        }
        values[at] = of(c);
      }
    return values;
  }
  values_of_nodes(state, choice) {
    const n = this.components(choice.field), parts = [];
    for (let k = 0; k < n; ++k) parts.push(this.at_nodes(state, choice.field, k)?.slice());
    if (!parts[0]) return this.groups.map(() => null);
    return this.groups.map((group) => {
      if (!group.area || !this.active(state, group)) return null;
      for (const part of parts) this.fill_between_corners(group, part);
      const values = this.on_lattice(group, parts, n, group.connect, choice.of);
      return values.some(Number.isFinite) ? values : null;
    });
  }
  // The excess pressure of pore water is linear between the corners, which alone have it.
  fill_between_corners(group, list) {
    const corners = {6: 3, 8: 4, 9: 4}[group.nodes];
    if (!corners) return;
    for (let e = 0; e < group.elements; ++e)
      for (let i = corners; i < group.nodes; ++i) {
        const node = group.node(e, i), side = i - corners;
        if (!Number.isNaN(list[node])) continue;
        const around = side < corners ? [side, (side + 1) % corners] : [...Array(corners).keys()];
        list[node] = around.reduce((sum, c) => sum + list[group.node(e, c)], 0) / around.length;
      }
  }
  // Means of elements, averaged at nodes over the elements of one material: as sagefe's pictures are drawn.
  values_of_points(state, choice) {
    const n = this.components(choice.field);
    const sums = Array.from({length: n}, () => new Float64Array(this.entries)), uses = new Float64Array(this.entries);
    const single = this.fields.find((f) => f.name === choice.field).words.length > 0;
    const has = this.groups.map((group) => {
      const raw = [];
      for (let k = 0; k < n; ++k) raw.push(group.area && this.active(state, group) ? this.at_points(state, group, choice.field, k) : null);
      if (!raw[0]) return false;
      const count = raw[0].length / group.elements;
      for (let e = 0; e < group.elements; ++e) {
        const mean = raw.map((list) => {
          let sum = 0;
          for (let p = 0; p < count; ++p) sum += single ? choice.of([list[e * count + p]]) : list[e * count + p];
          return sum / count;
        });
        if (!Number.isFinite(mean[0])) continue;
        for (let i = 0; i < group.nodes; ++i) {
          const entry = group.entries[e * group.nodes + i];
          for (let k = 0; k < n; ++k) sums[k][entry] += mean[k];
          uses[entry] += 1;
        }
      }
      return true;
    });
    for (const list of sums) for (let i = 0; i < list.length; ++i) list[i] = uses[i] ? list[i] / uses[i] : NaN;
    return this.groups.map((group, g) =>
      has[g] ? this.on_lattice(group, sums, n, group.entries, single ? (c) => c[0] : choice.of) : null);
  }

  // [low, high, full low, full high] of what is shown; without rare values far off where they would take a third of the colours.
  range(state, choice) {
    const all = [];
    for (const values of this.values(state, choice))
      if (values) {
        const stride = Math.max(1, Math.floor(values.length / 40000));
        for (let i = 0; i < values.length; i += stride) if (Number.isFinite(values[i])) all.push(values[i]);
      }
    for (const item of this.line_values(state, choice)) for (const v of item.values) if (Number.isFinite(v)) all.push(v);
    if (!all.length) return null;
    const sorted = Float64Array.from(all).sort(), last = sorted.length - 1;
    const full = [sorted[0], sorted[last]], most = [sorted[Math.floor(last * 0.005)], sorted[Math.ceil(last * 0.995)]];
    const robust = last > 200 && most[1] - most[0] < 0.67 * (full[1] - full[0]) && most[1] > most[0];
    return robust ? [...most, ...full] : [...full, ...full];
  }

  // Interfaces with values at their points: {group, element, values}.
  line_values(state, choice) {
    const list = [];
    if (choice.place !== "point") return list;
    for (const group of this.groups) {
      if (group.kind !== "interface" || !this.active(state, group)) continue;
      const n = this.components(choice.field), raw = [];
      for (let k = 0; k < n; ++k) raw.push(this.at_points(state, group, choice.field, k));
      if (!raw[0]) continue;
      const count = raw[0].length / group.elements;
      for (let e = 0; e < group.elements; ++e) {
        const values = [];
        for (let p = 0; p < count; ++p) values.push(choice.of(raw.map((r) => r[e * count + p])));
        list.push({group, element: e, values});
      }
    }
    return list;
  }

  // Place of a node, displaced `scale` times.
  place(node, state, scale) {
    const [u, v] = this.displaced(state);
    return [this.x[node] + scale * u[node], this.y[node] + scale * v[node]];
  }
  point_place(group, e, p) {
    let x = 0, y = 0;
    for (let i = 0; i < group.nodes; ++i) {
      const w = group.weights[p * group.nodes + i], node = group.node(e, i);
      x += w * this.x[node];
      y += w * this.y[node];
    }
    return [x, y];
  }

  // Places of an element's lattice, as drawn.
  lattice_places(group, e, state, scale) {
    const places = [], [u, v] = this.displaced(state);
    for (let k = 0; k < group.places; ++k) {
      let x = 0, y = 0;
      for (let i = 0; i < group.nodes; ++i) {
        const w = group.lattice[k * group.nodes + i], node = group.node(e, i);
        x += w * (this.x[node] + scale * u[node]);
        y += w * (this.y[node] + scale * v[node]);
      }
      places.push([x, y]);
    }
    return places;
  }

  // A grid of buckets over the elements as drawn, to find the one under the pointer.
  finder(state, scale) {
    const key = `${state} ${scale}`;
    if (this.found_key !== key) {
      this.found_key = key;
      this.buckets = this.make_buckets(state, scale);
    }
    return this.buckets;
  }
  make_buckets(state, scale) {
    const boxes = [], all = [Infinity, Infinity, -Infinity, -Infinity];
    for (const group of this.groups) {
      if (!group.area || !this.active(state, group)) continue;
      for (let e = 0; e < group.elements; ++e) {
        const box = [Infinity, Infinity, -Infinity, -Infinity];
        for (let i = 0; i < group.nodes; ++i) {
          const [x, y] = this.place(group.node(e, i), state, scale);
          box[0] = Math.min(box[0], x);
          box[1] = Math.min(box[1], y);
          box[2] = Math.max(box[2], x);
          box[3] = Math.max(box[3], y);
        }
        for (const k of [0, 1]) all[k] = Math.min(all[k], box[k]);
        for (const k of [2, 3]) all[k] = Math.max(all[k], box[k]);
        boxes.push({group, e, box});
      }
    }
    const n = Math.max(1, Math.ceil(Math.sqrt(boxes.length / 2)));
    const dx = (all[2] - all[0]) / n || 1, dy = (all[3] - all[1]) / n || 1, cells = new Map();
    const cell = (v, low, d) => Math.min(n - 1, Math.max(0, Math.floor((v - low) / d)));
    for (const item of boxes)
      for (let j = cell(item.box[1], all[1], dy); j <= cell(item.box[3], all[1], dy); ++j)
        for (let i = cell(item.box[0], all[0], dx); i <= cell(item.box[2], all[0], dx); ++i) {
          const key = j * n + i;
          if (!cells.has(key)) cells.set(key, []);
          cells.get(key).push(item);
        }
    return (x, y) => cells.get(cell(y, all[1], dy) * n + cell(x, all[0], dx)) || [];
  }

  // {group, element, value} at a place as drawn; value only with a choice.  null: no element is there.
  hit(state, scale, x, y, choice) {
    let best = null;
    for (const {group, e} of this.finder(state, scale)(x, y)) {
      const places = this.lattice_places(group, e, state, scale), values = choice && this.values(state, choice)[group.index];
      for (let t = 0; t < group.triangles.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => group.triangles[t + k]), [A, B, C] = [places[a], places[b], places[c]];
        const det = (B[0] - A[0]) * (C[1] - A[1]) - (C[0] - A[0]) * (B[1] - A[1]);
        const s = ((x - A[0]) * (C[1] - A[1]) - (C[0] - A[0]) * (y - A[1])) / det;
        const r = ((B[0] - A[0]) * (y - A[1]) - (x - A[0]) * (B[1] - A[1])) / det;
        if (!(s >= -1e-9 && r >= -1e-9 && s + r <= 1 + 1e-9)) continue;
        const at = e * group.places;
        const found = {group, element: e, value: values ? (1 - s - r) * values[at + a] + s * values[at + b] + r * values[at + c] : NaN};
        if (!best || (Number.isNaN(best.value) && !Number.isNaN(found.value))) best = found;
        break;
      }
    }
    return best;
  }

  // What is known of an element's integration point (nearest to a place, or of that number from 1): as in STEM.points.csv.
  probe_element(state, group, e, where) {
    const points = this.json.means ? 1 : group.points;
    let p = 0, least = Infinity;
    if (typeof where === "number") p = Math.min(Math.max(where, 1), points) - 1;
    else
      for (let i = 0; i < points; ++i) {
        const at = this.point_place(group, e, i), d = Math.hypot(at[0] - where[0], at[1] - where[1]);
        if (d < least) [least, p] = [d, i];
      }
    const rows = [];
    for (const field of this.fields) {
      if (field.place !== "point" || !this.active(state, group)) continue;
      field.columns.forEach((column, k) => {
        const list = this.at_points(state, group, field.name, k);
        if (!list) return;
        const value = list[e * points + p];
        rows.push({column, unit: field.unit, value, word: field.words.length ? field.words[value] : undefined});
      });
    }
    return {group, element: e, point: p, means: this.json.means, place: this.point_place(group, e, p), rows};
  }
  probe_node(state, node) {
    const rows = [];
    for (const field of this.fields)
      if (field.place === "node")
        field.columns.forEach((column, k) => rows.push({column, unit: field.unit, value: this.at_nodes(state, field.name, k)[node]}));
    return {node, number: this.number[node], place: [this.x[node], this.y[node]], rows};
  }
  nearest_node(group, e, state, scale, x, y) {
    let best = -1, least = Infinity;
    for (let i = 0; i < group.nodes; ++i) {
      const node = group.node(e, i), at = this.place(node, state, scale), d = Math.hypot(at[0] - x, at[1] - y);
      if (d < least) [least, best] = [d, node];
    }
    return best;
  }
  find_element(number) {
    for (const group of this.groups) {
      const e = group.numbers.indexOf(number);
      if (e >= 0) return {group, element: e};
    }
    return null;
  }

  // Ends of structures in a state: {group, ends: [{element, end, node, values}]}.
  ends(state) {
    return (this.states[state].ends || []).map((g) => {
      const values = g.values.map(numbers);
      return {group: this.groups[g.group],
              ends: g.element.map((element, i) => ({element, end: g.end[i], node: g.node[i], values: values.map((v) => v[i])}))};
    });
  }
  picture_url(picture) { return URL.createObjectURL(new Blob([bytes(picture.svg)], {type: "image/svg+xml"})); }
}
