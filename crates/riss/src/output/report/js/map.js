// The picture of a step: `FieldMap`. Knows fields, view and colors; the page tells it what to show.

/** Greatest displacement in the picture over the size of the body, at the middle of the slider. */
const DEFORMATION = 0.05;
/** Free space around the body as a share of the picture. */
const MARGIN = 0.07;
const MOST_PIXEL_RATIO = 2;

class FieldMap {
  constructor(canvas, results, stepsWithFields, viridis) {
    Object.assign(this, { canvas, results, stepsWithFields, viridis });
    this.context = canvas.getContext("2d");
    this.raster = new Raster();
    this.quantity = QUANTITIES[0];
    Object.assign(this, { rangeKind: "all", ownRange: [0, 1], bands: false, exaggeration: 1, view: null, fields: null, step: 0, cross: false });
    this.heads = new Map(stepsWithFields.map((step) => [step, this.readHead(step)]));
    this.bounds = this.wholeBody();
    this.factor = this.automaticFactor();
  }

  /** What is needed of all steps: sizes and ranges, without the values. */
  readHead(step) {
    const { ranges, channels, n_vertices, n_computed } = readJson(`fields-${step}`);
    return { ranges, x: [channels[0].low, channels[0].high], y: [channels[1].low, channels[1].high], n_vertices, n_computed };
  }

  wholeBody() {
    const boxes = [...this.heads.values()];
    const points = this.results.steps.flatMap((s) => s.cracks.flatMap((c) => c.path));
    const all = (k, axis) => (boxes.length ? boxes.flatMap((b) => b[axis]) : points.map((p) => p[k]));
    const ends = (values) => values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
    const [x, y] = [ends(all(0, "x")), ends(all(1, "y"))];
    return Number.isFinite(x[0] + y[0]) ? { x, y } : { x: [0, 1], y: [0, 1] };
  }

  size() {
    return Math.max(this.bounds.x[1] - this.bounds.x[0], this.bounds.y[1] - this.bounds.y[0]) || 1;
  }

  /** The same for all steps, so that they compare; a last step that falls apart does not make the others stiff. */
  automaticFactor() {
    const greatest = [...this.heads.values()].map((h) => h.ranges.displacement[1]).filter((u) => u > 0).sort((a, b) => a - b);
    if (!greatest.length) return 0;
    const middle = greatest[Math.floor(greatest.length / 2)];
    return (DEFORMATION * this.size()) / Math.min(greatest.at(-1), 10 * middle);
  }

  deformation() {
    return this.factor * this.exaggeration;
  }

  /** The step whose fields stand for `step`: its own, or the nearest one before it that was kept. */
  fieldsStep(step) {
    const before = this.stepsWithFields.filter((s) => s <= step);
    return before.at(-1) ?? this.stepsWithFields[0];
  }

  async show(step) {
    this.step = step;
    const wanted = this.fieldsStep(step);
    if (canReadFields && wanted !== undefined) {
      const fields = await readFields(wanted);
      if (this.step !== step) return;
      this.fields = fields;
    }
    this.draw();
  }

  range() {
    if (this.rangeKind === "own") return this.ownRange;
    const heads = this.rangeKind === "all" ? [...this.heads.values()] : [this.heads.get(this.fields.step)];
    const [first, second] = this.rangeKind === "full" ? [2, 3] : [0, 1];
    const ranges = heads.map((h) => h.ranges[this.quantity.name]);
    const [low, high] = [Math.min(...ranges.map((r) => r[first])), Math.max(...ranges.map((r) => r[second]))];
    if (!this.isDiverging(low, high)) return [low, high];
    const most = Math.max(Math.abs(low), Math.abs(high));
    return [-most, most];
  }

  /** White at zero only helps where there are values of both signs. */
  isDiverging(low, high) {
    return Boolean(this.quantity.signed) && low < 0 && high > 0;
  }

