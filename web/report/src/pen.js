// The same strokes on a canvas and in an SVG file.  Colours and places are the caller's; places in pixels.

export class CanvasPen {
  constructor(context) { this.c = context; }
  area(points, fill) {
    const c = this.c;
    c.beginPath();
    points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.closePath();
    c.fillStyle = c.strokeStyle = fill;
    c.lineWidth = 0.7;  // over the hairlines between neighbours
    c.fill();
    c.stroke();
  }
  line(points, stroke, width = 1, dash = []) {
    const c = this.c;
    c.beginPath();
    points.forEach(([x, y], i) => (i ? c.lineTo(x, y) : c.moveTo(x, y)));
    c.strokeStyle = stroke;
    c.lineWidth = width;
    c.setLineDash(dash);
    c.stroke();
    c.setLineDash([]);
  }
  // Many separate lines of two points: x1 y1 x2 y2 ...
  lines(flat, stroke, width) {
    const c = this.c;
    c.beginPath();
    for (let i = 0; i < flat.length; i += 4) {
      c.moveTo(flat[i], flat[i + 1]);
      c.lineTo(flat[i + 2], flat[i + 3]);
    }
    c.strokeStyle = stroke;
    c.lineWidth = width;
    c.stroke();
  }
  text(x, y, text, fill, anchor = "start", size = 12) {
    const c = this.c;
    c.font = `${size}px system-ui, sans-serif`;
    c.textAlign = anchor === "middle" ? "center" : anchor;
    c.fillStyle = fill;
    c.fillText(text, x, y);
  }
  image(url, x, y, width, height, source) { this.c.drawImage(source, x, y, width, height); }
}

const xml = (text) => String(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`).replace(/[\u0000-\u0008\u000b-\u001f]/g, " ");
const n = (v) => String(Math.round(v * 100) / 100);
const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${n(x)} ${n(y)}`).join("");

export class SvgPen {
  constructor(width, height, background) {
    this.width = width;
    this.height = height;
    this.parts = [`<rect width="${width}" height="${height}" fill="${background}"/>`];
  }
  area(points, fill) { this.parts.push(`<path d="${path(points)}Z" fill="${fill}" stroke="${fill}" stroke-width=".5"/>`); }
  line(points, stroke, width = 1, dash = []) {
    const dashes = dash.length ? ` stroke-dasharray="${dash.join(" ")}"` : "";
    this.parts.push(`<path d="${path(points)}" fill="none" stroke="${stroke}" stroke-width="${width}"${dashes}/>`);
  }
  lines(flat, stroke, width) {
    let d = "";
    for (let i = 0; i < flat.length; i += 4) d += `M${n(flat[i])} ${n(flat[i + 1])}L${n(flat[i + 2])} ${n(flat[i + 3])}`;
    this.parts.push(`<path d="${d}" fill="none" stroke="${stroke}" stroke-width="${width}"/>`);
  }
  text(x, y, text, fill, anchor = "start", size = 12) {
    this.parts.push(`<text x="${n(x)}" y="${n(y)}" fill="${fill}" font-family="sans-serif" font-size="${size}" text-anchor="${anchor}">${xml(text)}</text>`);
  }
  image(url, x, y, width, height) {
    this.parts.push(`<image href="${url}" x="${x}" y="${y}" width="${width}" height="${height}"/>`);
  }
  text_of_file() {
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${this.width}" height="${this.height}" viewBox="0 0 ${this.width} ${this.height}">\n${this.parts.join("\n")}\n</svg>\n`;
  }
}

// The part of a triangle whose value lies between two limits; corners are [x, y, value].
export function band_of(triangle, low, high) {
  const cut = (points, limit, sign) => {
    const kept = [];
    for (let i = 0; i < points.length; ++i) {
      const a = points[i], b = points[(i + 1) % points.length], da = sign * (a[2] - limit), db = sign * (b[2] - limit);
      if (da >= 0) kept.push(a);
      if (da * db < 0) {
        const t = da / (da - db);
        kept.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), limit]);
      }
    }
    return kept;
  };
  return cut(cut(triangle, low, 1), high, -1);
}
