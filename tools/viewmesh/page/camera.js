// The camera of camera.cpp, and how pointer, wheel and keys move it.

const degree = Math.PI / 180;
const halfAngle = 14 * degree;

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

export function cameraOf(state, aspect) {
  const azimuth = state.azimuth * degree, elevation = state.elevation * degree;
  const up = Math.tan(halfAngle), across = up * aspect;
  const distance = 1 / Math.sin(Math.atan(up * Math.min(1, aspect))) / state.zoom;
  const towards = [
    Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation)];
  const right = [-Math.sin(azimuth), Math.cos(azimuth), 0];
  const reach = 1.05 + Math.hypot(...state.target);
  return {
    towards, right, up: cross(towards, right), distance,
    eye: state.target.map((t, i) => t + distance * towards[i]),
    near: Math.max(distance - reach, 0.002), far: distance + reach,
    halfFrustum: [across, up],
  };
}

// The direction of the ray through a place of the picture, (-1, -1) lower left to (1, 1) upper right.
export function rayThrough(camera, x, y) {
  const [across, up] = camera.halfFrustum;
  return [0, 1, 2].map(i => x * across * camera.right[i] + y * up * camera.up[i] - camera.towards[i]);
}

function turn(state, dx, dy) {
  state.azimuth = (((state.azimuth - 0.35 * dx) % 360) + 540) % 360 - 180;
  state.elevation = Math.max(-90, Math.min(90, state.elevation + 0.35 * dy));
}

function move(state, dx, dy, canvas) {
  const camera = cameraOf(state, canvas.clientWidth / canvas.clientHeight);
  const scale = 2 * camera.halfFrustum[1] * camera.distance / canvas.clientHeight;
  state.target = state.target.map((t, i) => t + scale * (dy * camera.up[i] - dx * camera.right[i]));
}

const zoom = (state, factor) => { state.zoom = Math.max(0.1, Math.min(200, state.zoom * factor)); };

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
