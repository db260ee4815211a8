// The card with the controls: what they show follows the state, and what they change is told by changed().

import {cornersOf, kindOf} from "./cells.js";
import {colours, groupColour} from "./colours.js";
import {Histogram} from "./histogram.js";
import {axes, directionName} from "./state.js";

const byId = id => document.getElementById(id);
const grouped = new Intl.NumberFormat("en").format;
const plurals = {hex: "hexes", prism: "prisms", pyramid: "pyramids", tet: "tets"};

function element(tag, text, properties = {}) {
  const result = Object.assign(document.createElement(tag), properties);
  if (text !== undefined) result.textContent = text;
  return result;
}

function swatch(colour) {
  const box = element("b");
  box.style.background = colour;
  return box;
}

function brief(value) {
  if (typeof value !== "number" || !Number.isFinite(value)) return String(value);
  return Number.isInteger(value) ? grouped(value) : String(Number(value.toPrecision(4)));
}

// What a tool said, a line for what stands together: single values, and behind them what is told part by part, but for
// lists and for parts of parts, which only programs read.
function linesOf(name, entry, depth = 0) {
  const single = Object.entries(entry).filter(([, value]) => typeof value !== "object");
  const parts = Object.entries(entry).filter(([, value]) => value && typeof value === "object" && !Array.isArray(value));
  const words = single.map(([key, value]) => `${key.replaceAll("_", " ")} ${brief(value)}`);
  return [...words.length ? [(name && `${name.replaceAll("_", " ")}: `) + words.join(" · ")] : [],
    ...depth < 2 && entry.count !== 0 ? parts.flatMap(([key, part]) => linesOf(key, part, depth + 1)) : []];
}

export class Panel {
  // actions: changed(), viewDirection() -> a unit vector, link(), png(), reset()
  constructor(scene, state, actions) {
    this.scene = scene;
    this.state = state;
    this.actions = actions;
    this.histogram = new Histogram(scene, state, actions.changed);
    this.makeHeadline();
    this.makeCounts();
    this.makeHistory();
    this.connectChoices();
    this.connectSliders();
    for (const name of ["link", "png", "reset"]) byId(name).addEventListener("click", actions[name]);
    byId("theme").addEventListener("click", () => {
      state.theme = state.theme === "dark" ? "light" : "dark";
      actions.changed();
    });
    byId("fold").addEventListener("click", () => {
      byId("fold").textContent = byId("panel").classList.toggle("folded") ? "+" : "–";
    });
    byId("panel").hidden = false;
  }

  // Candidates overlap, and a tet mesh has no hexes: neither has a share to tell.
  makeHeadline() {
    const {scene} = this, total = scene.volume.reduce((a, b) => a + b, 0), headline = byId("headline");
    headline.hidden = !["result", "solution"].includes(scene.content) || !(total > 0);
    headline.append(element("b", `${(100 * scene.volume[0] / total).toFixed(1)} %`), " of the volume in hexes");
  }

  makeCounts() {
    const {scene, state} = this;
    this.kindButtons = scene.kinds.map(({name}, k) => {
      const total = scene.kindBegin[k + 1] - scene.kindBegin[k];
      const button = element("button", undefined, {title: `Show or hide ${plurals[name]}`, hidden: total === 0});
      button.dataset.kind = name;
      button.append(swatch(colours.kinds[name]), element("span", plurals[name]), element("span", grouped(total)),
        element("span", `${(100 * total / scene.cellCount).toFixed(1)} %`));
      button.style.display = total === 0 ? "none" : "";
      button.addEventListener("click", () => {
        state.kinds[k] = !state.kinds[k];
        this.actions.changed();
      });
      return button;
    });
    byId("counts").append(...this.kindButtons, element("div", "", {className: "total"}));
  }

  makeHistory() {
    const {history} = this.scene, list = byId("history").querySelector("ol");
    byId("history").hidden = history.length === 0;
    for (const {tool, version, options, ...rest} of history) {
      const item = element("li", undefined, {title: `${tool} ${version ?? ""}`});
      item.append(element("b", tool), ...linesOf("", rest).map(line => element("div", line)));
      item.append(element("div", Object.entries(options ?? {}).map(([k, v]) => `--${k} ${brief(v)}`).join("  ")));
      list.append(item);
    }
  }

