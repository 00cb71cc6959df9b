// Fields on the boundary of a solid: `SOLID_QUANTITIES`, `readBoundary(packed)`. The reverse of output/report/boundary.rs.

/** What the colors can show. */
const SOLID_QUANTITIES = [
  { name: "von_mises", title: withUnit("von Mises stress", "stress") },
  { name: "max_principal_stress", title: withUnit("max. principal stress", "stress") },
  ...["xx", "yy", "zz", "xy", "yz", "xz"].map((c) => ({ name: `stress_${c}`, title: withUnit(`stress ${c}`, "stress") })),
  { name: "displacement", title: withUnit("displacement", "length") },
  ...["x", "y", "z"].map((c) => ({ name: `displacement_${c}`, title: withUnit(`displacement ${c}`, "length") })),
];

/** The largest eigenvalue of a symmetric tensor, by the angle of its deviator. */
function largestPrincipal(xx, yy, zz, xy, yz, xz) {
  const mean = (xx + yy + zz) / 3;
  const [a, b, c] = [xx - mean, yy - mean, zz - mean];
  const radius = Math.sqrt((a * a + b * b + c * c + 2 * (xy * xy + yz * yz + xz * xz)) / 6);
  if (!(radius > 0)) return mean;
  const determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const angle = Math.acos(Math.min(1, Math.max(-1, determinant / (2 * radius ** 3)))) / 3;
  return mean + 2 * radius * Math.cos(angle);
}

/** Triangles with fields; values of a quantity are made when they are asked for. */
class Boundary {
  constructor(packed, data) {
    Object.assign(this, { n: packed.n_vertices, ranges: packed.ranges });
    this.channels = new Map();
    let at = 0;
    for (const channel of packed.channels) {
      this.channels.set(channel.name, readChannel(channel, data, at, this.n));
      at += channel.bytes * this.n;
    }
    this.triangles = new Uint32Array(3 * packed.n_triangles);
    readTriangles(this.triangles, data, at);
    const coordinates = ["x", "y", "z"].map((c) => this.channels.get(c));
    this.positions = Float32Array.from({ length: 3 * this.n }, (_, i) => coordinates[i % 3][Math.floor(i / 3)]);
  }

  values(name) {
    if (!this.channels.has(name)) this.channels.set(name, this.derive(name));
    return this.channels.get(name);
  }

  derive(name) {
    const [xx, yy, zz, xy, yz, xz] = ["xx", "yy", "zz", "xy", "yz", "xz"].map((c) => this.channels.get(`stress_${c}`));
    const [ux, uy, uz] = ["x", "y", "z"].map((c) => this.channels.get(`displacement_${c}`));
    const at = {
      displacement: (i) => Math.hypot(ux[i], uy[i], uz[i]),
      max_principal_stress: (i) => largestPrincipal(xx[i], yy[i], zz[i], xy[i], yz[i], xz[i]),
      von_mises: (i) => Math.sqrt(0.5 * ((xx[i] - yy[i]) ** 2 + (yy[i] - zz[i]) ** 2 + (zz[i] - xx[i]) ** 2) +
        3 * (xy[i] ** 2 + yz[i] ** 2 + xz[i] ** 2)),
    }[name];
    return Float64Array.from({ length: this.n }, (_, i) => at(i));
  }
}

const boundaries = new Map();

/** The boundary of a scene, read once. */
function readBoundary(packed) {
  if (!boundaries.has(packed)) boundaries.set(packed, decompress(packed.data).then((data) => new Boundary(packed, data)));
  return boundaries.get(packed);
}
