// What turns, zooms and plays the view of a solid, and its start.

const held = new Map();
const ratio = () => canvas.width / canvas.clientWidth;
const turnBy = (x, y) => {
  view.eye.turn += x;
  view.eye.tilt = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, view.eye.tilt + y));
};
const zoomBy = (factor) => {
  view.eye.zoom = Math.min(200, Math.max(0.2, view.eye.zoom * factor));
};
const moveBy = (x, y) => {
  view.eye.shift = [view.eye.shift[0] + x * ratio(), view.eye.shift[1] + y * ratio()];
};

/** The cracks over half of the picture, or all of the body. */
function reset() {
  const zoom = Math.max(1, (0.5 * whole.size) / cracked.size);
  view.eye = { turn: -0.6, tilt: -0.45, zoom, shift: [0, 0], middle: zoom === 1 ? whole.middle : cracked.middle };
  draw();
}

function listenToPointers() {
  canvas.addEventListener("pointerdown", (event) => {
    held.set(event.pointerId, event);
    canvas.setPointerCapture(event.pointerId);
  });
  ["pointerup", "pointercancel"].forEach((name) => canvas.addEventListener(name, (event) => held.delete(event.pointerId)));
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) {
      status.textContent = probe(event.offsetX * ratio(), event.offsetY * ratio());
      return;
    }
    const moved = [event.clientX - before.clientX, event.clientY - before.clientY];
    if (held.size === 2) {
      const [a, b] = [...held.values()];
      const other = a.pointerId === event.pointerId ? b : a;
      const apart = (e) => Math.hypot(e.clientX - other.clientX, e.clientY - other.clientY);
      zoomBy(apart(event) / Math.max(1, apart(before)));
      moveBy(0.5 * moved[0], 0.5 * moved[1]);
    } else if (event.shiftKey) {
      moveBy(...moved);
    } else {
      turnBy(0.01 * moved[0], -0.01 * moved[1]);
    }
    held.set(event.pointerId, event);
    draw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    zoomBy(Math.exp(-0.001 * event.deltaY));
    draw();
  }, { passive: false });
}

function listenToKeys() {
  const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
  canvas.addEventListener("keydown", (event) => {
    if (turns[event.key]) turnBy(...turns[event.key]);
    else if (event.key === "+" || event.key === "-") zoomBy(event.key === "+" ? 1.2 : 1 / 1.2);
    else if (event.key === "0") reset();
    else return;
    event.preventDefault();
    draw();
  });
}

function listenToControls() {
  byId("view-whole").addEventListener("click", () => {
    Object.assign(view.eye, { zoom: 1, shift: [0, 0], middle: whole.middle });
    draw();
  });
  byId("view-reset").addEventListener("click", reset);
  slider.addEventListener("input", () => show(Number(slider.value)));
  [opening, fieldChoice, bodyChoice].forEach((control) => control.addEventListener("input", draw));
  let timer = 0;
  play.addEventListener("click", async () => {
    if (timer) {
      clearInterval(timer);
      timer = 0;
    } else {
      if (step === scenes.length - 1) await show(0);
      timer = setInterval(async () => {
        await show(step + 1);
        if (timer && step === scenes.length - 1) play.click();
      }, 500);
    }
    play.textContent = timer ? "pause" : "play";
  });
  window.addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
}

/** Everything but the view and buttons is on the page already. */
async function start() {
  document.querySelectorAll(".scroll table").forEach((table) => {
    addCopyButton(table, table.closest("section").querySelector("h2").textContent, table.closest(".scroll"));
  });
  try {
    view = new SolidView(canvas, whole.size);
  } catch {
    status.textContent = "This browser offers no WebGL 2, so the body is not drawn; all numbers are below.";
    canvas.hidden = true;
    return;
  }
  fieldChoice.append(...SOLID_QUANTITIES.map((q) => element("option", { value: q.name }, q.title)));
  if (!crackPoints.length) bodyChoice.value = "both";
  byId("view-field-colors").style.background = gradient(viridis, false, "90deg");
  byId("view-opening-colors").style.background = gradient(ORANGES, false, "90deg");
  slider.max = scenes.length - 1;
  byId("view-steps").hidden = scenes.length < 2;
  await show(step);
  reset();
  listenToPointers();
  listenToKeys();
  listenToControls();
}
start().then(() => { document.documentElement.dataset.ready = ""; });