  connectChoices() {
    const {state, actions} = this;
    for (const choice of ["colour", "measures"])
      byId(choice).addEventListener("click", ({target}) => {
        if (!target.value) return;
        state.colour = target.value;
        actions.changed();
      });
    byId("measures").hidden = Object.keys(this.scene.measures).length === 0;
    byId("clip-axis").addEventListener("click", ({target}) => {
      if (!target.value) return;
      const fraction = state.clip?.fraction ?? 0.5;
      if (target.value === "none") state.clip = null;
      else if (target.value === "view") state.clip = {normal: actions.viewDirection(), fraction};
      else if (target.value === "flip")
        state.clip = state.clip && {normal: state.clip.normal.map(n => n === 0 ? 0 : -n), fraction: 1 - fraction};
      else state.clip = {normal: this.towardsCamera(axes[target.value]), fraction};
      actions.changed();
    });
    byId("edges").addEventListener("change", ({target}) => {
      state.edges = target.checked;
      actions.changed();
    });
  }

  // What is taken away is what would hide the cut.
  towardsCamera(axis) {
    const view = this.actions.viewDirection();
    return axis.reduce((sum, n, i) => sum + n * view[i], 0) < 0 ? axis.map(n => n === 0 ? 0 : -n) : axis;
  }

  connectSliders() {
    const {scene, state, actions} = this;
    let deepest = 1;
    for (const layer of scene.layer) if (layer < 255) deepest = Math.max(deepest, layer);
    byId("peel").max = deepest - 1;
    byId("fragments").hidden = scene.fragments.length === 0;
    byId("fragment").max = scene.fragments.length;
    byId("clip").addEventListener("input", ({target}) => {
      state.clip = {normal: state.clip?.normal ?? this.towardsCamera(axes.x), fraction: target.valueAsNumber};
      actions.changed();
    });
    for (const name of ["peel", "fragment"])
      byId(name).addEventListener("input", ({target}) => {
        state[name] = target.valueAsNumber;
        actions.changed();
      });
  }

  // `counts`: cells shown of each kind.
  show(counts) {
    const {scene, state} = this;
    document.documentElement.dataset.theme = state.theme;
    const press = (button, on) => button.setAttribute("aria-pressed", on);
    this.kindButtons.forEach((button, k) => press(button, state.kinds[k]));
    for (const button of [...byId("colour").children, ...byId("measures").children]) press(button, button.value === state.colour);
    const axis = state.clip ? (directionName(state.clip.normal) ?? "view").replace("-", "") : "none";
    for (const button of byId("clip-axis").children) press(button, button.value === axis);
    byId("clip").value = state.clip?.fraction ?? 1;
    byId("clip-value").textContent = state.clip ? `${Math.round(100 * state.clip.fraction)} %` : "";
    byId("peel").value = state.peel;
    byId("peel-value").textContent = state.peel ? `${state.peel} ${state.peel === 1 ? "layer" : "layers"}` : "";
    byId("fragment").value = state.fragment;
    byId("fragment-value").textContent = state.fragment ? `${state.fragment} of ${scene.fragments.length}` : "all";
    byId("edges").checked = state.edges;
    const shown = counts.reduce((a, b) => a + b, 0);
    byId("counts").querySelector(".total").textContent = shown === scene.cellCount
      ? `${grouped(shown)} cells` : `${grouped(shown)} of ${grouped(scene.cellCount)} cells shown`;
    this.showLegend();
    this.histogram.show();
  }

  showLegend() {
    const {scene, state} = this, legend = byId("legend");
    legend.replaceChildren();
    const key = (colour, text) => {
      const item = element("span", undefined, {className: "key"});
      item.append(swatch(colour), text);
      legend.append(item);
    };
    if (state.colour === "kind")
      scene.kinds.forEach(({name}, k) => scene.kindBegin[k] < scene.kindBegin[k + 1] && key(colours.kinds[name], name));
    else if (state.colour in scene.groups) this.showGroups(state.colour, legend);
    else if (state.colour in scene.measures) {
      const {best, limit, unit} = colours.measures[state.colour], sign = Math.sign(best - limit);
      this.showScale(legend, [0, 0.25, 0.5, 0.75, 1].map(part => Number(((limit + part * (best - limit)) / unit).toPrecision(3))));
      const missing = scene.measures[state.colour].reduce((count, value) => count + (sign * (value - limit) < 0), 0);
      if (missing > 0) key(colours.invalid, `${grouped(missing)} ${missing === 1 ? "cell misses" : "cells miss"} it`);
    } else {
      this.showScale(legend, ["0", "0.25", "0.5", "0.75", "1"]);
      if (state.colour === "hexes") key(colours.plain, "other cells");
      if (scene.quality.some(quality => !(quality > 0))) key(colours.invalid, "not positive");
    }
  }

