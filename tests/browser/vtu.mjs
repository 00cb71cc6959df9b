// Arrays of a .vtu file, and fields at any point: the reference for what the report shows.

import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

function bytes(text) {
  const head = Buffer.from(text.slice(0, 32), "base64");
  const nBlocks = Number(head.readBigUInt64LE(0));
  const headLength = 4 * Math.ceil((24 + 8 * nBlocks) / 3);
  const sizes = Buffer.from(text.slice(0, headLength), "base64");
  const body = Buffer.from(text.slice(headLength), "base64");
  const blocks = [];
  for (let k = 0, at = 0; k < nBlocks; k++) {
    const size = Number(sizes.readBigUInt64LE(24 + 8 * k));
    blocks.push(inflateSync(body.subarray(at, at + size)));
    at += size;
  }
  return Buffer.concat(blocks);
}

/** Arrays by name; integers become numbers. */
export function readVtu(path) {
  const arrays = {};
  for (const [, type, name, data] of readFileSync(path, "utf8").matchAll(/<DataArray type="(\w+)" Name="(\w+)"[^>]*>([^<]*)</g)) {
    const raw = bytes(data);
    const copy = raw.buffer.slice(raw.byteOffset, raw.byteOffset + raw.byteLength);
    arrays[name] = type === "Float64" ? new Float64Array(copy) : type === "Int64" ? Array.from(new BigInt64Array(copy), Number) : raw;
  }
  return arrays;
}

/** Value of a component at a point by the triangle that holds it; null outside of the body. */
export function valueAt(arrays, [px, py], name, component = 0) {
  const p = arrays.Points;
  const n = p.length / 3;
  const width = arrays[name].length / n;
  for (let t = 0; t < arrays.connectivity.length; t += 3) {
    const [a, b, c] = arrays.connectivity.slice(t, t + 3);
    const area = (p[3 * b] - p[3 * a]) * (p[3 * c + 1] - p[3 * a + 1]) - (p[3 * c] - p[3 * a]) * (p[3 * b + 1] - p[3 * a + 1]);
    const sb = ((px - p[3 * a]) * (p[3 * c + 1] - p[3 * a + 1]) - (p[3 * c] - p[3 * a]) * (py - p[3 * a + 1])) / area;
    const sc = ((p[3 * b] - p[3 * a]) * (py - p[3 * a + 1]) - (px - p[3 * a]) * (p[3 * b + 1] - p[3 * a + 1])) / area;
    if (sb < -1e-9 || sc < -1e-9 || sb + sc > 1 + 1e-9) continue;
    const value = (v) => arrays[name][width * v + component];
    return (1 - sb - sc) * value(a) + sb * value(b) + sc * value(c);
  }
  return null;
}
