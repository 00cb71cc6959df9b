// Triangles as pixels: `Raster`. On the processor, so that every browser and printer shows the same; a hundred thousand
// triangles take some hundredths of a second.

class Raster {
  resize(width, height) {
    if (this.image?.width === width && this.image?.height === height) return;
    this.image = new ImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    /** Triangle at each pixel, -1 outside of the body. */
    this.triangleAt = new Int32Array(width * height);
  }

  clear() {
    this.pixels.fill(0);
    this.triangleAt.fill(-1);
  }

  /**
   * Draws triangles, with colors by value and `missing` where there is none.
   *
   * - `x`, `y`: of the vertices, in pixels
   * - `low`, `high`: ends of the color scale
   */
  draw({ x, y, values, triangles, low, high, table, missing }) {
    const perUnit = high > low ? table.length / (high - low) : 0;
    for (let t = 0; t < triangles.length; t += 3) {
      this.drawTriangle(t, x, y, values, triangles, low, perUnit, table, missing);
    }
  }

  drawTriangle(t, x, y, values, triangles, low, perUnit, table, missing) {
    const { width, height } = this.image;
    const a = triangles[t];
    const b = triangles[t + 1];
    const c = triangles[t + 2];
    const ax = x[a], ay = y[a], bx = x[b], by = y[b], cx = x[c], cy = y[c];
    const top = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
    const bottom = Math.min(height - 1, Math.ceil(Math.max(ay, by, cy) - 0.5) - 1);
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    if (!(top <= bottom) || area === 0) return;
    const va = values[a];
    const dx = ((values[b] - va) * (cy - ay) - (values[c] - va) * (by - ay)) / area;
    const dy = ((values[c] - va) * (bx - ax) - (values[b] - va) * (cx - ax)) / area;
    const known = Number.isFinite(dx + dy + va);
    const most = table.length - 1;
    for (let row = top; row <= bottom; row++) {
      const level = row + 0.5;
      let from = Infinity;
      let to = -Infinity;
      if (ay <= level !== by <= level) { const s = ax + ((level - ay) * (bx - ax)) / (by - ay); from = s; to = s; }
      if (by <= level !== cy <= level) { const s = bx + ((level - by) * (cx - bx)) / (cy - by); if (s < from) from = s; if (s > to) to = s; }
      if (cy <= level !== ay <= level) { const s = cx + ((level - cy) * (ax - cx)) / (ay - cy); if (s < from) from = s; if (s > to) to = s; }
      const first = Math.max(0, Math.ceil(from - 0.5));
      const last = Math.min(width - 1, Math.ceil(to - 0.5) - 1);
      let at = row * width + first;
      let color = (va + dx * (first + 0.5 - ax) + dy * (level - ay) - low) * perUnit;
      const change = dx * perUnit;
      for (let column = first; column <= last; column++, at++) {
        this.pixels[at] = known ? table[color <= 0 ? 0 : color >= most ? most : color | 0] : missing;
        this.triangleAt[at] = t / 3;
        color += change;
      }
    }
  }
}
