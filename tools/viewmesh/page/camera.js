// The camera of camera.cpp, and how it fits what is shown. pointer.js moves it.

const degree = Math.PI / 180;
const upTangent = Math.tan(14 * degree);
const greatestZoom = 200;
const nearest = 0.1;  // of the way to the target; what is nearer is not drawn

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const combined = (vectors, factors) => [0, 1, 2].map(i => vectors.reduce((sum, v, k) => sum + factors[k] * v[i], 0));

// The axes of the plane across `up`, and `up` itself.
export function axesOf({axis, turned}) {
  const unit = k => [0, 1, 2].map(i => i === k % 3 ? 1 : 0), next = unit(axis + 1), last = unit(axis + 2);
  return turned ? [last, next, unit(axis).map(n => n === 0 ? 0 : -n)] : [next, last, unit(axis)];
}

const distanceAt = (zoom, aspect) => 1 / Math.sin(Math.atan(upTangent * Math.min(1, aspect))) / zoom;

function directionsOf(state) {
  const azimuth = state.azimuth * degree, elevation = state.elevation * degree;
  const [first, second, above] = axesOf(state.up);
  const ahead = combined([first, second], [Math.cos(azimuth), Math.sin(azimuth)]);
  const right = combined([first, second], [-Math.sin(azimuth), Math.cos(azimuth)]);
  const towards = combined([ahead, above], [Math.cos(elevation), Math.sin(elevation)]);
  return {right, up: cross(towards, right), towards};
}

export function cameraOf(state, aspect) {
  const directions = directionsOf(state), distance = distanceAt(state.zoom, aspect);
  const reach = 1.05 + Math.hypot(...state.target);
  return {
    ...directions, distance,
    eye: state.target.map((t, i) => t + distance * directions.towards[i]),
    near: Math.max(distance - reach, nearest * distance), far: distance + reach,
    halfFrustum: [upTangent * aspect, upTangent],
  };
}

// The direction of the ray through a place of the picture, (-1, -1) lower left to (1, 1) upper right.
export function rayThrough(camera, x, y) {
  const [across, up] = camera.halfFrustum;
  return [0, 1, 2].map(i => x * across * camera.right[i] + y * up * camera.up[i] - camera.towards[i]);
}

// The place of the picture where a point is seen; null behind the eye.
export function placeOf(camera, point) {
  const from = point.map((p, i) => p - camera.eye[i]), depth = -dot(from, camera.towards);
  if (depth <= 0) return null;
  const [across, up] = camera.halfFrustum;
  return [dot(from, camera.right) / depth / across, dot(from, camera.up) / depth / up];
}

// Where the eye has to be, along one way across the picture, for all points to be seen between two tangents.
class Slot {
  constructor(low, high) {
    this.low = low, this.high = high;
    this.least = Infinity, this.greatest = -Infinity;
  }
  add(across, towards) {
    const least = across + this.low * towards, greatest = across + this.high * towards;
    if (least < this.least) this.least = least;
    if (greatest > this.greatest) this.greatest = greatest;
  }
  get leastDepth() { return (this.greatest - this.least) / (this.high - this.low); }
  eyeAt(depth) { return (this.greatest - this.high * depth + this.least - this.low * depth) / 2; }
}

// Sets zoom and target so that the points, three numbers each, just fit into a frame, in its middle. The frame is a part
// of the picture, of which all is from -1 to 1. Without points the whole scene does.
export function fitCamera(state, points, aspect, {left, right, bottom, top}) {
  state.zoom = 1, state.target = [0, 0, 0];
  if (points.length === 0) return;
  const {right: [rx, ry, rz], up: [ux, uy, uz], towards: [tx, ty, tz]} = directionsOf(state);
  const across = new Slot(left * upTangent * aspect, right * upTangent * aspect);
  const upwards = new Slot(bottom * upTangent, top * upTangent);
  let back = Infinity, front = -Infinity;
  for (let i = 0; i < points.length; i += 3) {
    const x = points[i], y = points[i + 1], z = points[i + 2], towards = tx * x + ty * y + tz * z;
    across.add(rx * x + ry * y + rz * z, towards);
    upwards.add(ux * x + uy * y + uz * z, towards);
    if (towards < back) back = towards;
    if (towards > front) front = towards;
  }
  const middle = (back + front) / 2, closest = distanceAt(greatestZoom, aspect);
  const depth = Math.max(across.leastDepth, upwards.leastDepth, middle + closest);
  state.zoom = distanceAt(1, aspect) / (depth - middle);
  state.target = combined([[rx, ry, rz], [ux, uy, uz], [tx, ty, tz]], [across.eyeAt(depth), upwards.eyeAt(depth), middle]);
}

// Lets a ball take this part of the frame's height.
export function lookAt(state, middle, radius, part, aspect, frame) {
  const distance = radius / (upTangent * part * (frame.top - frame.bottom) / 2);
  state.zoom = Math.min(greatestZoom, distanceAt(1, aspect) / distance);
  const {right, up} = directionsOf(state), reached = distanceAt(state.zoom, aspect) * upTangent / 2;
  state.target = combined([middle, right, up],
    [1, -(frame.left + frame.right) * reached * aspect, -(frame.bottom + frame.top) * reached]);
}
