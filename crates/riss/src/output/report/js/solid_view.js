// Triangles and lines in space on a canvas: `SolidView`. WebGL 2 by way of twgl.

const PLACE = `#version 300 es
in vec3 position;
in float share;
uniform mat3 turn;
uniform vec3 middle;
uniform vec2 scale;
uniform vec2 shift;
uniform float deepest;
out vec3 eye;
out float value;
void main() {
  eye = turn * (position - middle);
  value = share;
  gl_Position = vec4(shift + scale * eye.xy, -eye.z / deepest, 1.0);
}`;

// Light from the eye shows the form; below zero there is no value.
const COLOR = `#version 300 es
precision highp float;
in vec3 eye;
in float value;
uniform vec3 stops[11];
uniform float lit;
out vec4 color;
void main() {
  float at = clamp(value, 0.0, 1.0) * 10.0;
  int k = min(int(at), 9);
  vec3 hue = value < -0.01 ? vec3(0.6) : mix(stops[k], stops[k + 1], at - float(k));
  vec3 normal = normalize(cross(dFdx(eye), dFdy(eye)));
  color = vec4(hue * (1.0 - lit * (1.0 - abs(normal.z))), 1.0);
}`;

const PLAIN_PLACE = `#version 300 es
in vec2 position;
void main() { gl_Position = vec4(position, -0.999, 1.0); }`;

const PLAIN_COLOR = `#version 300 es
precision highp float;
uniform vec4 tint;
out vec4 color;
void main() { color = tint; }`;

/** A color of the style sheet, `#abc` or `#aabbcc`, as four numbers up to one. */
function tintOf(name, alpha = 1) {
  const text = name.startsWith("#") ? name.slice(1) : themeColor(name).slice(1);
  const pairs = text.length === 3 ? [...text].map((c) => c + c) : text.match(/../g);
  return [...pairs.map((p) => parseInt(p, 16) / 255), alpha];
}