  showScale(legend, texts) {
    const scale = element("div", undefined, {className: "scale"});
    scale.style.background = `linear-gradient(to right, ${colours.quality.join()})`;
    const ticks = element("div", undefined, {className: "ticks"});
    ticks.append(...texts.map(text => element("span", String(text))));
    legend.append(scale, ticks);
  }

  // The legend of regions or surfaces: a click hides or shows a group, with shift it shows that one alone.
  showGroups(kind, legend) {
    const {scene, state} = this, groups = scene.groups[kind];
    const others = state.hidden.filter(group => group.kind !== kind);
    const isHidden = tag => state.hidden.some(group => group.kind === kind && group.tag === tag);
    const hide = tags => {
      state.hidden = [...others, ...tags.map(tag => ({kind, tag}))];
      this.actions.changed();
    };
    const tagsBut = tag => groups.map(group => group.tag).filter(other => other !== tag);
    groups.forEach(({tag, name}, place) => {
      const item = element("button", undefined, {className: "group", value: tag, title: `${name} (${tag}): hide or show; with shift, show alone`});
      item.append(swatch(groupColour(place)), element("span", name));
      item.setAttribute("aria-pressed", !isHidden(tag));
      item.addEventListener("click", ({shiftKey}) => {
        const hidden = groups.map(group => group.tag).filter(isHidden);
        if (shiftKey) hide(tagsBut(tag));
        else hide(isHidden(tag) ? hidden.filter(other => other !== tag) : [...hidden, tag]);
      });
      legend.append(item);
    });
    if (groups.some(({tag}) => isHidden(tag))) {
      const all = element("button", "Show all", {className: "all"});
      all.addEventListener("click", () => hide([]));
      legend.append(all);
    }
    if (groups.length === 0) legend.append(`This file has no ${kind}s.`);
  }

  nameOf(kind, place) {
    const {tag, name} = this.scene.groups[kind][place];
    return name === `${kind}_${tag}` ? String(tag) : `${name} (${tag})`;
  }

  // -1: none.
  showCell(cell, surface) {
    const {scene} = this, table = byId("picked").querySelector("table");
    byId("picked").hidden = cell < 0;
    table.replaceChildren();
    if (cell < 0) return;
    const row = (name, value) => table.insertRow().append(element("td", name), element("td", value));
    const corners = cornersOf(scene, cell), middle = [0, 0, 0];
    for (const v of corners)
      for (let axis = 0; axis < 3; ++axis) middle[axis] += scene.points[3 * v + axis] / corners.length;
    // Candidates and the tets that they leave count from 1, as in .sol files and messages; cells of a mesh from 0.
    const first = ["candidates", "solution"].includes(scene.content) ? 1 : 0;
    row(scene.content === "candidates" ? "candidate" : scene.kinds[kindOf(scene, cell)].name,
      `number ${scene.number[cell] + first}`);
    row("scaled Jacobian", scene.quality[cell].toFixed(4));
    for (const [name, values] of Object.entries(scene.measures)) {
      const {title, unit, decimals} = colours.measures[name];
      row(title, (values[cell] / unit).toFixed(decimals) + (name === "orthogonality" ? "°" : ""));
    }
    row("region", this.nameOf("region", scene.groups.region.findIndex(({tag}) => tag === scene.region[cell])));
    if (surface >= 0) row("surface", this.nameOf("surface", surface));
    row("layer", scene.layer[cell]);
    row("vertices", [...corners].join(" "));
    row("middle", middle.map((m, i) => Number((scene.centre[i] + scene.unit * m).toPrecision(5))).join(", "));
    byId("picked").scrollIntoView({block: "nearest"});
  }
}
