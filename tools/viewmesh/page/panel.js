// The card with the controls: what they show follows the state, and what they change is told by changed().

import {hexShare} from "./cells.js";
import {colours} from "./colours.js";
import {byId, element, grouped, swatch} from "./dom.js";
import {Histogram} from "./histogram.js";
import {showHistory} from "./history.js";
import {LegendPanel} from "./legend.js";
import {axes, directionName} from "./state.js";

const plurals = {hex: "hexes", prism: "prisms", pyramid: "pyramids", tet: "tets"};
const switches = ["edges", "axes", "dislocations"];

export class Panel {
  // actions: changed(), viewDirection() -> a unit vector, and what buttons do: link(), png(), reset(), fit()
  constructor(scene, state, actions) {
    this.scene = scene;
    this.state = state;
    this.actions = actions;
    this.histogram = new Histogram(scene, state, actions.changed);
    this.makeHeadline();
    this.makeCounts();
    showHistory(scene.history);
    this.legend = new LegendPanel(scene, state, actions.changed);
    this.connectChoices();
    this.connectSliders();
    for (const name of ["link", "png", "reset", "fit"]) byId(name).addEventListener("click", actions[name]);
    byId("theme").addEventListener("click", () => {
      state.theme = state.theme === "dark" ? "light" : "dark";
      actions.changed();
    });
    byId("fold").addEventListener("click", () => {
      byId("fold").textContent = byId("panel").classList.toggle("folded") ? "+" : "–";
      actions.changed();
    });
    byId("panel").hidden = false;
  }

  makeHeadline() {
    const share = hexShare(this.scene);
    byId("headline").hidden = share === null;
    byId("headline").append(element("b", share ?? ""), " of the volume in hexes");
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
    for (const name of switches)
      byId(name).addEventListener("change", ({target}) => {
        state[name] = target.checked;
        actions.changed();
      });
    for (const part of document.querySelectorAll(".of-dislocations")) part.hidden = this.scene.dislocations.length === 0;
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
    for (const name of switches) byId(name).checked = state[name];
    const shown = counts.reduce((a, b) => a + b, 0);
    byId("counts").querySelector(".total").textContent = shown === scene.cellCount
      ? `${grouped(shown)} cells` : `${grouped(shown)} of ${grouped(scene.cellCount)} cells shown`;
    this.legend.show();
    this.histogram.show();
  }
}
