// The facets of all cells, found once, and the triangles that are drawn: facets with visible cells on one side only.

import {extent, kindOf, middlesOf} from "./cells.js";

// A quad's corners 0 1 2 and 2 3 0; of these a triangle has the first three.
const cornersOfTriangles = [0, 1, 2, 2, 3, 0];

// Opposite senses of the same facet differ in this: whether, begun at the least vertex, the next is less than the last.
function senseOf(vertices, count) {
  let least = 0;
  for (let i = 1; i < count; ++i) if (vertices[i] < vertices[least]) least = i;
  return vertices[(least + 1) % count] < vertices[(least + count - 1) % count] ? 0 : 1;
}

// visit(vertices, count, item) for each facet of each cell; the item is (cell * 8 + the facet's number in the cell) * 2.
function forEachSide(scene, visit) {
  const vertices = new Int32Array(4);
  for (let k = 0; k < 4; ++k) {
    const {corners: width, facets} = scene.kinds[k], corners = scene.corners[k];
    for (let cell = scene.kindBegin[k], base = 0; cell < scene.kindBegin[k + 1]; ++cell, base += width)
      for (let local = 0; local < facets.length; ++local) {
        const facet = facets[local];
        for (let i = 0; i < facet.length; ++i) vertices[i] = corners[base + facet[i]];
        visit(vertices, facet.length, (cell * 8 + local) * 2);
      }
  }
}

const leastOf = (vertices, count) =>
  Math.min(vertices[0], vertices[1], vertices[2], vertices[count === 4 ? 3 : 2]);

// Four numbers a side: its vertices but for the least, ascending (-1 where a triangle has no more), and its item, of which
// the last bit is its sense.
function writeSide(vertices, count, least, item, sides, at) {
  sides[at] = sides[at + 1] = sides[at + 2] = -1;
  let done = at;
  for (let i = 0; i < count; ++i) {
    const vertex = vertices[i];
    if (vertex === least) continue;
    let j = done++;
    for (; j > at && sides[j - 1] > vertex; --j) sides[j] = sides[j - 1];
    sides[j] = vertex;
  }
  sides[at + 3] = item + senseOf(vertices, count);
}

// Those that have vertex v as the least are [begin[v], begin[v + 1]).
function sidesByLeastVertex(scene) {
  const begin = new Int32Array(scene.pointCount + 1);
  forEachSide(scene, (vertices, count) => { ++begin[leastOf(vertices, count) + 1]; });
  for (let v = 0; v < scene.pointCount; ++v) begin[v + 1] += begin[v];
  const next = begin.slice(), sides = new Int32Array(4 * begin[scene.pointCount]);
  forEachSide(scene, (vertices, count, item) => {
    const least = leastOf(vertices, count);
    writeSide(vertices, count, least, item, sides, 4 * next[least]++);
  });
  return {begin, sides};
}

// Around a vertex this many sides are compared each with each; more are sorted first.
const few = 200;

// The sides of facet f are items [begin[f], begin[f + 1]), in any order.
function findFacets(scene) {
  const {begin: around, sides} = sidesByLeastVertex(scene), begin = new Int32Array(sides.length / 4 + 1);
  let count = 0;
  const same = (a, b) => sides[a] === sides[b] && sides[a + 1] === sides[b + 1] && sides[a + 2] === sides[b + 2];
  for (let v = 0; v < scene.pointCount; ++v) {
    const first = 4 * around[v], end = 4 * around[v + 1], many = end - first > 4 * few;
    if (many) sortSides(sides.subarray(first, end));
    for (let at = first, last; at < end; at = last + 4) {
      last = at;
      for (let other = at + 4; other < end; other += 4)
        if (same(at, other)) swapSides(sides, last += 4, other);
        else if (many) break;
      begin[++count] = last / 4 + 1;
    }
  }
  return {begin: begin.slice(0, count + 1), items: Int32Array.from({length: sides.length / 4}, (_, i) => sides[4 * i + 3])};
}

function swapSides(sides, a, b) {
  if (a === b) return;
  for (let i = 0; i < 4; ++i) {
    const number = sides[a + i];
    sides[a + i] = sides[b + i];
    sides[b + i] = number;
  }
}

