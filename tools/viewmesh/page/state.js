// How the scene is looked at, in the words of view_state.hpp: a link holds it behind the #, --view takes the same text.
// Beside these a state `follows` as long as zoom and target are to fit anew when other cells are shown.

export const axes = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
const kindNames = ["hex", "prism", "pyramid", "tet"];
const colourNames = ["hexes", "quality", "kind", "region", "surface", "orthogonality", "weight", "determinant", "flatness"];

const rounded = number => String(Number(number.toPrecision(6)));
// Written as std::from_chars takes them.
const number = /^-?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const numbers = (text, count, low, high) => {
  const list = text.split(",").map(part => number.test(part) ? Number(part) : NaN);
  if (list.length !== count || !list.every(value => value >= low && value <= high)) throw new Error(text);
  return list;
};
const integer = (text, low, high) => Math.trunc(numbers(text, 1, low, high)[0]);
const oneOf = (text, names) => {
  if (!names.includes(text)) throw new Error(text);
  return text;
};

const isOn = text => oneOf(text, ["off", "on"]) === "on";

function parseUp(text) {
  const [, sign, name] = /^(-?)([xyz])$/.exec(text) ?? [];
  if (!name) throw new Error(text);
  return {axis: "xyz".indexOf(name), turned: sign === "-"};
}

function parseDirection(text) {
  const [, sign, name] = /^(-?)([xyz])$/.exec(text) ?? [];
  if (name) return axes[name].map(n => n === 0 ? 0 : sign ? -n : n);
  const direction = numbers(text, 3, -1, 1);
  if (Math.hypot(...direction) < 1e-3) throw new Error(text);
  return direction;
}

function parseClip(text) {
  if (text === "none") return null;
  const colon = text.indexOf(":");
  if (colon < 0) throw new Error(text);
  return {normal: parseDirection(text.slice(0, colon)), fraction: numbers(text.slice(colon + 1), 1, 0, 1)[0]};
}

export function directionName(normal) {
  for (const name of Object.keys(axes))
    for (const sign of [1, -1])
      if (axes[name].every((n, i) => sign * n === normal[i])) return (sign < 0 ? "-" : "") + name;
  return null;
}

// A group is hidden by its kind and tag; a link may have its name, which the page knows.
function parseHidden(text, groups) {
  if (text === "none") return [];
  return text.split(",").map(part => {
    const [, kind, word] = /^(region|surface):(.+)$/.exec(part) ?? [];
    const group = groups?.[kind]?.find(({tag, name}) => String(tag) === word || name === word);
    if (!group) throw new Error(part);
    return {kind, tag: group.tag};
  });
}

// The bounds are those of view_state.cpp: what --view refuses, no link sets.
const setters = {
  camera(state, text) {
    const fitted = text.split(",").length === 2;
    const [azimuth, elevation, zoom, ...target] = numbers(text, fitted ? 2 : 6, -1e4, 1e4);
    if (Math.abs(elevation) > 90 || zoom < 0.05) throw new Error(text);
    Object.assign(state, {azimuth, elevation, fitted, follows: fitted}, fitted ? {} : {zoom, target});
  },
  up: (state, text) => { state.up = parseUp(text); },
  clip: (state, text) => { state.clip = parseClip(text); },
  quality: (state, text) => { state.quality = numbers(text, 2, -1, 1); },
  peel: (state, text) => { state.peel = integer(text, 0, 255); },
  kinds(state, text) {
    const shown = text === "none" ? [] : text.split(",").map(name => oneOf(name, kindNames));
    state.kinds = kindNames.map(name => shown.includes(name));
  },
  hidden: (state, text, groups) => { state.hidden = parseHidden(text, groups); },
  colour: (state, text) => { state.colour = oneOf(text, colourNames); },
  color: (state, text) => { state.colour = oneOf(text, colourNames); },
  edges: (state, text) => { state.edges = isOn(text); },
  axes: (state, text) => { state.axes = isOn(text); },
  legend: (state, text) => { state.legend = isOn(text); },
  dislocations: (state, text) => { state.dislocations = isOn(text); },
  theme: (state, text) => { state.theme = oneOf(text, ["light", "dark"]); },
  fragment: (state, text) => { state.fragment = integer(text, 0, 1e9); },
};

// Changes what the text names; what it says wrongly stays as it is, for links may come from anywhere. `groups` are the
// scene's.
export function applyText(state, text, groups) {
  for (const part of text.split("&")) {
    const equals = part.indexOf("=");
    const setter = setters[part.slice(0, equals)];
    try {
      setter?.(state, decodeURIComponent(part.slice(equals + 1)), groups);
    } catch {
      continue;
    }
  }
  return state;
}

export function toText(state) {
  const clip = state.clip &&
    `${directionName(state.clip.normal) ?? state.clip.normal.map(rounded).join()}:${rounded(state.clip.fraction)}`;
  const place = state.fitted ? [] : [state.zoom, ...state.target];
  const camera = [state.azimuth, state.elevation, ...place].map(rounded);
  const onOff = name => `&${name}=${state[name] ? "on" : "off"}`;
  return `camera=${camera}&up=${state.up.turned ? "-" : ""}${"xyz"[state.up.axis]}&clip=${clip ?? "none"}&quality=${state.quality.map(rounded)}&peel=${state.peel}` +
    `&kinds=${kindNames.filter((_, k) => state.kinds[k]).join() || "none"}` +
    `&hidden=${state.hidden.map(({kind, tag}) => `${kind}:${tag}`).join() || "none"}&colour=${state.colour}` +
    ["edges", "axes", "legend", "dislocations"].map(onOff).join("") +
    `&theme=${state.theme}&fragment=${state.fragment}`;
}
