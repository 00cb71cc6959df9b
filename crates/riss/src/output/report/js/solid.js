// The body of a solid with its cracks in space: turned by mouse, touch and arrow keys, a step at a time, values under the cursor.
"use strict";

(function () {
  const data = (id) => JSON.parse(document.getElementById(id).textContent);
  const { colors, lengthUnit, factorUnit } = data("view");
  const scenes = data("scenes");
  const canvas = document.getElementById("view-canvas");
  if (!scenes.length || !canvas) return;
  const byId = (id) => document.getElementById(id);
  const [slider, play, opening, status] = ["view-step", "view-play", "view-opening", "view-status"].map(byId);
  const context = canvas.getContext("2d");

  /** Corner of least coordinates, middle and diagonal of the box around points. */
  function box(lists) {
    const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity];
    for (const points of lists) {
      for (let i = 0; i < points.length; i++) {
        lower[i % 3] = Math.min(lower[i % 3], points[i]);
        upper[i % 3] = Math.max(upper[i % 3], points[i]);
      }
    }
    const middle = lower.map((v, k) => 0.5 * (v + upper[k]));
    return { lower, middle, size: Math.hypot(...lower.map((v, k) => upper[k] - v)) || 1 };
  }
  const body = scenes[0].body;
  const points = scenes.flatMap((s) => s.cracks.map((c) => c.points));
  const [whole, cracked] = [box([body, ...points]), box(points)];
  const size = whole.size;
  const largest = Math.max(0, ...scenes.flatMap((s) => s.cracks.flatMap((c) => c.gaps)));

  let turn, tilt, zoom, shift, middle;
  let step = scenes.length - 1;
  let places = [];

  /** Five digits, as in the tables. */
  const digits = (v) => (v === null || v === undefined ? "–" : Number(v).toPrecision(5));

  /** Pixels right and down of a place, and its depth towards the eye. */
  function seen(x, y, z) {
    const [a, b, c] = [x - middle[0], y - middle[1], z - middle[2]];
    const across = a * Math.cos(turn) - b * Math.sin(turn);
    const away = a * Math.sin(turn) + b * Math.cos(turn);
    const up = c * Math.cos(tilt) - away * Math.sin(tilt);
    const depth = -away * Math.cos(tilt) - c * Math.sin(tilt);
    const scale = (zoom * 0.9 * Math.min(canvas.width, canvas.height)) / size;
    return [canvas.width / 2 + shift[0] + scale * across, canvas.height / 2 + shift[1] - scale * up, depth];
  }

  function color(gap) {
    const share = largest > 0 ? Math.min(1, Math.max(0, gap / largest)) : 0;
    return colors[Math.round(share * (colors.length - 1))];
  }

  function draw() {
    const wide = canvas.clientWidth * (window.devicePixelRatio || 1);
    if (wide && Math.abs(canvas.width - wide) > 1) {
      canvas.width = Math.round(wide);
      canvas.height = Math.round(0.62 * wide);
    }
    const style = getComputedStyle(document.body);
    const [text, line] = ["--text", "--quiet"].map((name) => style.getPropertyValue(name));
    context.clearRect(0, 0, canvas.width, canvas.height);
    const scene = scenes[step];
    const width = Math.max(1, canvas.width / 900);
    context.strokeStyle = line;
    context.globalAlpha = 0.7;
    context.lineWidth = width;
    context.beginPath();
    for (let i = 0; i + 5 < body.length; i += 6) {
      context.moveTo(...seen(body[i], body[i + 1], body[i + 2]));
      context.lineTo(...seen(body[i + 3], body[i + 4], body[i + 5]));
    }
    context.stroke();
    context.globalAlpha = 1;
    places = [];
    const faces = [];
    const stretch = largest > 0 ? (0.5 * Number(opening.value) * 0.12 * cracked.size) / largest : 0;
    for (const crack of scene.cracks) {
      for (const side of stretch > 0 ? [1, -1] : [1]) {
        const at = [];
        for (let i = 0; i < crack.gaps.length; i++) {
          const p = [0, 1, 2].map((k) => crack.points[3 * i + k] + side * stretch * crack.openings[3 * i + k]);
          at.push(seen(...p));
          if (side === 1) places.push({ at: at[i], crack, index: i });
        }
        for (let t = 0; t < crack.triangles.length; t += 3) {
          const corners = [0, 1, 2].map((k) => crack.triangles[t + k]);
          const depth = corners.reduce((sum, c) => sum + at[c][2], 0);
          const gap = corners.reduce((sum, c) => sum + crack.gaps[c], 0) / 3;
          faces.push({ depth, fill: color(gap), at: corners.map((c) => at[c]) });
        }
      }
    }
    faces.sort((a, b) => a.depth - b.depth);
    for (const face of faces) {
      context.fillStyle = context.strokeStyle = face.fill;
      context.lineWidth = 0.5;
      context.beginPath();
      context.moveTo(face.at[0][0], face.at[0][1]);
      context.lineTo(face.at[1][0], face.at[1][1]);
      context.lineTo(face.at[2][0], face.at[2][1]);
      context.closePath();
      context.fill();
      context.stroke();
    }
    context.strokeStyle = "#d55e00";
    context.fillStyle = "#d55e00";
    for (const front of scene.fronts) {
      const at = front.points.map((p) => seen(...p.position));
      context.lineWidth = 2 * width;
      context.beginPath();
      at.forEach((p, i) => (i ? context.lineTo(p[0], p[1]) : context.moveTo(p[0], p[1])));
      if (front.closed) context.closePath();
      context.stroke();
      at.forEach((p, i) => {
        context.beginPath();
        context.arc(p[0], p[1], 2.5 * width, 0, 7);
        context.fill();
        places.push({ at: p, front, index: i });
      });
    }
    context.fillStyle = text;
    context.font = `${Math.round(12 * width)}px system-ui, sans-serif`;
    ["x", "y", "z"].forEach((name, k) => {
      const corner = whole.lower.slice();
      const from = seen(...corner);
      corner[k] += 0.18 * size;
      const to = seen(...corner);
      context.strokeStyle = text;
      context.lineWidth = width;
      context.beginPath();
      context.moveTo(from[0], from[1]);
      context.lineTo(to[0], to[1]);
      context.stroke();
      context.fillText(name, to[0] + 3 * width, to[1] - 3 * width);
    });
    byId("view-legend").textContent = `opening 0 to ${digits(largest)}${lengthUnit}`;
    byId("view-label").textContent = scene.label;
    slider.value = step;
    slider.setAttribute("aria-valuetext", scene.label);
  }

  /** What is known nearest to a pixel, in words. */
  function probe(x, y) {
    let [best, nearest] = [14 * (canvas.width / canvas.clientWidth), null];
    for (const place of places) {
      const distance = Math.hypot(place.at[0] - x, place.at[1] - y) * (place.front ? 0.7 : 1);
      if (distance < best) [best, nearest] = [distance, place];
    }
    if (!nearest) return "";
    if (nearest.front) {
      const p = nearest.front.points[nearest.index];
      const [k1, k2, k3] = [p.K_I, p.K_II, p.K_III].map(digits);
      return `front of ${nearest.front.crack} at (${p.position.map(digits).join(", ")})${lengthUnit}: ` +
        `K_I ${k1}, K_II ${k2}, K_III ${k3}, ± ${digits(p.K_uncertainty)}${factorUnit}`;
    }
    const at = [0, 1, 2].map((k) => digits(nearest.crack.points[3 * nearest.index + k]));
    return `${nearest.crack.name} at (${at.join(", ")})${lengthUnit}: opening ${digits(nearest.crack.gaps[nearest.index])}${lengthUnit}`;
  }

  function show(number) {
    step = Math.min(scenes.length - 1, Math.max(0, number));
    draw();
  }

  const held = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
  });
  ["pointerup", "pointercancel"].forEach((name) => canvas.addEventListener(name, (event) => held.delete(event.pointerId)));
  canvas.addEventListener("pointermove", (event) => {
    const ratio = canvas.width / canvas.clientWidth;
    const before = held.get(event.pointerId);
    if (!before) {
      status.textContent = probe(event.offsetX * ratio, event.offsetY * ratio);
      return;
    }
    const moved = [event.clientX - before.clientX, event.clientY - before.clientY];
    if (held.size === 2) {
      const [a, b] = [...held.values()];
      const other = a.pointerId === event.pointerId ? b : a;
      const apart = (e) => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY);
      zoom *= apart(event) / Math.max(1, apart(before));
    } else if (event.shiftKey) {
      shift = [shift[0] + moved[0] * ratio, shift[1] + moved[1] * ratio];
    } else {
      turn += 0.01 * moved[0];
      tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, tilt + 0.01 * moved[1]));
    }
    held.set(event.pointerId, event);
    draw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoom = Math.min(200, Math.max(0.2, zoom * Math.exp(-0.001 * event.deltaY)));
    draw();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
    if (turns[event.key]) {
      turn += turns[event.key][0];
      tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, tilt + turns[event.key][1]));
    } else if (event.key === "+" || event.key === "-") {
      zoom = Math.min(200, Math.max(0.2, zoom * (event.key === "+" ? 1.2 : 1 / 1.2)));
    } else if (event.key === "0") {
      reset();
    } else {
      return;
    }
    event.preventDefault();
    draw();
  });
  /** The cracks over half of the picture, or all of the body. */
  function reset() {
    [turn, tilt, shift, middle] = [-0.6, 0.45, [0, 0], cracked.middle];
    zoom = Math.max(1, (0.5 * size) / cracked.size);
    if (zoom === 1) middle = whole.middle;
    draw();
  }
  byId("view-whole").addEventListener("click", () => {
    [zoom, shift, middle] = [1, [0, 0], whole.middle];
    draw();
  });
  byId("view-reset").addEventListener("click", reset);
  slider.addEventListener("input", () => show(Number(slider.value)));
  opening.addEventListener("input", draw);
  let timer = 0;
  play.addEventListener("click", () => {
    if (timer) {
      clearInterval(timer);
      timer = 0;
    } else {
      if (step === scenes.length - 1) show(0);
      timer = setInterval(() => {
        show(step + 1);
        if (step === scenes.length - 1) play.click();
      }, 500);
    }
    play.textContent = timer ? "pause" : "play";
  });
  slider.max = scenes.length - 1;
  byId("view-steps").hidden = scenes.length < 2;
  window.addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  reset();
  document.documentElement.dataset.ready = "";
})();