class SolidView {
  /** `size` is the diagonal of all that is drawn; throws where the browser has no WebGL 2. */
  constructor(canvas, size) {
    const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!gl) throw new Error("no WebGL 2");
    Object.assign(this, { canvas, gl, size, buffers: new Map(), eye: { turn: 0, tilt: 0, zoom: 1, shift: [0, 0], middle: [0, 0, 0] } });
    this.surfaceProgram = twgl.createProgramInfo(gl, [PLACE, COLOR]);
    this.lineProgram = twgl.createProgramInfo(gl, [PLACE, PLAIN_COLOR]);
    this.plainProgram = twgl.createProgramInfo(gl, [PLAIN_PLACE, PLAIN_COLOR]);
  }

  /** Rows: to the right, up, towards the eye. */
  axes() {
    const { turn, tilt } = this.eye;
    const [ct, st, cp, sp] = [Math.cos(turn), Math.sin(turn), Math.cos(tilt), Math.sin(tilt)];
    return [[ct, -st, 0], [-st * sp, -ct * sp, cp], [-st * cp, -ct * cp, -sp]];
  }

  /** Pixels of a unit of length. */
  pixels() {
    return (this.eye.zoom * 0.9 * Math.min(this.canvas.width, this.canvas.height)) / this.size;
  }

  /** Starts a picture: the background and where the eye is. */
  begin() {
    const { gl, canvas, eye } = this;
    const ratio = window.devicePixelRatio || 1;
    const wide = Math.round(canvas.clientWidth * ratio);
    if (wide && Math.abs(canvas.width - wide) > 1) [canvas.width, canvas.height] = [wide, Math.round(0.62 * wide)];
    this.width = Math.max(1, canvas.width / 900);
    this.rows = this.axes();
    const scale = this.pixels();
    this.uniforms = {
      turn: [0, 1, 2].flatMap((column) => this.rows.map((row) => row[column])),
      middle: eye.middle,
      scale: [(2 * scale) / canvas.width, (2 * scale) / canvas.height],
      shift: [(2 * eye.shift[0]) / canvas.width, (-2 * eye.shift[1]) / canvas.height],
      deepest: 2 * this.size,
    };
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
  }

  /** Pixels right and down of a place, and how near to the eye it is. */
  seen(x, y, z) {
    const { eye, canvas, rows } = this;
    const from = [x - eye.middle[0], y - eye.middle[1], z - eye.middle[2]];
    const [across, up, near] = rows.map((row) => row[0] * from[0] + row[1] * from[1] + row[2] * from[2]);
    const scale = this.pixels();
    return [canvas.width / 2 + eye.shift[0] + scale * across, canvas.height / 2 + eye.shift[1] - scale * up, near];
  }

  /** Draws arrays with a program; they go to the graphics memory anew where `key` differs from that of the last time. */
  put(name, key, program, arrays, uniforms, kind) {
    const { gl } = this;
    let held = this.buffers.get(name);
    if (held?.key !== key) {
      if (held) Object.values(held.info.attribs).forEach((a) => gl.deleteBuffer(a.buffer));
      if (held?.info.indices) gl.deleteBuffer(held.info.indices);
      held = { key, info: twgl.createBufferInfoFromArrays(gl, arrays()) };
      this.buffers.set(name, held);
    }
    gl.useProgram(program.program);
    twgl.setBuffersAndAttributes(gl, program, held.info);
    twgl.setUniforms(program, uniforms);
    twgl.drawBufferInfo(gl, held.info, kind);
  }

  /**
   * Draws colored triangles.
   *
   * - `arrays`: function that gives `positions`, `shares` of the color scale and `triangles`
   * - `side`: "both", or "far" for those alone that turn away from the eye
   */
  surface(name, key, arrays, stops, side, lit) {
    const { gl } = this;
    if (side === "far") {
      gl.enable(gl.CULL_FACE);
      gl.cullFace(gl.FRONT);
    }
    const flat = Float32Array.from(stops.flat(), (c) => c / 255);
    const made = () => {
      const { positions, shares, triangles } = arrays();
      return { position: { numComponents: 3, data: positions }, share: { numComponents: 1, data: shares }, indices: triangles };
    };
    this.put(name, key, this.surfaceProgram, made, { ...this.uniforms, stops: flat, lit }, gl.TRIANGLES);
    gl.disable(gl.CULL_FACE);
  }

  /** Draws segments between pairs of places. */
  lines(name, key, positions, tint) {
    const made = () => ({ position: { numComponents: 3, data: Float32Array.from(positions) } });
    this.put(name, key, this.lineProgram, made, { ...this.uniforms, tint }, this.gl.LINES);
  }

  /** Draws triangles given in pixels over all else. */
  over(corners, tint) {
    if (!corners.length) return;
    const { gl, canvas } = this;
    const clip = Float32Array.from(corners.flat(), (v, i) => (i % 2 ? 1 - (2 * v) / canvas.height : (2 * v) / canvas.width - 1));
    gl.disable(gl.DEPTH_TEST);
    this.put("over", Symbol(), this.plainProgram, () => ({ position: { numComponents: 2, data: clip } }), { tint }, gl.TRIANGLES);
    gl.enable(gl.DEPTH_TEST);
  }

  /** Corners of triangles along a line through pixels. */
  ribbon(points, wide) {
    const corners = [];
    for (let i = 0; i + 1 < points.length; i++) {
      const [[ax, ay], [bx, by]] = [points[i], points[i + 1]];
      const length = Math.hypot(bx - ax, by - ay) || 1;
      const [x, y] = [(-(by - ay) / length) * 0.5 * wide, ((bx - ax) / length) * 0.5 * wide];
      corners.push([ax + x, ay + y], [ax - x, ay - y], [bx + x, by + y], [bx + x, by + y], [ax - x, ay - y], [bx - x, by - y]);
    }
    return corners;
  }

  /** Corners of the triangles of a dot. */
  dot([x, y], radius) {
    const at = (k) => [x + radius * Math.cos((k * Math.PI) / 4), y + radius * Math.sin((k * Math.PI) / 4)];
    return Array.from({ length: 8 }, (_, k) => [[x, y], at(k), at(k + 1)]).flat();
  }
}
