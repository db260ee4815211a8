// Arrays as page.cpp packs them, and the scene made of them.

async function inflate(text) {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function words(text) {
  const bytes = await inflate(text);
  const count = bytes.length / 4;
  const result = new Uint32Array(count);
  for (let i = 0; i < count; ++i)
    result[i] = bytes[i] | (bytes[count + i] << 8) | (bytes[2 * count + i] << 16) | (bytes[3 * count + i] << 24);
  return result;
}

async function integers(text, stride) {
  const coded = await words(text);
  const result = new Int32Array(coded.length);
  for (let i = 0; i < coded.length; ++i)
    result[i] = (i < stride ? 0 : result[i - stride]) + ((coded[i] >>> 1) ^ -(coded[i] & 1));
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

// `fragments` becomes a list of arrays of cells; all else keeps its name.
export async function decodeScene(data) {
  const scene = {...data, points: await points(data.points, data.pointCount)};
  scene.corners = await Promise.all(data.corners.map((text, k) => integers(text, data.kinds[k].corners)));
  scene.quality = await floats(data.quality);
  for (const name of ["region", "layer", "number"]) scene[name] = await integers(data[name], 1);
  const sizes = await integers(data.fragments.sizes, 1), cells = await integers(data.fragments.cells, 1);
  let at = 0;
  scene.fragments = Array.from(sizes, size => cells.subarray(at, at += size));
  scene.cellCount = data.kindBegin[4];
  return scene;
}
