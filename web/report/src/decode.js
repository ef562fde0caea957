// Packed numbers of the page's data (sage/report/encode.hpp) as typed arrays.

export function bytes(text) {
  const raw = atob(text);
  const list = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) list[i] = raw.charCodeAt(i);
  return list;
}

function steps(p, width) {
  const from = bytes(p.b), to = new Float64Array(p.n);
  const none = 256 ** width - 1, size = (p.hi - p.lo) / (none - 1);
  for (let i = 0, at = 0; i < p.n; ++i) {
    let step = 0;
    for (let k = 0, place = 1; k < width; ++k, place *= 256) step += from[at++] * place;
    to[i] = step === none ? NaN : p.lo + step * size;
  }
  return to;
}

function differences(p) {
  const from = bytes(p.b), to = new Int32Array(p.n);
  for (let i = 0, at = 0; i < p.n; ++i) {
    let value = 0, place = 1, byte;
    do {
      byte = from[at++];
      value += (byte & 127) * place;
      place *= 128;
    } while (byte > 127);
    to[i] = (value % 2 ? -(value + 1) / 2 : value / 2) + (i >= p.s ? to[i - p.s] : 0);
  }
  return to;
}

// Float64Array of numbers, Int32Array of whole ones.
export function numbers(p) {
  switch (p.t) {
    case "c": return new Float64Array(p.n).fill(p.v === null ? NaN : p.v);
    case "f8": return new Float64Array(bytes(p.b).buffer);
    case "q3": return steps(p, 3);
    case "q2": return steps(p, 2);
    case "v": return differences(p);
  }
  throw new Error("unknown packing " + p.t);
}

// A function of a key that remembers its answers, the last `most` of them.
export function remembered(most, make) {
  const kept = new Map();
  return (key, ...rest) => {
    if (!kept.has(key)) {
      if (kept.size >= most) kept.delete(kept.keys().next().value);
      kept.set(key, make(key, ...rest));
    }
    return kept.get(key);
  };
}
