// Curves of the tips over steps, crack length or cycles: `Curves`. Drawn by uPlot.

const LINE_COLORS = ["#0b7a75", "#d1495b", "#3066be", "#c77d0a", "#7b4ea3", "#4c956c", "#8a5a44", "#5c677d"];
const CHART_HEIGHT = 260;

/** What can stand on the horizontal axis, where it is known. */
const AXES = [
  { name: "a", title: withUnit("crack length a", "length"), of: (point) => point.a },
  { name: "cycles", title: "load cycles N", of: (point) => point.step.cycles },
  { name: "step", title: "step", of: (point) => point.step.step },
];

/** What can stand on the vertical axis of the chart that the reader chooses. */
const CHOICES = [
  { title: "load factor", of: (point) => point.step.load_factor, when: (p) => p.step.load_factor !== null && p.step.load_factor !== 1 },
  { title: withUnit("growth per cycle", "rate"), of: (point) => point.tip.growth_rate },
  { title: withUnit("equivalent K", "factor"), of: (point) => point.tip.K_equivalent, spread: (point) => point.tip.K_uncertainty },
  { title: withUnit("J-integral", "force per length"), of: (point) => point.tip.J },
  { title: withUnit("T-stress", "stress"), of: (point) => point.tip.T },
  { title: "kink angle in degrees", of: (point) => point.tip.kink_angle_deg },
  { title: withUnit("increment", "length"), of: (point) => point.tip.increment },
  { title: withUnit("strain energy", "energy"), of: (point) => point.step.strain_energy, once: true },
];

const pathLength = (path) => path.slice(1).reduce((sum, p, k) => sum + Math.hypot(p[0] - path[k][0], p[1] - path[k][1]), 0);

/** All tips with what they did in each step, by crack and end. */
function tipHistories(results) {
  const histories = new Map();
  for (const step of results.steps) {
    for (const crack of step.cracks) {
      for (const tip of crack.tips) {
        const name = `${crack.name} ${tip.end}`;
        if (!histories.has(name)) histories.set(name, { name, color: LINE_COLORS[histories.size % LINE_COLORS.length], points: [] });
        histories.get(name).points.push({ step, tip, a: pathLength(crack.path) });
      }
    }
  }
  return [...histories.values()];
}

class Curves {
  constructor(results, tips) {
    Object.assign(this, { results, tips, charts: [], step: null });
    const points = tips.flatMap((t) => t.points);
    const has = (choice) => points.some((p) => (choice.when ?? ((q) => choice.of(q) !== null))(p));
    this.axes = AXES.filter((axis) => points.some((p) => axis.of(p) !== null));
    this.choices = CHOICES.filter(has);
    // Tips of cohesive cracks have no factors, and stay where they are: the load curve has what changes.
    this.isShown = results.steps.length > 1 && tips.length > 0 && !results.loading;
    if (!this.isShown) return;
    byId("curves").hidden = false;
    this.axisSelect = this.fill("curve-x", this.axes);
    this.choiceSelect = this.fill("curve-y", this.choices);
    this.redraw();
    new ResizeObserver(() => this.resize()).observe(byId("charts"));
  }

  fill(id, options) {
    const select = byId(id);
    options.forEach((option, k) => select.append(element("option", { value: k }, option.title)));
    select.addEventListener("change", () => this.redraw());
    return select;
  }

  redraw() {
    if (!this.isShown) return;
    this.charts.forEach((chart) => chart.destroy());
    byId("charts").replaceChildren();
    const axis = this.axes[this.axisSelect.value];
    const factors = [
      { title: "K_I", of: (p) => p.tip.K_I, spread: (p) => p.tip.K_uncertainty },
      { title: "K_II", of: (p) => p.tip.K_II, spread: (p) => p.tip.K_uncertainty, dash: [6, 4] },
    ];
    const length = { title: withUnit("crack length a", "length"), of: (p) => p.a };
    const time = this.axes.find((a) => a.name === "cycles") ?? this.axes.find((a) => a.name === "step");
    const growth = this.results.steps.some((s) => s.cycles !== null || s.load_factor !== 1) || this.axes.length > 1;
    this.charts = [
      this.chart("Stress intensity factors ± uncertainty", factors, axis),
      growth ? this.chart(`Crack length over ${time.title}`, [length], time) : null,
      this.choices.length ? this.chart(this.choices[this.choiceSelect.value].title, [this.choices[this.choiceSelect.value]], axis) : null,
    ].filter(Boolean);
  }

