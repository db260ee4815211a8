// What colour a cell has, as skin.cpp says it.

import colours from "./colours.json";
import {kindOf} from "./cells.js";

export {colours};
export const picked = [236, 64, 140];

export function rgb(text) {
  const value = parseInt(text.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
}

const quality = colours.quality.map(rgb), plain = rgb(colours.plain), invalid = rgb(colours.invalid);
const kinds = Object.values(colours.kinds).map(rgb), groups = colours.groups.map(rgb);

// 0 is worst, 1 best.
function rampColour(value) {
  const place = Math.min(value, 1) * (quality.length - 1), below = Math.min(Math.floor(place), quality.length - 2);
  const part = place - below, from = quality[below], to = quality[below + 1];
  const mix = i => Math.round(from[i] * (1 - part) + to[i] * part);
  return [mix(0), mix(1), mix(2)];
}

export const qualityColour = value => value > 0 ? rampColour(value) : invalid;

// From what a measure allows to its best; what it does not allow is as an invalid cell.
function measureColour({best, limit}, value) {
  const place = (value - limit) / (best - limit);
  return place < 0 ? invalid : rampColour(place);
}

// The place of each tag among the groups of a kind, "region" or "surface".
const placesOf = (scene, kind) => new Map(scene.groups[kind].map(({tag}, place) => [tag, place]));

export const groupColour = place => colours.groups[place % colours.groups.length];

// (cell, place of the facet's surface or -1) -> [r, g, b]
export function painter(scene, mode) {
  if (mode === "kind") return cell => kinds[kindOf(scene, cell)];
  if (mode === "region") {
    const places = placesOf(scene, "region");
    return cell => groups[places.get(scene.region[cell]) % groups.length];
  }
  if (mode === "surface") return (cell, surface) => surface < 0 ? plain : groups[surface % groups.length];
  if (scene.measures[mode]) return cell => measureColour(colours.measures[mode], scene.measures[mode][cell]);
  if (mode === "hexes") return cell => cell < scene.kindBegin[1] ? qualityColour(scene.quality[cell]) : plain;
  return cell => qualityColour(scene.quality[cell]);
}
