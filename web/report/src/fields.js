// What a view can show: fields, their components, and what follows from the stress at a place.

const stress = {
  mean: (s) => (s[0] + s[1] + s[2]) / 3,
  deviator: (s) =>
    Math.sqrt(((s[0] - s[1]) ** 2 + (s[1] - s[2]) ** 2 + (s[2] - s[0]) ** 2) / 2 + 3 * s[3] ** 2),
  principal(s) {
    const centre = (s[0] + s[1]) / 2, radius = Math.hypot((s[0] - s[1]) / 2, s[3]);
    return [centre - radius, centre + radius, s[2]].sort((a, b) => b - a);
  },
};

// {id, label, unit, place, field, of: components -> number}; components are those of the field at one place.
export function choices(fields) {
  const list = [];
  for (const field of fields) {
    const n = field.columns.length;
    const base = {unit: field.unit === "-" ? "" : field.unit, place: field.place, field: field.name, sign: field.sign};
    const title = (text) => (field.meaning && n === 1 ? `${field.meaning} (${text})` : text);
    if (field.words.length) {
      list.push({...base, unit: "", id: field.name, label: "yielded: part of the points not elastic",
                 of: (c) => (Number.isNaN(c[0]) ? NaN : c[0] > 1 ? 1 : 0)});
      continue;
    }
    if (field.vector) list.push({...base, id: field.name, label: field.name + " (length)", of: (c) => Math.hypot(c[0], c[1])});
    for (let k = 0; k < n; ++k)
      list.push({...base, id: field.columns[k], label: title(field.columns[k]), of: (c) => c[k]});
    if (field.name !== "stress" || n !== 4) continue;
    const more = [["sigma_3", "sigma_3 (least principal stress)", (s) => stress.principal(s)[2]],
                  ["sigma_1", "sigma_1 (largest principal stress)", (s) => stress.principal(s)[0]],
                  ["stress_difference", "sigma_1 - sigma_3", (s) => stress.principal(s)[0] - stress.principal(s)[2]],
                  ["mean_stress", "mean stress p", stress.mean], ["deviator", "deviator q", stress.deviator]];
    for (const [id, label, of] of more) list.push({...base, id, label, of});
  }
  return list;
}

export function default_choice(list) {
  for (const id of ["stress_difference", "head", "excess_pressure", "displacement"]) if (list.some((c) => c.id === id)) return id;
  return list.length ? list[0].id : "";
}

const viridis = [[68, 1, 84], [72, 24, 106], [71, 45, 123], [66, 64, 134], [59, 82, 139], [51, 99, 141], [44, 114, 142],
                 [38, 130, 142], [33, 145, 140], [31, 160, 136], [40, 174, 128], [63, 188, 115], [94, 201, 98], [132, 212, 75],
                 [173, 220, 48], [216, 226, 25], [253, 231, 37]];

// The colour map of sagefe's pictures, which the colour-blind can read; [red, green, blue] of 0..255.
export function colour(t) {
  const at = Math.min(Math.max(t, 0), 1) * (viridis.length - 1), low = Math.min(Math.floor(at), viridis.length - 2);
  return viridis[low].map((c, i) => Math.round(c + (at - low) * (viridis[low + 1][i] - c)));
}
export const css = (c) => `rgb(${c[0]},${c[1]},${c[2]})`;
export const line_colours = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#8a8a00", "#e69f00", "#56b4e9"];

export function nice_step(size) {
  const power = 10 ** Math.floor(Math.log10(size)), part = size / power;
  return (part <= 1.0001 ? 1 : part <= 2.0001 ? 2 : part <= 2.5001 ? 2.5 : part <= 5.0001 ? 5 : 10) * power;
}

// Bands of colour between round limits: {low, step, count}.
export function bands_of(low, high, about = 10) {
  if (!(low < high)) {
    const half = Math.max(Math.abs(low) * 1e-3, 1e-12) || 1e-12;
    low -= half;
    high += half;
  }
  const step = nice_step((high - low) / about);
  const first = Math.floor(low / step + 1e-6), last = Math.ceil(high / step - 1e-6);
  return {low: first * step, step, count: Math.max(1, Math.min(24, last - first))};
}

// A number as people read it: so many digits, without noise.
export function text_of(value, digits = 6) {
  if (value === null || value === undefined || Number.isNaN(value)) return "";
  if (!Number.isFinite(value)) return value > 0 ? "inf" : "-inf";
  return String(Number(value.toPrecision(digits)));
}
