// Goes from the poorest cell to the next poorest, and from the longest dislocation to the next, at a click.

import {fitCamera, lookAt} from "./camera.js";
import {cornersOf, middleOf} from "./cells.js";
import {colours} from "./colours.js";
import {brief, byId, grouped} from "./dom.js";

// Of the free part of the picture, this much of its height is for a cell that was found, and this much for a line.
const cellPart = 0.16, linePart = 0.4;

// cell -> how good it is: by what the colours tell, if that is a measure, otherwise by the scaled Jacobian.
function goodnessOf(scene, state) {
  const values = scene.measures[state.colour];
  if (!values) return cell => scene.quality[cell];
  const {best, limit} = colours.measures[state.colour];
  return best > limit ? cell => values[cell] : cell => -values[cell];
}

// Where `cell` stands among those that are shown, from the poorest, and which is the next (step 1) or the one before (-1).
// Without a cell (-1) the poorest is next. Nothing is sorted: a look at all cells takes milliseconds.
export function nextPoorest(scene, state, shown, cell, step) {
  const goodness = goodnessOf(scene, state), own = cell < 0 ? -Infinity : goodness(cell);
  let found = -1, best = step > 0 ? Infinity : -Infinity, before = 0, count = 0;
  for (let other = 0; other < scene.cellCount; ++other) {
    if (!shown[other]) continue;
    ++count;
    const value = goodness(other), isBefore = value < own || (value === own && other < cell);
    if (isBefore) ++before;
    if (other === cell || isBefore === step > 0) continue;
    if (step > 0 ? value < best : value >= best) best = value, found = other;
  }
  return {found, rank: before + (step > 0 ? (shown[cell] ? 2 : 1) : 0), count};
}

export class Finder {
  // view: {scene, state, skin, aspect(), frame(), camera(), pick(cell)}
  constructor(view) {
    this.view = view;
    this.cell = this.line = -1;
    for (const [id, go] of [["poor", step => this.goToCell(step)], ["lines", step => this.goToLine(step)]])
      byId(id).addEventListener("click", ({target}) => target.value && go(Number(target.value)));
  }

  goToCell(step) {
    const {view} = this, {scene, state} = view;
    view.skin.chooseCells({...state, clip: null});
    const {found, rank, count} = nextPoorest(scene, state, view.skin.visible, this.cell, step);
    if (found < 0) return;
    this.cell = found;
    byId("poor-place").textContent = `${grouped(rank)} of ${grouped(count)}`;
    this.showCell(found);
    view.pick(found);
  }

  // A cut across the line of sight opens the view to a cell inside.
  showCell(cell) {
    const {scene, state, skin} = this.view, middle = middleOf(scene, cell);
    const normal = this.view.camera().towards.map(n => Number(n.toPrecision(4)));
    const [low, high] = skin.extentAlong(normal), along = normal.reduce((sum, n, i) => sum + n * middle[i], 0);
    state.clip = {normal, fraction: Math.min(1, Math.max(0, (along - low) / (high - low) + 1e-4))};
    state.fitted = state.follows = false;
    let radius = 0;
    for (const v of cornersOf(scene, cell))
      radius = Math.max(radius, Math.hypot(...middle.map((m, i) => scene.points[3 * v + i] - m)));
    lookAt(state, middle, radius, cellPart, this.view.aspect(), this.view.frame());
  }

  goToLine(step) {
    const {view} = this, {scene, state} = view, count = scene.dislocations.length;
    this.line = this.line < 0 ? (step > 0 ? 0 : count - 1) : (this.line + step + count) % count;
    const {points, length} = scene.dislocations[this.line], {left, right, bottom, top} = view.frame();
    byId("lines-place").textContent = `${this.line + 1} of ${count} · ${brief(length)}`;
    byId("lines-place").title = `Its length is ${brief(length)}.`;
    const middle = [(left + right) / 2, (bottom + top) / 2], part = linePart;
    fitCamera(state, points, view.aspect(), {
      left: middle[0] + part * (left - middle[0]), right: middle[0] + part * (right - middle[0]),
      bottom: middle[1] + part * (bottom - middle[1]), top: middle[1] + part * (top - middle[1]),
    });
    state.clip = null;
    state.dislocations = true;
    state.fitted = state.follows = false;
    view.pick(-1);
  }
}
