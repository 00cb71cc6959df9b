// Mouse, pen and fingers on the map: `attachPointer(map, onPoint)`.

const ZOOM_STEP = 1.3;

/** `onPoint(x, y)` hears where the pointer is on the canvas, or nothing when it leaves. */
function attachPointer(map, onPoint) {
  const { canvas } = map;
  const down = new Map();
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left - canvas.clientLeft, event.clientY - box.top - canvas.clientTop];
  };
  canvas.addEventListener("pointerdown", (event) => {
    down.set(event.pointerId, at(event));
    if (event.pointerType === "mouse" || map.view) canvas.setPointerCapture(event.pointerId);
    onPoint(...at(event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const now = at(event);
    const before = down.get(event.pointerId);
    if (before) {
      down.set(event.pointerId, now);
      if (down.size === 1 && (event.pointerType === "mouse" || map.view)) {
        canvas.classList.add("dragging");
        map.pan(now[0] - before[0], now[1] - before[1]);
      } else if (down.size === 2) {
        pinch(map, before, now, [...down].find(([id]) => id !== event.pointerId)[1]);
      }
    }
    onPoint(...now);
  });
  const up = (event) => {
    down.delete(event.pointerId);
    canvas.classList.remove("dragging");
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => onPoint());
  canvas.addEventListener("dblclick", (event) => map.zoom(ZOOM_STEP ** 3, at(event)));
  // Without Ctrl the wheel scrolls the page, unless the reader works in the map.
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;
    event.preventDefault();
    map.zoom(Math.exp(-event.deltaY * (event.ctrlKey && Math.abs(event.deltaY) < 30 ? 0.01 : 0.0015)), at(event));
    onPoint(...at(event));
  }, { passive: false });
}

/** One of two fingers moves from `before` to `now`. */
function pinch(map, before, now, other) {
  const distance = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
  if (distance(before) > 0) map.zoom(distance(now) / distance(before), [0.5 * (now[0] + other[0]), 0.5 * (now[1] + other[1])]);
}