function sortSides(sides) {
  const old = sides.slice(), order = Int32Array.from({length: sides.length / 4}, (_, i) => 4 * i);
  order.sort((a, b) => old[a] - old[b] || old[a + 1] - old[b + 1] || old[a + 2] - old[b + 2]);
  order.forEach((from, i) => sides.set(old.subarray(from, from + 4), 4 * i));
}

export class Skin {
  constructor(scene) {
    this.scene = scene;
    this.facets = findFacets(scene);
    this.visible = new Uint8Array(scene.cellCount);
    this.shown = new Int32Array(this.facets.begin.length - 1);
    this.at = new Int32Array(4);
  }

  // How far the cells reach along a normal: [least, greatest]. What sliding a plane does not change is kept.
  extentAlong(normal) {
    if (this.direction !== normal.join()) {
      this.direction = normal.join();
      this.extent = extent(this.scene, normal);
    }
    return this.extent;
  }

  // A clip's plane: what lies beyond is farther along its normal.
  planeOf({normal, fraction}) {
    const [low, high] = this.extentAlong(normal);
    return low + fraction * (high - low);
  }

  // cell -> whether its middle is beyond the plane.
  clippedBy(clip) {
    if (!clip) return () => false;
    const middles = this.middles ??= middlesOf(this.scene), [x, y, z] = clip.normal, beyond = this.planeOf(clip);
    return cell => x * middles[3 * cell] + y * middles[3 * cell + 1] + z * middles[3 * cell + 2] > beyond;
  }

  // Cells that the state shows; returns how many of each kind.
  chooseCells(state) {
    const {scene, visible} = this, clipped = this.clippedBy(state.clip);
    const low = Math.fround(state.quality[0]), high = Math.fround(state.quality[1]);
    const counts = [0, 0, 0, 0];
    const hidden = new Set(state.hidden.filter(({kind}) => kind === "region").map(({tag}) => tag));
    visible.fill(0);
    const judge = (k, cell) => {
      const quality = scene.quality[cell];
      if (scene.layer[cell] <= state.peel || quality < low || quality > high) return;
      if (clipped(cell) || (hidden.size > 0 && hidden.has(scene.region[cell]))) return;
      visible[cell] = 1;
      ++counts[k];
    };
    const fragment = scene.fragments[state.fragment - 1];
    if (fragment) {
      for (const cell of fragment) if (state.kinds[kindOf(scene, cell)]) judge(kindOf(scene, cell), cell);
      return counts;
    }
    for (let k = 0; k < 4; ++k)
      if (state.kinds[k]) for (let cell = scene.kindBegin[k]; cell < scene.kindBegin[k + 1]; ++cell) judge(k, cell);
    return counts;
  }

  // Items of the facets to draw, of a facet the first visible cell's; returns {shown, count, triangles}.
  chooseFacets(state) {
    const {visible, shown} = this, {begin, items} = this.facets, {surfaceOfFacet} = this.scene;
    const hidden = this.hiddenSurfaces(state);
    let count = 0, triangles = 0;
    for (let f = 0; f + 1 < begin.length; ++f) {
      let first0 = -1, first1 = -1;
      for (let i = begin[f]; i < begin[f + 1]; ++i) {
        const item = items[i];
        if (!visible[item >> 4]) continue;
        if (item & 1) first1 = first1 < 0 || item < first1 ? item : first1;
        else first0 = first0 < 0 || item < first0 ? item : first0;
      }
      if ((first0 < 0) === (first1 < 0)) continue;
      const item = first0 < 0 ? first1 : first0;
      if (hidden[surfaceOfFacet[item >> 1]]) continue;
      shown[count++] = item;
      triangles += this.facetOf(item).length - 2;
    }
    return {count, triangles};
  }

  // By what surfaceOfFacet has.
  hiddenSurfaces(state) {
    const {surface} = this.scene.groups, hidden = new Uint8Array(surface.length + 1);
    for (const {kind, tag} of state.hidden)
      if (kind === "surface") hidden[surface.findIndex(group => group.tag === tag) + 1] = 1;
    return hidden;
  }

  facetOf(item) {
    return this.scene.kinds[kindOf(this.scene, item >> 4)].facets[(item >> 1) & 7];
  }