  /** Series of several quantities and all tips on one axis of abscissas. */
  chart(title, quantities, axis) {
    const series = quantities.flatMap((q) => (q.once ? this.tips.slice(0, 1) : this.tips).map((tip) => ({ q, tip })));
    const known = series.map(({ q, tip }) => {
      const byX = new Map();
      for (const p of tip.points) {
        if (axis.of(p) !== null && q.of(p) !== null) byX.set(axis.of(p), p);
      }
      return [...byX].sort((a, b) => a[0] - b[0]);
    });
    const tables = known.map((points, k) => [points.map((p) => p[0]), points.map((p) => series[k].q.of(p[1]))]);
    const spreads = known.map((points, k) => new Map(points.map(([x, p]) => [x, series[k].q.spread?.(p) ?? 0])));
    const label = ({ q, tip }) => (quantities.length > 1 ? `${q.title} ${tip.name}` : q.once ? q.title : tip.name);
    const box = element("div", { class: "chart" }, element("h3", {}, title));
    byId("charts").append(box);
    const options = {
      width: box.clientWidth,
      height: CHART_HEIGHT,
      scales: { x: { time: false } },
      cursor: { drag: { x: true, y: false } },
      axes: [
        { ...this.axisStyle(axis.title), size: 34 },
        { ...this.axisStyle(quantities.length > 1 ? withUnit("K", "factor") : quantities[0].title), size: this.axisSize },
      ],
      series: [
        { label: axis.title, value: (_, v) => number(v) },
        ...series.map((s) => ({
          label: label(s), stroke: s.tip.color, width: 2, dash: s.q.dash, spanGaps: true, points: { size: 5 }, value: (_, v) => number(v),
        })),
      ],
      hooks: { draw: [(u) => { this.drawSpreads(u, spreads); this.drawStep(u, axis); }] },
    };
    return new uPlot(options, uPlot.join(tables), box);
  }

  axisStyle(label) {
    const quiet = themeColor("quiet");
    const line = { stroke: themeColor("grid"), width: 1 };
    const values = (_, ticks) => ticks.map((t) => number(t, 6));
    return { label, labelSize: 24, labelFont: "13px system-ui", font: "12px system-ui", stroke: quiet, grid: line, ticks: line, values };
  }

  /** Room for the longest number. */
  axisSize(u, values) {
    const longest = (values ?? []).reduce((most, v) => Math.max(most, v.length), 3);
    return u && values ? 20 + 7.4 * longest : 50;
  }

  drawSpreads(u, spreads) {
    const { ctx } = u;
    const cap = 3 * devicePixelRatio;
    ctx.save();
    ctx.lineWidth = devicePixelRatio;
    spreads.forEach((spread, k) => {
      ctx.strokeStyle = u.series[k + 1]._stroke ?? "gray";
      ctx.beginPath();
      u.data[0].forEach((x, i) => {
        const y = u.data[k + 1][i];
        if (!u.series[k + 1].show || y === null || y === undefined || !spread.get(x)) return;
        const [px, low, high] = [u.valToPos(x, "x", true), u.valToPos(y - spread.get(x), "y", true), u.valToPos(y + spread.get(x), "y", true)];
        for (const [ax, ay, bx, by] of [[px, low, px, high], [px - cap, low, px + cap, low], [px - cap, high, px + cap, high]]) {
          ctx.moveTo(ax, ay);
          ctx.lineTo(bx, by);
        }
      });
      ctx.stroke();
    });
    ctx.restore();
  }

  /** A line at the step that the picture shows. */
  drawStep(u, axis) {
    const point = this.tips.flatMap((t) => t.points).find((p) => p.step.step === this.step);
    const x = point && axis.of(point);
    if (x === null || x === undefined) return;
    const { ctx, bbox } = u;
    const at = u.valToPos(x, "x", true);
    if (at < bbox.left || at > bbox.left + bbox.width) return;
    ctx.save();
    ctx.strokeStyle = themeColor("quiet");
    ctx.setLineDash([3, 3]);
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }

  show(step) {
    this.step = step;
    this.charts.forEach((chart) => chart.redraw(false));
  }

  resize() {
    for (const chart of this.charts) {
      const width = chart.root.parentElement.clientWidth;
      if (width > 0 && width !== chart.width) chart.setSize({ width, height: CHART_HEIGHT });
    }
  }
}