  stops() {
    const [low, high] = this.range();
    return this.isDiverging(low, high) && Math.abs(low + high) <= 1e-9 * (high - low) ? RED_BLUE : this.viridis;
  }

  pixelRatio() {
    return Math.min(window.devicePixelRatio || 1, MOST_PIXEL_RATIO);
  }

  /** Center and scale of the view; the whole body unless the reader moved it. */
  currentView() {
    if (this.view) return this.view;
    const { x, y } = this.bounds;
    const room = 1 - 2 * MARGIN;
    const scale = Math.min((room * this.canvas.clientWidth) / (x[1] - x[0] || 1), (room * this.canvas.clientHeight) / (y[1] - y[0] || 1));
    return { x: 0.5 * (x[0] + x[1]), y: 0.5 * (y[0] + y[1]), scale };
  }

  /** Zooms by a factor around a place of the canvas, its middle if none is given. */
  zoom(by, at = [0.5 * this.canvas.clientWidth, 0.5 * this.canvas.clientHeight]) {
    const view = this.currentView();
    const fitted = (0.5 * Math.min(this.canvas.clientWidth, this.canvas.clientHeight)) / this.size();
    const scale = Math.min(Math.max(view.scale * by, 0.2 * fitted), 1e6 * fitted);
    const [dx, dy] = [at[0] - 0.5 * this.canvas.clientWidth, 0.5 * this.canvas.clientHeight - at[1]];
    this.setView({ x: view.x + dx / view.scale - dx / scale, y: view.y + dy / view.scale - dy / scale, scale });
  }

  /** Moves the body by pixels of the page. */
  pan(dx, dy) {
    const view = this.currentView();
    this.setView({ x: view.x - dx / view.scale, y: view.y + dy / view.scale, scale: view.scale });
  }

  setView(view) {
    this.view = view;
    this.canvas.classList.toggle("zoomed", view !== null);
    this.draw();
  }

  draw() {
    const ratio = this.pixelRatio();
    const [width, height] = [this.canvas.clientWidth, this.canvas.clientHeight].map((s) => Math.max(1, Math.round(s * ratio)));
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    const view = this.currentView();
    const scale = view.scale * ratio;
    this.toPixel = (x, y) => [(x - view.x) * scale + 0.5 * width, 0.5 * height - (y - view.y) * scale];
    this.raster.resize(width, height);
    this.raster.clear();
    if (this.fields) this.drawBody();
    this.context.putImageData(this.raster.image, 0, 0);
    this.context.lineJoin = this.context.lineCap = "round";
    if (this.fields) this.drawLines(ratio);
    this.drawCracks(ratio);
    if (this.cross) this.drawCross(ratio);
  }

  /** Places of vertices, moved by so much of the displacement. */
  place(x, y, ux, uy, factor) {
    const moved = { x: new Float64Array(x.length), y: new Float64Array(x.length) };
    for (let i = 0; i < x.length; i++) {
      const known = Number.isFinite(ux[i] + uy[i]);
      const [px, py] = this.toPixel(x[i] + (known ? factor * ux[i] : 0), y[i] + (known ? factor * uy[i] : 0));
      moved.x[i] = px;
      moved.y[i] = py;
    }
    return moved;
  }

  drawBody() {
    const f = this.fields;
    const of = (name) => f.values(name);
    this.places = this.place(of("x"), of("y"), of("displacement_x"), of("displacement_y"), this.deformation());
    const [low, high] = this.range();
    const [r, g, b] = [1, 3, 5].map((k) => parseInt(themeColor("body-fill").slice(k, k + 2), 16));
    const missing = ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
    const table = pixelTable(this.stops(), this.bands);
    this.raster.draw({ ...this.places, values: of(this.quantity.name), triangles: f.triangles, low, high, table, missing });
  }

