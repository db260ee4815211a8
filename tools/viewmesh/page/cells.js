// What a cell of the scene is and where.

export function kindOf(scene, cell) {
  let k = 3;
  while (scene.kindBegin[k] > cell) --k;
  return k;
}

export function cornersOf(scene, cell) {
  const k = kindOf(scene, cell), count = scene.kinds[k].corners, begin = (cell - scene.kindBegin[k]) * count;
  return scene.corners[k].subarray(begin, begin + count);
}

export function pointOf(scene, vertex) {
  return [...scene.points.subarray(3 * vertex, 3 * vertex + 3)];
}

// The mean of each cell's corners, three numbers a cell.
export function middlesOf(scene) {
  const {points} = scene, result = new Float64Array(3 * scene.cellCount);
  let place = 0;
  for (let k = 0; k < 4; ++k) {
    const count = scene.kinds[k].corners, corners = scene.corners[k];
    for (let base = 0; base < corners.length; base += count) {
      let x = 0, y = 0, z = 0;
      for (let i = base; i < base + count; ++i) {
        const at = 3 * corners[i];
        x += points[at], y += points[at + 1], z += points[at + 2];
      }
      result[place++] = x / count, result[place++] = y / count, result[place++] = z / count;
    }
  }
  return result;
}

// How far the cells' corners reach along a direction: [least, greatest].
export function extent(scene, [x, y, z]) {
  let low = Infinity, high = -Infinity;
  for (const corners of scene.corners)
    for (const v of corners) {
      const along = x * scene.points[3 * v] + y * scene.points[3 * v + 1] + z * scene.points[3 * v + 2];
      if (along < low) low = along;
      if (along > high) high = along;
    }
  return [low, high];
}

// The mean of one cell's corners.
export function middleOf(scene, cell) {
  const corners = cornersOf(scene, cell), middle = [0, 0, 0];
  for (const v of corners)
    for (let axis = 0; axis < 3; ++axis) middle[axis] += scene.points[3 * v + axis] / corners.length;
  return middle;
}

// The share of the volume that hexes have, as text; null where cells overlap, or no hex can be.
export function hexShare(scene) {
  const total = scene.volume.reduce((a, b) => a + b, 0);
  if (!["result", "solution"].includes(scene.content) || !(total > 0)) return null;
  return `${(100 * scene.volume[0] / total).toFixed(1)} %`;
}