  // Arrays as skin.vert wants them, and the cell, its facet and the surface (-1: none) of each triangle. colourOf(cell, surface)
  // gives [r, g, b].
  triangles(state, colourOf) {
    const counts = this.chooseCells(state), {count, triangles} = this.chooseFacets(state);
    const out = {
      counts,
      position: new Float32Array(9 * triangles), normal: new Int8Array(12 * triangles),
      colour: new Uint8Array(12 * triangles), cell: new Int32Array(triangles), surface: new Int32Array(triangles),
      facet: new Uint8Array(triangles), done: 0,
    };
    for (let i = 0; i < count; ++i) this.addFacet(this.shown[i], colourOf, out);
    return out;
  }

  addFacet(item, colourOf, out) {
    const cell = item >> 4, facet = this.facetOf(item), quad = facet.length === 4, {points} = this.scene;
    const k = kindOf(this.scene, cell), corners = this.scene.corners[k];
    const base = (cell - this.scene.kindBegin[k]) * this.scene.kinds[k].corners;
    const at = this.at;
    for (let i = 0; i < facet.length; ++i) at[i] = 3 * corners[base + facet[i]];
    // Across the diagonals of a quad, along two sides of a triangle.
    const u0 = at[0], u1 = quad ? at[2] : at[1], v0 = quad ? at[1] : at[0], v1 = quad ? at[3] : at[2];
    const ux = points[u1] - points[u0], uy = points[u1 + 1] - points[u0 + 1], uz = points[u1 + 2] - points[u0 + 2];
    const vx = points[v1] - points[v0], vy = points[v1 + 1] - points[v0 + 1], vz = points[v1 + 2] - points[v0 + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const surface = this.scene.surfaceOfFacet[item >> 1] - 1, colour = colourOf(cell, surface);
    const scale = 127 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1);
    // The two triangles of a quad hide the side opposite their corner 1, its diagonal.
    for (let corner = 0; corner < (quad ? 6 : 3); ++corner) {
      const vertex = 3 * out.done + corner, from = at[cornersOfTriangles[corner]];
      out.position[3 * vertex] = points[from];
      out.position[3 * vertex + 1] = points[from + 1];
      out.position[3 * vertex + 2] = points[from + 2];
      out.normal[4 * vertex] = Math.round(scale * nx);
      out.normal[4 * vertex + 1] = Math.round(scale * ny);
      out.normal[4 * vertex + 2] = Math.round(scale * nz);
      out.colour[4 * vertex] = colour[0];
      out.colour[4 * vertex + 1] = colour[1];
      out.colour[4 * vertex + 2] = colour[2];
      out.colour[4 * vertex + 3] = corner % 3 + (quad ? 8 : 0);
    }
    for (let triangle = 0; triangle < (quad ? 2 : 1); ++triangle) {
      out.surface[out.done] = surface;
      out.facet[out.done] = (item >> 1) & 7;
      out.cell[out.done++] = cell;
    }
  }
}

// The cell, its facet and the surface of the triangle that a ray meets first, or -1 for each.
export function triangleHit(skin, origin, direction) {
  const p = skin.position;
  let nearest = Infinity, hit = -1;
  for (let t = 0; t < skin.cell.length; ++t) {
    const i = 9 * t;
    const ux = p[i + 3] - p[i], uy = p[i + 4] - p[i + 1], uz = p[i + 5] - p[i + 2];
    const vx = p[i + 6] - p[i], vy = p[i + 7] - p[i + 1], vz = p[i + 8] - p[i + 2];
    const [dx, dy, dz] = direction;
    const hx = dy * vz - dz * vy, hy = dz * vx - dx * vz, hz = dx * vy - dy * vx;
    const determinant = ux * hx + uy * hy + uz * hz;
    if (determinant === 0) continue;
    const sx = origin[0] - p[i], sy = origin[1] - p[i + 1], sz = origin[2] - p[i + 2];
    const a = (sx * hx + sy * hy + sz * hz) / determinant;
    if (a < 0 || a > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const b = (dx * qx + dy * qy + dz * qz) / determinant;
    if (b < 0 || a + b > 1) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / determinant;
    if (distance > 0 && distance < nearest) nearest = distance, hit = t;
  }
  if (hit < 0) return {cell: -1, facet: -1, surface: -1};
  return {cell: skin.cell[hit], facet: skin.facet[hit], surface: skin.surface[hit]};
}
