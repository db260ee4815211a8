// What is drawn over the mesh: the directions of x, y and z, a bar of a round length, the cell that was found, and what is
// measured. Axes and bar are
// those of picture/axis_marks.cpp.

import {dot, placeOf} from "./camera.js";
import {cornersOf, kindOf, pointOf} from "./cells.js";
import {colours, picked} from "./colours.js";

// In ems.
const corner = 3.4, axisLength = 2.1, barBegins = 7, longestBar = 13;
export const fontOf = (size, weight = "") =>
  `${weight} ${size}px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", "DejaVu Sans", sans-serif`;

function line(context, from, to, width, colour) {
  context.strokeStyle = colour, context.lineWidth = width, context.lineCap = "round";
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}

// Text with a rim, which keeps it readable over the mesh.
function write(context, text, x, y, rimWidth, colour, rim) {
  context.textAlign = "center";
  context.strokeStyle = rim, context.lineWidth = rimWidth, context.lineJoin = "round";
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}

function drawAxes(context, camera, em, bottom) {
  const middle = [corner * em, bottom - corner * em];
  const directions = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
  const nearestLast = Object.keys(directions).sort((a, b) =>
    dot(directions[a], camera.towards) - dot(directions[b], camera.towards));
  context.font = fontOf(em, "bold"), context.textAlign = "center";
  for (const name of nearestLast) {
    const across = dot(directions[name], camera.right), up = dot(directions[name], camera.up);
    const at = ems => [middle[0] + ems * em * across, middle[1] - ems * em * up];
    line(context, middle, at(axisLength), 0.2 * em, colours.axes[name]);
    const [x, y] = at(axisLength + 0.62);
    context.fillStyle = colours.axes[name];
    context.fillText(name, x, y + 0.3 * em);
  }
}

// The greatest of 1, 2 and 5 times a power of ten that is not longer.
export function roundLength(length) {
  const ten = 10 ** Math.floor(Math.log10(length));
  return ([5, 2].find(times => times * ten <= length) ?? 1) * ten;
}

// `pixels`: of a unit of the mesh, at the distance of the target.
function drawBar(context, pixels, em, bottom, {soft, card}) {
  const length = roundLength(longestBar * em / pixels);
  const left = barBegins * em, right = left + length * pixels, base = bottom - 2 * em;
  // A pale rim keeps it readable over the mesh.
  for (const [width, colour] of [[0.46 * em, card], [0.22 * em, soft]]) {
    line(context, [left, base], [right, base], width, colour);
    for (const end of [left, right]) line(context, [end, base - 0.3 * em], [end, base + 0.3 * em], width, colour);
  }
  context.font = fontOf(em);
  write(context, String(Number(length.toPrecision(1))), (left + right) / 2, base - 0.6 * em, 0.24 * em, soft, card);
}

const mark = `rgb(${picked.join()})`;

// The pixel where a vertex is seen; null behind the eye.
function pixelOf(camera, scene, vertex, width, height) {
  const place = placeOf(camera, pointOf(scene, vertex));
  return place && [(1 + place[0]) * width / 2, (1 - place[1]) * height / 2];
}

// The edges of a cell, also those that other cells hide.
function drawCell(context, camera, scene, cell, em, width, height) {
  const corners = cornersOf(scene, cell), {facets} = scene.kinds[kindOf(scene, cell)];
  const pixels = Array.from(corners, vertex => pixelOf(camera, scene, vertex, width, height));
  if (pixels.includes(null)) return;
  for (const facet of facets)
    facet.forEach((corner, i) => line(context, pixels[corner], pixels[facet[(i + 1) % facet.length]], 0.14 * em, mark));
}

function drawMeasure(context, camera, scene, measure, em, width, height, card) {
  const pixels = measure.ends.map(vertex => pixelOf(camera, scene, vertex, width, height));
  if (pixels.length === 0 || pixels.includes(null)) return;
  if (pixels.length === 2) line(context, ...pixels, 0.18 * em, mark);
  for (const [x, y] of pixels) {
    context.fillStyle = mark;
    context.beginPath();
    context.arc(x, y, 0.36 * em, 0, 2 * Math.PI);
    context.fill();
  }
  if (!measure.text) return;
  const x = (pixels[0][0] + pixels[1][0]) / 2, y = (pixels[0][1] + pixels[1][1]) / 2 - 0.7 * em;
  context.font = fontOf(1.15 * em, "bold");
  write(context, measure.text, x, y, 0.35 * em, mark, card);
}

// Onto a picture of this size, of which what lies below `bottom` is covered. Letters have `em` pixels.
export function drawMarks(context, {camera, state, scene, measure, found}, {width, height, bottom, em}) {
  const theme = colours[state.theme];
  if (state.axes) {
    drawAxes(context, camera, em, bottom);
    drawBar(context, height / (2 * camera.halfFrustum[1] * camera.distance * scene.unit), em, bottom, theme);
  }
  if (found >= 0) drawCell(context, camera, scene, found, em, width, height);
  drawMeasure(context, camera, scene, measure, em, width, height, theme.card);
}
