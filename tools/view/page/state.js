// How the scene is looked at, in the words of view_state.hpp: a link holds it behind the #, --view takes the same text.

export const axes = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
const kindNames = ["hex", "prism", "pyramid", "tet"];
const colourNames = ["hexes", "quality", "kind", "region"];

const rounded = number => String(Number(number.toPrecision(6)));
const numbers = (text, count) => {
  const list = text.split(",").map(part => part === "" ? NaN : Number(part));
  if (list.length !== count || !list.every(Number.isFinite)) throw new Error(text);
  return list;
};
const oneOf = (text, names) => {
  if (!names.includes(text)) throw new Error(text);
  return text;
};

function parseClip(text) {
  if (text === "none") return null;
  const [direction, fraction] = text.split(":");
  const axis = axes[direction.replace("-", "")];
  const sign = direction.startsWith("-") ? -1 : 1;
  return {normal: axis ? axis.map(n => sign * n) : numbers(direction, 3), fraction: numbers(fraction, 1)[0]};
}

export function directionName(normal) {
  for (const name of Object.keys(axes))
    for (const sign of [1, -1])
      if (axes[name].every((n, i) => sign * n === normal[i])) return (sign < 0 ? "-" : "") + name;
  return null;
}

const setters = {
  camera(state, text) {
    const list = numbers(text, 6);
    [state.azimuth, state.elevation, state.zoom] = list;
    state.target = list.slice(3);
  },
  clip: (state, text) => { state.clip = parseClip(text); },
  quality: (state, text) => { state.quality = numbers(text, 2); },
  peel: (state, text) => { state.peel = numbers(text, 1)[0]; },
  kinds: (state, text) => { state.kinds = kindNames.map(name => text.split(",").includes(name)); },
  colour: (state, text) => { state.colour = oneOf(text, colourNames); },
  edges: (state, text) => { state.edges = oneOf(text, ["off", "on"]) === "on"; },
  theme: (state, text) => { state.theme = oneOf(text, ["light", "dark"]); },
  fragment: (state, text) => { state.fragment = numbers(text, 1)[0]; },
};

// Changes what the text names; what it says wrongly stays as it is, for links may come from anywhere.
export function applyText(state, text) {
  for (const part of text.split("&")) {
    const equals = part.indexOf("=");
    const setter = setters[part.slice(0, equals)];
    try {
      setter?.(state, decodeURIComponent(part.slice(equals + 1)));
    } catch {
      continue;
    }
  }
  return state;
}

export function toText(state) {
  const clip = state.clip &&
    `${directionName(state.clip.normal) ?? state.clip.normal.map(rounded).join()}:${rounded(state.clip.fraction)}`;
  const camera = [state.azimuth, state.elevation, state.zoom, ...state.target].map(rounded);
  return `camera=${camera}&clip=${clip ?? "none"}&quality=${state.quality.map(rounded)}&peel=${state.peel}` +
    `&kinds=${kindNames.filter((_, k) => state.kinds[k]).join() || "none"}&colour=${state.colour}` +
    `&edges=${state.edges ? "on" : "off"}&theme=${state.theme}&fragment=${state.fragment}`;
}
