// Coloured bands over the mesh by WebGL2: positions, displacements and values are kept in buffers, so that moving the
// view, the scale of displacements or the limits of the colours costs a few numbers.

const vertex = `#version 300 es
in vec2 place, moved; in float value;
uniform vec2 centre, scale; uniform float times;
out float v;
void main() { v = value; gl_Position = vec4((place + times * moved - centre) * scale, 0.0, 1.0); }`;
const fragment = `#version 300 es
precision highp float;
in float v; out vec4 colour;
uniform float low, band; uniform int count; uniform vec3 colours[24]; uniform vec4 plain;
void main() {
  if (plain.a > 0.0) { colour = vec4(plain.rgb * plain.a, plain.a); return; }
  if (v > 1e29) { colour = vec4(0.6, 0.6, 0.6, 1.0); return; }
  colour = vec4(colours[clamp(int(floor((v - low) / band + 1e-4)), 0, count - 1)], 1.0);
}`;

function shader(gl, type, text) {
  const made = gl.createShader(type);
  gl.shaderSource(made, text);
  gl.compileShader(made);
  if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
  return made;
}

export function make_gl(canvas) {
  if (/[?#&]nowebgl/.test(location.href)) return null;
  const gl = canvas.getContext("webgl2", {antialias: true, preserveDrawingBuffer: true, alpha: true});
  return gl ? new Gl(gl) : null;
}

class Gl {
  constructor(gl) {
    this.gl = gl;
    const program = (this.program = gl.createProgram());
    gl.attachShader(program, shader(gl, gl.VERTEX_SHADER, vertex));
    gl.attachShader(program, shader(gl, gl.FRAGMENT_SHADER, fragment));
    ["place", "moved", "value"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    this.at = {};
    for (const name of ["centre", "scale", "times", "low", "band", "count", "colours", "plain"])
      this.at[name] = gl.getUniformLocation(program, name);
    this.buffers = {};
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }
  fill(name, data, target = this.gl.ARRAY_BUFFER) {
    const gl = this.gl;
    if (!this.buffers[name]) this.buffers[name] = gl.createBuffer();
    gl.bindBuffer(target, this.buffers[name]);
    gl.bufferData(target, data, gl.DYNAMIC_DRAW);
  }
  use(name, index, size) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[name]);
    gl.enableVertexAttribArray(index);
    gl.vertexAttribPointer(index, size, gl.FLOAT, false, 0, 0);
  }

  // Once a run: lattice places of all elements, and the nodes, about `middle`.
  set_mesh(run, middle) {
    const places = [], triangles = [], first = [];
    let vertices = 0;
    for (const group of run.groups) {
      first.push(vertices);
      vertices += group.elements * group.places;
    }
    const place = new Float32Array(2 * vertices);
    this.first = first;
    this.vertices = vertices;
    for (const group of run.groups) {
      const list = new Uint32Array(group.area ? group.elements * group.triangles.length : 0);
      let at = 0;
      for (let e = 0; e < group.elements && group.area; ++e) {
        const base = first[group.index] + e * group.places;
        for (let k = 0; k < group.places; ++k) {
          let x = 0, y = 0;
          for (let i = 0; i < group.nodes; ++i) {
            const w = group.lattice[k * group.nodes + i], node = group.node(e, i);
            x += w * (run.x[node] - middle[0]);
            y += w * (run.y[node] - middle[1]);
          }
          place[2 * (base + k)] = x;
          place[2 * (base + k) + 1] = y;
        }
        for (const t of group.triangles) list[at++] = base + t;
      }
      this.fill("triangles" + group.index, list, this.gl.ELEMENT_ARRAY_BUFFER);
      triangles.push(list.length);
    }
    this.triangles = triangles;
    this.fill("place", place);
    const nodes = new Float32Array(2 * run.x.length);
    for (let i = 0; i < run.x.length; ++i) {
      nodes[2 * i] = run.x[i] - middle[0];
      nodes[2 * i + 1] = run.y[i] - middle[1];
    }
    this.fill("nodes", nodes);
    this.sides = run.groups.map((group) => {
      const seen = new Set(), list = [], n = run.x.length;
      if (group.area)
        for (let e = 0; e < group.elements; ++e)
          for (const side of group.sides)
            for (let i = 0; i + 1 < side.length; ++i) {
              const a = group.node(e, side[i]), b = group.node(e, side[i + 1]), key = Math.min(a, b) * n + Math.max(a, b);
              if (seen.has(key)) continue;
              seen.add(key);
              list.push(a, b);
            }
      this.fill("sides" + group.index, new Uint32Array(list), this.gl.ELEMENT_ARRAY_BUFFER);
      return list.length;
    });
  }
  set_displaced(run, state) {
    const [u, v] = run.displaced(state), moved = new Float32Array(2 * this.vertices), nodes = new Float32Array(2 * run.x.length);
    for (let i = 0; i < u.length; ++i) {
      nodes[2 * i] = u[i];
      nodes[2 * i + 1] = v[i];
    }
    for (const group of run.groups)
      for (let e = 0; e < group.elements && group.area; ++e)
        for (let k = 0, at = this.first[group.index] + e * group.places; k < group.places; ++k, ++at) {
          let x = 0, y = 0;
          for (let i = 0; i < group.nodes; ++i) {
            const w = group.lattice[k * group.nodes + i], node = group.node(e, i);
            x += w * u[node];
            y += w * v[node];
          }
          moved[2 * at] = x;
          moved[2 * at + 1] = y;
        }
    this.fill("moved", moved);
    this.fill("nodes_moved", nodes);
  }
  set_values(run, values) {
    const all = new Float32Array(this.vertices).fill(1e30);
    values.forEach((list, g) => {
      if (list) for (let i = 0, at = this.first[g]; i < list.length; ++i, ++at) all[at] = Number.isFinite(list[i]) ? list[i] : 1e30;
    });
    this.fill("value", all);
  }

  // look: {centre, scale (clip units a length), times, bands, colours, groups (in the order of drawing), mesh: rgba or null}
  draw(look) {
    const gl = this.gl;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(this.program);
    gl.uniform2fv(this.at.centre, look.centre);
    gl.uniform2fv(this.at.scale, look.scale);
    gl.uniform1f(this.at.times, look.times);
    gl.uniform1f(this.at.low, look.bands.low);
    gl.uniform1f(this.at.band, look.bands.step);
    gl.uniform1i(this.at.count, look.bands.count);
    const colours = new Float32Array(72);
    look.colours.forEach((c, i) => colours.set([c[0] / 255, c[1] / 255, c[2] / 255], 3 * i));
    gl.uniform3fv(this.at.colours, colours);
    this.use("place", 0, 2);
    this.use("moved", 1, 2);
    this.use("value", 2, 1);
    gl.uniform4f(this.at.plain, 0, 0, 0, 0);
    for (const g of look.groups) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers["triangles" + g]);
      gl.drawElements(gl.TRIANGLES, this.triangles[g], gl.UNSIGNED_INT, 0);
    }
    if (!look.mesh) return;
    this.use("nodes", 0, 2);
    this.use("nodes_moved", 1, 2);
    gl.disableVertexAttribArray(2);
    gl.uniform4fv(this.at.plain, look.mesh);
    for (const g of look.groups) {
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers["sides" + g]);
      gl.drawElements(gl.LINES, this.sides[g], gl.UNSIGNED_INT, 0);
    }
  }
}
