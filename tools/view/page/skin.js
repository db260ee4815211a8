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

// Numbers facets by their vertices, in the order in which they come: a hash table with open addressing.
class FacetNumbers {
  constructor(most) {
    let size = 16;
    while (size < 2 * most) size *= 2;
    this.table = new Int32Array(size).fill(-1);
    this.keys = new Int32Array(4 * most);
    this.count = 0;
    this.key = new Int32Array(4);
  }

  // Small insertion sort of the vertices; a triangle's fourth is -1.
  sortIntoKey(vertices, count) {
    const key = this.key;
    key[3] = -1;
    for (let i = 0; i < count; ++i) {
      let j = i;
      for (; j > 0 && key[j - 1] > vertices[i]; --j) key[j] = key[j - 1];
      key[j] = vertices[i];
    }
  }

  numberOf(vertices, count) {
    this.sortIntoKey(vertices, count);
    const {key, keys, table} = this, a = key[0], b = key[1], c = key[2], d = key[3];
    let hash = Math.imul(a, 0x9e3779b1) ^ Math.imul(b, 0x85ebca6b) ^ Math.imul(c, 0xc2b2ae35) ^ Math.imul(d, 0x27d4eb2f);
    hash ^= hash >>> 15;
    for (let slot = hash & (table.length - 1);; slot = (slot + 1) & (table.length - 1)) {
      const number = table[slot], at = 4 * number;
      if (number < 0) {
        const place = 4 * this.count;
        keys[place] = a, keys[place + 1] = b, keys[place + 2] = c, keys[place + 3] = d;
        return table[slot] = this.count++;
      }
      if (keys[at] === a && keys[at + 1] === b && keys[at + 2] === c && keys[at + 3] === d) return number;
    }
  }
}

// The sides of facet f are items [begin[f], begin[f + 1]), each (cell * 8 + its number in the cell) * 2 + sense.
function findFacets(scene) {
  let total = 0;
  for (let k = 0; k < 4; ++k) total += scene.kinds[k].facets.length * (scene.kindBegin[k + 1] - scene.kindBegin[k]);
  const numbers = new FacetNumbers(total), facetOf = new Int32Array(total), item = new Int32Array(total);
  const vertices = new Int32Array(4);
  let side = 0;
  for (let k = 0; k < 4; ++k) {
    const {corners: width, facets} = scene.kinds[k], corners = scene.corners[k];
    for (let cell = scene.kindBegin[k], base = 0; cell < scene.kindBegin[k + 1]; ++cell, base += width)
      for (let local = 0; local < facets.length; ++local, ++side) {
        const facet = facets[local];
        for (let i = 0; i < facet.length; ++i) vertices[i] = corners[base + facet[i]];
        facetOf[side] = numbers.numberOf(vertices, facet.length);
        item[side] = (cell * 8 + local) * 2 + senseOf(vertices, facet.length);
      }
  }
  const begin = new Int32Array(numbers.count + 1), items = new Int32Array(total);
  for (let i = 0; i < total; ++i) ++begin[facetOf[i] + 1];
  for (let f = 0; f < numbers.count; ++f) begin[f + 1] += begin[f];
  const next = begin.slice();
  for (let i = 0; i < total; ++i) items[next[facetOf[i]]++] = item[i];
  return {begin, items};
}

export class Skin {
  constructor(scene) {
    this.scene = scene;
    this.facets = findFacets(scene);
    this.middles = middlesOf(scene);
    this.visible = new Uint8Array(scene.cellCount);
    this.shown = new Int32Array(this.facets.begin.length - 1);
    this.at = new Int32Array(4);
  }

  // Cells that the state shows; returns how many of each kind.
  chooseCells(state) {
    const {scene, middles, visible} = this;
    const [x, y, z] = state.clip?.normal ?? [0, 0, 0];
    let beyond = Infinity;
    if (state.clip) {
      const [low, high] = extent(scene, state.clip.normal);
      beyond = low + state.clip.fraction * (high - low);
    }
    const low = Math.fround(state.quality[0]), high = Math.fround(state.quality[1]);
    const counts = [0, 0, 0, 0];
    visible.fill(0);
    const judge = (k, cell) => {
      const quality = scene.quality[cell];
      if (scene.layer[cell] <= state.peel || quality < low || quality > high) return;
      if (x * middles[3 * cell] + y * middles[3 * cell + 1] + z * middles[3 * cell + 2] > beyond) return;
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
  chooseFacets() {
    const {visible, shown} = this, {begin, items} = this.facets;
    let count = 0, triangles = 0;
    for (let f = 0; f + 1 < begin.length; ++f) {
      let first0 = -1, first1 = -1;
      for (let i = begin[f]; i < begin[f + 1]; ++i) {
        const item = items[i];
        if (!visible[item >> 4]) continue;
        if (item & 1) first1 = first1 < 0 ? item : first1;
        else first0 = first0 < 0 ? item : first0;
      }
      if ((first0 < 0) === (first1 < 0)) continue;
      const item = first0 < 0 ? first1 : first0;
      shown[count++] = item;
      triangles += this.facetOf(item).length - 2;
    }
    return {count, triangles};
  }

  facetOf(item) {
    return this.scene.kinds[kindOf(this.scene, item >> 4)].facets[(item >> 1) & 7];
  }

  // Arrays as skin.vert wants them, and the cell of each triangle. colourOf(cell) gives [r, g, b].
  triangles(state, colourOf) {
    const counts = this.chooseCells(state), {count, triangles} = this.chooseFacets();
    const out = {
      counts,
      position: new Float32Array(9 * triangles), normal: new Int8Array(12 * triangles),
      colour: new Uint8Array(12 * triangles), cell: new Int32Array(triangles), done: 0,
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
    const scale = 127 / (Math.sqrt(nx * nx + ny * ny + nz * nz) || 1), colour = colourOf(cell);
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
    out.cell[out.done++] = cell;
    if (quad) out.cell[out.done++] = cell;
  }
}

// The cell whose triangle a ray meets first, or -1.
export function cellHit(skin, origin, direction) {
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
    if (distance > 0 && distance < nearest) nearest = distance, hit = skin.cell[t];
  }
  return hit;
}
