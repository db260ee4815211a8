// How pointer, wheel and keys move the camera.

import {cameraOf} from "./camera.js";

// Zoom and target stay as they are, but what is seen now need not fit.
function turn(state, dx, dy) {
  state.azimuth = (((state.azimuth - 0.35 * dx) % 360) + 540) % 360 - 180;
  state.elevation = Math.max(-90, Math.min(90, state.elevation + 0.35 * dy));
  state.fitted = false;
}

// Whoever chooses a place keeps it when other cells are shown.
function place(state) {
  state.fitted = state.follows = false;
}

function move(state, dx, dy, canvas) {
  const camera = cameraOf(state, canvas.clientWidth / canvas.clientHeight);
  const scale = 2 * camera.halfFrustum[1] * camera.distance / canvas.clientHeight;
  state.target = state.target.map((t, i) => t + scale * (dy * camera.up[i] - dx * camera.right[i]));
  place(state);
}

function zoom(state, factor) {
  state.zoom = Math.max(0.1, Math.min(200, state.zoom * factor));
  place(state);
}

// moved() is called after every change, clicked(x, y) for a press that did not move.
export function controlCamera(canvas, state, moved, clicked) {
  const pointers = new Map();
  let travelled = 0;
  canvas.addEventListener("contextmenu", event => event.preventDefault());
  canvas.addEventListener("pointerdown", event => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    travelled = 0;
    canvas.classList.add("turning");
  });
  canvas.addEventListener("pointermove", event => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const dx = event.clientX - before.clientX, dy = event.clientY - before.clientY;
    travelled += Math.abs(dx) + Math.abs(dy);
    if (pointers.size === 2) {
      const other = [...pointers.values()].find(pointer => pointer.pointerId !== event.pointerId);
      const apart = pointer => Math.hypot(pointer.clientX - other.clientX, pointer.clientY - other.clientY);
      zoom(state, apart(event) / Math.max(apart(before), 1));
      move(state, dx / 2, dy / 2, canvas);
    } else if (event.shiftKey || event.buttons & 6) move(state, dx, dy, canvas);
    else turn(state, dx, dy);
    pointers.set(event.pointerId, event);
    moved();
  });
  const release = event => {
    if (!pointers.delete(event.pointerId)) return;
    canvas.classList.remove("turning");
    if (event.type === "pointerup" && travelled < 4 && pointers.size === 0) clicked(event.clientX, event.clientY);
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("wheel", event => {
    event.preventDefault();
    zoom(state, Math.exp(-event.deltaY * (event.deltaMode ? 0.04 : 0.0012)));
    moved();
  }, {passive: false});
  const keys = {
    ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20],
  };
  canvas.addEventListener("keydown", event => {
    if (keys[event.key]) turn(state, ...keys[event.key]);
    else if (event.key === "+" || event.key === "-") zoom(state, event.key === "+" ? 1.15 : 1 / 1.15);
    else return;
    event.preventDefault();
    moved();
  });
}
