// What the colours mean, as picture/legend.cpp says it, and how the panel shows it.

import {colours, groupColour} from "./colours.js";
import {byId, element, grouped, swatch} from "./dom.js";

const qualityTicks = ["0", "0.25", "0.5", "0.75", "1"];

function qualityKeys(scene, colour) {
  const keys = [];
  if (colour === "hexes" && scene.kindBegin[1] < scene.cellCount) keys.push({colour: colours.plain, text: "other cells"});
  if (scene.quality.some(quality => !(quality > 0))) keys.push({colour: colours.invalid, text: "not positive"});
  return keys;
}

function measureLegend(scene, name) {
  const {best, limit, unit, title} = colours.measures[name], sign = Math.sign(best - limit);
  const ticks = [0, 0.25, 0.5, 0.75, 1].map(part => String(Number(((limit + part * (best - limit)) / unit).toPrecision(3))));
  const missing = scene.measures[name].reduce((count, value) => count + (sign * (value - limit) < 0), 0);
  const text = `${grouped(missing)} ${missing === 1 ? "cell misses" : "cells miss"} it`;
  return {subject: title, ticks, keys: missing > 0 ? [{colour: colours.invalid, text}] : []};
}

const isHidden = (state, kind, tag) => state.hidden.some(group => group.kind === kind && group.tag === tag);

function legendOfColour(scene, state) {
  const {colour} = state;
  if (colour === "kind") {
    const there = scene.kinds.filter((_, k) => scene.kindBegin[k] < scene.kindBegin[k + 1] && state.kinds[k]);
    return {subject: "kind of cell", ticks: [], keys: there.map(({name}) => ({colour: colours.kinds[name], text: name}))};
  }
  if (colour in scene.groups) {
    const keys = scene.groups[colour].map(({tag, name}, place) => ({tag, colour: groupColour(place), text: name}));
    return {subject: colour, ticks: [], keys: keys.filter(({tag}) => !isHidden(state, colour, tag))};
  }
  if (colour in scene.measures) return measureLegend(scene, colour);
  const subject = colour === "hexes" ? "scaled Jacobian of hexes" : "scaled Jacobian";
  return {subject, ticks: qualityTicks, keys: qualityKeys(scene, colour)};
}

// {subject, ticks of the scale (none: no scale), keys of {colour, text}}
export function legendOf(scene, state) {
  const legend = legendOfColour(scene, state);
  if (state.dislocations && scene.dislocations.length > 0)
    legend.keys.push({colour: colours.dislocations, text: "dislocations"});
  return legend;
}

export class LegendPanel {
  constructor(scene, state, changed) {
    this.scene = scene;
    this.state = state;
    this.changed = changed;
  }

  show() {
    const {scene, state} = this, box = byId("legend"), {ticks, keys} = legendOf(scene, state);
    box.replaceChildren();
    if (state.colour in scene.groups) {
      this.showGroups(state.colour, box);
      return;
    }
    if (ticks.length > 0) box.append(...this.scaleWith(ticks));
    for (const {colour, text} of keys) {
      const item = element("span", undefined, {className: "key"});
      item.append(swatch(colour), text);
      box.append(item);
    }
  }

  scaleWith(texts) {
    const scale = element("div", undefined, {className: "scale"}), ticks = element("div", undefined, {className: "ticks"});
    scale.style.background = `linear-gradient(to right, ${colours.quality.join()})`;
    ticks.append(...texts.map(text => element("span", text)));
    return [scale, ticks];
  }

  // A click hides or shows a group, with shift it shows that one alone.
  showGroups(kind, box) {
    const {scene, state} = this, groups = scene.groups[kind];
    const others = state.hidden.filter(group => group.kind !== kind);
    const hide = tags => {
      state.hidden = [...others, ...tags.map(tag => ({kind, tag}))];
      this.changed();
    };
    const tags = groups.map(group => group.tag), hidden = tags.filter(tag => isHidden(state, kind, tag));
    groups.forEach(({tag, name}, place) => {
      const title = `${name} (${tag}): hide or show; with shift, show alone`;
      const item = element("button", undefined, {className: "group", value: tag, title});
      item.append(swatch(groupColour(place)), element("span", name));
      item.setAttribute("aria-pressed", !hidden.includes(tag));
      item.addEventListener("click", ({shiftKey}) => {
        if (shiftKey) hide(tags.filter(other => other !== tag));
        else hide(hidden.includes(tag) ? hidden.filter(other => other !== tag) : [...hidden, tag]);
      });
      box.append(item);
    });
    if (hidden.length > 0) {
      const all = element("button", "Show all", {className: "all"});
      all.addEventListener("click", () => hide([]));
      box.append(all);
    }
    if (groups.length === 0) box.append(`This file has no ${kind}s.`);
  }
}
