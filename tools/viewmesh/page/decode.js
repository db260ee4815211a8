// Arrays as page.cpp packs them, and the scene made of them.

function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text), bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

async function words(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const count = bytes.length / 4, result = new Int32Array(count);
  for (let i = 0; i < count; ++i)
    result[i] = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
  return result;
}

// Each number is told by its difference to the one `stride` before.
async function integers(text, stride) {
  const result = await words(text);
  for (let i = 0; i < result.length; ++i)
    result[i] = (i < stride ? 0 : result[i - stride]) + ((result[i] >>> 1) ^ -(result[i] & 1));
  return result;
}

async function floats(text) {
  return new Float32Array((await words(text)).buffer);
}

async function points(text, count) {
  const rows = await floats(text);
  const result = new Float32Array(3 * count);
  for (let axis = 0; axis < 3; ++axis)
    for (let i = 0; i < count; ++i) result[3 * i + axis] = rows[axis * count + i];
  return result;
}

// For each facet of each cell, at eight times the cell and the facet's number, one more than the place of its surface; 0
// on none.
async function surfaces(packed, cellCount) {
  const facets = await integers(packed.facets, 1), places = await integers(packed.surfaces, 1);
  const result = new Uint16Array(8 * cellCount);
  for (let i = 0; i < facets.length; ++i) result[facets[i]] = places[i] + 1;
  return result;
}

// Lines of {points: three numbers each, length in the mesh's own units}.
async function dislocations(packed) {
  const sizes = await integers(packed.sizes, 1), lengths = await floats(packed.lengths), all = await floats(packed.points);
  let at = 0;
  return Array.from(sizes, (size, i) => ({points: all.subarray(at, at += 3 * size), length: lengths[i]}));
}

// `fragments` becomes a list of arrays of cells, `dislocations` a list of lines, `surfaceFacets` becomes `surfaceOfFacet`;
// all else keeps its name.
export async function decodeScene(data) {
  const scene = {...data, points: await points(data.points, data.pointCount)};
  scene.corners = await Promise.all(data.corners.map((text, k) => integers(text, data.kinds[k].corners)));
  scene.quality = await floats(data.quality);
  for (const name of ["region", "layer", "number"]) scene[name] = await integers(data[name], 1);
  const sizes = await integers(data.fragments.sizes, 1), cells = await integers(data.fragments.cells, 1);
  let at = 0;
  scene.fragments = Array.from(sizes, size => cells.subarray(at, at += size));
  scene.measures = {};
  for (const [name, text] of Object.entries(data.measures)) scene.measures[name] = await integers(text, 1);
  scene.cellCount = data.kindBegin[4];
  scene.dislocations = await dislocations(data.dislocations);
  scene.surfaceOfFacet = await surfaces(data.surfaceFacets, scene.cellCount);
  return scene;
}