  drawLines(ratio) {
    const f = this.fields;
    const before = this.place(f.values("x"), f.values("y"), f.values("displacement_x"), f.values("displacement_y"), 0);
    for (const [places, color, width] of [[before, "ghost", 0.8], [this.places, "outline", 1.2]]) {
      this.context.strokeStyle = themeColor(color);
      this.context.lineWidth = width * ratio;
      this.context.beginPath();
      for (let i = 0; i < f.outline.length; i += 2) {
        this.context.moveTo(places.x[f.outline[i]], places.y[f.outline[i]]);
        this.context.lineTo(places.x[f.outline[i + 1]], places.y[f.outline[i + 1]]);
      }
      this.context.stroke();
    }
  }

  /** Faces where there are fields, else the paths; a ring at each tip. */
  drawCracks(ratio) {
    const { context } = this;
    context.strokeStyle = themeColor("crack");
    context.lineWidth = 1.6 * ratio;
    const line = (x, y) => {
      context.beginPath();
      for (let i = 0; i < x.length; i++) context.lineTo(x[i], y[i]);
      context.stroke();
    };
    const cracks = this.results.steps.find((s) => s.step === this.step)?.cracks ?? [];
    const ownFaces = this.fields?.step === this.step ? this.fields.cracks : null;
    this.tips = [];
    cracks.forEach((crack, k) => {
      const faces = ownFaces?.length === cracks.length ? ownFaces[k] : null;
      const sides = faces ? ["left", "right"].map((s) => this.place(faces.x, faces.y, faces[`${s}_x`], faces[`${s}_y`], this.deformation())) : [];
      sides.forEach((side) => line(side.x, side.y));
      const path = crack.path.map((p) => this.toPixel(p[0], p[1]));
      if (!faces) line(path.map((p) => p[0]), path.map((p) => p[1]));
      for (const tip of crack.tips) {
        const i = tip.end === "start" ? 0 : (sides[0]?.x.length ?? path.length) - 1;
        const at = sides.length ? [0.5 * (sides[0].x[i] + sides[1].x[i]), 0.5 * (sides[0].y[i] + sides[1].y[i])] : path[i];
        this.tips.push({ at, crack, tip });
        context.beginPath();
        context.arc(at[0], at[1], 4.5 * ratio, 0, 2 * Math.PI);
        context.stroke();
      }
    });
  }

  drawCross(ratio) {
    const [x, y] = [0.5 * this.canvas.width, 0.5 * this.canvas.height];
    this.context.strokeStyle = themeColor("text");
    this.context.lineWidth = ratio;
    this.context.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      this.context.moveTo(x + 4 * ratio * dx, y + 4 * ratio * dy);
      this.context.lineTo(x + 12 * ratio * dx, y + 12 * ratio * dy);
    }
    this.context.stroke();
  }

  /** What is at a place of the canvas: a tip, and place and values of the body before it was deformed. */
  probe(cssX, cssY) {
    const ratio = this.pixelRatio();
    const [px, py] = [cssX * ratio, cssY * ratio];
    const near = (this.tips ?? []).find(({ at }) => Math.hypot(at[0] - px, at[1] - py) < 9 * ratio);
    const body = this.fields && this.probeBody(px, py);
    return near || body ? { tip: near, ...body } : null;
  }

  probeBody(px, py) {
    const { width, height } = this.raster.image;
    const [column, row] = [Math.floor(px), Math.floor(py)];
    const inside = column >= 0 && column < width && row >= 0 && row < height;
    const t = inside ? this.raster.triangleAt[row * width + column] : -1;
    if (t < 0) return null;
    const corners = this.fields.triangles.subarray(3 * t, 3 * t + 3);
    const [[ax, ay], [bx, by], [cx, cy]] = [...corners].map((v) => [this.places.x[v], this.places.y[v]]);
    const [x, y] = [column + 0.5, row + 0.5];
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    const b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area;
    const c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area;
    const shares = [1 - b - c, b, c];
    const value = (name) => {
      const values = this.fields.values(name);
      return shares.reduce((sum, share, k) => sum + share * values[corners[k]], 0);
    };
    return { x: value("x"), y: value("y"), value };
  }
}
