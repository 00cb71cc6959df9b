// Fields of a step: `QUANTITIES`, `readFields(step)`, `canReadFields`. The reverse of output/report/quantize.rs.

/** What the colors can show; `signed` quantities have white at zero. */
const QUANTITIES = [
  { name: "von_mises", title: withUnit("von Mises stress", "stress") },
  { name: "max_principal_stress", title: withUnit("max. principal stress", "stress") },
  { name: "min_principal_stress", title: withUnit("min. principal stress", "stress"), signed: true },
  { name: "stress_xx", title: withUnit("stress xx", "stress"), signed: true },
  { name: "stress_yy", title: withUnit("stress yy", "stress"), signed: true },
  { name: "stress_xy", title: withUnit("stress xy", "stress"), signed: true },
  { name: "displacement", title: withUnit("displacement", "length") },
  { name: "displacement_x", title: withUnit("displacement x", "length"), signed: true },
  { name: "displacement_y", title: withUnit("displacement y", "length"), signed: true },
  { name: "error_indicator", title: "error indicator" },
];

const canReadFields = typeof DecompressionStream === "function";

async function decompress(base64) {
  const text = atob(base64);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Reads one channel of `n` values from byte `at` on. */
function readChannel(channel, data, at, n) {
  const values = new Float64Array(n);
  const mask = channel.bytes === 2 ? 0xffff : 0xffffff;
  const step = (channel.high - channel.low) / (mask - 1);
  const unit = channel.scale.asinh?.unit;
  let last = 0;
  for (let i = 0; i < n; i++) {
    let z = data[at + i] | (data[at + n + i] << 8);
    if (channel.bytes === 3) z |= data[at + 2 * n + i] << 16;
    last = (last + ((z >>> 1) ^ -(z & 1))) & mask;
    const value = channel.low + last * step;
    values[i] = last === mask ? NaN : unit ? unit * Math.sinh(value) : value;
  }
  return values;
}

/** Reads triangles from byte `at` on; returns the byte after them. */
function readTriangles(triangles, data, at) {
  let next = 0;
  for (let i = 0; i < triangles.length; i++) {
    let back = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = data[at++];
      back |= (byte & 127) << shift;
      if (byte < 128) break;
    }
    triangles[i] = next - back;
    if (back === 0) next++;
  }
  return at;
}

/** Sides that belong to one triangle only, as pairs of vertices. */
function outline(triangles, n) {
  const keys = new Float64Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[t + k];
      const b = triangles[t + ((k + 1) % 3)];
      keys[t + k] = a < b ? a * n + b : b * n + a;
    }
  }
  keys.sort();
  const sides = [];
  for (let i = 0; i < keys.length; i++) {
    if (keys[i] !== keys[i - 1] && keys[i] !== keys[i + 1]) sides.push(Math.floor(keys[i] / n), keys[i] % n);
  }
  return Uint32Array.from(sides);
}

/** The fields of a step; values of a quantity are made when they are asked for. */
class Fields {
  constructor(packed, data) {
    Object.assign(this, { step: packed.step, n: packed.n_vertices, nComputed: packed.n_computed, ranges: packed.ranges });
    this.channels = new Map();
    let at = 0;
    for (const channel of packed.channels) {
      this.channels.set(channel.name, readChannel(channel, data, at, this.n));
      at += channel.bytes * this.n;
    }
    this.triangles = new Uint32Array(3 * packed.n_triangles);
    at = readTriangles(this.triangles, data, at);
    this.outline = outline(this.triangles, this.n);
    this.cracks = this.readCracks(packed, data, at);
    this.outOfPlane = packed.out_of_plane;
  }

  readCracks(packed, data, at) {
    const n = packed.n_crack_points.reduce((sum, k) => sum + k, 0);
    const all = {};
    for (const channel of packed.crack_channels) {
      all[channel.name] = readChannel(channel, data, at, n);
      at += channel.bytes * n;
    }
    let first = 0;
    return packed.n_crack_points.map((k) => {
      const part = Object.fromEntries(Object.entries(all).map(([name, v]) => [name, v.subarray(first, first + k)]));
      first += k;
      return part;
    });
  }

  values(name) {
    if (!this.channels.has(name)) this.channels.set(name, this.derive(name));
    return this.channels.get(name);
  }

  derive(name) {
    const [ux, uy, xx, yy, xy] = ["displacement_x", "displacement_y", "stress_xx", "stress_yy", "stress_xy"].map((c) => this.channels.get(c));
    const zz = this.channels.get("stress_zz");
    const middle = (i) => 0.5 * (xx[i] + yy[i]);
    const radius = (i) => Math.hypot(0.5 * (xx[i] - yy[i]), xy[i]);
    const at = {
      displacement: (i) => Math.hypot(ux[i], uy[i]),
      max_principal_stress: (i) => middle(i) + radius(i),
      min_principal_stress: (i) => middle(i) - radius(i),
      von_mises: (i) => {
        const z = zz ? zz[i] : this.outOfPlane * (xx[i] + yy[i]);
        return Math.sqrt(0.5 * ((xx[i] - yy[i]) ** 2 + (yy[i] - z) ** 2 + (z - xx[i]) ** 2) + 3 * xy[i] ** 2);
      },
    }[name];
    return Float64Array.from({ length: this.n }, (_, i) => at(i));
  }
}

/** Steps that were read last, so that playing again is quick. */
const MOST_STEPS_IN_MEMORY = 40;
const fieldsInMemory = new Map();

function readFields(step) {
  let found = fieldsInMemory.get(step);
  fieldsInMemory.delete(step);
  if (!found) {
    const packed = readJson(`fields-${step}`);
    found = decompress(packed.data).then((data) => new Fields(packed, data));
  }
  fieldsInMemory.set(step, found);
  if (fieldsInMemory.size > MOST_STEPS_IN_MEMORY) fieldsInMemory.delete(fieldsInMemory.keys().next().value);
  return found;
}
